"""The failure modes of a machine file, and the ages at which they happen to specimens without noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.life_tests.drive import COLD, FAST, HOT, RADIUS, Drive
from benchmarks.life_tests.states import State

Array = NDArray[np.float64]

#: Names of the modes as hersey prints them.
COLD_FAST = "motor torque, cold and fast"
HOT_SLOW = "motor torque, hot and slow"
STICK_FULL = "stick-slip, full speed"
STICK_SLOW = "stick-slip, thick paper"
CONTINUOUS = "continuous torque"
ENERGY = "energy per page"
STARVATION = "starvation, full speed"
#: Film over flooded film below which hersey calls a film starved, whatever the law.
STARVED = 0.5 ** (1 / 3)
#: Travel of the belt in one page, m.
TRAVEL = 0.3


@dataclass(frozen=True)
class Use:
    """How the machine is used and what it can bear; what is None is not stated."""

    slow: float
    #: Share of running time at full speed.
    share: float
    motor: float
    cold: float = COLD
    continuous: float | None = None
    energy: float | None = None

    def limits(self, starves: bool) -> dict[str, float]:
        """Return the limit of each mode that is judged."""
        judged = {COLD_FAST: self.motor, HOT_SLOW: self.motor, STICK_FULL: FAST, STICK_SLOW: self.slow}
        judged |= {CONTINUOUS: self.continuous} if self.continuous else {}
        judged |= {ENERGY: self.energy} if self.energy else {}
        return judged | ({STARVATION: 1.0} if starves else {})


def indicators(drive: Drive, use: Use, state: State) -> dict[str, Array]:
    """Return the value of each mode, shape of the state."""
    torque = {speed: drive.whole(state, speed, HOT) for speed in (FAST, use.slow)}
    shares = {FAST: use.share, use.slow: 1 - use.share}
    power = sum(share * torque[speed] * speed / RADIUS for speed, share in shares.items())
    least = drive.transition(state, HOT)
    return {
        COLD_FAST: drive.whole(state, FAST, use.cold),
        HOT_SLOW: torque[use.slow],
        STICK_FULL: least,
        STICK_SLOW: least,
        CONTINUOUS: np.sqrt(sum(share * torque[speed] ** 2 for speed, share in shares.items())),
        ENERGY: power * TRAVEL / sum(share * speed for speed, share in shares.items()),
        STARVATION: drive.flooded(state, FAST, HOT) / (drive.layer * state.layer),
    }


def film_ratio(drive: Drive, state: State) -> Array:
    """Return film over flooded film, hot and fast."""
    return drive.starved(drive.layer * state.layer / drive.flooded(state, FAST, HOT))


def first_crossing(ages: Array, values: Array, limit: float) -> Array:
    """Return the first age at which each row reaches the limit, inf if it never does."""
    over = values >= limit
    at = over.argmax(1)
    rows = np.arange(len(values))
    before = np.maximum(at - 1, 0)
    low, high = np.log(values[rows, before]), np.log(values[rows, at])
    part = np.where(high > low, (np.log(limit) - low) / np.where(high > low, high - low, 1), 1.0)
    age = ages[before] + np.clip(part, 0, 1) * (ages[at] - ages[before])
    return np.where(over.any(1), np.where(at == 0, ages[0], age), np.inf)


def failure_ages(drive: Drive, use: Use, state: State, ages: Array) -> dict[str, Array]:
    """Return the age at which each mode happens to each specimen."""
    values = indicators(drive, use, state)
    values[STARVATION] = STARVED / film_ratio(drive, state)
    limits = use.limits(drive.film != "flooded")
    return {name: first_crossing(ages, values[name], limit) for name, limit in limits.items()}
