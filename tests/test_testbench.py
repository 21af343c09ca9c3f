"""The virtual test stand: seeded, honest about itself, and with every disturbance it promises."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest

from hersey import testbench
from hersey.errors import ParameterError
from hersey.testbench import RPM, Stand, Truth

QUIET = {
    "torque_noise": 0.0,
    "repeatability": 0.0,
    "torque_offset": 0.0,
    "torque_step": 0.0,
    "speed_ripple": 0.0,
    "mesh_ripple": 0.0,
    "inertia": 0.0,
    "temperature_noise": 0.0,
    "dropped": 0.0,
    "stick_slip": False,
}


def text(**arguments: object) -> str:
    out = io.StringIO()
    testbench.run(**arguments).write(out)  # type: ignore[arg-type]
    return out.getvalue()


def test_the_same_seed_gives_the_same_log() -> None:
    assert text(seed=4) == text(seed=4)
    assert text(seed=4) != text(seed=5)


def test_it_says_that_it_is_synthetic() -> None:
    assert text(seed=1).startswith("# SYNTHETIC")
    document = testbench.run(seed=1).truth_document()
    assert document["synthetic"] is True
    assert json.loads(json.dumps(document))["truth"]["c"] == -0.7


def test_a_quiet_stand_shows_the_truth() -> None:
    truth = Truth()
    table = testbench.run(stand=Stand(**QUIET)).table  # type: ignore[arg-type]
    time, torque, rpm, celsius = (table[c].to_numpy() for c in testbench.COLUMNS)
    moving = rpm > 0
    expected = truth.torque(rpm * RPM, celsius)
    np.testing.assert_allclose(torque[moving], expected[moving], rtol=2e-3, atol=1e-4)
    np.testing.assert_allclose(np.diff(time), 0.05, atol=1e-9)


def test_torque_is_continuous_at_the_transition() -> None:
    truth = Truth()
    celsius = np.array([100.0, 180.0])
    at = truth.transition_speed(celsius)
    np.testing.assert_allclose(
        truth.torque(at * (1 - 1e-9), celsius), truth.torque(at * (1 + 1e-9), celsius), rtol=1e-6
    )
    # a fixed Hersey number: viscosity ~ T^(b/(1+c)) times speed does not change along it
    np.testing.assert_allclose(at * celsius ** (truth.b / (1 + truth.c)), at[0] * 100.0**-3.0, rtol=1e-9)


@pytest.mark.parametrize(
    "disturbance", ["torque_noise", "torque_offset", "speed_ripple", "mesh_ripple", "inertia", "dropped"]
)
def test_each_disturbance_does_something(disturbance: str) -> None:
    quiet = testbench.run(stand=Stand(**QUIET)).table  # type: ignore[arg-type]
    value = getattr(Stand(), disturbance)
    disturbed = testbench.run(stand=Stand(**(QUIET | {disturbance: value}))).table  # type: ignore[arg-type]
    assert not disturbed.equals(quiet)


def test_the_heater_overshoots() -> None:
    table = testbench.run(stand=Stand(**QUIET)).table  # type: ignore[arg-type]
    hottest = float(table["Heater temperature [degC]"].max())  # type: ignore[arg-type]
    assert hottest == pytest.approx(180 + 0.06 * 30, abs=0.1)


def test_impossible_stands_are_refused() -> None:
    with pytest.raises(ParameterError, match="dwell"):
        testbench.run(stand=Stand(dwell=0))
