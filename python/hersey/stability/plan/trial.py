"""One drive-speed profile tried on one machine.

The profile is a wait at rest, a ramp up, a hold and a ramp down to the target. Each trial is the exact motion
of the belt, followed until a whole lap has passed without sticking and then to what the motion settles to.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.motion.drag import AnyDrag
from hersey.motion.parameters import MOST_STEPS
from hersey.motion.schedule import Schedule, ScheduleArguments
from hersey.motion.simulation import Drivetrain

#: Significant digits of the durations and of the peak speed: what is tried is what is written.
_DIGITS = 6
#: Relative error of sums and quotients of rounded numbers.
ROUNDING = 1e-9
#: Laps followed after the last ramp at first, laps without sticking that end the trial, doublings at most.
_WATCH, _CALM, _DOUBLINGS = 3.0, 1.5, 6
#: Samples per lap from which the greatest spring force is found, cubics between them.
_PER_LAP = 24
#: Modes in which the belt does not slide.
_HELD = ("stuck", "microslip")
#: The event of a spring force that reaches the limit, and what is said of it.
_GRIP_LOST, FORCE = "grip_lost", "force"


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
    unit = 10.0 ** (math.floor(math.log10(value)) - _DIGITS + 1)
    count = math.ceil(value / unit * (1.0 - ROUNDING)) if up else round(value / unit)
    near = float(f"{count * unit:.{_DIGITS}g}")
    enough = not up or near >= value * (1.0 - ROUNDING)
    return near if enough else float(f"{(count + 1) * unit:.{_DIGITS}g}")


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


class TemperatureProfile:
    """Temperature against time, K, or none."""

    def __init__(self, given: float | Schedule | None) -> None:
        """Take the profile as `simulate` does."""
        self.schedule = None if given is None else Schedule.of(given)
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
        self.lap = 2.0 * math.pi * math.sqrt(train.mass / train.stiffness)
        self._law = drag.law()
        self._laws: dict[float | None, tuple[float, float]] = {}

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
        until: float = 0.0,
        tolerance: float = 1e-9,
    ) -> Outcome:
        """Return what the profile does to this machine; followed at least ``until`` that time.

        The motion is that of a roll whose grip is the limit of force: where the force passes it is an event
        located to rounding, and up to there the roll grips, so that a grip changes nothing.
        """
        drive = shape.points(waited=False)
        train = self._train(force_limit)
        watch = _WATCH * self.lap
        peak = math.nan
        for _ in range(_DOUBLINGS):
            duration = max(shape.ramps + watch, until - shape.wait)
            samples = math.ceil(duration / self.lap * _PER_LAP) + 1 if force else 2
            run = _core.simulate(
                train,
                self._law,
                ("speed", (*drive, None)),
                thermal.arguments(shape.wait, self.drag.temperature_zero),
                (0.0, 0.0),
                duration,
                samples,
                tolerance,
                "adaptive",
                MOST_STEPS,
            )
            if force:
                turned = greatest_stretch(run.time, run.belt_speed, run.stretch, drive)
                at_events = (abs(stretch) for stretch in run.events.stretch)
                peak = min(self.train.stiffness * max(turned, *at_events, 0.0), force_limit)
            if _GRIP_LOST in run.events.guard:
                return Outcome(math.inf, peak, FORCE)
            state = float(run.belt_speed[-1]), float(run.stretch[-1])
            kind = self._settled(train, thermal.at(shape.wait + duration), shape.target, state, tolerance)
            if kind != "steady_sliding":
                return Outcome(math.inf, peak, kind.replace("_", "-"))
            released, held = _last_held(run.events)
            if not held and duration - released >= _CALM * self.lap:
                return self._for_good(shape, thermal, force_limit, max(released, shape.ramps), peak)
            watch *= 2.0
        return Outcome(math.inf, peak, "still sticking")

    def _train(self, force_limit: float) -> tuple[float, float, float | None]:
        grip = force_limit if force_limit < math.inf else None
        return float(self.train.stiffness), float(self.train.mass), grip

    def _settled(
        self,
        train: tuple[float, float, float | None],
        temperature: float | None,
        target: float,
        state: tuple[float, float],
        tolerance: float,
    ) -> str:
        """What the motion settles to from a state, temperature held."""
        zero = self.drag.temperature_zero
        law = self._law if temperature is None else self._law.at(temperature - zero)
        return _core.stick_slip(train, law, target, state, None, tolerance, MOST_STEPS).kind

    def _for_good(
        self,
        shape: Shape,
        thermal: TemperatureProfile,
        force_limit: float,
        ready: float,
        peak: float,
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


def _last_held(events: _core.Events) -> tuple[float, bool]:
    """When the belt last began to slide, and whether it is held at the end."""
    if not events.time or events.to_mode[-1] in _HELD:
        return math.inf, True
    begun = zip(reversed(events.time), reversed(events.from_mode), strict=True)
    return next((time for time, mode in begun if mode in _HELD), 0.0), False


def greatest_stretch(
    time: FloatArray, speed: FloatArray, stretch: FloatArray, drive: tuple[list[float], list[float]]
) -> float:
    """Return the greatest magnitude of the stretch, from samples and the cubics between them."""
    step = float(time[1] - time[0])
    rate = np.interp(time, *drive) - speed
    best = float(np.abs(stretch).max())
    for i in np.flatnonzero(rate[:-1] * rate[1:] < 0).tolist():
        rows = stretch[i], stretch[i + 1], rate[i] * step, rate[i + 1] * step
        best = max(best, abs(_turning_value(*map(float, rows))))
    return best


def _turning_value(low: float, high: float, low_slope: float, high_slope: float) -> float:
    """Value of the cubic of given ends and slopes on [0, 1] where its slope changes sign."""
    a = low_slope + high_slope - 2.0 * (high - low)
    b = 3.0 * (high - low) - 2.0 * low_slope - high_slope
    q = -(b + math.copysign(math.sqrt(max(b * b - 3.0 * a * low_slope, 0.0)), b))
    for x in (q / (3.0 * a) if a else math.nan, low_slope / q if q else math.nan):
        if 0.0 <= x <= 1.0:
            return low + x * (low_slope + x * (b + x * a))
    return max(low, high, key=abs)
