"""Speed from a position: unwrapped where it restarts at every turn, and its slope over a window."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray

#: Time over which the slope is taken, s, unless another is asked for: ramps are slower, noise is faster.
WINDOW = 0.2
#: Fewest rows under a window.
_LEAST = 5
_TURN = 2.0 * np.pi
#: Fewest changes that show a step, how near to a multiple of it they are, as many of them as that, and steps
#: in a change at the most: any number is near a multiple of a small one.
_FEWEST, _NEAR, _SHARE, _MOST_STEPS = 10, 0.05, 0.98, 1e4
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


def smallest_step(position: FloatArray) -> float:
    """Return the step in which a position counts, 0 if it has none: most rows change by whole steps."""
    changes = np.abs(np.diff(position[np.isfinite(position)][:100_000]))
    largest = float(np.max(changes, initial=0.0))
    gaps = np.diff(np.unique(np.append(0.0, changes)))
    gaps = gaps[gaps > 1e-6 * largest]
    if changes.size < _FEWEST or not gaps.size:
        return 0.0
    step = float(np.mean(gaps[gaps < 1.5 * gaps.min()]))
    ratio = changes / step
    counts = np.mean(np.abs(ratio - np.round(ratio)) < _NEAR) > _SHARE
    return step if counts and np.median(ratio) < _MOST_STEPS else 0.0
