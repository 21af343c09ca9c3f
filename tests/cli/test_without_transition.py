"""Logs whose fit announces no transition: report, map and posterior answer, and claim what was measured."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.cli.command import run

DRIVETRAIN = """
[drivetrain]
stiffness = "9 N/mm"
mass = "8 kg"
roll_radius = "20 mm"
stick_speed = "1 mm/s"
"""
#: 4 to 140 rpm are 8.4 to 293 mm/s at the belt.
SLOWEST, FASTEST = 0.0084, 0.293


def _point(name: str, speed: float, celsius: float) -> str:
    return f'[[points]]\nname = "{name}"\nspeed = "{speed} mm/s"\ntemperature = "{celsius} degC"\n'


def _written(folder: Path, torque: Callable[[np.ndarray], np.ndarray]) -> Path:
    """Dwells of a torque from 4 to 140 rpm, 1 % scatter, isothermal; a machine with a point."""
    speeds = np.repeat(np.geomspace(4.0, 140.0, 10), 3) * np.pi / 30.0
    noise = np.random.default_rng(2).standard_normal(speeds.size)
    torques = torque(speeds) * np.exp(0.01 * noise)
    rows = [f"{w:.9g},{t:.9g}" for w, t in zip(speeds.tolist(), torques.tolist(), strict=True)]
    (folder / "means.csv").write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows, ""]))
    (folder / "machine.toml").write_text(DRIVETRAIN + _point("fast", 250, 100))
    return folder


def _reported(folder: Path) -> dict[str, Any]:
    given = ("means.csv", "--means", "--isothermal", "--machine", "machine.toml", "--json")
    done = run("report", *given, cwd=folder)
    assert done.returncode == 0, done.stderr
    document: dict[str, Any] = json.loads(done.stdout)
    return document


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Torque 0.3 (w/1 rad/s)^0.4 N m."""
    return _written(tmp_path_factory.mktemp("rising"), lambda w: 0.3 * w**0.4)


def test_the_report_says_what_the_machine_does(here: Path) -> None:
    document = _reported(here)
    assert document["fit"]["transition"] is None
    assert (document["fit"]["trend"]["rises"], document["fit"]["trend"]["falls"]) == (True, False)
    decision = document["decision"]
    # whatever the closure: V* of a film that only rises is near the slowest dwell or below
    assert decision["fold"]["low"] < SLOWEST < 4.0 * decision["fold"]["high"]
    assert SLOWEST < decision["safe_speed"] < 1.0
    [point] = decision["points"]
    assert point["smooth"] > 0.85
    assert point["sticks"] < 0.01
    curve = document["fit"]["curves"][0]
    speed = np.array(curve["speed"])
    assert speed * np.array(curve["damping"]) == pytest.approx(0.3 * speed**0.4, rel=0.02)


@pytest.mark.usefixtures("roughly")
def test_map_and_posterior_need_no_transition(here: Path) -> None:
    given = ("means.csv", "--means", "--isothermal")
    done = run("map", "machine.toml", *given, "--out", "map.svg", cwd=here)
    assert done.returncode == 0, done.stderr
    assert "fast (250 mm/s" in done.stdout
    drawn = run("posterior", *given, "--machine", "machine.toml", "--draws", "100", "-v", cwd=here)
    assert drawn.returncode == 0, drawn.stderr
    assert "constant torque plus a power of speed" in drawn.words
    page = run("report", *given, "--machine", "machine.toml", "--out", "r.html", cwd=here)
    assert page.returncode == 0, page.stderr


def _falling(w: np.ndarray) -> np.ndarray:
    return 0.3 * w**-0.3


def _hump(w: np.ndarray) -> np.ndarray:
    return np.asarray(0.3 * np.exp(-(np.log(w / 2.5) ** 2) / 3.0))


@pytest.mark.usefixtures("few_laws")
@pytest.mark.parametrize(("torque", "rises"), [(_falling, False), (_hump, True)])
def test_torque_that_still_falls_at_the_fastest_dwell_bounds_nothing(
    tmp_path: Path, torque: Callable[[np.ndarray], np.ndarray], rises: bool
) -> None:
    """No V* and no verdict above: no dwell shows where it turns. Below, torque that falls surely sticks."""
    document = _reported(_written(tmp_path, torque))
    decision, trend = document["decision"], document["fit"]["trend"]
    assert decision["safe_speed"] is None
    assert decision["fold"] is None
    assert decision["interval"].startswith(
        "V* is not known: torque may still fall at the fastest dwell. Record faster"
    )
    [point] = decision["points"]
    assert point["verdict"] == ("unknown" if rises else "sticks")
    assert point["smooth"] < 0.01
    assert point["plan"] is None
    assert (trend["rises"], trend["falls"]) == (rises, True)
    below = float(re.findall(r"Below ([\d.]+) mm/s it sticks", decision["otherwise"])[0])
    assert below < 50.0 if rises else below == pytest.approx(1e3 * FASTEST, rel=0.02)


@pytest.mark.usefixtures("few_draws", "few_laws")
def test_a_point_without_a_verdict_leaves_the_others_theirs(tmp_path: Path) -> None:
    """Dwells from 60 to 180 degC; points at 25 degC and below 0 degC."""
    rng, rows = np.random.default_rng(3), []
    speeds = np.geomspace(0.5, 15.0, 8)
    for celsius in (60.0, 100.0, 140.0, 180.0):
        scaled = speeds / (celsius / 100.0) ** 2
        torque = 0.15 * (scaled**0.4 + scaled**-0.5) * np.exp(0.01 * rng.standard_normal(8))
        rows += [f"{w:.9g},{t:.9g},{celsius}" for w, t in zip(speeds, torque, strict=True)]
    head = "Speed [rad/s],Torque [N*m],Temperature [degC]"
    (tmp_path / "warm.csv").write_text("\n".join([head, *rows, ""]))
    points = _point("fast", 250, 100) + _point("frost", 250, -5) + _point("cool", 250, 25)
    (tmp_path / "machine.toml").write_text(DRIVETRAIN + points)
    given = ("warm.csv", "--means")
    done = run("report", *given, "--machine", "machine.toml", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    decision = json.loads(done.stdout)["decision"]
    said = {point["name"]: point for point in decision["points"]}
    for name in ("fast", "cool"):
        assert said[name]["verdict"] in ("smooth", "depends", "unknown")
    assert said["frost"]["words"].startswith("not judged: temperature is 268.15 K")
    assert decision["fold"] is not None
    drawn = run("map", "machine.toml", *given, "--out", "m.svg", cwd=tmp_path)
    assert drawn.returncode == 0, drawn.stderr
    assert "frost: not judged" in drawn.stdout
