"""Lives of specimens that have an age already, by numbers printed for laws with stated parameters."""

from __future__ import annotations

import numpy as np

import hersey


def of(shape: float, scale: float) -> hersey.FailureLaw:
    """Return the law of a sample with just these estimates: they follow powers and factors of its ages."""
    ages, failed = np.linspace(1.0, 3.0, 9), np.ones(9, dtype=bool)
    first, middle = (each.value for each in hersey.weibull(ages, failed, calibrate=False).parameters)
    return hersey.weibull(scale * (ages / middle) ** (first / shape), failed, calibrate=False)


def test_a_component_that_has_survived() -> None:
    """Real Statistics, Survivability and Weibull distribution: shape 2.2, scale 1120.

    Printed: 0.620643 outlive 800, 0.111725 outlive 1600, hence 18 % of those that outlive 800; 60 % outlive
    825.31. Its address is https://real-statistics.com/other-key-distributions/survivability-weibull-distribution
    """
    law = of(2.2, 1120.0)
    assert [round(law.reliability(age).share, 6) for age in (800.0, 1600.0)] == [0.620643, 0.111725]
    assert round(law.b_life(0.4).age, 2) == 825.31
    fails = hersey.fleet_forecast(law, [800.0], 800.0, count=[1000]).expected[-1] / 1000.0
    assert round(1.0 - fails, 2) == 0.18
    life = hersey.remaining_life(law, 800.0)
    assert round(float(np.interp(800.0, life.ahead, life.outlive)), 2) == 0.18


def test_windings_that_have_survived() -> None:
    """Nelson, Applied Life Data Analysis (1982), p. 70: shape 2, scale 13; at 6.5 years 7.1 are left."""
    fleet = hersey.fleet_forecast(of(2.0, 13.0), [6.5], 40.0, count=[1000])
    running = 1.0 - np.append(0.0, fleet.expected) / 1000.0
    assert round(float(np.trapezoid(running, np.append(0.0, fleet.ahead))), 1) == 7.1
