"""Why there is no profile: the limit that forbids it, and the number that would do."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from hersey.errors import ParameterError, sentence
from hersey.machine.limits import Limits
from hersey.result import Means, Record
from hersey.stability.plan.draws import Trials
from hersey.stability.plan.grid import Room
from hersey.stability.plan.probing import PROBES, least, slower
from hersey.stability.plan.search import Search
from hersey.stability.plan.trial import MachineSample, Shape

#: Profiles tried for the force that would do, where the force allowed does not even start the belt.
_FEW_PROBES = 500
#: Digits of the number that would do, rounded up.
_DIGITS = 3
#: Names and units of the limits, as people read them.
_NAMES = {
    "speed": ("drive speed", "m/s"),
    "acceleration": ("acceleration", "m/s^2"),
    "spring_force": ("spring force", "N"),
    "motor_torque": ("motor torque", "N m"),
    "grip": ("grip", "N"),
    "target_speed": ("target speed", "m/s"),
}
#: What is said of a draw that needs more than a limit of force.
_BROKEN = {
    "spring_force": "the spring force exceeds its limit",
    "motor_torque": "the motor torque is not sufficient",
    "grip": "the drive slips",
}


@dataclass(frozen=True)
class Obstacle(Record):
    """A limit that forbids every profile."""

    limit: Annotated[
        str,
        Means(
            "speed, acceleration, spring_force, motor_torque, grip, target_speed, several, uncertainty, "
            "temperature or confidence"
        ),
    ]
    given: Annotated[
        float,
        Means(
            "its value, SI; null for several and uncertainty; for temperature what remained between two "
            "iterations, K, or the share that works at its own temperatures",
            open=True,
        ),
    ]
    needed: Annotated[
        float | None,
        Means("value that would do if no other changed, SI, or null; for confidence the share that works"),
    ]
    text: str

    def __post_init__(self) -> None:
        """Finish the text as sentences."""
        object.__setattr__(self, "text", sentence(self.text))


@dataclass(frozen=True)
class Reach:
    """The limits as the search takes them; ``forces`` holds the spring force (N) each stands for, by name.

    The factor of a limit leads from the spring force to its own unit.
    """

    speed: float
    acceleration: float
    forces: Mapping[str, float]
    factors: Mapping[str, float]

    @classmethod
    def of(cls, limits: Limits, roll_radius: float | None, grip: float | None = None) -> Reach:
        """Return the reach of a drive; the torque acts at ``roll_radius`` (m), ``grip`` (N) is the roll's."""
        factors = {"spring_force": 1.0, "grip": 1.0}
        given = {"spring_force": limits.spring_force, "grip": limits.grip if grip is None else grip}
        if limits.motor_torque is not None:
            if roll_radius is None or not (math.isfinite(roll_radius) and roll_radius > 0):
                raise ParameterError("the motor_torque limit needs a roll_radius greater than 0")
            factors["motor_torque"] = roll_radius
            given["motor_torque"] = limits.motor_torque / roll_radius
        forces = {name: value for name, value in given.items() if value is not None}
        return cls(limits.speed or math.inf, limits.acceleration or math.inf, forces, factors)

    @property
    def force(self) -> float:
        """The least of the forces, infinite without a limit."""
        return min(self.forces.values(), default=math.inf)

    @property
    def broken(self) -> str:
        """What happens where the spring force exceeds them: the least of them binds."""
        return _BROKEN[min(self.forces, key=self.forces.__getitem__)]

    def uses(self, shape: Shape, force: float) -> list[tuple[str, float, float]]:
        """Return name, limit and use of every limit that is given."""
        rows = [("speed", self.speed, shape.peak), ("acceleration", self.acceleration, shape.acceleration)]
        rows += [(n, f * self.factors[n], force * self.factors[n]) for n, f in self.forces.items()]
        return [row for row in rows if row[1] < math.inf]


def obstacles(
    search: Search, limits: Limits, reach: Reach, greatest: float, *, searched: bool
) -> tuple[Obstacle, ...]:
    """Return what forbids every profile; before the search only what is certain without it.

    Without a limit of speed, peak speeds up to ``greatest`` (m/s) are sought.
    """
    trials, target = search.trials, search.target
    if limits.speed is not None and limits.speed < target:
        return (_obstacle("speed", limits.speed, target),)
    lowest = _lowest_target(trials, target)
    if lowest >= target:
        fixed = search.thermal.schedule is None
        where = "" if fixed else " at the final temperature of the profile"
        text = (
            f"the target speed {speed_text(target)} is not above the transition speed "
            f"{speed_text(lowest)}{where}, so steady sliding is unstable there; choose a higher target"
        )
        return (Obstacle("target_speed", target, _up(lowest * 1.01), text),)
    if not searched and _least_force(trials, target) <= reach.force:
        return ()
    reasons = [*_of_force(search, reach), *(_of_room(search, reach, greatest) if searched else [])]
    return tuple(reasons) or (_together(search, limits),)


def _lowest_target(trials: Trials, target: float) -> float:
    """The transition speed where temperature ends that all but the allowed machines keep below."""
    end = trials.thermal.at(trials.thermal.end)
    return trials.kept([machine.at(end, target)[0] for machine in trials.machines])


def _least_force(trials: Trials, target: float) -> float:
    """The force without which the belt neither breaks away nor slides where temperature ends."""
    thermal = trials.thermal
    sliding = [machine.at(thermal.at(thermal.end), target)[1] for machine in trials.machines]
    return max(_starting_force(trials), trials.kept(sliding))


def _starting_force(trials: Trials) -> float:
    """The force without which the belt does not break away at any time."""
    thermal, spread = trials.thermal, trials.machines
    times = np.linspace(0.0, thermal.end, 50).tolist() if thermal.schedule is not None else [0.0]
    sample = spread[:: max(1, len(spread) // 100)] if len(times) > 1 else spread
    off = [min(_holding(m, thermal.at(t)) for t in times) for m in sample]
    share = min(trials.allowed * len(sample) // len(spread) + 1, len(off))
    return sorted(off)[-share]


def _holding(machine: MachineSample, temperature: float | None) -> float:
    return machine.drag.law_at(temperature).holding_force


def _of_force(search: Search, reach: Reach) -> list[Obstacle]:
    """Obstacles of force, if a profile works without any limit of force."""
    if not reach.forces:
        return []
    starting = _starting_force(search.trials)
    free = _relaxed(search, search.room, math.inf)
    probes = _FEW_PROBES if starting > reach.force else PROBES
    easiest = least(free, probes=probes)
    if easiest is None:
        return [
            _not_started(n, limit, starting, reach) for n, limit in reach.forces.items() if starting > limit
        ]
    force = free.trials.peak(easiest[1])
    short = {name: limit for name, limit in reach.forces.items() if limit < force}
    return [
        _obstacle(name, limit * reach.factors[name], force * reach.factors[name], held=starting > limit)
        for name, limit in short.items()
    ]


def _not_started(name: str, limit: float, starting: float, reach: Reach) -> Obstacle:
    """The obstacle of a force that does not start the belt, where no force would leave a profile."""
    (label, unit), factor = _NAMES[name], reach.factors[name]
    enough, given = (_written(value * factor, unit) for value in (_up(starting), limit))
    text = f"the {label} of {given} cannot start it, since it needs {enough} to break away"
    return Obstacle(name, limit * factor, None, text)


def _of_room(search: Search, reach: Reach, greatest: float) -> list[Obstacle]:
    """Obstacles of speed and of acceleration, each if a profile works without it."""
    reasons = []
    if reach.speed < math.inf:
        free = _relaxed(
            search, replace(search.room, speed=max(greatest, reach.speed)), search.trials.force_limit
        )
        easiest = least(free, lambda shape: shape.peak)
        if easiest is not None and (peak := slower(free, easiest[1]).peak) > reach.speed:
            reasons.append(_obstacle("speed", reach.speed, peak))
    if reach.acceleration < math.inf:
        free = _relaxed(search, replace(search.room, acceleration=math.inf), search.trials.force_limit)
        easiest = least(free, lambda shape: shape.acceleration)
        if easiest is not None and reach.acceleration < easiest[0] < math.inf:
            reasons.append(_obstacle("acceleration", reach.acceleration, easiest[0]))
    return reasons


def _relaxed(search: Search, room: Room, force: float) -> Search:
    trials = Trials(search.trials.machines, search.trials.allowed, search.thermal, force)
    nominal, thermal, target = search.nominal, search.thermal, search.target
    return Search(nominal, trials, thermal, target, room, seed=search.seed, progress=search.progress)


def _obstacle(name: str, given: float, needed: float, *, held: bool = False) -> Obstacle:
    """The obstacle of a limit; ``held``: it does not even start the belt."""
    label, unit = _NAMES[name]
    enough = _up(needed)
    would_do, limit = (_written(value, unit) for value in (enough, given))
    text = f"the {label} is limited to {limit}, but {would_do} would be enough"
    if held and name != "spring_force":
        text = f"the {label} of {limit} cannot start it; {would_do} is needed"
    return Obstacle(name, given, enough, text)


def speed_text(value: float) -> str:
    """Return a speed as people write it."""
    return _written(value, "m/s")


def _written(value: float, unit: str) -> str:
    if unit.startswith("m/s") and abs(value) < 1.0:
        return f"{1e3 * value:.4g} m{unit}"
    return f"{value:.4g} {unit}"


def _together(search: Search, limits: Limits) -> Obstacle:
    stated = {**vars(limits), "grip": limits.grip}
    given = [_NAMES[name][0] for name, value in stated.items() if value is not None and name in _NAMES]
    if given:
        text = f"no single limit prevents it; relax several of {', '.join(given)} together"
        return Obstacle("several", math.nan, None, text)
    text = (
        f"no profile up to {search.room.speed:.4g} m/s works for enough draws; determine the parameters "
        "better, or accept a lower confidence"
    )
    return Obstacle("uncertainty", math.nan, None, text)


def _up(value: float) -> float:
    unit = 10.0 ** (math.floor(math.log10(value)) - _DIGITS + 1)
    return float(f"{math.ceil(value / unit * (1.0 - 1e-9)) * unit:.{_DIGITS}g}")
