"""V*: the greatest drive speed at which a belt that was stuck does not come to slide."""

from __future__ import annotations

import math
from dataclasses import replace

from benchmarks.decisions.belt import Belt, Drive
from benchmarks.decisions.motion import moved

#: Factor between the drive speeds that are tried first.
_FACTOR = 1.12
#: So many of them in a row must slide.
_IN_A_ROW = 4
#: Over the transition speed, the greatest drive speed that is tried.
_FARTHEST = 1e3


def lasts(belt: Belt, speed: float) -> bool:
    """Return whether stick-slip lasts at a drive speed, from any state in which the belt is released."""
    drive = Drive((0.0, speed))
    return any(moved(belt, drive, start).outcome != "slides" for start in belt.stuck_starts)


def fold(belt: Belt, tolerance: float = 1e-5) -> float:
    """Return V*: the transition speed if stick-slip lasts nowhere above it, infinite if everywhere.

    A roll that slips on the belt damps the swing: where the belt is started, its grip counts.
    """
    if belt.start >= belt.grip:
        belt = replace(belt, grip=math.inf)  # a belt that is never started has none of its own
    low, speed, sliding = belt.transition, 1.001 * belt.transition, 0
    while sliding < _IN_A_ROW:
        if speed > _FARTHEST * belt.transition:
            return math.inf
        if lasts(belt, speed):
            low, sliding = speed, 0
        else:
            sliding += 1
        speed *= _FACTOR
    high = low * _FACTOR if low > belt.transition else 1.001 * low
    while high / low > 1.0 + tolerance:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if lasts(belt, middle) else (low, middle)
    return high
