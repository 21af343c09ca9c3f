"""Rows that their neighbours rule out: bursts, jumps there and back, flips of the sign, drop-outs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray

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


def bursts(values: FloatArray, low: float, high: float, size: float) -> BoolArray:
    """Return runs of rows so far beyond the ordinary range as no drive goes and comes back from so soon."""
    found = np.zeros(values.size, dtype=bool)
    for far, longest in _BURSTS:
        beyond = (values > high + far * size) | (values < low - far * size)
        for start, end in runs_of_true(beyond):
            if end - start <= longest and start > 0 and end < values.size:
                found[start:end] = True
    return found


def on_its_way(values: FloatArray, seeds: BoolArray, low: float, high: float, size: float) -> BoolArray:
    """Return rows beside impossible ones that lead there: beyond the ordinary range, and changing fast."""
    near = (values > high + _BESIDE * size) | (values < low - _BESIDE * size)
    found = np.zeros(values.size, dtype=bool)
    for start, end in runs_of_true(seeds):
        for row, step in ((start - 1, -1), (end, 1)):
            while 0 <= row < values.size and near[row] and not seeds[row]:
                if abs(values[row] - values[row - step]) < _ON_ITS_WAY * size:
                    break
                found[row] = True
                row += step  # walks on
    return found


def pulses(values: FloatArray, time: FloatArray, size: float, most: float) -> BoolArray:
    """Return rows between a jump and the one that leads back to the level before it."""
    jump, steps = max(LEAST_JUMP, size), np.diff(values)
    jumps = np.flatnonzero((np.abs(steps) > jump) & (np.diff(time) <= _ROWS_APART)) + 1
    found = np.zeros(values.size, dtype=bool)
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
        found[start : jumps[back]] = True
        i = back + 1
    return found


def flips(values: FloatArray) -> BoolArray:
    """Return rows of the sign opposite to that of steady rows before and after, and about as large."""
    negative = values < 0.0
    starts = np.flatnonzero(negative[1:] != negative[:-1]) + 1

    def opposite(inside: FloatArray, level: FloatArray) -> BoolArray:
        return np.asarray(np.abs(inside + level[:, None]) <= _STEADY_FLIP * np.abs(level)[:, None])

    return _between_steady(values, starts, _STEADY_FLIP, 0.0, opposite)


def drop_outs(values: FloatArray, zero: float, least: float) -> BoolArray:
    """Return rows that read zero, which is ``zero`` in SI, between steady rows that are further from it."""
    none_read = values == zero if zero == 0.0 else np.abs(values - zero) <= 1e-12 * abs(zero)
    starts = np.flatnonzero(none_read[1:] & ~none_read[:-1]) + 1
    from_zero = np.where(none_read, 0.0, values - zero) if starts.size and zero else values

    def none(inside: FloatArray, _level: FloatArray) -> BoolArray:
        return np.asarray(inside == 0.0)

    return _between_steady(from_zero, starts, _STEADY_DROP, least, none)


def _between_steady(
    values: FloatArray,
    starts: IntArray,
    steady: float,
    least: float,
    odd: Callable[[FloatArray, FloatArray], BoolArray],
) -> BoolArray:
    """Rows of short runs that are odd between rows that are steady, and larger than the least."""
    found = np.zeros(values.size, dtype=bool)
    if not starts.size or starts.size > _MOST_STARTS * values.size:
        return found
    for length in range(1, _SHORT + 1):
        at = starts[(starts >= _AROUND) & (starts + length + _AROUND <= values.size)]
        before = values[at[:, None] - 1 - np.arange(_AROUND)]
        after = values[at[:, None] + length + np.arange(_AROUND)]
        around = np.hstack([before, after])
        level = np.median(around, axis=1)
        inside = values[at[:, None] + np.arange(length)]
        calm = np.ptp(around, axis=1) <= steady * np.abs(level)
        hit = at[calm & (np.abs(level) > least) & odd(inside, level).all(axis=1)]
        for row in range(length):
            found[hit + row] = True
    return found
