"""A few torques tested together: exact squares, and how often chance makes a trend."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import isotonic_regression

from hersey.damping.order import _squares_of_starts, chances

Z = np.log(np.geomspace(0.5, 15.0, 12))


def test_squares_are_those_of_isotonic_regression() -> None:
    y = np.random.default_rng(0).standard_normal((5, 9))
    found = _squares_of_starts(y)
    for i in range(5):
        for count in range(1, 10):
            curve = isotonic_regression(y[i, :count]).x
            assert found[i, count - 1] == pytest.approx(float(np.sum((y[i, :count] - curve) ** 2)), abs=1e-12)


def test_chance_makes_a_trend_as_often_as_stated() -> None:
    random = np.random.default_rng(1)
    found = np.array([chances([random.standard_normal(7), random.standard_normal(5)]) for _ in range(2000)])
    for level in (0.05, 0.01):
        share = np.mean(found < level, axis=0)
        assert share == pytest.approx([level, level], abs=4.0 * np.sqrt(level / 2000))


def test_twelve_noisy_dwells_fall_or_turn_as_they_do() -> None:
    """Torque as speed to the power -0.15 with 3 % scatter, and a shallow minimum with 0.5 %."""
    random = np.random.default_rng(2)
    for _ in range(10):
        rise, fall = chances([-0.15 * Z + 0.03 * random.standard_normal(12)])
        assert fall < 0.001 < 0.05 < rise
        rise, fall = chances([0.04 * np.abs(Z - 1.0) + 0.005 * random.standard_normal(12)])
        assert max(rise, fall) < 0.001


def test_three_dwells_tell_nothing() -> None:
    assert chances([np.array([3.0, 2.0, 1.0])]) == (1.0, pytest.approx(0.5, abs=0.05))
