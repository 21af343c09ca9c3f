"""Torque that still relaxes within the dwells after each change of speed.

Within one dwell a slow relaxation hardly differs from noise. All dwells together show it: their trends
depend on the change of speed before them. What is left of it in the mean of a dwell is an error that the
dwells share.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import SAME_SPEED

#: Fewest dwells whose trends are compared.
FEWEST = 8
#: Blocks into which each is averaged.
BLOCKS = 12
#: Standard errors by which trends must go with the change of speed.
SIGNIFICANT = 5.0
#: Shortest time constant tried, as a share of the median dwell.
SHORTEST = 0.1
#: Longest of them.
LONGEST = 10.0
#: How many are tried.
TRIED = 41
#: Square of residuals over the least at which a time constant is still possible, in variances of a residual.
POSSIBLE = 4.0
#: Largest share of torque that may be left of a relaxation without being worth an error.
NEGLIGIBLE = 1e-3


@dataclass(frozen=True)
class Trend:
    """Torque of a dwell over its mean, in blocks of time since the speed changed, s."""

    since: FloatArray
    relative: FloatArray
    step: float  #: ln(speed / speed before); 0 where the drive stood before
    isothermal: bool  #: whether temperature is that of the speed before

    @classmethod
    def of(cls, since: FloatArray, torque: FloatArray, step: float, *, isothermal: bool = True) -> Trend:
        """Return the trend of rows of a dwell."""
        edges = np.linspace(0, torque.size, min(BLOCKS, torque.size) + 1).astype(np.intp)
        counts = np.diff(edges)
        relative = np.add.reduceat(torque, edges[:-1]) / counts / float(np.mean(torque))
        return cls(np.add.reduceat(since, edges[:-1]) / counts, relative - relative.mean(), step, isothermal)


@dataclass(frozen=True)
class Relaxation:
    """How torque relaxes after a change of speed.

    ``time`` is its time constant, s, and ``possible`` the range of those that fit as well, none longer than
    the largest tried. ``size`` is the change of ln torque that is late per change of ln speed. ``left`` is
    what is left of it in the mean of each dwell at the most, relative, shape (dwells,).
    """

    time: float
    possible: tuple[float, float]
    size: float
    left: FloatArray


def relaxation(trends: Sequence[Trend]) -> Relaxation | None:
    """Return the relaxation that dwells show together, or None if they show none that matters."""
    stepped = [t for t in trends if t.isothermal and abs(t.step) > SAME_SPEED and t.since.size > 2]
    if len(stepped) < FEWEST or not _goes_with_steps(stepped):
        return None
    longest = float(np.median([trend.since[-1] for trend in stepped]))
    times = np.geomspace(SHORTEST * longest, LONGEST * longest, TRIED)
    squares, sizes = np.array([_fitted(stepped, float(time)) for time in times]).T
    best = int(np.argmin(squares))
    spare = sum(trend.since.size - 1 for trend in stepped) - 2
    near = squares <= squares[best] * (1.0 + POSSIBLE / max(spare, 1))
    left = [_left(trends, float(times[i]), float(sizes[i])) for i in np.flatnonzero(near)]
    most = np.asarray(max(left, key=lambda each: float(np.max(np.abs(each)))))
    if float(np.max(np.abs(most))) < NEGLIGIBLE:
        return None
    possible = float(times[near].min()), float(times[near].max())
    return Relaxation(float(times[best]), possible, float(sizes[best]), most)


def _goes_with_steps(trends: Sequence[Trend]) -> bool:
    """Whether the slopes of the dwells depend on the changes of speed before them, beyond chance."""
    slopes = np.array([_slope(trend) for trend in trends])
    steps = np.array([trend.step for trend in trends])
    size = float(slopes @ steps) / float(steps @ steps)
    error = float(np.sqrt(np.sum((slopes - size * steps) ** 2) / (slopes.size - 1) / (steps @ steps)))
    return abs(size) > SIGNIFICANT * max(error, 1e-12)


def _slope(trend: Trend) -> float:
    """Rise of a straight line over the dwell, relative."""
    centred = trend.since - trend.since.mean()
    spread = float(centred @ centred)
    return float(centred @ trend.relative) / spread * float(np.ptp(trend.since)) if spread else 0.0


def _fitted(trends: Sequence[Trend], time: float) -> tuple[float, float]:
    """Least sum of squares of the trends for a time constant, and the size of the relaxation."""
    shapes = [trend.step * _faded(trend.since, time) for trend in trends]
    above = sum(float(shape @ trend.relative) for shape, trend in zip(shapes, trends, strict=True))
    size = above / max(sum(float(shape @ shape) for shape in shapes), 1e-300)
    square = sum(
        float(np.sum((t.relative - size * shape) ** 2)) for shape, t in zip(shapes, trends, strict=True)
    )
    return square, size


def _faded(since: FloatArray, time: float) -> FloatArray:
    """What is left of a relaxation, about its mean over the dwell."""
    left = np.exp(-since / time)
    return np.asarray(left - left.mean())


def _left(trends: Sequence[Trend], time: float, size: float) -> FloatArray:
    """What is left in the mean of each dwell, relative."""
    return np.array([size * trend.step * float(np.mean(np.exp(-trend.since / time))) for trend in trends])
