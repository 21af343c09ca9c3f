"""One question comes before any conclusion where a number cannot be what it is called."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.decision.plausibility import Question, asked
from hersey.document.assembly import document_of
from hersey.machine.limits import Limits, OperatingPoint
from hersey.study import study
from hersey.study.first_screen.questions import in_words
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def machine() -> hersey.Machine:
    """The demo's machine without its no-load log, which is of the same unit."""
    stated = hersey.read_machine(ROOT / "examples" / "machine.toml")
    limits = replace(stated.limits, motor_torque=8.0)
    return replace(stated, rest=None, limits=limits)


def _points(points: hersey.SteadyPoints, **factors: float) -> hersey.SteadyPoints:
    table = points.table
    for name, factor in factors.items():
        table = table.with_columns((table[name] * factor).alias(name))
    return replace(points, table=table)


def _asked(points: hersey.SteadyPoints, machine: hersey.Machine) -> Question | None:
    return asked(points, hersey.fit(points), machine)


def test_possible_numbers_are_not_asked_about(points: hersey.SteadyPoints, machine: hersey.Machine) -> None:
    assert _asked(points, machine) is None
    assert asked(points, hersey.fit(points), None) is None
    bare = replace(machine, limits=Limits(), points=())
    assert _asked(points, bare) is None


def test_a_torque_in_the_wrong_unit_is_asked_about(
    points: hersey.SteadyPoints, machine: hersey.Machine
) -> None:
    median = float(np.median(np.abs(points.column("torque"))))
    found = _asked(_points(points, torque=1e3, torque_error=1e3), machine)
    assert found is not None
    assert (found.kind, found.of) == ("torque unit", "motor")
    assert found.times == pytest.approx(1e3 * median / 8.0)
    text, remedy = in_words(replace(found, value=840.0 * 8.0))
    assert text == "Is torque in mN·m? It is 840 times your motor's limit"
    assert remedy == "Give the unit with units={'torque': ...}."


def test_a_radius_in_metres_is_asked_about(points: hersey.SteadyPoints, machine: hersey.Machine) -> None:
    found = _asked(points, replace(machine, roll_radius=15.0))
    assert found is not None
    assert found.kind == "radius unit"
    assert in_words(found)[0] == "Is the radius 15000 mm? That is 15 m"


def test_swapped_columns_are_asked_about(points: hersey.SteadyPoints, machine: hersey.Machine) -> None:
    """Torque as large as speeds, and speeds as small as torques."""
    slow = _points(points, torque=400.0, torque_error=400.0, speed=1e-2)
    far = replace(machine, points=(OperatingPoint("full speed", 0.2, 453.15),))
    found = _asked(slow, far)
    assert found is not None
    assert found.kind == "swapped"
    assert in_words(found)[0].startswith("Are the torque and speed columns swapped?")


@pytest.mark.usefixtures("few_draws")
def test_the_first_screen_asks_and_concludes_nothing(bench_csv: Path, machine: hersey.Machine) -> None:
    text = bench_csv.read_text().replace("Drive torque [N*m]", "Drive torque [kN*m]")
    path = bench_csv.parent / "thousandfold.csv"
    path.write_text(text)
    log = hersey.read(path)
    document = document_of(study(log.steady(tare="standing"), machine))
    said = document.decision
    assert said is not None
    assert said.instruction.startswith("Is torque in mN·m? It is ")
    assert said.signal == "act"
    assert said.otherwise.endswith("Until then, nothing is concluded.")
    assert {point.words for point in said.points} == {"not judged until the question is answered"}
    assert said.safe_speed is None


def test_doubts_about_the_machine_are_warnings_of_the_study(
    points: hersey.SteadyPoints, machine: hersey.Machine
) -> None:
    alone = study(points)
    for stiffness, kinds in ((machine.stiffness, []), (1.1, ["natural frequency"])):
        soft = replace(machine, stiffness=stiffness)
        assert [warning.kind for warning in soft.warnings] == kinds
        with_machine = replace(alone, machine=soft, machine_file=Path("soft.toml"))
        found = [warning for warning in with_machine.warnings if warning.where == "soft.toml"]
        assert [warning.kind for warning in found] == kinds
    assert found[0].number("frequency") == pytest.approx((1.1 / machine.mass) ** 0.5 / (2.0 * np.pi))
