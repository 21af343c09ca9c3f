"""Rows whose time lies off the clock of the rows before and after."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.log.believed import is_code
from hersey.log.long_arrays import blocks, joined, rows_where
from hersey.log.middle import median_step
from hersey.units import Conversion

#: A step of the clock is a jump if it is negative, or longer than so many usual ones.
_JUMP = 10.0
#: Stray rows end where the clock goes on: within so many times the rows that passed, and so many rows more.
_ON, _MORE = 3.0, 2.0
#: Stray rows in one place, at the most, as a share; and jumps looked at to find their end.
_LONGEST, _LOOKED_AT = 0.2, 2000

_SECONDS = Conversion("s", 1.0, 0.0)


def stray_times(time: FloatArray) -> IntArray:
    """Return the rows that are off a clock (s, finite) that goes on behind them as if they had kept to it.

    A clock that starts anew never goes on as before, and a gap leads nowhere else: neither is stray. At the
    start and the end, where nothing comes before or after, rows that stand at a code of the logger are.

    Examples
    --------
    >>> time = np.arange(20.0)
    >>> time[3:5] = 65535.0
    >>> stray_times(time).tolist()
    [3, 4]
    """
    if time.size < 3 or _goes_on(time):
        return np.empty(0, dtype=np.intp)
    usual = median_step(time, forward=True)
    if usual is None:
        return np.empty(0, dtype=np.intp)

    def jumping(block: slice) -> BoolArray:
        steps = np.diff(time[block.start : block.stop + 1])
        return np.asarray((steps < 0) | (steps > _JUMP * usual))

    jumps = rows_where(jumping, time.size - 1, time) + 1
    stray: list[IntArray] = []
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
                stray.append(np.arange(start, end))
                done = end
                break
    return np.unique(joined([*stray, *_at_the_ends(time, jumps)]))


def _goes_on(time: FloatArray) -> bool:
    """Whether a clock never steps back nor jumps, as most do: seen without the median of its steps.

    If most steps forward are longer than a tenth of the greatest, that one is no jump.
    """
    ends = [(steps.min(), steps.max()) for steps in _steps(time)]
    greatest = max(most for _, most in ends)
    if min(least for least, _ in ends) < 0.0:
        return False
    long = forward = 0
    for steps in _steps(time):
        long += int(np.count_nonzero(steps > greatest / _JUMP))
        forward += int(np.count_nonzero(steps > 0.0))
    return 2 * long > forward


def _steps(time: FloatArray) -> Iterator[FloatArray]:
    """The steps of a clock, block by block."""
    for block in blocks(time.size - 1, time):
        yield np.diff(time[block.start : block.stop + 1])


def _at_the_ends(time: FloatArray, jumps: IntArray) -> Iterator[IntArray]:
    """Rows before the first jump, or from the last on, that all stand at one code."""
    if jumps.size:
        for first, end in ((0, int(jumps[0])), (int(jumps[-1]), time.size)):
            if is_code(time[first : first + 1], _SECONDS, "time")[0] and np.all(
                time[first:end] == time[first]
            ):
                yield np.arange(first, end)
