"""What dwells support: said by the functions that judge a fit, so that a look before it promises no more."""

from __future__ import annotations

import numpy as np

import hersey
from hersey.inspection.support import support_of_points
from hersey.verdict.regime import regime

SPEEDS = np.geomspace(10.0, 150.0, 8)


def points(*temperatures: float, load: bool = False) -> hersey.SteadyPoints:
    """Dwells of a power law, each temperature visited once, under a load that rises with speed if so told."""
    speed, hot = np.tile(SPEEDS, len(temperatures)), np.repeat(temperatures, SPEEDS.size)
    noise = 1.0 + 0.003 * np.random.default_rng(2).standard_normal(speed.size)
    table = {
        "speed [rpm]": speed,
        "torque [N*m]": 2.0 * hot**-0.9 * speed**0.3 * noise,
        "temperature [degC]": hot,
    }
    if not load:
        return hersey.SteadyPoints.from_table(table)
    loaded = table | {"load [N]": 100.0 + speed}
    return hersey.SteadyPoints.from_table(loaded, channels={"load": "load"})


def test_an_exponent_whose_interval_a_fit_does_not_tell_is_not_promised() -> None:
    two = points(90.0, 150.0)
    surface = hersey.fit(two)
    assert surface.b is not None
    assert not surface.b.estimable
    found = support_of_points(two)
    assert not any(said.startswith("exponent b") for said in found.can)
    assert any("90, 150 degC were visited once each" in said for said in found.cannot)
    assert any(said.startswith("exponent b") for said in support_of_points(points(90.0, 120.0, 150.0)).can)


def test_no_exponent_holds_under_several_loads() -> None:
    several = points(90.0, 120.0, 150.0, load=True)
    why = regime(several, hersey.fit(several)).why_unnamed
    assert why.startswith("the load varies from 110 to 250 N")
    found = support_of_points(several)
    assert why in found.cannot
    assert not any(said.startswith("one exponent") for said in found.can)


def test_an_exponent_that_does_not_hold_says_nothing_of_where_torque_rises() -> None:
    """Torque rises with speed where it is cold and falls where it is hot: no exponent is that of both."""
    speed, hot = np.tile(np.geomspace(5.0, 200.0, 12), 2), np.repeat([90.0, 150.0], 12)
    at = 40.0 * (hot / 100.0) ** 3
    torque = hot**-0.9 * np.exp(0.3 * np.abs(np.log(speed / at)))
    noise = 1.0 + 0.003 * np.random.default_rng(1).standard_normal(speed.size)
    two = hersey.SteadyPoints.from_table(
        {"speed [rpm]": speed, "torque [N*m]": torque * noise, "temperature [degC]": hot}
    )
    surface = hersey.fit(two)
    assert surface.transition is None
    assert surface.c.high < -1.0
    assert not any("torque does not rise up to" in said for said in support_of_points(two).cannot)
    said = regime(two, surface).verdict
    assert said.startswith("No single exponent")
    assert "Torque falls as speed rises where its exponent is below -1" in said
