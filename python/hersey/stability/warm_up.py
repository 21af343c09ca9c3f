"""The warm-up: slow until warm. The quickest course of drive speed whose drag stays below a limit.

A cold film is thick and drags. At each film temperature the drive may go at the target, or at the greatest
speed below it at which drag keeps the limit, on the branch that slides. Speed and temperatures make each
other: they are found in rounds, each a motion of the core with temperature as a state (`HeatBalance`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, UnfinishedError
from hersey.motion.belt import BeltDrag, Drivetrain, Train, belt_of
from hersey.motion.drag import AnyDrag
from hersey.motion.heat import HeatBalance
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import simulate
from hersey.motion.trajectory import Trajectory
from hersey.schema.warning import Warning
from hersey.stability.hysteresis import hysteresis
from hersey.stability.warm_up_result import WarmUp
from hersey.units import takes_si

#: Points of a course.
_POINTS = 501
#: Rounds at the most.
_ROUNDS = 50
#: Temperature to which two rounds agree, K.
_ALIKE = 0.1
#: Between these temperatures the allowed speed is interpolated, K.
_STEP = 0.5
#: Between these the fold is, which takes longer, K.
_FOLD_STEP = 10.0
#: The course goes on beyond its estimated end by this share.
_BEYOND = 1.1
#: And by so many laps of the free belt.
_LAPS = 20
#: Samples of a motion for each point of the course.
_FINER = 4
#: Modes in which the belt does not slide.
_HELD = ("stuck", "microslip")


@takes_si(target_speed="belt speed", force_limit="force", acceleration="acceleration", longest="time")
def warm_up(
    train: Train,
    drag: BeltDrag,
    heat: HeatBalance,
    *,
    target_speed: float,
    force_limit: float,
    acceleration: float,
    margin: float = 0.1,
    longest: float = 1800.0,
) -> WarmUp:
    """Return the fastest profile of drive speed that keeps drag, including no-load torque, below a limit.

    The drive stands while the allowed speed is so low that a belt started from rest would stick (below V* of
    `hysteresis`, or below the transition speed if V* is above the target). Once it runs, it stops only below
    the transition speed.

    Parameters
    ----------
    drag
        Drag law that depends on temperature.
    heat
        Heat balance with the temperatures of the cold start.
    target_speed
        m/s.
    force_limit
        Force limit, N: the smallest of grip, motor torque over roll radius, and the force that the spring
        withstands.
    acceleration
        Acceleration of the drive, m/s^2, up and down.
    margin
        Share of the limit kept in reserve, because the motion itself also needs force.
    longest
        Time simulated if the target is not reached earlier, s.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name, or the drag does not depend on temperature.
    UnfinishedError
        If speed and temperature do not converge, or a motion cannot be finished.

    Examples
    --------
    >>> from hersey import Drag
    >>> drag = Drag(
    ...     50, 0.01, -0.7, -1.2, 3e-4, reference_temperature=400.0, force_temperature_exponent=-4.0
    ... )
    >>> heat = HeatBalance(150, 250, 12, 300.0, 300.0, 300.0, heater_power=900.0, setpoint=450.0)
    >>> warm = warm_up(
    ...     Drivetrain(11e3, 11), drag, heat, target_speed=0.12, force_limit=180, acceleration=0.5
    ... )
    >>> warm.found, warm.drag_at_once > 180, warm.full_speed < warm.full_speed_standing
    (True, True, True)
    """
    _check(
        margin, target_speed=target_speed, force_limit=force_limit, acceleration=acceleration, longest=longest
    )
    train, drag, _ = belt_of(train, drag, heat, target_speed=target_speed)
    rule = _Rule(train, drag, target_speed, force_limit * (1.0 - margin))
    motion = partial(_motion, train, drag, heat)
    resting = motion(0.0, longest)
    end = min(longest, _estimated_end(rule, resting, 2.0 * target_speed / acceleration))
    time = np.linspace(0.0, end, _POINTS)
    still = _film(motion(0.0, end))
    speed, run, rounds = _agreed(rule, motion, time, still, acceleration)
    standing = np.where(rule.allowed(still) >= target_speed, target_speed, 0.0)
    drag_at_once, within = _at_once(train, drag, heat, target_speed, force_limit, end)
    result = WarmUp(
        target_speed=float(target_speed),
        force_limit=float(force_limit),
        margin=float(margin),
        acceleration=float(acceleration),
        **_found(train, drag, time, speed, run),
        full_speed=_full(time, speed, target_speed),
        drag_at_once=drag_at_once,
        within_at_once=within,
        full_speed_standing=_full(time, _ramped(standing, acceleration * float(time[1])), target_speed),
        rounds=rounds,
        warnings=(),
    )
    return replace(result, warnings=tuple(_warnings(result, rule, resting)))


def _check(margin: float, **positive: float) -> None:
    for name, value in positive.items():
        if not 0 < value < math.inf:
            raise ParameterError(f"{name} is {value:g}: it must be greater than 0, and finite")
    if not 0 <= margin < 1:
        raise ParameterError(f"margin is {margin:g}: it must be a share of the limit, from 0 to below 1")


def _estimated_end(rule: _Rule, resting: Trajectory, ramps: float) -> float:
    """When a course is over by an estimate, s; ``ramps`` up and down take so long."""
    warm = np.flatnonzero(rule.allowed(_film(resting)) >= rule.target)
    if not warm.size:
        return math.inf
    return float(_BEYOND * resting.time[_FINER * warm[0]] + ramps + _LAPS * rule.train.free_period)


def _motion(
    train: Drivetrain, drag: AnyDrag, heat: HeatBalance, speed: float | Schedule, duration: float
) -> Trajectory:
    count = _FINER * (_POINTS - 1) + 1
    return simulate(train, drag, drive_speed=speed, temperature=heat, duration=duration, samples=count)


def _agreed(
    rule: _Rule,
    motion: Callable[[float | Schedule, float], Trajectory],
    time: FloatArray,
    film: FloatArray,
    acceleration: float,
) -> tuple[FloatArray, Trajectory, int]:
    """The course and its motion, once their temperatures agree, and the rounds that took."""
    for rounds in range(1, _ROUNDS + 1):
        speed = _ramped(rule.course(film), acceleration * float(time[1]))
        run = motion(Schedule(time, speed), float(time[-1]))
        off = float(np.max(np.abs(_film(run) - film)))
        film = _film(run)
        if off < _ALIKE:
            return speed, run, rounds
    raise UnfinishedError(
        f"speed and temperature do not agree after {rounds} iterations; they differ by {off:.2g} K. "
        "Give a lower target, or a larger heat capacity",
        quantity="temperature",
        value=off,
        unit="K",
    )


def _found(
    train: Drivetrain, drag: AnyDrag, time: FloatArray, speed: FloatArray, run: Trajectory
) -> dict[str, Any]:
    """What a `WarmUp` has of its course and of the motion along it."""
    running = speed > 0
    peak = float(np.max(np.abs(run.spring_force)))
    return {
        "time": time,
        "drive_speed": speed,
        "film_temperature": _film(run),
        "roll_temperature": _of(run.roll_temperature),
        "drag": _steady(drag, speed, _film(run)),
        "start": float(time[max(int(np.argmax(running)) - 1, 0)]) if running.any() else math.inf,
        "slides_from": _slides_from(run) if running.any() else math.inf,
        "peak_force": max([peak, *(train.stiffness * abs(event.stretch) for event in run.events)]),
        "response": run,
    }


class _Rule:
    """Which drive speed is allowed at which film temperature."""

    def __init__(self, train: Drivetrain, drag: AnyDrag, target: float, limit: float) -> None:
        self.train, self.drag, self.target, self.limit = train, drag, target, limit
        zero = drag.temperature_zero
        self._transition = _Between(self._transition_at, _STEP, zero)
        self._allowed = _Between(self._allowed_at, _STEP, zero)
        self._fold = _Between(self._fold_at, _FOLD_STEP, zero)

    def allowed(self, film: FloatArray) -> FloatArray:
        """The target, or the greatest speed below it that keeps the limit; 0 if none slides so."""
        speeds = np.array([self._allowed(kelvin) for kelvin in film.tolist()])
        return np.where(speeds > self.transition(film), speeds, 0.0)

    def transition(self, film: FloatArray) -> FloatArray:
        return np.array([self._transition(kelvin) for kelvin in film.tolist()])

    def course(self, film: FloatArray) -> FloatArray:
        """The speed to drive at along a course of film temperatures: 0 where the drive stands."""
        speeds, running = self.allowed(film), False
        for i, (speed, kelvin) in enumerate(zip(speeds.tolist(), film.tolist(), strict=True)):
            if speed == 0:
                running = False
            elif not running:
                fold = self._fold(kelvin)
                running = fold > self.target or speed >= fold
            speeds[i] = speed if running else 0.0
        return speeds

    def _transition_at(self, kelvin: float) -> float:
        return self.drag.law_at(kelvin).transition_speed

    def _allowed_at(self, kelvin: float) -> float:
        law = self.drag.law_at(kelvin)
        speed = min(self.target, law.speeds_of(self.limit).faster)
        return speed if law.force(np.array([speed]))[0] <= self.limit * (1.0 + 1e-9) else 0.0

    def _fold_at(self, kelvin: float) -> float:
        return hysteresis(self.train, self.drag, temperature=kelvin, sensitivity=False).upper


class _Between:
    """A function of temperature, computed at whole steps where it is asked for, straight lines between.

    It has no value at ``zero`` and below, so the first step above it has no line.
    """

    def __init__(self, function: Callable[[float], float], step: float, zero: float) -> None:
        self._function, self._step, self._zero = function, step, zero
        self._known: dict[int, float] = {}

    def __call__(self, kelvin: float) -> float:
        below = math.floor(kelvin / self._step)
        if below * self._step <= self._zero:
            return self._function(kelvin)
        low, high = self._at(below), self._at(below + 1)
        share = kelvin / self._step - below
        return low + share * (high - low) if share > 0 and math.isfinite(low + high) else low

    def _at(self, number: int) -> float:
        if number not in self._known:
            self._known[number] = self._function(number * self._step)
        return self._known[number]


def _ramped(speed: FloatArray, rise: float) -> FloatArray:
    """The greatest speeds up to those given that start from 0 and change by no more from point to point."""
    out = speed.copy()
    out[0] = 0.0
    for i in range(1, out.size):
        out[i] = min(out[i], out[i - 1] + rise)
    for i in range(out.size - 2, -1, -1):
        out[i] = min(out[i], out[i + 1] + rise)
    return out


def _at_once(
    train: Drivetrain, drag: AnyDrag, heat: HeatBalance, target: float, limit: float, end: float
) -> tuple[float, float]:
    """Drag at full speed from the start on, and from when on it keeps the limit; the roll never slips."""
    run = simulate(
        replace(train, grip=None),
        drag,
        drive_speed=target,
        temperature=heat,
        duration=end,
        samples=_POINTS,
        start="steady",
    )
    force = _steady(drag, np.full(_POINTS, target), _of(run.film_temperature, 1))
    above = np.flatnonzero(force > limit)
    if above.size == 0:
        return float(force.max()), 0.0
    last = int(above[-1])
    return float(force.max()), float(run.time[last + 1]) if last + 1 < _POINTS else math.inf


def _steady(drag: AnyDrag, speed: FloatArray, film: FloatArray) -> FloatArray:
    """Drag of sliding steadily at each speed and temperature, NaN at standstill."""
    force = np.full(speed.size, np.nan)
    for i in np.flatnonzero(speed > 0).tolist():
        force[i] = drag.law_at(float(film[i])).force(speed[i : i + 1])[0]
    return force


def _film(run: Trajectory) -> FloatArray:
    return _of(run.film_temperature)


def _of(body: FloatArray | None, every: int = _FINER) -> FloatArray:
    assert body is not None  # temperature is a state of every motion here
    return np.ascontiguousarray(body[::every])


def _full(time: FloatArray, speed: FloatArray, target: float) -> float:
    """From when on the speed is the target to the end."""
    below = np.flatnonzero(speed < target * (1.0 - 1e-12))
    return float(time[below[-1] + 1]) if below[-1] + 1 < time.size else math.inf


def _slides_from(run: Trajectory) -> float:
    """When the belt last began to slide with the roll; infinite if it is held, or slips, at the end."""
    if str(run.mode[-1]) in _HELD or run.slipping[-1]:
        return math.inf
    begun = [event.time for event in run.events if event.from_mode in _HELD]
    slipped = run.time[run.slipping]
    return max(0.0, *begun[-1:], *map(float, slipped[-1:]))


def _warnings(warm: WarmUp, rule: _Rule, resting: Trajectory) -> Iterator[Warning]:
    """Yield what the course does not keep, and what comes after it."""
    if warm.peak_force > warm.force_limit:
        yield Warning(
            "peak force above the limit",
            "the spring force reaches {peak_force:.4g} N while it breaks away or accelerates, "
            "above the limit of {force_limit:.4g} N; steady sliding stays below the limit",
            severity="watch",
            peak_force=warm.peak_force,
            force_limit=warm.force_limit,
        )
    if math.isfinite(warm.full_speed) and warm.slides_from > warm.full_speed:
        yield Warning(
            "slides late",
            "it slides steadily only from {slides_from:.4g} s on"
            if math.isfinite(warm.slides_from)
            else "it does not slide steadily within the time simulated",
            severity="watch",
            remedy="plan a start with plan_profile, using the temperature profile of this warm-up",
            slides_from=warm.slides_from,
        )
    film = _film(resting)
    unstable = (resting.time[::_FINER] > warm.full_speed) & (rule.transition(film) >= warm.target_speed)
    if unstable.any():
        yield Warning(
            "unstable once warmer",
            "the film keeps warming. From {temperature:.4g degC} on, the transition speed is above the "
            "target, so sliding is unstable",
            severity="watch",
            temperature=float(film[unstable][0]),
        )
