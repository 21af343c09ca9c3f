"""Draws of growth: ages at a level and curves are each other's inverse, integrals and shares are exact."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from hersey.arrays import FloatArray
from hersey.life.growth.draws import Draws
from hersey.life.growth.importance import importance_sampled
from hersey.life.growth.laws import LAWS
from hersey.life.growth.limit_ages import reached_by
from hersey.life.growth.marginal import Specimens

(EXPONENTIAL,) = [each for each in LAWS if each.name == "exponential"]


def draws(count: int = 4000) -> Draws:
    """Draws of two specimens, followed to 1 and 0.5, and of three new ones, all of ln y = 0.2 t."""
    of = (
        Specimens(
            EXPONENTIAL,
            np.zeros((count, each)),
            np.full((count, each), math.log(0.2)),
            np.zeros((0, count, 1)),
            np.full((count, 1), 0.05),
        )
        for each in (2, 3)
    )
    known, new = ((each,) for each in of)
    return Draws(known, new, np.array([1.0, 0.5]), seed=5)


def test_curves_reach_the_level_at_its_age_also_beyond_the_last_run() -> None:
    found = draws(40)
    known, _ = found.ages(0.3, 0.0, accumulates=False)
    assert (known > [1.0, 0.5]).all()
    assert known.std() > 0.05  # by law it is 1.5
    for i in range(40):
        for unit in range(2):
            at = known[i, unit]
            assert found.curves(np.array([at]), [unit])[i, 0, 0] == pytest.approx(0.3)
            assert found.curve(unit, np.array([at]))[i, 0] == pytest.approx(0.3)
    within, _ = found.ages(0.06, 0.0, accumulates=False)
    assert within == pytest.approx(0.3)


def test_a_level_that_is_known_to_an_error_spreads_ages_in_common() -> None:
    """Within the data age is level over 0.2, so its deviation is that of the level over 0.2."""
    found = draws()
    known, new = found.ages(0.06, 0.01, accumulates=False)
    assert known.mean(axis=0) == pytest.approx([0.3, 0.3], abs=0.003)
    assert known.std(axis=0) == pytest.approx([0.05, 0.05], rel=0.04)
    assert known[:, 0] == pytest.approx(known[:, 1])
    assert known[:, 0] == pytest.approx(new[:, 2])


def test_the_integral_of_a_density_is_found_from_unlike_rounds() -> None:
    """Three times a normal density of deviations 1 and 2, correlated by 0.6."""
    covariance = np.array([[1.0, 1.2], [1.2, 4.0]])
    normal = stats.multivariate_normal(np.array([0.5, -1.0]), covariance)

    def log_density(at: FloatArray) -> FloatArray:
        return np.asarray(normal.logpdf(at) + math.log(3.0))

    found = importance_sampled(
        log_density, np.zeros(2), 2.0 * np.eye(2), [300, 900, 600], np.random.default_rng(2)
    )
    assert found.log_integral == pytest.approx(math.log(3.0), abs=0.03)
    mean = found.weight @ found.draws
    assert mean == pytest.approx([0.5, -1.0], abs=0.1)
    away = found.draws - mean
    assert away.T @ (away * found.weight[:, None]) == pytest.approx(covariance, abs=0.3)


def test_a_share_is_reached_when_so_many_specimens_have() -> None:
    ages = np.arange(1.0, 11.0)[None]
    shares = (0.05, 0.10, 0.11, 0.50, 0.51, 1.0)
    assert [float(reached_by(ages, share)[0]) for share in shares] == [1, 1, 2, 5, 6, 10]
