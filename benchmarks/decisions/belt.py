"""A belt pulled by a drive through a spring: drag at every speed, and how the belt comes to rest.

Below the stick speed v_s drag is A exp(-v/v_s), with A = e F(v_s). The closure says what a slow belt does:

========  ===========================================================================
retained  a belt slower than v_s keeps its speed until the spring pulls more than that
stiction  a belt moves freely down to speed 0, where it is held by up to A
========  ===========================================================================

SI units throughout. Nothing here comes from hersey.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

Closure = Literal["retained", "stiction"]
CLOSURES: tuple[Closure, ...] = ("retained", "stiction")

State = tuple[float, float]  #: belt speed (m/s) and spring force (N)


@dataclass(frozen=True)
class Belt:
    """Drag on a belt, its mass, and the spring that pulls it; forces in N at the belt."""

    film: Callable[[float], float]  #: drag of the contact against speed, above the stick speed
    transition: float  #: speed of least drag, m/s
    stick: float  #: stick speed, m/s
    stiffness: float
    mass: float
    closure: Closure
    grip: float = math.inf  #: greatest force that the roll can transmit
    rest: float = 0.0  #: drag besides that of the contact

    @cached_property
    def static(self) -> float:
        """Greatest drag of the contact on a belt at rest, A."""
        return math.e * self.film(self.stick)

    @cached_property
    def start(self) -> float:
        """Spring force that starts a belt from rest."""
        return self.static + self.rest

    @cached_property
    def period(self) -> float:
        """Period of the free oscillation, s."""
        return math.tau * math.sqrt(self.mass / self.stiffness)

    def drag(self, speed: float) -> float:
        """Return the force against the motion of a moving belt, at a speed of either sign."""
        size = -speed if speed < 0.0 else speed
        force = self.film(size) if size >= self.stick else self.static * math.exp(-size / self.stick)
        return force + self.rest

    def hold(self, speed: float) -> float:
        """Return the spring force up to which a belt slower than the stick speed is held."""
        return self.static * math.exp(-abs(speed) / self.stick) + self.rest

    def held(self, speed: float, pull: float) -> bool:
        """Return whether a belt at this speed is held against this spring force."""
        slow = speed == 0.0 if self.closure == "stiction" else abs(speed) < self.stick
        return slow and abs(pull) <= self.hold(speed)

    @property
    def stuck_starts(self) -> tuple[State, ...]:
        """States at the release of a stuck belt: from rest, and for `retained` also from the stick speed."""
        rest = (0.0, self.start)
        if self.closure == "stiction":
            return (rest,)
        creeping = self.stick * (1.0 - 1e-13)
        return (creeping, self.hold(creeping)), rest


class Drive:
    """Speed of the drive, linear between corners (time, speed) and constant after the last."""

    def __init__(self, *corners: State) -> None:
        self.corners = corners

    def piece(self, time: float) -> tuple[float, float, float]:
        """Return speed and acceleration right after a time, and the time of the next corner."""
        t0, v0 = self.corners[0]
        if time < t0:
            return v0, 0.0, t0
        for t1, v1 in self.corners[1:]:
            if time < t1 - 1e-12:
                slope = (v1 - v0) / (t1 - t0)
                return v0 + slope * (time - t0), slope, t1
            t0, v0 = t1, v1
        return v0, 0.0, math.inf
