"""Values of runs that change with age, differently in each unit: a linear model with random effects.

A run's values are ``start of its unit + change of its unit x age + scatter of the run``; starts and changes
of units are normal about those of the population. Runs tell their values through information matrices, so
that a run that tells nothing of a value is no exception. All else that the runs share is solved for with
them. Runs go out first, then units, then what is left: cost and memory are linear in runs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray

#: How many units, or runs, a usual variance is worth beside those of the data.
_WEIGHT = 2.0


@dataclass(frozen=True, repr=False)
class Told:
    """What the dwells tell of (own values of a run, shared values): information and right-hand side.

    ``matrix`` (runs, own + shared, own + shared), ``right`` (runs, own + shared).
    """

    matrix: FloatArray
    right: FloatArray


@dataclass(frozen=True, repr=False)
class Spread:
    """Variances: of units in start and change (2 own,), and of runs (own,)."""

    units: FloatArray
    runs: FloatArray


@dataclass(frozen=True, repr=False)
class Solved:
    """The posterior: of the population and what is shared, of each unit, and of each run's values.

    ``common`` holds starts and changes of the population, then the shared values; a unit holds its starts,
    then its changes.
    """

    common: FloatArray
    common_covariance: FloatArray
    unit: FloatArray
    unit_covariance: FloatArray
    mean: FloatArray  #: of the units, and its covariance: of these units, not of others like them
    mean_covariance: FloatArray
    run: FloatArray
    spread: Spread  #: as these values make it likeliest: the next step of expectation and maximisation


def solve(
    told: Told,
    age: FloatArray,
    unit: np.ndarray,
    spread: Spread,
    usual: Spread,
    prior: tuple[FloatArray, FloatArray],
) -> Solved:
    """Return the posterior at stated variances.

    Parameters
    ----------
    told
        Of each run.
    age
        Of each run, (runs,).
    unit
        The place of its unit from 0, ascending, (runs,).
    spread, usual
        The variances, and those that are usual: worth two units, or runs.
    prior
        Mean and deviation of population and shared values, (2 own + shared,) each.
    """
    own, every = spread.runs.size, told.matrix.shape[-1]
    first = np.flatnonzero(np.r_[True, np.diff(unit) > 0])
    of_run = told.matrix[:, :own, :own]
    cross = told.matrix[:, :own, own:]
    # Runs go out: each leaves what it tells of its unit's line at its age.
    shrink = np.linalg.inv(np.eye(own) + of_run * spread.runs)
    scatter = spread.runs[:, None] * shrink  # covariance of the scatter of a run, its line given
    line = shrink @ told.matrix[:, :own, :]  # of the line, with itself and with the shared
    right_line = (shrink @ told.right[:, :own, None])[..., 0]
    shared = told.matrix[:, own:, own:] - cross.swapaxes(1, 2) @ scatter @ cross
    right_shared = told.right[:, own:] - (cross.swapaxes(1, 2) @ scatter @ told.right[:, :own, None])[..., 0]
    powers = np.stack([np.ones_like(age), age, age**2])

    def summed(values: FloatArray, power: int) -> FloatArray:
        weight = powers[power].reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray(np.add.reduceat(values * weight, first, axis=0))

    a, b = line[..., :own], line[..., own:]
    ends = [[summed(a, 0), summed(a, 1)], [summed(a, 1), summed(a, 2)]]
    by_unit = np.block(ends)
    with_shared = np.concatenate([summed(b, 0), summed(b, 1)], axis=1)
    right_unit = np.concatenate([summed(right_line, 0), summed(right_line, 1)], axis=1)
    # Units go out.
    two = 2 * own
    shrink_unit = np.linalg.inv(np.eye(two) + by_unit * spread.units)
    loose = spread.units[:, None] * shrink_unit  # covariance of a unit's own, population and shared given
    mean, deviation = prior
    matrix = np.zeros((two + every - own,) * 2)
    matrix[:two, :two] = (shrink_unit @ by_unit).sum(axis=0)
    matrix[:two, two:] = (shrink_unit @ with_shared).sum(axis=0)
    matrix[two:, :two] = matrix[:two, two:].T
    held = with_shared.swapaxes(1, 2) @ loose
    matrix[two:, two:] = shared.sum(axis=0) - (held @ with_shared).sum(axis=0)
    right = np.concatenate(
        [
            (shrink_unit @ right_unit[..., None])[..., 0].sum(axis=0),
            right_shared.sum(axis=0) - (held @ right_unit[..., None])[..., 0].sum(axis=0),
        ]
    )
    # In deviations of the prior the matrix is well scaled.
    scaled = deviation[:, None] * matrix * deviation + np.eye(mean.size)
    inverse = np.linalg.inv(0.5 * (scaled + scaled.T))
    covariance = deviation[:, None] * inverse * deviation
    common = deviation * (inverse @ (deviation * right + mean / deviation))
    # Back to units: their own is what the data leave of the population's line.
    pull = -loose @ np.concatenate([by_unit, with_shared], axis=2)
    apart = (loose @ right_unit[..., None])[..., 0] + pull @ common
    whole = np.zeros((len(first), two, mean.size))
    whole[:, :two, :two] = np.eye(two)
    whole += pull
    unit_covariance = loose + whole @ covariance @ whole.swapaxes(1, 2)
    apart_variance = _diagonal(loose) + _diagonal(pull @ covariance @ pull.swapaxes(1, 2))
    units = apart + common[:two]
    middle = whole.mean(axis=0)
    mean_covariance = loose.sum(axis=0) / len(first) ** 2 + middle @ covariance @ middle.T
    # And to runs.
    lines = units[unit, :own] + age[:, None] * units[unit, own:]
    rest = told.right[:, :own] - (of_run @ lines[..., None])[..., 0] - cross @ common[two:]
    off = (scatter @ rest[..., None])[..., 0]
    reach = np.concatenate([-scatter @ of_run, -age[:, None, None] * (scatter @ of_run)], axis=2)
    # The shared values are known far better than a run: their part in its variance is left out.
    off_variance = _diagonal(scatter) + _diagonal(reach @ unit_covariance[unit] @ reach.swapaxes(1, 2))
    likeliest = Spread(
        _pooled(apart**2 + apart_variance, usual.units), _pooled(off**2 + off_variance, usual.runs)
    )
    mean_of_units = units.mean(axis=0)
    return Solved(
        common, covariance, units, unit_covariance, mean_of_units, mean_covariance, lines + off, likeliest
    )


def _pooled(squares: FloatArray, usual: FloatArray) -> FloatArray:
    """Mean square, with a usual variance that counts as `_WEIGHT` more: few units tell no spread."""
    return np.asarray((squares.sum(axis=0) + _WEIGHT * usual) / (len(squares) + _WEIGHT))


def _diagonal(matrices: FloatArray) -> FloatArray:
    return np.asarray(np.diagonal(matrices, axis1=1, axis2=2))
