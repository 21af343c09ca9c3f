"""Rows whose time lies off the clock of the rows before and after."""

from __future__ import annotations

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.log.believed import is_code
from hersey.units import Conversion

#: A step of the clock is a jump if it is negative, or longer than so many usual ones.
_JUMP = 10.0
#: Stray rows end where the clock goes on: within so many times the rows that passed, and so many rows more.
_ON, _MORE = 3.0, 2.0
#: Stray rows in one place, at the most, as a share; and jumps looked at to find their end.
_LONGEST, _LOOKED_AT = 0.2, 2000
#: Rows whose steps are looked at together.
_AT_ONCE = 1 << 16

_SECONDS = Conversion("s", 1.0, 0.0)


def stray_times(time: FloatArray) -> BoolArray:
    """Return which rows are off a clock (s, finite) that goes on behind them as if they had kept to it.

    A clock that starts anew never goes on as before, and a gap leads nowhere else: neither is stray. At the
    start and the end, where nothing comes before or after, rows that stand at a code of the logger are.

    Examples
    --------
    >>> time = np.arange(20.0)
    >>> time[3:5] = 65535.0
    >>> np.flatnonzero(stray_times(time)).tolist()
    [3, 4]
    """
    stray = np.zeros(time.size, dtype=bool)
    if time.size < 3 or _goes_on(time):
        return stray
    steps = np.diff(time)
    forward = steps[steps > 0]
    if not forward.size:
        return stray
    usual = float(np.median(forward))
    jumps = np.flatnonzero((steps < 0) | (steps > _JUMP * usual)) + 1
    done = 0
    for i, start in enumerate(jumps):
        if start < done:
            continue
        before = time[start - 1]
        for end in jumps[i + 1 : i + 1 + _LOOKED_AT]:
            passed = end - start + 1
            if passed > max(2.0, _LONGEST * time.size):
                break
            on = time[end] - before
            if not 0.0 < on <= _ON * usual * (passed + _MORE):
                continue
            inside = time[start:end]
            if np.all((inside < before) | (inside > time[end])):
                stray[start:end] = True
                done = end
                break
    return stray | _at_the_ends(time, jumps)


def _goes_on(time: FloatArray) -> bool:
    """Whether a clock never steps back nor jumps, as most do: seen without the median of its steps.

    If most steps forward are longer than a tenth of the greatest, that one is no jump.
    """
    parts = [slice(i, i + _AT_ONCE + 1) for i in range(0, time.size - 1, _AT_ONCE)]  # which stay in the cache
    ends = [(steps.min(), steps.max()) for part in parts if (steps := np.diff(time[part])).size]
    greatest = max(most for _, most in ends)
    if min(least for least, _ in ends) < 0.0:
        return False
    long = forward = 0
    for part in parts:
        steps = np.diff(time[part])
        long += int(np.count_nonzero(steps > greatest / _JUMP))
        forward += int(np.count_nonzero(steps > 0.0))
    return 2 * long > forward


def _at_the_ends(time: FloatArray, jumps: np.ndarray) -> BoolArray:
    """Rows before the first jump, or from the last on, that all stand at one code."""
    found = np.zeros(time.size, dtype=bool)
    if jumps.size:
        for part in (slice(0, int(jumps[0])), slice(int(jumps[-1]), time.size)):
            same = np.all(time[part] == time[part][0])
            if same and is_code(time[part][:1], _SECONDS, "time")[0]:
                found[part] = True
    return found
