"""One drive-speed profile tried on one machine.

The profile is a wait at rest, a ramp up, a hold and a ramp down to the target. Each trial is the exact motion
of the belt, followed until a whole lap has passed without sticking and then to what the motion settles to.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.motion.heat import HeatBalance
from hersey.motion.parameters import MOST_STEPS
from hersey.motion.schedule import Schedule, ScheduleArguments

#: Significant digits of the durations and of the peak speed: what is tried is what is written.
_DIGITS = 6
#: Relative error of sums and quotients of rounded numbers.
ROUNDING = 1e-9
#: Threads over which the machines are spread; what is found does not depend on it.
_THREADS = os.cpu_count() or 1
#: Tolerance of the motions of the search, and of what is said of them.
COARSE, FINE = 1e-7, 1e-9
#: Machines that a profile is tried on, at first and in all, while so many fail as may.
_BLOCKS = (16, 80, None)
#: Laps within which a temperature changes quickly: a swing that dies out at one may not at the next.
_QUICK = 100.0
#: What is said of a spring force that reaches the limit, and of other endings of a trial.
FORCE = "force"
_WHY = {"grip_lost": FORCE, "still_sticking": "still sticking", "late": "sticks longer"}


@dataclass(frozen=True)
class Shape:
    """Wait at rest, ramp up to ``peak``, hold, ramp down to ``target``: durations in s, speeds in m/s."""

    target: float
    peak: float
    rise: float
    hold: float = 0.0
    fall: float = 0.0
    wait: float = 0.0

    def __post_init__(self) -> None:
        """Round to what a table can hold; ramps become longer, never steeper."""
        peak = self.target if self.peak <= self.target else rounded(self.peak)
        object.__setattr__(self, "peak", peak)
        object.__setattr__(self, "rise", rounded(self.rise, up=True))
        object.__setattr__(self, "hold", rounded(self.hold) if peak > self.target else 0.0)
        object.__setattr__(self, "fall", rounded(self.fall, up=True) if peak > self.target else 0.0)
        object.__setattr__(self, "wait", rounded(self.wait, up=True))

    @property
    def ramps(self) -> float:
        """Time from the end of the wait to the end of the last ramp."""
        return self.rise + self.hold + self.fall

    @property
    def end(self) -> float:
        """Time at which the last ramp ends."""
        return self.wait + self.ramps

    @property
    def acceleration(self) -> float:
        """Greatest magnitude of the slope; infinite with a jump."""
        slopes = [_slope(self.peak, self.rise)]
        if self.peak > self.target:
            slopes.append(_slope(self.peak - self.target, self.fall))
        return max(slopes)

    def schedule(self, *, waited: bool = True) -> Schedule:
        """Return drive speed against time; without the wait if ``waited`` is false."""
        return Schedule(*self.points(waited=waited))

    def points(self, *, waited: bool = True) -> tuple[list[float], list[float]]:
        """Return times and speeds, joined by straight lines."""
        start = self.wait if waited else 0.0
        times, speeds = [0.0], [0.0]
        stops = ((start, 0.0), (self.rise, self.peak), (self.hold, self.peak), (self.fall, self.target))
        at = 0.0
        for duration, speed in stops:
            at = float(f"{at + duration:.12g}")
            if (at, speed) != (times[-1], speeds[-1]):
                times.append(at)
                speeds.append(speed)
        return times, speeds


def rounded(value: float, *, up: bool = False) -> float:
    """Return a duration or speed with the digits of a table."""
    if not value > 0:
        return 0.0
    near = float(f"{value:.{_DIGITS}g}")
    if not up or near >= value * (1.0 - ROUNDING):
        return near
    unit = 10.0 ** (math.floor(math.log10(value)) - _DIGITS + 1)
    return float(f"{near + unit:.{_DIGITS}g}")


def _slope(speed: float, duration: float) -> float:
    return speed / duration if duration > 0 else math.inf


class Outcome(NamedTuple):
    """What a profile does to a machine.

    ``ready`` is the time from which the drive is at the target and the belt slides for good (s; infinite if
    never, or if a limit is broken), ``peak_force`` the greatest magnitude of the spring force up to there and
    after (N; no more than the limit; NaN if not asked for), ``why`` what went wrong.
    """

    ready: float
    peak_force: float
    why: str


@dataclass(frozen=True)
class Follow:
    """How a motion is followed: at least ``until`` a time (s), and what is not ready before ``latest`` fails.

    ``force`` says whether the greatest spring force is wanted, ``tolerance`` is that of the steps.
    """

    force: bool = False
    until: float = 0.0
    latest: float = math.inf
    tolerance: float = FINE


#: To its end, without the force.
PLAINLY = Follow()


class TemperatureProfile:
    """Temperature against time, K, or none; with ``heat`` each motion makes its own, and this is nominal."""

    def __init__(self, given: float | Schedule | None, heat: HeatBalance | None = None) -> None:
        """Take the profile as `simulate` does."""
        self.schedule = None if given is None else Schedule.of(given)
        self.heat = heat
        self._arguments: dict[tuple[float, float], ScheduleArguments] = {}

    @property
    def end(self) -> float:
        """Time after which the temperature stays, s."""
        return 0.0 if self.schedule is None else max(0.0, float(np.asarray(self.schedule.times)[-1]))

    @cached_property
    def levels(self) -> tuple[tuple[float, float], ...]:
        """Times and temperatures at the points of the profile, from time 0 on."""
        if self.schedule is None:
            return ()
        times = np.asarray(self.schedule.times, dtype=float)
        rows = zip(times.tolist(), np.asarray(self.schedule.values, dtype=float).tolist(), strict=True)
        return ((0.0, self.schedule.first), *(row for row in rows if row[0] > 0))

    def at(self, time: float) -> float | None:
        """Return the temperature at a time."""
        return None if self.schedule is None else self.schedule.at(time)

    def after(self, time: float) -> list[float | None]:
        """Return temperatures that bound those from ``time`` on."""
        if self.schedule is None:
            return [None]
        now = self.schedule.at(time)
        first = int(np.searchsorted(self._times, time, side="right"))
        return [now, *self._bounds[first]] if first < self._times.size else [now]

    @cached_property
    def _times(self) -> FloatArray:
        return np.array([at for at, _ in self.levels])

    @cached_property
    def _bounds(self) -> list[tuple[float, float]]:
        """Least and greatest temperature from each point on."""
        values = np.array([value for _, value in self.levels])[::-1]
        low, high = np.minimum.accumulate(values)[::-1], np.maximum.accumulate(values)[::-1]
        return list(zip(low.tolist(), high.tolist(), strict=True))

    def from_time(self, time: float) -> Schedule | None:
        """Return the profile with time counted from ``time``."""
        if self.schedule is None or time == 0.0:
            return self.schedule
        return Schedule(np.asarray(self.schedule.times) - time, self.schedule.values, self.schedule.smooth)

    def arguments(self, time: float, zero: float) -> ScheduleArguments | None:
        """Return what the core takes: time counted from ``time``, temperature from ``zero``."""
        if self.schedule is None:
            return None
        if (time, zero) not in self._arguments:
            if len(self._arguments) > 64:
                self._arguments.clear()
            moved = self.from_time(time)
            assert moved is not None
            self._arguments[time, zero] = moved.shifted(-zero).arguments
        return self._arguments[time, zero]


class MachineSample:
    """A drivetrain and its drag, with what does not depend on the profile kept."""

    def __init__(self, train: Drivetrain, drag: AnyDrag) -> None:
        """Take the parameters of one draw."""
        self.train, self.drag = train, drag
        self.lap = train.free_period
        self._laws: dict[float | None, tuple[float, float]] = {}
        self._belts: dict[float, _core.StartingBelt] = {}

    def at(self, temperature: float | None, target: float) -> tuple[float, float]:
        """Return transition speed and steady drag at the target speed, at a temperature."""
        if temperature not in self._laws:
            if len(self._laws) > 256:
                self._laws.clear()
            law = self.drag.law_at(temperature)
            self._laws[temperature] = (law.transition_speed, float(law.force(np.array([target]))[0]))
        return self._laws[temperature]

    def trial(
        self,
        shape: Shape,
        thermal: TemperatureProfile,
        force_limit: float = math.inf,
        *,
        force: bool = False,
        tolerance: float = FINE,
    ) -> Outcome:
        """Return what the profile does to this machine."""
        return outcomes([self], [shape], thermal, force_limit, Follow(force=force, tolerance=tolerance))[0]

    def belt(self, force_limit: float) -> _core.StartingBelt:
        """Return the machine as the core takes it: the limit of force is the grip of the roll."""
        if force_limit not in self._belts:
            train, grip = self.train, force_limit if force_limit < math.inf else None
            given = float(train.stiffness), float(train.mass), grip
            self._belts[force_limit] = _core.StartingBelt(given, self.drag.law())
        return self._belts[force_limit]

    def for_good(
        self, shape: Shape, thermal: TemperatureProfile, force_limit: float, ready: float, peak: float
    ) -> Outcome:
        """What comes after the profile: temperature goes on slowly, the belt slides along."""
        for temperature in thermal.after(shape.wait + ready):
            transition, drag = self.at(temperature, shape.target)
            if transition >= shape.target:
                return Outcome(math.inf, peak, "transition speed")
            peak = max(peak, drag)
            if drag > force_limit:
                return Outcome(math.inf, peak, FORCE)
        return Outcome(shape.wait + ready, peak, "")


def outcomes(
    machines: Sequence[MachineSample],
    shapes: Sequence[Shape],
    thermal: TemperatureProfile,
    force_limit: float = math.inf,
    how: Follow = PLAINLY,
    *,
    allowed: int | None = None,
) -> list[Outcome]:
    """Return what a profile does to each machine, in order, until more than ``allowed`` of them fail.

    Or what each profile, of one wait and target, does to one machine. It is also followed while the
    temperature changes quickly. The motion is that of a roll whose grip is the limit of force: where the
    force passes it is an event located to rounding, and up to there the roll grips, so that a grip changes
    nothing. With ``heat`` of the profile temperature is a state of each motion, from the wait on; the profile
    then tells what comes after.
    """
    if not machines or not shapes:
        return []

    def followed(some: Sequence[MachineSample], may_fail: int | None) -> list[Outcome]:
        return _followed(some, shapes, thermal, force_limit, how, may_fail)

    if allowed is None:
        return followed(machines, None)
    found: list[Outcome] = []
    for block in _BLOCKS:  # most profiles fail on the first few machines: the others are not handed over
        some = machines[len(found) : block]
        found += followed(some, allowed - sum(each.ready == math.inf for each in found)) if some else []
        if sum(each.ready == math.inf for each in found) > allowed:
            break
    return found


def _followed(
    machines: Sequence[MachineSample],
    shapes: Sequence[Shape],
    thermal: TemperatureProfile,
    force_limit: float,
    how: Follow,
    allowed: int | None,
) -> list[Outcome]:
    """What the core says of these machines, and what comes after the profile."""
    zero, heat, until = machines[0].drag.temperature_zero, thermal.heat, how.until
    begin = 0.0 if heat is not None else shapes[0].wait
    if thermal.end <= _QUICK * machines[0].lap:
        until = max(until, thermal.end)
    released, peaks, endings = _core.start_ups(
        [machine.belt(force_limit) for machine in machines],
        [
            ((*shape.points(waited=heat is not None), None), shape.ramps + shape.wait - begin)
            for shape in shapes
        ],
        None if heat is not None else thermal.arguments(begin, zero),
        None if heat is None else heat.arguments(zero),
        (shapes[0].target, until - begin, how.latest - begin),
        how.force,
        max(len(machines), len(shapes)) if allowed is None else allowed,
        how.tolerance,
        _THREADS,
        MOST_STEPS,
    )
    found = []
    for i, (at, pull, ending) in enumerate(zip(released, peaks, endings, strict=True)):
        machine, shape = machines[i % len(machines)], shapes[i % len(shapes)]
        peak = min(pull, force_limit) if how.force else math.nan
        if ending:
            found.append(Outcome(math.inf, peak, _WHY.get(ending, ending.replace("_", "-"))))
        else:
            ready = max(at + begin - shape.wait, shape.ramps)
            found.append(machine.for_good(shape, thermal, force_limit, ready, peak))
    return found
