"""Verdicts follow from the exponents and name what they reject."""

from __future__ import annotations

import numpy as np
import pytest

import hersey
from tests.test_surface import SPEEDS, points_of


def verdict(exponent: float, error: float = 0.005) -> hersey.Regime:
    random = np.random.default_rng(8)
    torque = SPEEDS ** (1 + exponent) * np.exp(error * random.standard_normal(SPEEDS.size))
    points = points_of(SPEEDS, torque, error=error)
    return hersey.regime(points, hersey.fit(points))


@pytest.mark.parametrize(
    ("exponent", "name"),
    [(0.0, "constant film"), (-0.58, "soft EHL"), (-0.7, "Dowson-Higginson EHL"), (-1.0, "dry Coulomb")],
)
def test_each_regime_is_recognised(exponent: float, name: str) -> None:
    found = verdict(exponent)
    assert name in found.verdict
    kept = [h.name for h in found.hypotheses if h.consistent]
    assert any(k.startswith(name) for k in kept)
    assert not {"constant film", "dry Coulomb friction"} & set(kept) or exponent in (0.0, -1.0)


def test_a_falling_branch_warns_of_stick_slip() -> None:
    assert "can stick and slip" in verdict(-1.2).verdict


def test_what_fits_nothing_is_said_to_fit_nothing() -> None:
    found = verdict(-0.85)
    assert "no named regime" in found.verdict
    assert not any(h.consistent for h in found.hypotheses)


def test_wide_intervals_reject_nothing_near() -> None:
    points = points_of(SPEEDS, SPEEDS**0.35, error=0.1)
    found = hersey.regime(points, hersey.fit(points))
    assert {"soft EHL", "Dowson-Higginson EHL"} <= {h.name for h in found.hypotheses if h.consistent}


def test_p_values_and_intervals_agree() -> None:
    random = np.random.default_rng(9)
    for _ in range(20):
        torque = SPEEDS**0.3 * np.exp(0.02 * random.standard_normal(SPEEDS.size))
        points = points_of(SPEEDS, torque, error=0.02)
        surface = hersey.fit(points)
        for h in hersey.regime(points, surface).hypotheses:
            if np.isfinite(h.low):
                assert h.consistent == (surface.c.low <= h.high and surface.c.high >= h.low)


def test_exponents_per_temperature_and_branch(points: hersey.SteadyPoints) -> None:
    found = hersey.regime(points, hersey.fit(points))
    branches = {(e.branch, round((e.temperature or 0) - 273.15)) for e in found.exponents}
    assert ("mixed", 180) in branches
    assert ("ehl", 90) in branches
    for e in found.exponents:
        assert e.exponent.value == pytest.approx(-1.2 if e.branch == "mixed" else -0.7, abs=0.05)
