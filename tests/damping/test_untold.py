"""Two temperatures visited once each: what hangs on temperature is not told, and every limit says so."""

from __future__ import annotations

import numpy as np
import pytest

import hersey
from hersey.damping.candidates import compare_models
from hersey.errors import UntoldWarning

SPEEDS = np.geomspace(5.0, 100.0, 8)
NOISE = 1.0 + 0.003 * np.random.default_rng(4).standard_normal(16)


def points(*temperatures: float) -> hersey.SteadyPoints:
    speed, hot = np.tile(SPEEDS, len(temperatures)), np.repeat(temperatures, SPEEDS.size)
    torque = 2.0 * hot**-0.9 * speed**0.3 * np.resize(NOISE, speed.size)
    return hersey.SteadyPoints.from_table(
        {"speed [rpm]": speed, "torque [N*m]": torque, "temperature [degC]": hot}
    )


def test_limits_of_two_visits_say_that_they_are_those_of_these_visits() -> None:
    two = points(100.0, 160.0)
    surface = hersey.fit(two)
    assert surface.b is not None
    assert not surface.b.estimable
    assert surface.c.estimable
    assert "interval not known" in surface.summary()
    assert "cannot be determined for a visit: too few" in surface.summary()
    with pytest.warns(UntoldWarning, match="recorded visits"):
        surface.predict(speed="20 rpm", temperature="120 degC")
    with pytest.warns(UntoldWarning):
        compare_models(two, bootstrap=0, cross_validate=False).predict(speed="20 rpm", temperature="120 degC")


@pytest.mark.filterwarnings("error::hersey.errors.UntoldWarning")
def test_a_third_temperature_tells_it() -> None:
    surface = hersey.fit(points(100.0, 130.0, 160.0))
    assert surface.b is not None
    assert surface.b.estimable
    surface.predict(speed="20 rpm", temperature="120 degC")


def test_a_transition_that_moves_does_not_tell_how_far_two_visits_scatter() -> None:
    """It shows the law of temperature a second time, too loosely to hold a visit against it."""
    speed, hot = np.tile(np.geomspace(5.0, 150.0, 16), 2), np.repeat([80.0, 180.0], 16)
    at = 25.0 * (hot / 120.0) ** 3
    law = hot**-0.9 * at**0.3 * (speed / at) ** np.where(speed < at, -0.25, 0.3)
    for seed in range(12):
        noise = np.random.default_rng(seed)
        visits = np.repeat(0.03 * noise.standard_normal(2), 16) + 0.01 * noise.standard_normal(32)
        surface = hersey.fit(
            hersey.SteadyPoints.from_table(
                {
                    "speed [rpm]": speed,
                    "torque [N*m]": 2.0 * law * np.exp(visits),
                    "temperature [degC]": hot,
                }
            )
        )
        assert surface.transition is not None
        assert surface.b is not None
        assert not surface.b.estimable
        assert not surface.transition.speed.estimable


def test_two_runs_without_temperatures_tell_by_how_much_they_stand_apart() -> None:
    speed, run = np.tile(SPEEDS, 2), np.repeat([1, 2], SPEEDS.size)
    torque = 2.0 * speed**0.3 * np.resize(NOISE, speed.size) * np.where(run == 1, 1.0, 1.05)
    table = {"speed [rpm]": speed, "torque [N*m]": torque, "run": run}
    surface = hersey.fit(hersey.SteadyPoints.from_table(table))
    (shared,) = surface.statistics.shared
    assert (shared.name, shared.estimable) == ("run", True)
    assert shared.deviation == pytest.approx(np.log(1.05) / 2**0.5, rel=0.1)
    assert surface.a.low < 2.0 * (30 / np.pi) ** 0.3 * 1.025 < surface.a.high
    assert surface.a.high > 1.2 * surface.a.value  # one degree of freedom
