"""Rows that their neighbours rule out: bursts, jumps there and back, flips of the sign, drop-outs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.log.long_arrays import blocks, joined, rows_where

#: A burst lies so many sizes (span, or greatest value) beyond the ordinary range, for at most so many rows.
_BURSTS = ((5.0, 2), (20.0, 20), (1000.0, 1_000_000_000))
NEAREST_BURST = _BURSTS[0][0]
#: Rows beside what is impossible go with it where they lie beyond the ordinary range by more than this many
#: sizes and change by more than this many from one to the next: a reading on its way there.
_BESIDE, _ON_ITS_WAY = 0.25, 0.1
#: Rows at the most in which a reading drops out or changes its sign, and steady rows on either side.
_SHORT, _AROUND = 2, 5
#: Rows are steady if they span at most this share of their median, and opposite to it within the second.
_STEADY_FLIP, _STEADY_DROP = 0.5, 0.3
#: No temperature jumps by so many kelvin from row to row, and back again, with rows at most so many s apart.
LEAST_JUMP, _ROWS_APART = 100.0, 10.0
#: Short runs are looked at one by one unless they start in more than this share of the rows.
_MOST_STARTS = 0.3


def runs_of_true(mask: BoolArray) -> list[tuple[int, int]]:
    """Return the first row of each run of true, and the row behind its last."""
    edges = np.flatnonzero(np.diff(mask.astype(np.int8), prepend=0, append=0))
    return [(start, end) for start, end in edges.reshape(-1, 2).tolist()]


def _runs(rows: IntArray) -> list[tuple[int, int]]:
    """First row of each run of neighbours, and the row behind its last; ``rows`` are in order."""
    ends = np.flatnonzero(np.diff(rows) != 1)
    first, last = rows[np.append(0, ends + 1)], rows[np.append(ends, -1)]
    return list(zip(first.tolist(), (last + 1).tolist(), strict=True))


def _from_to(stretches: list[tuple[int, int]]) -> IntArray:
    """The rows of stretches that follow each other."""
    return joined(np.arange(start, end) for start, end in stretches)


def bursts(values: FloatArray, low: float, high: float, size: float) -> IntArray:
    """Return runs of rows so far beyond the ordinary range as no drive goes and comes back from so soon."""

    def beyond(part: FloatArray, far: float) -> BoolArray:
        return np.asarray((part > high + far * size) | (part < low - far * size))

    rows = rows_where(lambda block: beyond(values[block], NEAREST_BURST), values.size, values)
    found = []
    for far, longest in _BURSTS:
        rows = rows[beyond(values[rows], far)]
        for start, end in _runs(rows) if rows.size else ():
            if end - start <= longest and start > 0 and end < values.size:
                found.append((start, end))
    return np.unique(_from_to(found))


def on_its_way(values: FloatArray, seeds: IntArray, low: float, high: float, size: float) -> IntArray:
    """Return rows beside impossible ones that lead there: beyond the ordinary range, and changing fast."""
    found = []
    runs = _runs(seeds)
    behind = [0, *(end for _, end in runs)]
    before = [*(start for start, _ in runs), values.size]
    for (start, end), least, most in zip(runs, behind[:-1], before[1:], strict=True):
        for row, step in ((start - 1, -1), (end, 1)):
            while least <= row < most and _is_beside(values[row], low, high, size):
                if abs(values[row] - values[row - step]) < _ON_ITS_WAY * size:
                    break
                found.append(row)
                row += step  # walks on
    return np.unique(np.array(found, dtype=np.intp))


def _is_beside(value: float, low: float, high: float, size: float) -> bool:
    return bool(value > high + _BESIDE * size or value < low - _BESIDE * size)


def pulses(values: FloatArray, time: FloatArray, size: float, most: float) -> IntArray:
    """Return rows between a jump and the one that leads back to the level before it."""
    jump = max(LEAST_JUMP, size)

    def far(block: slice) -> BoolArray:
        return np.asarray(np.abs(np.diff(values[block.start : block.stop + 1])) > jump)

    jumps = rows_where(far, values.size - 1, values) + 1
    jumps = jumps[time[jumps] - time[jumps - 1] <= _ROWS_APART]
    found = []
    longest, i = most * values.size, 0
    while i < jumps.size:
        start = jumps[i]
        level = values[start - 1]
        back = next(
            (
                k
                for k in range(i + 1, jumps.size)
                if abs(values[jumps[k]] - level) < 0.3 * jump or jumps[k] - start > longest
            ),
            None,
        )
        if back is None or jumps[back] - start > longest:
            i += 1
            continue
        found.append((start, jumps[back]))
        i = back + 1
    return _from_to(found)


def flips(values: FloatArray) -> IntArray:
    """Return rows of the sign opposite to that of steady rows before and after, and about as large."""

    def starts(part: FloatArray) -> BoolArray:
        negative = part < 0.0
        return np.asarray(negative[1:] != negative[:-1])

    def opposite(inside: FloatArray, level: FloatArray) -> BoolArray:
        return np.asarray(np.abs(inside + level[:, None]) <= _STEADY_FLIP * np.abs(level)[:, None])

    return _between_steady(values, starts, lambda part: part, _STEADY_FLIP, 0.0, opposite)


def drop_outs(values: FloatArray, zero: float, least: float) -> IntArray:
    """Return rows that read zero, which is ``zero`` in SI, between steady rows that are further from it."""

    def none_read(part: FloatArray) -> BoolArray:
        return np.asarray(part == zero if zero == 0.0 else np.abs(part - zero) <= 1e-12 * abs(zero))

    def starts(part: FloatArray) -> BoolArray:
        none = none_read(part)
        return np.asarray(none[1:] & ~none[:-1])

    def from_zero(part: FloatArray) -> FloatArray:
        return np.where(none_read(part), 0.0, part - zero) if zero else part

    def none(inside: FloatArray, _level: FloatArray) -> BoolArray:
        return np.asarray(inside == 0.0)

    return _between_steady(values, starts, from_zero, _STEADY_DROP, least, none)


def _between_steady(
    values: FloatArray,
    starting: Callable[[FloatArray], BoolArray],
    beside: Callable[[FloatArray], FloatArray],
    steady: float,
    least: float,
    odd: Callable[[FloatArray, FloatArray], BoolArray],
) -> IntArray:
    """Rows of short runs that are odd between rows that are steady, and larger than the least.

    ``starting`` tells which rows start a run, from the second on, ``beside`` how far values are from zero.
    """
    found, starts = [], 0
    for block in blocks(values.size, values):
        before = max(block.start - 1, 0)
        at = np.flatnonzero(starting(values[before : block.stop])) + before + 1
        starts += at.size
        if starts > _MOST_STARTS * values.size:
            return np.empty(0, dtype=np.intp)
        if at.size:
            first = max(before - _AROUND, 0)
            near = beside(values[first : block.stop + _SHORT + _AROUND])
            at = at[(at >= _AROUND) & (at + 1 + _AROUND <= values.size)]
            found.append(_odd_rows(near, at - first, steady, least, odd) + first)
    return np.unique(joined(found))


def _odd_rows(
    values: FloatArray,
    starts: IntArray,
    steady: float,
    least: float,
    odd: Callable[[FloatArray, FloatArray], BoolArray],
) -> IntArray:
    """Of runs that start in these rows, those that are odd between steady rows; five rows are before each."""
    found = []
    for length in range(1, _SHORT + 1):
        at = starts[starts + length + _AROUND <= values.size]
        before = values[at[:, None] - 1 - np.arange(_AROUND)]
        after = values[at[:, None] + length + np.arange(_AROUND)]
        around = np.hstack([before, after])
        level = np.median(around, axis=1)
        inside = values[at[:, None] + np.arange(length)]
        calm = np.ptp(around, axis=1) <= steady * np.abs(level)
        hit = at[calm & (np.abs(level) > least) & odd(inside, level).all(axis=1)]
        found += [hit + row for row in range(length)]
    return joined(found)
