"""Speed from an encoder that counts: below one count per row it reads 0, or one whole step.

At 1 rpm an encoder whose step is 6 rpm reads 0, 0, 0, 0, 0, 6, 0, ... Each count is spread over the rows
since the one before, which keeps the angle turned, so that such a dwell is judged by its mean speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.log.counters import FEW_COUNTS, STEP_TOLERANCE, step_of_few_counts
from hersey.log.long_arrays import HELD
from hersey.log.torque_log import Run

#: Share of rows without a count that makes a stretch one to be spread, and fewest counts in it.
_EMPTY, _COUNTS = 0.05, 3
#: Counts are gathered over at least this time, s, and so many rows: a count is known to a row.
_WINDOW, _ROWS = 0.2, 20
#: Rows without a count are a standstill if they last that many times as long as those beside them.
_STANDS = 3.0
#: The sum of counts may stray from a straight line by so many of them.
_STRAYS = 3.0


def with_counts_spread(run: Run) -> tuple[Run, float]:
    """Return a run with the counts of its encoder spread, and the step, rad/s; 0 if it needs none of that."""
    if run.speed.size > HELD:  # which stays on disk
        return run, 0.0
    size = np.abs(run.speed)
    step = step_of_few_counts(size)
    if not step:
        return run, 0.0
    speed = run.speed.copy()
    few = _directions(run.speed, size <= (FEW_COUNTS + STEP_TOLERANCE) * step)
    edges = np.flatnonzero(np.diff(few)) + 1
    for first, last in zip([0, *edges], [*edges, speed.size], strict=True):
        if few[first]:
            _spread(run.time[first:last], speed[first:last], max(_WINDOW, _ROWS * run.sampling_interval))
    return (run, 0.0) if np.array_equal(speed, run.speed) else (replace(run, speed=speed), step)


def _directions(speed: FloatArray, few: BoolArray) -> IntArray:
    """Direction of each row of few counts, 0 for others; a row without a count has that of the next."""
    direction = np.where(few, np.where(speed < 0, -1, 1), 0).astype(np.intp)
    at = np.where(speed != 0, np.arange(speed.size), speed.size - 1)
    following = direction[np.minimum.accumulate(at[::-1])[::-1]]
    return np.where((direction != 0) & (following != 0), following, direction).astype(np.intp)


def _spread(time: FloatArray, speed: FloatArray, window: float) -> None:
    """Spread the counts of one stretch over its rows, in place."""
    counts = np.flatnonzero(speed)
    if counts.size < _COUNTS or np.mean(speed == 0) < _EMPTY:
        return
    ends = time[counts]
    gaps = np.diff(ends, prepend=time[0])
    beside = np.maximum(np.append(gaps[1:], 0.0), np.insert(gaps[:-1], 0, 0.0))
    stands = gaps > np.maximum(_STANDS * beside, window)
    windows = _windows(time[0], ends.tolist(), stands.tolist(), counts.tolist(), window)
    for first, last in windows:
        if not speed[first:last].all():
            speed[first:last] = np.mean(speed[first:last])


def _windows(
    began: float, ends: list[float], stands: list[bool], counts: list[int], window: float
) -> Iterator[tuple[int, int]]:
    """Rows [first, last) over which counts are gathered: they end with a count, and hold no standstill."""
    first = 0
    for i, (count, end) in enumerate(zip(counts, ends, strict=True)):
        if stands[i]:  # what was gathered before it is a window already
            first, began = count + 1, end
        elif end - began >= window or i + 1 == len(counts) or stands[i + 1]:
            yield first, count + 1
            first, began = count + 1, end


def counting_error(values: FloatArray, step: float) -> float | None:
    """Return the standard error of the mean of readings that are counts, or None if they are not.

    The sum of counts is that of the angle turned within one count at each end, however many rows there are.
    """
    if not step or not values.size:
        return None
    strays = np.ptp(np.cumsum(values - np.mean(values)))
    return step / values.size / np.sqrt(6.0) if strays <= _STRAYS * step else None
