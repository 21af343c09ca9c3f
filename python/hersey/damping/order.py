"""Whether a few torques rise or fall with speed, tested on all of them together.

The torques are compared with the best curve that never falls (or never rises), and with the best curve that
falls and then rises. Where scatter alone makes the first so much worse than the second is known from draws of
constant torque (Robertson, Wright and Dykstra, Order Restricted Statistical Inference, 1988). Pairs of speeds
tell as much where there are many dwells; with a dozen they leave too few degrees of freedom.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from hersey.arrays import FloatArray

#: Greatest number of torques, all temperatures together: beyond, pairs of speeds tell enough.
MOST = 16
#: Draws of constant torque behind a chance, and their seed.
_DRAWS, _SEED = 4000, 11
#: Squares over others from which they are rounding.
_EXACT = 1e-20


def chances(groups: Sequence[FloatArray]) -> tuple[float, float]:
    """Return how often constant torque seems to rise, and to fall, as much as these.

    Parameters
    ----------
    groups
        ln torque of the dwells at each temperature, the slowest first.
    """
    rise, fall = _ratios([each[None, :] for each in groups])
    by_chance, _ = _of_constant(tuple(sorted(each.size for each in groups)))
    # constant torque seems to fall as often as it seems to rise
    return _share(by_chance, rise), _share(by_chance, fall)


def _share(by_chance: FloatArray, found: FloatArray) -> float:
    return float((1 + np.count_nonzero(by_chance >= found[0])) / (1 + by_chance.size))


@lru_cache(maxsize=32)
def _of_constant(sizes: tuple[int, ...]) -> tuple[FloatArray, FloatArray]:
    random = np.random.default_rng(_SEED)
    return _ratios([random.standard_normal((_DRAWS, size)) for size in sizes])


def _ratios(groups: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Squares about a curve that never rises, and that never falls, over those about one that turns once."""
    falling = np.zeros(groups[0].shape[0])
    rising, turning = np.zeros_like(falling), np.zeros_like(falling)
    for y in groups:
        before = _squares_of_starts(-y)  # about a curve that never rises, of each start of the sequence
        after = _squares_of_starts(-y[:, ::-1])[:, ::-1]  # about one that never falls, of each end
        falling += before[:, -1]
        rising += after[:, 0]
        turned = np.minimum(
            np.min(before[:, :-1] + after[:, 1:], axis=1), np.minimum(before[:, -1], after[:, 0])
        )
        turning += turned
    return _over(falling, turning), _over(rising, turning)


def _over(squares: FloatArray, least: FloatArray) -> FloatArray:
    """Ratio of squares; where a curve that turns once misses nothing, infinite or, if neither does, 0."""
    exact = least <= _EXACT * squares
    ratio = squares / np.where(exact, 1.0, least)
    return np.asarray(np.where(exact, np.where(squares > 0.0, np.inf, 0.0), ratio))


def _squares_of_starts(y: FloatArray) -> FloatArray:
    """Squares about the best curve that never falls, of the first one, two ... of each sequence.

    The curve at i is the greatest over a <= i of the least over b >= i of the mean from a to b.
    """
    count, size = y.shape
    total = np.concatenate([np.zeros((count, 1)), np.cumsum(y, axis=1)], axis=1)
    ends = np.arange(size)
    length = np.maximum(ends[None, :] - ends[:, None] + 1, 1)
    means = (total[:, None, 1:] - total[:, :-1, None]) / length
    means = np.where(ends[None, :] >= ends[:, None], means, np.inf)
    out = np.zeros((count, size))
    for last in range(1, size):
        part = means[:, : last + 1, : last + 1]
        least = np.minimum.accumulate(part[:, :, ::-1], axis=2)[:, :, ::-1]
        usable = np.where(ends[: last + 1, None] <= ends[None, : last + 1], least, -np.inf)
        curve = usable.max(axis=1)
        out[:, last] = np.sum((y[:, : last + 1] - curve) ** 2, axis=1)
    return out
