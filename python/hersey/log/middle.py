"""The median of the steps of a clock, to the bit that of NumPy, without the steps of a long log in memory."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.log.long_arrays import blocks, let_go

#: Rows whose steps are held at once.
_AT_ONCE = 1 << 20
#: Places at which so many steps each are looked at first, and the share of them about the middle that is
#: taken to enclose it; where it does not, so many times as much.
_PLACES, _EACH, _ABOUT, _WIDER = 512, 256, 0.02, 4.0
#: Blocks whose distinct steps are put together.
_TOGETHER = 64


def median_step(time: FloatArray, *, forward: bool = False) -> float | None:
    """Return the median time between rows, or of those alone that go forward; None if there are none."""
    if time.size <= _AT_ONCE:
        every = _kept(np.diff(time), forward)
        return float(np.median(every)) if every.size else None
    starts = np.linspace(0, time.size - 1 - _EACH, _PLACES).astype(np.intp)
    sample = [np.diff(time[start : start + _EACH + 1]) for start in starts]
    seen, about = np.sort(_kept(np.concatenate(sample), forward)), _ABOUT
    let_go(time)
    while True:
        low, high = _bracket(seen, about)
        steps, below, values, ranks = _ranked(time, forward, low, high)
        if not steps:
            return None
        lower, upper = (steps - 1) // 2 - below, steps // 2 - below
        if lower >= 0 and values.size and upper < ranks[-1]:
            at = np.searchsorted(ranks, (lower, upper), side="right")
            return float(values[at[0]] + values[at[1]]) / 2.0
        about *= _WIDER


def _kept(steps: FloatArray, forward: bool) -> FloatArray:
    return steps[steps > 0] if forward else steps


def _bracket(seen: FloatArray, about: float) -> tuple[float, float]:
    """Steps that should enclose the middle: of those seen, in order, a share of them about theirs."""
    first, last = (round((0.5 + side * about) * (seen.size - 1)) for side in (-1, 1))
    if first < 0 or not seen.size:
        return -np.inf, np.inf
    return float(seen[first]), float(seen[last])


def _ranked(
    time: FloatArray, forward: bool, low: float, high: float
) -> tuple[int, int, FloatArray, IntArray]:
    """How many steps there are and how many below a bracket; the steps within, and how many up to each."""
    steps, below = 0, 0
    found = [(np.empty(0), np.empty(0, dtype=np.intp))]
    for block in blocks(time.size - 1, time):
        part = _kept(np.diff(time[block.start : block.stop + 1]), forward)
        steps, below = steps + part.size, below + int(np.count_nonzero(part < low))
        found.append(np.unique(part[(part >= low) & (part <= high)], return_counts=True))
        if len(found) > _TOGETHER:
            found = [_together(found)]
    values, counts = _together(found)
    return steps, below, values, np.cumsum(counts)


def _together(found: list[tuple[FloatArray, IntArray]]) -> tuple[FloatArray, IntArray]:
    """Distinct steps of several parts in order, and how often each occurs."""
    values, at = np.unique(np.concatenate([each for each, _ in found]), return_inverse=True)
    counts = np.bincount(at, np.concatenate([each for _, each in found]), values.size)
    return values, counts.astype(np.intp)
