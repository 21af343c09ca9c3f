"""The physical truth of the stand, and the shipped drive: one machine, told again by its log."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey import testbench
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of
from hersey.errors import ParameterError
from hersey.machine.machine import Machine, read_machine
from hersey.study import study
from hersey.study.torque_budget import torque_budget
from hersey.testbench import RPM, FullTruth, PhysicalTruth
from hersey.units import ZERO_CELSIUS
from tests.conftest import ROOT

EXAMPLES = ROOT / "examples"
REST = NoLoadTorque.stated(constant=0.18, per_speed=1e-3)


@pytest.fixture(scope="module")
def machine() -> Machine:
    return read_machine(EXAMPLES / "machine.toml")


@pytest.fixture(scope="module")
def shipped() -> dict[str, object]:
    def strange(name: str) -> float:
        raise AssertionError(f"{name} is no JSON")

    told: dict[str, object] = json.loads((EXAMPLES / "bench-truth.json").read_text(), parse_constant=strange)
    return told


@pytest.fixture(scope="module")
def page(machine: Machine) -> Analysis:
    log = hersey.read(EXAMPLES / "bench.csv")
    assert machine.rest is not None
    return document_of(study(log.steady(tare="standing").without(machine.rest), machine))


def test_torque_is_that_of_contact_and_rest(machine: Machine) -> None:
    speed, level = np.array([-3.0, 0.0, 0.6, 9.0]), np.full(4, 170.0)
    torque = PhysicalTruth(machine.mixed, REST).torque(speed, level)
    assert machine.mixed is not None
    alone = machine.mixed.at(speed=np.abs(speed), temperature=level + ZERO_CELSIUS).torque
    assert torque == pytest.approx(np.sign(speed) * (alone + 0.18 + 1e-3 * np.abs(speed)), rel=1e-12)
    assert torque[1] == 0.0


def test_without_a_contact_it_is_a_no_load_log() -> None:
    free = PhysicalTruth(None, REST)
    assert free.torque(np.array([2.0]), np.array([90.0])) == pytest.approx([0.182])
    stand = testbench.Stand(temperatures_degC=(90.0,), speeds_rpm=(20.0, 40.0), stick_slip=False)
    told = testbench.run(truth=free, stand=stand).truth_document()
    assert told["transition_speeds_rpm"] == [None]
    with pytest.raises(ParameterError, match="a drive without contact cannot stick"):
        testbench.run(truth=free, stand=testbench.Stand(temperatures_degC=(90.0,), speeds_rpm=(20.0,)))


def test_the_shipped_files_are_those_of_the_script(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, EXAMPLES / "bench_drive.py", tmp_path], check=False, capture_output=True
    )
    assert done.returncode == 0, done.stderr
    for name in ("bench.csv", "no-load.csv"):
        again, there = ((folder / name).read_text().splitlines() for folder in (tmp_path, EXAMPLES))
        assert again[:2] == there[:2]
        rows = [np.array([line.split(",") for line in lines[2:]], dtype=float) for lines in (again, there)]
        assert rows[0] == pytest.approx(rows[1], abs=2e-3)  # a last digit may round otherwise elsewhere
    assert (EXAMPLES / "bench.csv").stat().st_size < 1e6


def test_the_log_tells_the_rest_of_the_drive(machine: Machine) -> None:
    assert machine.rest is not None
    for name in ("constant", "per_speed"):
        estimate, true = getattr(machine.rest, name), getattr(REST, name).value
        assert estimate.low < true < estimate.high, name


def test_the_log_tells_transition_and_exponent(page: Analysis, shipped: dict[str, object]) -> None:
    transition = page.film and page.film.transition
    assert transition
    speeds = shipped["transition_speeds_rpm"]
    assert transition.speed == pytest.approx(np.multiply(speeds, RPM), rel=0.02)  # warmer by a few tenths
    for low, true, high in zip(transition.low, np.multiply(speeds, RPM), transition.high, strict=True):
        assert low < true < high
    found = np.divide(transition.measured, transition.speed)
    assert np.all((found > 1 / 1.5) & (found < 1.5))
    c = page.fit.coefficients["c"]
    assert c.low is not None
    assert c.high is not None
    assert page.film is not None
    assert page.film.exponents is not None
    assert c.low < (page.film.exponents.solved or 0.0) < c.high


def test_the_page_does_not_contradict_itself(page: Analysis) -> None:
    text = " ".join(page.verdict)
    assert "The measured exponent agrees with that regime" in text
    assert "which agrees" in text
    assert "contradict" not in text
    assert "disagrees" not in text
    film = page.film
    assert film is not None
    assert film.measured is not None
    assert 0.9 < film.measured.calibration.value < 1.1
    assert not any(
        word in each.text
        for each in film.warnings
        for word in ("times the prediction", "exceeds", "strained")
    )


def test_the_page_says_who_carries_the_torque(page: Analysis, machine: Machine) -> None:
    budget = page.torque_budget
    assert budget is not None
    low, mean, high = budget.ratio
    assert 0.5 < low < high < 2.0
    assert mean == pytest.approx(1.0, abs=0.02)
    whole = np.sum([budget.rest, budget.contact, budget.shear, budget.inlet], axis=0)
    truth = FullTruth(machine.mixed, REST)
    level = np.full(whole.size, budget.temperature - ZERO_CELSIUS)
    assert whole == pytest.approx(truth.torque(np.array(budget.speed), level), rel=0.01)
    shares, agreement, hard = budget.text
    assert "208 mN m at 5 rpm (film 3 %, contact 10 %, no-load 87 %)" in shares
    assert "at 17.4 rpm (film 6 %, contact 1 %, no-load 94 %)" in shares
    assert agreement.startswith("Measured torque is 1.00 times that")
    assert hard.startswith("Eq. 9 gives 1 N m at 17.4 rpm, 84 times film and contact")
    # The level of the paper, 50 ozf at 1 in/s.
    assert np.interp(0.0254 / 0.015, budget.speed, whole) == pytest.approx(50 * 0.278 * 0.015, rel=0.15)


def test_without_asperities_nothing_is_said_of_who_carries(machine: Machine) -> None:
    log = hersey.read(EXAMPLES / "bench.csv")
    points = log.steady(tare="standing")
    surface = hersey.fit(points)
    assert torque_budget(points, surface, None) is None
    assert torque_budget(points, surface, replace(machine, asperities=None, boundary=None)) is None
    whole = torque_budget(points, surface, machine)  # the rest not taken off: far more than the film makes
    assert whole is not None
    assert "so the machine file does not describe this log" in whole.text[1]
