"""The paper's motion against `values.json`, which `make_values.py` computes without hersey."""

from __future__ import annotations

import json
from typing import Any

import pytest

import hersey
from tests.conftest import shared
from tests.reference import make_values
from tests.reference.make_values import PLACE, Belt

VALUES = json.loads(PLACE.read_text())


def named(row: dict[str, Any]) -> str:
    return "-".join(f"{name}={value}" for name, value in row["change"].items()) or "baseline"


def parts(change: dict[str, Any]) -> tuple[hersey.Drivetrain, hersey.Drag, float]:
    """Drivetrain, drag and drive speed of the baseline with a change."""
    given = VALUES["baseline"] | change
    train = hersey.Drivetrain(given.pop("stiffness"), given.pop("mass"))
    speed = given.pop("drive_speed")
    drag = hersey.Drag(transition_speed=1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, **given)
    return train, drag, speed


def test_the_motion_from_rest() -> None:
    """Both kinds of stick: held back beyond v_s, and at v_s."""
    train, drag, speed = parts({})
    run = hersey.simulate(train, drag, drive_speed=speed, duration=1.3, tolerance=1e-13)
    ends = [event for event in run.events if "stuck" in (event.from_mode, event.to_mode)]
    for event, expected in zip(ends, VALUES["events_from_rest"], strict=False):
        assert (event.to_mode == "stuck") == (expected["kind"] == "stick")
        seen = (event.time, event.stretch, event.belt_speed)
        wanted = (expected["time"], expected["stretch"], expected["speed"])
        assert seen == pytest.approx(wanted, rel=1e-11, abs=1e-13)
    assert len(ends) >= len(VALUES["events_from_rest"]) == 6


@pytest.mark.parametrize("row", VALUES["cycles"], ids=named)
@pytest.mark.parametrize(("tolerance", "accuracy"), [(1e-13, 1e-12), (None, 1e-8)])
def test_cycles(row: dict[str, Any], tolerance: float | None, accuracy: float) -> None:
    train, drag, speed = parts(row["change"])
    asked = {} if tolerance is None else {"tolerance": tolerance}
    cycle = hersey.stick_slip(train, drag, drive_speed=speed, **asked)
    assert cycle.kind == "stick_slip"
    for name in ("frequency", "speed_max", "stuck_fraction"):
        assert getattr(cycle, name) == pytest.approx(row[name], rel=accuracy)


@pytest.mark.parametrize("row", VALUES["folds"], ids=named)
def test_folds(row: dict[str, Any]) -> None:
    train, drag, _ = parts(row["change"])
    assert hersey.hysteresis(train, drag, sensitivity=False).upper == pytest.approx(row["fold"], rel=1e-9)


def test_the_file_is_what_its_script_makes() -> None:
    """One cycle and, of a fold, that a lap misses above it and not below."""
    (baseline,) = [row for row in VALUES["cycles"] if row["change"] == {"drive_speed": 1.0}]
    made = make_values.cycle(Belt())
    assert made == pytest.approx({name: baseline[name] for name in made}, rel=1e-12)
    fold = VALUES["folds"][0]["fold"]
    below, above = (make_values.margin(Belt(drive_speed=fold * (1 + d))) for d in (-1e-9, 1e-9))
    assert below < 0 < above


def test_the_file_agrees_with_the_solution_of_others() -> None:
    rows = json.loads(shared("reference/stick-slip.json").read_text())
    keys = {"k": "stiffness", "B0": "transition_force", "m": "mass", "vs": "stick_speed", "v2": "drive_speed"}
    of = {tuple(sorted((VALUES["baseline"] | row["change"]).items())): row for row in VALUES["cycles"]}
    assert len(rows) == len(of)
    for row in rows:
        drive = {ours: row[theirs] for theirs, ours in keys.items()} | {"closure": row["law"]}
        ours = of[tuple(sorted(drive.items()))]
        near = 1e-11 if row["law"] == "retained" else 1e-9  # their stiction is coarser
        assert ours["frequency"] == pytest.approx(row["frequency"], rel=near)
        assert ours["speed_max"] == pytest.approx(row["v_max"], rel=1e-11)
        assert ours["stuck_fraction"] == pytest.approx(row["stuck_fraction"], rel=10 * near)
