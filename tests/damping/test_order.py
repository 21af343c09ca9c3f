"""A few torques tested together: exact squares, and how often chance makes a trend."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import isotonic_regression

from hersey.damping.order import _about_order, chances, off_parabolas

Z = np.log(np.geomspace(0.5, 15.0, 12))


def test_squares_are_those_of_isotonic_regression() -> None:
    y = np.random.default_rng(0).standard_normal((20, 9))
    expected = [float(np.sum((each - isotonic_regression(each).x) ** 2)) for each in y]
    assert _about_order(y) == pytest.approx(expected, abs=1e-12)


def test_parabolas_are_exact_and_noise_is_one() -> None:
    z = np.sort(np.random.default_rng(3).uniform(0.0, 4.0, 9))
    assert off_parabolas(z, (2.0 - 3.0 * z + 0.7 * z**2)[None, :]) == pytest.approx(0.0, abs=1e-12)
    noise = np.random.default_rng(4).standard_normal((4000, 9))
    assert off_parabolas(z, noise).std(axis=0) == pytest.approx(np.ones(6), abs=0.05)


def test_chance_makes_a_trend_as_often_as_stated() -> None:
    random = np.random.default_rng(1)
    found = np.array(
        [
            chances([(Z[:7], random.standard_normal(7)), (Z[:5], random.standard_normal(5))])
            for _ in range(1000)
        ]
    )
    for level in (0.05, 0.01):
        share = np.mean(found < level, axis=0)
        assert share == pytest.approx([level, level], abs=4.0 * np.sqrt(level / 1000))


def test_noise_on_a_steep_rise_makes_no_fall() -> None:
    """Of 500 logs that rise with 1 % scatter none seems to fall by less than one chance in 200."""
    random = np.random.default_rng(5)
    falls = [chances([(Z, 0.4 * Z + 0.01 * random.standard_normal(12))])[1] for _ in range(500)]
    assert min(falls) > 0.005


def test_twelve_noisy_dwells_fall_or_turn_as_they_do() -> None:
    """Torque as speed to the power -0.15 with 3 % scatter, and a minimum with 0.5 %."""
    random = np.random.default_rng(2)
    for _ in range(10):
        rise, fall = chances([(Z, -0.15 * Z + 0.03 * random.standard_normal(12))])
        assert fall < 0.001 < 0.05 < rise
        rise, fall = chances([(Z, 0.05 * (Z - 1.0) ** 2 + 0.005 * random.standard_normal(12))])
        assert max(rise, fall) < 0.001


def test_three_dwells_tell_nothing() -> None:
    rise, fall = chances([(Z[:3], np.array([3.0, 2.0, 1.0]))])
    assert rise == 1.0
    assert 0.3 < fall < 1.0
