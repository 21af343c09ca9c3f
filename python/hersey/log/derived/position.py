"""Speed from a position: unwrapped where it restarts at every turn, and its slope over a window."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.white_noise import MEDIAN_MAGNITUDE

#: Longest time over which the slope is taken, s, unless another is asked for: noise is faster.
WINDOW = 0.2
#: Share of the speed that a window may smooth away, by the typical row, and how often the noise of half of it
#: may be in what it smooths.
_SMOOTHED, _NOISE = 0.01, 4.0
#: Fewest rows under a window.
_LEAST = 5
_TURN = 2.0 * np.pi
#: Fewest changes that show a step, how near to a multiple of it they are, as many of them as that, and steps
#: in a change at the most: any number is near a multiple of a small one.
_FEWEST, _NEAR, _SHARE, _MOST_STEPS = 10, 0.05, 0.98, 1e4
#: Most rows that a window is chosen by.
_MOST_ROWS = 100_000
#: Changes of fewer than so many steps are looked at first: in larger ones roundings add up.
_SMALL = 5.5
#: An angle restarts at every turn if it spans no more than one, within this share, and jumps back by
#: more than half a turn.
_WHOLE, _JUMP = 1.001, 0.5


def unwrapped(angle: FloatArray) -> tuple[FloatArray, int]:
    """Return an angle, rad, that goes on where it restarts at every turn, and how often it did so."""
    known = np.isfinite(angle)
    if not known.any() or np.ptp(angle[known]) > _WHOLE * _TURN:
        return angle, 0
    steps = np.diff(angle[known])
    jumps = np.abs(steps) > _JUMP * _TURN
    if not jumps.any():
        return angle, 0
    turns = np.append(0.0, np.cumsum(np.where(jumps, -np.sign(steps), 0.0)))
    out = angle.copy()
    out[known] += _TURN * turns
    return out, int(jumps.sum())


def slope(time: FloatArray, position: FloatArray, window: float) -> tuple[FloatArray, float]:
    """Return the speed from a position, and the time over which it was taken, s.

    It is the change of position over rows so far apart: the angle turned stays, changes that are faster than
    the window are smoothed. A row beside which numbers are missing has none.
    """
    rows = time.size
    if rows < 2:
        return np.full(rows, np.nan), window
    step = float(np.median(np.diff(time)))
    half = max(_LEAST // 2, round(0.5 * window / step)) if step > 0 else _LEAST // 2
    at = np.arange(rows)
    reach = np.minimum(half, np.maximum(np.minimum(at, rows - 1 - at), 1))
    first, last = np.maximum(at - reach, 0), np.minimum(at + reach, rows - 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = (position[last] - position[first]) / (time[last] - time[first])
    return np.where(np.isfinite(speed), speed, np.nan), 2.0 * half * step


def window_for(time: FloatArray, position: FloatArray) -> float:
    """Return the time over which the slope is to be taken, s: shorter than usual where the motion is faster.

    A window is too long if the speed over half of it differs, by more than noise makes it.
    """
    known = np.flatnonzero(np.isfinite(position))[:_MOST_ROWS]
    time, position = time[known], position[known]
    if time.size < _LEAST:
        return WINDOW
    third = np.diff(position, 3)
    rough = float(np.nanmedian(np.abs(third))) / (MEDIAN_MAGNITUDE * np.sqrt(20.0)) if third.size else 0.0
    noise = max(rough, smallest_step(position) / np.sqrt(12.0))
    window, least = WINDOW, _LEAST * float(np.median(np.diff(time)))
    speed = slope(time, position, window)[0]
    while 0.5 * window >= least:
        nearer = slope(time, position, 0.5 * window)[0]
        allowed = _SMOOTHED * float(np.nanmedian(np.abs(nearer)))
        allowed += _NOISE * MEDIAN_MAGNITUDE * noise * np.sqrt(10.0) / window
        if not float(np.nanmedian(np.abs(nearer - speed))) > allowed:
            break
        window, speed = 0.5 * window, nearer
    return window


def smallest_step(position: FloatArray) -> float:
    """Return the step in which a position counts, 0 if it has none: most rows change by whole steps."""
    changes = np.abs(np.diff(position[np.isfinite(position)][:_MOST_ROWS]))
    largest = float(np.max(changes, initial=0.0))
    gaps = np.diff(np.unique(np.append(0.0, changes)))
    gaps = gaps[gaps > 1e-6 * largest]
    if changes.size < _FEWEST or not gaps.size:
        return 0.0
    moved = changes > 1e-6 * largest
    alone = changes[1:-1][moved[1:-1] & ~moved[:-2] & ~moved[2:]]
    if alone.size >= _FEWEST:  # single counts show the step, whatever the decimals in which they were written
        few = changes[moved & (changes < _SMALL * alone.min())]
        if step := _counted(few, _mean_of_least(alone)):
            return step
    return _counted(changes, _mean_of_least(gaps))


def _mean_of_least(values: FloatArray) -> float:
    return float(np.mean(values[values < 1.5 * values.min()]))


def _counted(changes: FloatArray, step: float) -> float:
    """The step if changes are multiples of it, else 0."""
    ratio = changes / step
    counts = np.mean(np.abs(ratio - np.round(ratio)) < _NEAR) > _SHARE
    return step if counts and np.median(ratio) < _MOST_STEPS else 0.0
