"""Falls of speed that end in a speed that is held: steps of a staircase, which a drive sets.

A wheel that friction slows goes on slowing: in as much time again it loses at least a third of what it has
lost, or of what it has left, even where friction grows with the square of speed. Speed that changes by much
less is held.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray

#: Change of a held speed at the most, as a share of the fall before it and of the speed itself.
_HELD = 0.2
#: Standard deviations of the noise by which a change must be smaller.
_SURELY = 3.0
#: Standard deviations by which the highest row of a hold exceeds its lowest.
_ABOVE = 8.0
#: Rows of a fall and of a hold at the least.
_FEWEST_ROWS = 3
#: Rows of a hold are within this share of the fall, or within so many standard deviations of the noise.
_EVEN, _WITHIN = 0.05, 5.0
#: Growth of the times after the beginning of a fall at which a hold is looked for.
_GROWTH = 1.1
#: Share of the rows of a hold whose mean stands for its speed at each end.
_AVERAGED = 8


@dataclass(frozen=True)
class Step:
    """A fall from row ``top`` to row ``start``, from which speed is held to row ``end``."""

    top: int
    start: int
    end: int


def steps_in(time: FloatArray, speed: FloatArray, top: int, bottom: int, noise: float) -> list[Step]:
    """Return the steps of a fall of speed, without the part after the last hold."""
    found: list[Step] = []
    part = speed[top:bottom]
    top += int(np.flatnonzero(part >= part[0] - _ABOVE * noise)[-1])  # the end of a hold before the fall
    while True:
        step = _first(time, speed, top, bottom, noise)
        if step is None:
            return found
        found.append(step)
        top = step.end - 1


def _first(time: FloatArray, speed: FloatArray, top: int, bottom: int, noise: float) -> Step | None:
    """The first hold after the beginning of a fall that lasts as long as the fall."""
    rows = float(_FEWEST_ROWS)
    while (start := top + int(rows)) < bottom:
        end = int(np.searchsorted(time, 2.0 * time[start] - time[top], side="right"))
        if end >= time.size:
            return None
        size = max(1, (end - start) // _AVERAGED)
        level = _mean(speed, start, size)
        lost = min(speed[top] - level, level)
        middle = (start + end) // 2
        changes = [abs(_mean(speed, row, size) - level) for row in (middle, end - size)]
        if end - start >= _FEWEST_ROWS and max(changes) + noise * _SURELY / np.sqrt(size) < _HELD * lost:
            first, last = _hold(speed, middle, end, max(_EVEN * lost, _WITHIN * noise))
            if first > top and time[last - 1] - time[first] >= time[first] - time[top]:
                return Step(top, first, last)
        rows = max(rows + 1.0, _GROWTH * rows)
    return None


def _mean(speed: FloatArray, row: int, size: int) -> float:
    return float(speed[row : row + size].mean())


def _hold(speed: FloatArray, middle: int, end: int, allowed: float) -> tuple[int, int]:
    """First row of a hold, and the row after its last, from rows in it; speed may still settle in them."""
    while True:
        away = np.abs(speed - float(speed[middle:end].mean())) > allowed
        before, after = np.flatnonzero(away[:middle]), np.flatnonzero(away[end:])
        first = int(before[-1]) + 1 if before.size else 0
        last = end + int(after[0]) if after.size else speed.size
        if last == end:
            return first, last
        middle, end = (first + last) // 2, last
