"""Whether a few torques rise or fall with speed, tested on all of them together.

Squares about the best curve that never falls (or never rises) are compared with squares off parabolas through
neighbours, which tell the scatter. How large chance makes their ratio is known from draws of constant torque
(Robertson, Wright and Dykstra, Order Restricted Statistical Inference, 1988). Pairs of speeds tell as much
where there are many dwells; a dozen leave them too few degrees of freedom.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hersey.arrays import FloatArray

#: Greatest number of torques, all temperatures together: beyond, pairs of speeds tell enough.
MOST = 24
#: Draws of constant torque behind a chance, and their seed.
_DRAWS, _SEED = 4000, 11
#: Squares over others from which they are rounding.
_EXACT = 1e-20


def chances(groups: Sequence[tuple[FloatArray, FloatArray]]) -> tuple[float, float]:
    """Return how often constant torque seems to rise, and to fall, as much as these.

    Parameters
    ----------
    groups
        ln speed and ln torque of the dwells at each temperature, the slowest first.
    """
    random = np.random.default_rng(_SEED)
    of_chance = [(z, random.standard_normal((_DRAWS, z.size))) for z, _ in groups]
    found = _ratios([(z, y[None, :]) for z, y in groups])
    by_chance = _ratios(of_chance)
    rise, fall = (
        (1 + np.count_nonzero(chance >= seen[0])) / (1 + _DRAWS)
        for chance, seen in zip(by_chance, found, strict=True)
    )
    return float(rise), float(fall)


def _ratios(groups: Sequence[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    """Squares about a curve that never rises, and that never falls, over those off parabolas."""
    rise, fall, scatter = (np.zeros(groups[0][1].shape[0]) for _ in range(3))
    for z, y in groups:
        rise += _about_order(-y)
        fall += _about_order(y)
        if z.size > 3:
            scatter += np.sum(off_parabolas(z, y) ** 2, axis=1)
    return _over(rise, scatter), _over(fall, scatter)


def _over(squares: FloatArray, scatter: FloatArray) -> FloatArray:
    """Ratio of squares; without scatter infinite or, if there is nothing to compare either, 0."""
    exact = scatter <= _EXACT * squares
    ratio = squares / np.where(exact, 1.0, scatter)
    return np.asarray(np.where(exact, np.where(squares > 0.0, np.inf, 0.0), ratio))


def _about_order(y: FloatArray) -> FloatArray:
    """Squares about the best curve that never falls, of sequences of shape (draws, points).

    The curve at i is the greatest over a <= i of the least over b >= i of the mean from a to b.
    """
    count, size = y.shape
    total = np.concatenate([np.zeros((count, 1)), np.cumsum(y, axis=1)], axis=1)
    curve = np.full((count, size), -np.inf)
    for first in range(size):
        means = (total[:, first + 1 :] - total[:, first : first + 1]) / np.arange(1, size - first + 1)
        least = np.minimum.accumulate(means[:, ::-1], axis=1)[:, ::-1]
        curve[:, first:] = np.maximum(curve[:, first:], least)
    return np.asarray(np.sum((y - curve) ** 2, axis=1))


def off_parabolas(z: FloatArray, y: FloatArray) -> FloatArray:
    """Return how far every four neighbours lie off a parabola, shape (draws, points - 3).

    Noise of standard deviation 1 makes it 1. ``z`` ascends, shape (points,); ``y`` has shape (draws, points).
    """
    return np.column_stack([y[:, i : i + 4] @ _off_parabola(z[i : i + 4]) for i in range(z.size - 3)])


def _off_parabola(z: FloatArray) -> FloatArray:
    """The one combination of four values, of length 1, that every parabola makes 0."""
    return np.asarray(np.linalg.svd(np.vander(z - z[0], 3).T)[2][3])
