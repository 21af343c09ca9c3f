"""A linear mixed-effects model: values of runs that change with age, differently in each specimen.

A run's values are ``start of its specimen + change of its specimen x age + scatter of the run``; starts and
changes of specimens are normal about those of the population. Runs enter by information matrices, so a run
that says nothing of a value is no exception. All else that the runs share is solved for with them. Runs are
eliminated first, then specimens, then what is left: cost and memory are linear in runs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray, IntArray

#: How many specimens, or runs, a usual variance is worth beside those of the data.
_WEIGHT = 2.0


@dataclass(frozen=True, repr=False)
class Information:
    """What the dwells say of (own values of a run, shared values): information and right-hand side.

    ``matrix`` (runs, own + shared, own + shared), ``right`` (runs, own + shared).
    """

    matrix: FloatArray
    right: FloatArray


@dataclass(frozen=True, repr=False)
class Spread:
    """Variances: of specimens in start and change (2 own,), and of runs (own,)."""

    specimens: FloatArray
    runs: FloatArray


@dataclass(frozen=True, repr=False)
class Solved:
    """The posterior: of the population and what is shared, of each specimen, and of each run's values.

    ``common`` holds starts and changes of the population, then the shared values; a specimen holds its
    starts, then its changes.
    """

    common: FloatArray
    common_covariance: FloatArray
    specimen: FloatArray
    specimen_covariance: FloatArray
    mean: FloatArray  #: of the specimens, and its covariance: of these, not of others like them
    mean_covariance: FloatArray
    run: FloatArray
    spread: Spread  #: as these values make it likeliest: the next step of expectation and maximisation


def solve(
    information: Information,
    age: FloatArray,
    specimen: IntArray,
    spread: Spread,
    usual: Spread,
    prior: tuple[FloatArray, FloatArray],
) -> Solved:
    """Return the posterior at stated variances.

    Parameters
    ----------
    information
        Of each run.
    age
        Of each run, (runs,).
    specimen
        The place of its specimen from 0, ascending, (runs,).
    spread, usual
        The variances, and those that are usual: worth two specimens, or runs.
    prior
        Mean and deviation of population and shared values, (2 own + shared,) each.
    """
    runs = _Runs(information, spread.runs)
    specimens = _Specimens.of(runs, age, specimen, spread.specimens)
    common, covariance = specimens.common(prior)
    found, likeliest = specimens.values(common, covariance)
    values, squares = runs.values(age, specimen, common, found)
    renewed = Spread(_pooled(likeliest, usual.specimens), _pooled(squares, usual.runs))
    return Solved(
        common,
        covariance,
        found.mean,
        found.covariance,
        found.mean.mean(axis=0),
        specimens.covariance_of_mean(covariance),
        values,
        renewed,
    )


@dataclass(frozen=True)
class _Normal:
    """Means (specimens, 2 own) and covariances."""

    mean: FloatArray
    covariance: FloatArray


class _Runs:
    """Runs, eliminated: what each leaves of its specimen's line at its age, and of what is shared."""

    def __init__(self, information: Information, variance: FloatArray) -> None:
        own = self.own = variance.size
        self.information = information
        self.of_run = information.matrix[:, :own, :own]
        self.cross = information.matrix[:, :own, own:]
        shrink = np.asarray(np.linalg.inv(np.eye(own) + self.of_run * variance), dtype=float)
        self.scatter = variance[:, None] * shrink  # covariance of the scatter of a run, its line given
        self.line = shrink @ information.matrix[:, :own, :]  # of the line, with itself and with the shared
        self.right_line = _times(shrink, information.right[:, :own])
        back = self.cross.swapaxes(1, 2) @ self.scatter
        self.shared = (information.matrix[:, own:, own:] - back @ self.cross).sum(axis=0)
        self.right_shared = (information.right[:, own:] - _times(back, information.right[:, :own])).sum(
            axis=0
        )

    def values(
        self, age: FloatArray, specimen: IntArray, common: FloatArray, specimens: _Normal
    ) -> tuple[FloatArray, FloatArray]:
        """Values of each run, and the mean squares of their scatter."""
        own, of = self.own, specimens.mean[specimen]
        lines = of[:, :own] + age[:, None] * of[:, own:]
        rest = self.information.right[:, :own] - _times(self.of_run, lines) - self.cross @ common[2 * own :]
        deviation = _times(self.scatter, rest)
        by_line = self.scatter @ self.of_run
        response = np.concatenate([-by_line, -age[:, None, None] * by_line], axis=2)
        # The shared values are known far better than a run: their part in its variance is left out.
        variance = _diagonal(self.scatter) + _propagated(response, specimens.covariance[specimen])
        return lines + deviation, deviation**2 + variance


@dataclass(frozen=True)
class _Specimens:
    """Specimens, eliminated: information on starts and changes, with themselves and with what is shared."""

    by_specimen: FloatArray
    with_shared: FloatArray
    right: FloatArray
    variance: FloatArray
    shared: FloatArray
    right_shared: FloatArray

    @classmethod
    def of(cls, runs: _Runs, age: FloatArray, specimen: IntArray, variance: FloatArray) -> _Specimens:
        """Sum over the runs of each specimen."""
        first = np.flatnonzero(np.r_[True, np.diff(specimen) > 0])
        powers = np.stack([np.ones_like(age), age, age**2])

        def summed(values: FloatArray, power: int) -> FloatArray:
            weight = powers[power].reshape(-1, *[1] * (values.ndim - 1))
            return np.asarray(np.add.reduceat(values * weight, first, axis=0))

        a, b, right = runs.line[..., : runs.own], runs.line[..., runs.own :], runs.right_line
        return cls(
            np.block([[summed(a, 0), summed(a, 1)], [summed(a, 1), summed(a, 2)]]),
            np.concatenate([summed(b, 0), summed(b, 1)], axis=1),
            np.concatenate([summed(right, 0), summed(right, 1)], axis=1),
            variance,
            runs.shared,
            runs.right_shared,
        )

    @cached_property
    def shrink(self) -> FloatArray:
        """What the spread over specimens leaves of their information."""
        return np.asarray(np.linalg.inv(np.eye(self.variance.size) + self.by_specimen * self.variance))

    @cached_property
    def own_covariance(self) -> FloatArray:
        """Covariance of a specimen's own, population and shared given."""
        return np.asarray(self.variance[:, None] * self.shrink)

    @cached_property
    def response(self) -> FloatArray:
        """How a specimen's own values follow population and shared ones."""
        return np.asarray(-self.own_covariance @ np.concatenate([self.by_specimen, self.with_shared], axis=2))

    @cached_property
    def full_response(self) -> FloatArray:
        """The same of its values, the population's among them."""
        own = self.variance.size
        full_response = np.zeros_like(self.response)
        full_response[:, :own, :own] = np.eye(own)
        return np.asarray(full_response + self.response)

    def common(self, prior: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
        """Posterior mean and covariance of population and shared values."""
        mean, deviation = prior
        own = self.variance.size
        held = self.with_shared.swapaxes(1, 2) @ self.own_covariance
        matrix = np.zeros((mean.size,) * 2)
        matrix[:own, :own] = (self.shrink @ self.by_specimen).sum(axis=0)
        matrix[:own, own:] = (self.shrink @ self.with_shared).sum(axis=0)
        matrix[own:, :own] = matrix[:own, own:].T
        matrix[own:, own:] = self.shared - (held @ self.with_shared).sum(axis=0)
        of_specimens = _times(self.shrink, self.right).sum(axis=0)
        right = np.concatenate([of_specimens, self.right_shared - _times(held, self.right).sum(axis=0)])
        # In deviations of the prior the matrix is well scaled.
        scaled = deviation[:, None] * matrix * deviation + np.eye(mean.size)
        inverse = np.linalg.inv(0.5 * (scaled + scaled.T))
        covariance = deviation[:, None] * inverse * deviation
        return deviation * (inverse @ (deviation * right + mean / deviation)), covariance

    def values(self, common: FloatArray, covariance: FloatArray) -> tuple[_Normal, FloatArray]:
        """Values of each specimen, and the mean squares of what sets them apart from the population."""
        own = self.variance.size
        deviation = _times(self.own_covariance, self.right) + self.response @ common
        of_specimens = self.own_covariance + self.full_response @ covariance @ self.full_response.swapaxes(
            1, 2
        )
        variance = _diagonal(self.own_covariance) + _propagated(self.response, covariance)
        return _Normal(deviation + common[:own], of_specimens), deviation**2 + variance

    def covariance_of_mean(self, covariance: FloatArray) -> FloatArray:
        """Covariance of the mean of these specimens."""
        middle = self.full_response.mean(axis=0)
        return np.asarray(
            self.own_covariance.sum(axis=0) / len(self.own_covariance) ** 2 + middle @ covariance @ middle.T
        )


def _times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """Each matrix times its vector."""
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def _pooled(squares: FloatArray, usual: FloatArray) -> FloatArray:
    """Mean square, with a usual variance that counts as `_WEIGHT` more: few specimens show no spread."""
    return np.asarray((squares.sum(axis=0) + _WEIGHT * usual) / (len(squares) + _WEIGHT))


def _diagonal(matrices: FloatArray) -> FloatArray:
    return np.asarray(np.diagonal(matrices, axis1=1, axis2=2))


def _propagated(response: FloatArray, covariance: FloatArray) -> FloatArray:
    """Variances of what responds so to values of a covariance."""
    return _diagonal(response @ covariance @ response.swapaxes(1, 2))
