"""The profiles that a search tries first: up, over and down in steps of laps, after each of some waits."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.stability.plan.trial import ROUNDING, Shape, TemperatureProfile

#: Rises of the grid in laps (periods of spring and mass), beyond what the acceleration needs.
_RISES = (0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0)
#: Holds of the grid in laps.
_HOLDS = (0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 8.0)
#: Falls of the grid in laps, beyond what the acceleration needs.
_FALLS = (0.0, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.5, 4.0, 7.0)
#: One in so many that overshoot is tried first, all of them only if none of these works.
_EVERY = 4
#: Factors on these durations: each only if those before find nothing.
STRETCHES = (1.0, 6.0, 40.0)
#: Peak speeds of the grid between target and greatest.
_PEAKS = 10
#: Waits of the grid over a temperature profile.
WAITS = 24


@dataclass(frozen=True)
class Room:
    """What the drive may do: greatest speed (m/s), greatest acceleration (m/s^2; infinite for jumps)."""

    speed: float
    acceleration: float

    def shape(
        self, target: float, peak: float, rise: float, hold: float, fall: float, wait: float = 0.0
    ) -> Shape:
        """Return the profile whose ramps take so much longer than they must."""
        peak = max(peak, target)
        least_rise, least_fall = peak / self.acceleration, (peak - target) / self.acceleration
        return Shape(target, peak, least_rise + rise, hold, least_fall + fall, wait)

    def allows(self, shape: Shape) -> bool:
        """Return whether the profile keeps within."""
        return shape.peak <= self.speed and shape.acceleration <= self.acceleration * (1.0 + ROUNDING)


def profiles(room: Room, target: float, lap: float) -> list[Shape]:
    """Return the profiles to a target (m/s) that the room allows, quickest first, without waits.

    Their durations go by ``lap``, s.
    """
    peaks = np.linspace(target, room.speed, _PEAKS + 1)[1:].tolist()
    if not room.speed > target:
        peaks = []
    direct = [room.shape(target, target, lap * r, 0.0, 0.0) for r in (*_RISES, *_HOLDS)]
    over = (
        room.shape(target, peak, lap * r, lap * h, lap * f)
        for peak, r, h, f in itertools.product(peaks, _RISES, _HOLDS, _FALLS)
    )
    return sorted((s for s in {*direct, *over} if room.allows(s)), key=lambda s: (s.end, s.peak))


def waits_of(thermal: TemperatureProfile) -> list[float]:
    """Return the waits of the grid: none, and where the temperature has moved by equal shares."""
    levels = thermal.levels
    if len({value for _, value in levels}) < 2:
        return [0.0]
    even = np.linspace(0.0, thermal.end, 20 * WAITS)
    moved = np.cumsum(np.abs(np.diff([thermal.at(t) or 0.0 for t in even], prepend=0.0)))
    moved = moved - moved[0]
    shares = np.linspace(0.0, moved[-1], WAITS)
    return sorted({0.0, *np.interp(shares, moved, even).tolist(), thermal.end})


def thinned(grid: Sequence[Shape]) -> list[Shape]:
    """Return the profiles of a grid tried first: straight up to the target, and one in so many others."""
    return [shape for i, shape in enumerate(grid) if i % _EVERY == 0 or shape.peak == shape.target]
