"""Numbers that cannot be what they are called: one question comes before any conclusion.

A ratio that lies far beyond every real machine is compared with the factors by which units are confused: a
thousand between mN m and N m or mm and m, and columns that are swapped.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hersey.damping.dwells import SteadyPoints
from hersey.damping.surface import DampingSurface
from hersey.machine.machine import Machine

#: Times a limit from which a number is asked about, and the window about a factor of a thousand.
FAR, THOUSAND = 20.0, (100.0, 1e4)
#: Greatest roll radius (m) and belt speed (m/s) of a machine that needs no question, and greatest friction.
LARGE_RADIUS, FAST, FRICTION = 1.0, 20.0, 3.0

Kind = Literal["torque unit", "speed unit", "radius unit", "swapped"]


@dataclass(frozen=True)
class Question:
    """What is asked: ``times`` is how many times ``limit`` the value is, ``of`` what sets that limit."""

    kind: Kind
    value: float  #: SI
    limit: float
    of: Literal["motor", "friction", "drive", "usual"]

    @property
    def times(self) -> float:
        """How many times the limit the value is."""
        return self.value / self.limit

    @property
    def thousandfold(self) -> bool:
        """Whether a factor of a thousand explains it."""
        return THOUSAND[0] <= self.times <= THOUSAND[1]


def asked(points: SteadyPoints, surface: DampingSurface, machine: Machine | None) -> Question | None:
    """Return the one question that must be answered first; None where the numbers are possible."""
    if machine is None:
        return None
    radius = machine.roll_radius
    torque = float(np.median(np.abs(points.column("torque"))))
    slow, fast = (speed * radius for speed in surface.speed_range)
    speed = _too_fast(machine, fast)
    heavy = _too_much_torque(machine, torque)
    if heavy is not None and _swapped(machine, slow, fast):
        return Question("swapped", heavy.value, heavy.limit, heavy.of)
    if radius > LARGE_RADIUS and (speed is not None or heavy is None):
        return Question("radius unit", radius, LARGE_RADIUS, "usual")
    return heavy or speed


def _too_much_torque(machine: Machine, torque: float) -> Question | None:
    limits = machine.limits
    if limits.motor_torque is not None and torque > FAR * limits.motor_torque:
        return Question("torque unit", torque, limits.motor_torque, "motor")
    if limits.nip_load is not None and limits.motor_torque is None:
        most = FRICTION * limits.nip_load * machine.roll_radius
        if torque > FAR * most:
            return Question("torque unit", torque, most, "friction")
    return None


def _too_fast(machine: Machine, fast: float) -> Question | None:
    limit = machine.limits.speed
    if limit is not None and fast > FAR * limit:
        return Question("speed unit", fast, limit, "drive")
    return Question("speed unit", fast, FAST, "usual") if fast > FAR * FAST else None


def _swapped(machine: Machine, slow: float, fast: float) -> bool:
    """Whether the log's speeds are far slower than those of the machine, as torques in N m would be."""
    known = [point.speed for point in machine.points]
    known += [machine.limits.speed] if machine.limits.speed is not None else []
    if not known:
        return False
    return fast * 5.0 < min(known) or math.log(fast / slow) < 0.1
