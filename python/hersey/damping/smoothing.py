"""A smooth curve through the dwells, no law assumed: where torque is least, and whether a law leaves a trend.

ln torque against ln speed is a smoothing spline of order three, whose third derivative is as small as the
dwells allow: the posterior of a twice integrated Wiener process beside what is known (Wahba, J. R. Stat. Soc.
B 45 (1983) 133). How far it bends is weighed by its restricted likelihood, so that a minimum of any shape,
steeper on one side than on the other, is found where it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.distributions import student_below
from hersey.damping.estimate import CONFIDENCE

#: Variances of the curve that are weighed, over that of the dwells, by mean of what each adds.
_RATIOS = np.geomspace(1e-3, 1e9, 49)
#: Weight below which a variance is excluded, of the likeliest.
_LEAST_WEIGHT = 1e-3
#: Speeds at which the slope of the curve is looked at.
_SLOPES = 241
#: Most groups of dwells, of neighbouring speeds, that a curve is drawn through.
MOST_GROUPS = 150


@dataclass(frozen=True)
class Least:
    """Where a curve is least: logarithms of speed and torque.

    ``speed_gain`` and ``torque_gain`` say by how much one unit of each point moves them, shape (points,).
    """

    log_speed: float
    log_torque: float
    ends: tuple[float, float]  #: of ``log_speed``, 95 %; infinite where the dwells do not bound it
    speed_gain: FloatArray
    torque_gain: FloatArray
    scale: float  #: of the covariance of the points


@dataclass(frozen=True)
class Curve:
    """What a smooth curve through points takes: ``at`` and ``values``, shape (points,).

    ``noise`` is their covariance, (points, points), to be scaled by no less than ``floor``; ``known`` holds
    what may be added to the curve at no cost, (points, columns). ``freedom`` is that of the noise.
    """

    at: FloatArray
    values: FloatArray
    noise: FloatArray
    floor: float
    known: FloatArray
    freedom: float

    @cached_property
    def _away(self) -> FloatArray:
        return np.asarray(self.at - self.at.min())

    @cached_property
    def _own(self) -> FloatArray:
        """Covariance of the curve with itself at the points, for a ratio of 1."""
        return _covariance(self._away, self._away)

    @cached_property
    def _solutions(self) -> dict[float, tuple[FloatArray, FloatArray]]:
        """What `_solved` has returned: the slope is asked for on two grids, with the same ratios."""
        return {}

    @cached_property
    def _weighed(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Ratios of variance, the log-likelihood of each, and the scale of the noise with each."""
        whiten = np.linalg.inv(np.linalg.cholesky(self.noise))
        left, singular, _ = np.linalg.svd(whiten @ self.known)
        rank = int(np.count_nonzero(singular > 1e-10 * singular[0]))
        free = left[:, rank:].T @ whiten
        spread, axes = np.linalg.eigh(free @ self._own @ free.T)
        squares = (axes.T @ (free @ self.values)) ** 2
        spread = np.maximum(spread, 0.0)
        ratios = np.append(0.0, _RATIOS / max(float(spread.mean()), 1e-300))
        inflated = 1.0 + ratios[:, None] * spread
        misfit = np.sum(squares / inflated, axis=1)
        scale = np.maximum(misfit / squares.size, self.floor)
        log_likelihood = -0.5 * (squares.size * np.log(scale) + misfit / scale + np.log(inflated).sum(axis=1))
        return ratios, log_likelihood, scale

    def trend(self) -> float:
        """Return by how much a curve beside what is known is likelier than none: twice the logarithm."""
        log_likelihood = self._weighed[1]
        return float(2.0 * (log_likelihood.max() - log_likelihood[0]))

    def least(self) -> Least | None:
        """Return the deepest minimum within the points; None if the curve has none."""
        grid = np.linspace(self.at.min(), self.at.max(), _SLOPES)
        slope, falling = self._slopes(grid)
        turns = np.flatnonzero((slope[:-1] < 0) & (slope[1:] >= 0))
        if not turns.size:
            return None
        turn = int(turns[np.argmin(np.cumsum(slope)[turns])])
        low, high = _beyond_doubt(falling, turn, -1), _beyond_doubt(falling, turn, 1)
        closer = np.linspace(grid[max(low, 0)], grid[min(high, grid.size - 1)], _SLOPES)
        slope, falling = self._slopes(closer)
        turn = int(np.flatnonzero((slope[:-1] < 0) & (slope[1:] >= 0))[0])
        curvature = float(slope[turn + 1] - slope[turn]) / float(closer[1] - closer[0])
        z = float(closer[turn]) - float(slope[turn]) / curvature
        ends = (
            min(_crossing(closer, falling, turn, -1), z) if low >= 0 else -np.inf,
            max(_crossing(closer, falling, turn, 1), z) if high < grid.size else np.inf,
        )
        ratios, log_likelihood, scale = self._weighed
        likeliest = 1 + int(np.argmax(log_likelihood[1:]))
        by_value, by_slope = self._gains(np.array([z]), float(ratios[likeliest]))
        return Least(
            log_speed=z,
            log_torque=float(by_value[0] @ self.values),
            ends=ends,
            speed_gain=np.asarray(-by_slope[0] / curvature),
            torque_gain=by_value[0],
            scale=float(scale[likeliest]),
        )

    def _slopes(self, grid: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Slope of the curve, and the probability that it falls, over all variances as likely as they are."""
        ratios, log_likelihood, scale = (each[1:] for each in self._weighed)
        weights = np.exp(log_likelihood - log_likelihood.max())
        weights[weights < _LEAST_WEIGHT] = 0.0
        weights /= weights.sum()
        slope, falling = np.zeros(grid.size), np.zeros(grid.size)
        at = grid - self.at.min()
        parts = _slope_covariance(at, self._away), _slopes_of_known(at), at**3
        for i in np.flatnonzero(weights):
            mean, deviation = self._slope(*parts, float(ratios[i]), float(scale[i]))
            slope += weights[i] * mean
            falling += weights[i] * student_below(-mean / deviation, self.freedom)
        return slope, falling

    def _slope(
        self, covariance: FloatArray, known: FloatArray, cubes: FloatArray, ratio: float, scale: float
    ) -> tuple[FloatArray, FloatArray]:
        """Slope of the curve with its standard error, from what does not depend on ratio and scale."""
        cross = ratio * covariance
        inverse, bread = self._solved(ratio)
        pulled = cross @ inverse
        rest = known - pulled @ self.known
        left = rest @ bread
        gain = pulled + left @ self.known.T @ inverse
        variance = ratio * cubes / 3.0 - np.sum(pulled * cross, axis=1)
        variance += np.sum(left * rest, axis=1)
        return gain @ self.values, np.sqrt(np.maximum(variance * scale, 1e-30))

    def _gains(self, grid: FloatArray, ratio: float) -> tuple[FloatArray, FloatArray]:
        """By how much one unit of each point moves the curve and its slope, shape (grid, points)."""
        at = grid - self.at.min()
        inverse, bread = self._solved(ratio)
        gains: list[FloatArray] = []
        for cross, known in (
            (ratio * _covariance(at, self._away), np.vander(at, 3, increasing=True)),
            (ratio * _slope_covariance(at, self._away), _slopes_of_known(at)),
        ):
            rest = known - cross @ inverse @ self.known
            gains.append(np.asarray(cross @ inverse + rest @ bread @ self.known.T @ inverse))
        return gains[0], gains[1]

    def _solved(self, ratio: float) -> tuple[FloatArray, FloatArray]:
        if ratio not in self._solutions:
            inverse = np.asarray(np.linalg.inv(self.noise + ratio * self._own), dtype=np.float64)
            bread = np.linalg.inv(self.known.T @ inverse @ self.known)
            self._solutions[ratio] = inverse, np.asarray(bread, dtype=np.float64)
        return self._solutions[ratio]


def parabola(at: FloatArray) -> FloatArray:
    """Return what a curve that is to have a minimum takes as known, shape (points, 3)."""
    return np.vander(at - at.min(), 3, increasing=True)


def _beyond_doubt(falling: FloatArray, turn: int, side: int) -> int:
    """Index nearest a turn at which the curve falls (side -1) or rises (1) beyond doubt; outside if none."""
    sure = 0.5 - side * 0.5 * CONFIDENCE
    beyond = np.flatnonzero((falling - sure) * side <= 0.0)
    beyond = beyond[beyond <= turn] if side < 0 else beyond[beyond > turn]
    if not beyond.size:
        return -1 if side < 0 else falling.size
    return int(beyond[-1] if side < 0 else beyond[0])


def _crossing(grid: FloatArray, falling: FloatArray, turn: int, side: int) -> float:
    """Where that probability is reached, interpolated."""
    outer = _beyond_doubt(falling, turn, side)
    inner, sure = outer - side, 0.5 - side * 0.5 * CONFIDENCE
    share = (falling[outer] - sure) / (falling[outer] - falling[inner])
    return float(grid[outer] + np.clip(share, 0.0, 1.0) * (grid[inner] - grid[outer]))


def _covariance(first: FloatArray, second: FloatArray) -> FloatArray:
    """That of a twice integrated Wiener process."""
    low, high = np.minimum(first[:, None], second), np.maximum(first[:, None], second)
    return np.asarray(low**3 * (10.0 * high**2 - 5.0 * low * high + low**2) / 120.0)


def _slope_covariance(at: FloatArray, other: FloatArray) -> FloatArray:
    """That of its slope with itself elsewhere."""
    s, t = np.broadcast_arrays(at[:, None], other)
    before = 30.0 * s**2 * t**2 - 20.0 * s**3 * t + 5.0 * s**4
    return np.asarray(np.where(s < t, before, 20.0 * t**3 * s - 5.0 * t**4) / 120.0)


def _slopes_of_known(at: FloatArray) -> FloatArray:
    return np.column_stack([np.zeros_like(at), np.ones_like(at), 2.0 * at])
