"""Friction curves of dwells whose law is known: law, parameters, and what cannot be determined."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey import SteadyPoints
from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import rpm
from hersey.verdict.friction import leading_friction

#: Coulomb and static friction, N m; Stribeck speed, rad/s; viscous coefficient, N m s/rad.
COULOMB, STATIC, STRIBECK, VISCOUS = 0.42, 0.60, 1.5, 0.011
SPEEDS = np.geomspace(0.3, 30.0, 10)
NOISE = 0.004


def torque_of(
    speed: FloatArray, *, coulomb: float = COULOMB, static: float | None = None, thinned: float = 1.0
) -> FloatArray:
    """The torque of a joint, N m."""
    size = np.abs(speed)
    rise = 0.0 if static is None else (static - coulomb) * np.exp(-((size / STRIBECK) ** 2))
    return np.asarray(np.sign(speed) * (coulomb + rise) + VISCOUS * thinned * speed)


def dwells(speed: FloatArray, torque: FloatArray, celsius: FloatArray | None = None) -> SteadyPoints:
    """Dwells with noise that is the same for the same number of them."""
    noisy = torque * (1.0 + NOISE * np.random.default_rng(4).standard_normal(torque.size))
    table = {"speed [rpm]": rpm(speed), "torque [N*m]": noisy, "torque error [N*m]": NOISE * np.abs(torque)}
    if celsius is not None:
        table["temperature [degC]"] = celsius
    return SteadyPoints.from_table(table)


BOTH_WAYS = np.concatenate([SPEEDS, -SPEEDS])


def holds(curve: hersey.FrictionCurve, name: str, truth: float, direction: str | None = None) -> bool:
    known = curve.parameter(name, direction).estimate
    return known.low <= truth <= known.high


def test_coulomb_plus_viscous_friction() -> None:
    curve = hersey.fit_friction(dwells(BOTH_WAYS, torque_of(BOTH_WAYS)))
    assert (curve.kind, curve.apart, curve.rises, curve.least) == ("coulomb_viscous", False, True, ())
    assert holds(curve, "T_C", COULOMB)
    assert holds(curve, "k_v", VISCOUS)
    assert curve.parameter("T_C").direction == "both"
    assert curve.directions is not None
    assert not curve.directions.differ
    assert curve.headline().startswith("Coulomb plus viscous friction: T_C = 4")


def test_a_stribeck_curve_has_its_least_torque() -> None:
    curve = hersey.fit_friction(dwells(BOTH_WAYS, torque_of(BOTH_WAYS, static=STATIC)))
    assert (curve.kind, curve.apart, curve.rises) == ("stribeck", False, False)
    for name, truth in (("T_C", COULOMB), ("T_S", STATIC), ("w_S", STRIBECK), ("k_v", VISCOUS)):
        assert holds(curve, name, truth), name
    grid = np.geomspace(1.0, 10.0, 4000)
    least = float(grid[np.argmin(torque_of(grid, static=STATIC))])
    (found,) = curve.least
    assert found.speed.low <= least <= found.speed.high


def test_directions_that_differ_have_their_own_parameters() -> None:
    ratio = 0.85
    torque = np.where(BOTH_WAYS > 0, torque_of(BOTH_WAYS), torque_of(BOTH_WAYS, coulomb=ratio * COULOMB))
    curve = hersey.fit_friction(dwells(BOTH_WAYS, torque))
    assert curve.apart
    assert holds(curve, "T_C", COULOMB, "forward")
    assert holds(curve, "T_C", ratio * COULOMB, "reverse")
    assert curve.directions is not None
    assert curve.directions.offset == pytest.approx(0.5 * (1.0 - ratio) * COULOMB, rel=0.1)
    with pytest.raises(ParameterError, match="has no single T_C"):
        curve.parameter("T_C")


def test_one_direction_is_no_test_of_both() -> None:
    curve = hersey.fit_friction(dwells(-SPEEDS, torque_of(-SPEEDS)))
    assert curve.directions is None
    assert curve.forward_speeds is None
    assert curve.parameter("T_C").direction == "reverse"
    assert holds(curve, "T_C", COULOMB)


def test_viscous_friction_thins_with_temperature() -> None:
    hot = np.repeat([25.0, 45.0, 65.0, 45.0], SPEEDS.size)
    speed = np.tile(SPEEDS, 4)
    torque = torque_of(speed, thinned=1.0) + VISCOUS * speed * np.expm1(-0.03 * (hot - 45.0))
    curve = hersey.fit_friction(dwells(speed, torque, hot))
    assert curve.reference_temperature is not None
    assert holds(curve, "s", 0.03)
    assert holds(curve, "T_C", COULOMB)
    with pytest.raises(ParameterError, match="Give the temperature"):
        curve.torque(1.0)
    assert curve.torque(10.0, temperature=318.15) == pytest.approx(COULOMB + 10 * VISCOUS, rel=0.02)


def test_dwells_above_the_stribeck_region_say_nothing_of_it() -> None:
    fast = np.geomspace(4.0 * STRIBECK, 30.0, 8)
    curve = hersey.fit_friction(dwells(fast, torque_of(fast, static=STATIC)))
    assert curve.kind == "coulomb_viscous"
    assert {each.name for each in curve.parameters} == {"T_C", "k_v"}


def test_a_rise_that_starts_below_the_slowest_dwell_is_not_bounded() -> None:
    """Only the foot of the rise is seen: how high it gets cannot be determined, and nothing is made up."""
    some = np.geomspace(1.55 * STRIBECK, 30.0, 14)
    curve = hersey.fit_friction(dwells(some, torque_of(some, static=1.9 * STATIC)))
    assert curve.kind == "stribeck"
    rest = curve.parameter("T_S")
    assert not rest.bounded
    assert curve.to_dict()["parameters"][1]["estimate"]["high"] is None
    assert "T_S cannot be determined (the slowest dwell" in curve.headline()


def test_windage_is_no_stribeck_friction() -> None:
    """Torque rises at every speed: a Coulomb friction below 0 bent the curve, and it was called falling."""
    speed = np.geomspace(4.0, 140.0, 28)
    curve = hersey.fit_friction(dwells(speed, 0.008 + 2e-4 * speed + 4e-6 * speed**2))
    assert curve.kind == "coulomb_viscous"
    assert curve.rises


def test_a_curve_that_rises_over_all_dwells_is_not_called_falling() -> None:
    curve = hersey.fit_friction(dwells(SPEEDS, torque_of(SPEEDS, static=STATIC)))
    law = replace(curve, least=(), forward_speeds=(6.0, 30.0))
    assert law.rises_beyond_rest
    assert law.finding == (
        "Torque rises with speed above 57.3 rpm, the slowest dwell: stick-slip is possible below it."
    )
    assert "Torque falls as speed rises" in replace(law, forward_speeds=(0.3, 1.5)).finding


def test_a_film_leads_over_friction() -> None:
    power = 0.3 * SPEEDS**0.4
    points = dwells(SPEEDS, power)
    surface = hersey.fit(points)
    assert leading_friction(points, surface, hersey.regime(points, surface)) is None


def test_friction_leads_where_it_holds() -> None:
    points = dwells(BOTH_WAYS, torque_of(BOTH_WAYS))
    surface = hersey.fit(points)
    curve = leading_friction(points, surface, hersey.regime(points, surface))
    assert curve is not None
    assert curve.kind == "coulomb_viscous"
    assert json.loads(json.dumps(curve.to_dict(), allow_nan=False))["residuals"]


def test_too_few_dwells_are_refused() -> None:
    with pytest.raises(InsufficientDataError, match="at least 5 are needed"):
        hersey.fit_friction(dwells(SPEEDS[::3], torque_of(SPEEDS[::3])))
