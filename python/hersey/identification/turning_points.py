"""Where the force turns, by more than noise: maxima and minima in turn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import ndimage  # scipy.signal takes longer to import than a log to read

from hersey.arrays import FloatArray, IntArray

#: So few turns need no thinning.
_FEW_TURNS = 2000


class Falls(NamedTuple):
    """Indices of each maximum and of the minimum that follows it, both of shape (falls,)."""

    top: IntArray
    bottom: IntArray


def smoothed(value: FloatArray, window: int) -> FloatArray:
    """Return the running median over ``window`` samples, an odd number: it keeps corners and slopes."""
    return np.asarray(ndimage.median_filter(value, window, mode="nearest")) if window > 1 else value


def averaged(value: FloatArray, window: int) -> FloatArray:
    """Return the running mean over ``window`` samples."""
    return np.asarray(ndimage.uniform_filter1d(value, window, mode="nearest")) if window > 1 else value


def curved(value: FloatArray, window: int) -> FloatArray:
    """Return the parabola through ``window`` samples about each: it keeps the height of a rounded turn.

    Savitzky and Golay, Anal. Chem. 36 (1964) 1627; ``window`` is an odd number.
    """
    if window <= 3:
        return value
    half = window // 2
    away = np.arange(-half, half + 1, dtype=float)
    weights = 3.0 * (3.0 * half * (half + 1.0) - 1.0) - 15.0 * away**2
    weights /= (2.0 * half - 1.0) * (2.0 * half + 1.0) * (2.0 * half + 3.0)
    return np.asarray(ndimage.correlate1d(value, weights, mode="nearest"))


def least_turn(noise: float, samples: int, window: int) -> float:
    """Return the greatest difference that noise alone makes between two of ``samples`` running medians.

    Of n normal values the greatest is near sqrt(2 ln n) deviations (Cramer, Mathematical Methods of
    Statistics,
    1946); the variance of a median of many is pi/2 of that of their mean.
    """
    variance = noise**2 * (1.0 if window == 1 else 0.5 * np.pi / window)
    return 2.0 * float(np.sqrt(2.0 * np.log(samples) * variance))


def falls(value: FloatArray, least: float) -> Falls:
    """Return all falls by more than ``least`` between which the force rises by more than ``least``."""
    candidates = _turns(value, least)
    tops: list[int] = []
    bottoms: list[int] = []
    highest = lowest = float(value[0])
    at_highest = at_lowest = 0
    falling: bool | None = None
    for index, now in zip(candidates.tolist(), value[candidates].tolist(), strict=True):
        if now > highest and falling is not True:
            highest, at_highest = now, index
        if now < lowest and falling is not False:
            lowest, at_lowest = now, index
        if falling is not True and highest - now > least:
            tops.append(at_highest)
            falling, lowest, at_lowest = True, now, index
        elif falling is not False and now - lowest > least:
            if tops:
                bottoms.append(at_lowest)
            falling, highest, at_highest = False, now, index
    return Falls(np.array(tops[: len(bottoms)], dtype=np.intp), np.array(bottoms, dtype=np.intp))


def _turns(value: FloatArray, least: float) -> IntArray:
    """Local extremes, without most of those that turn by less than ``least``.

    A step between two extremes that is no greater than those beside it hides within them: both may go.
    """
    change = np.diff(value)
    steps = np.flatnonzero(change)
    signs = np.signbit(change[steps])
    turns = np.concatenate([[0], steps[1:][signs[1:] != signs[:-1]], [value.size - 1]])
    while turns.size > _FEW_TURNS:
        step = np.abs(np.diff(value[turns]))
        hidden = np.zeros(step.size, dtype=bool)
        hidden[1:-1] = (step[1:-1] <= least) & (step[1:-1] < step[:-2]) & (step[1:-1] <= step[2:])
        if np.sum(hidden) < 0.01 * turns.size:
            break
        gone = np.concatenate([hidden, [False]]) | np.concatenate([[False], hidden])
        turns = turns[~gone]
    return np.asarray(turns, dtype=np.intp)


def crossing(value: FloatArray, slips: Falls, share: float) -> FloatArray:
    """Return where, in samples, each fall last passes the level at ``share`` of it below its top."""
    top, length = slips.top, slips.bottom - slips.top
    level = value[top] - share * (value[top] - value[slips.bottom])
    first = np.concatenate([[0], np.cumsum(length)[:-1]])
    place = np.arange(int(np.sum(length))) + np.repeat(top - first, length)
    above = np.where(value[place] >= np.repeat(level, length), place, np.repeat(top, length))
    last = np.maximum.reduceat(above, first)
    step = value[last] - value[last + 1]
    within = np.divide(value[last] - level, step, out=np.zeros(top.size), where=step > 0)
    return np.asarray(last + np.clip(within, 0.0, 1.0))
