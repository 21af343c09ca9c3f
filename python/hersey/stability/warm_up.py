"""The warm-up: slow until warm. The quickest course of drive speed whose drag stays below a limit.

A cold film is thick and drags. At each film temperature the drive may go at the target, or at the greatest
speed below it at which drag keeps the limit, on the branch that slides. Speed and temperatures make each
other: they are found in rounds, each a motion of the core with temperature as a state (`HeatBalance`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, UnfinishedError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.motion.heat import HeatBalance
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import Trajectory, simulate
from hersey.result import Means, Result
from hersey.stability.hysteresis import hysteresis
from hersey.units import celsius, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Points of a course; rounds at the most, and the temperature to which two of them agree, K.
_POINTS, _ROUNDS, _ALIKE = 501, 50, 0.1
#: Between these temperatures speeds are interpolated, K: the allowed one, and the fold, which takes longer.
_STEP, _FOLD_STEP = 0.5, 10.0
#: The course goes on beyond its estimated end by this share, and by these laps of the free belt.
_BEYOND, _LAPS = 1.1, 20
#: Samples of a motion for each point of the course, and points of the temperature profile for a plan.
_FINER, _OF_PROFILE = 4, 101
#: Modes in which the belt does not slide.
_HELD = ("stuck", "microslip")
_ROWS = 12


@dataclass(frozen=True, repr=False)
class WarmUp(Result):
    """A course of drive speed from a cold start, and the temperatures that go with it.

    Arrays have shape (points,): ``time`` (s), ``drive_speed`` (m/s; straight lines join the points),
    ``film_temperature`` and ``roll_temperature`` (K), and ``drag`` (N), that of steady sliding at each
    moment, NaN while the drive stands. ``force_limit`` (N) is kept with a ``margin``, a share of it, to
    spare. The drive starts at ``start`` (s) and is at ``target_speed`` (m/s) from ``full_speed`` (s) on,
    infinite if not within the time looked at. In the motion, ``response``, the belt slides for good from
    ``slides_from`` (s) on, and ``peak_force`` (N) is the greatest spring force.

    Beside it: at full speed from the start on drag begins with ``drag_at_once`` (N) and keeps ``force_limit``
    from ``within_at_once`` (s) on; standing until the film is warm enough for the target brings full speed at
    ``full_speed_standing`` (s). ``rounds`` were needed.
    """

    also_stated = ("verdict", "beside")
    not_stated = ("response",)

    target_speed: float
    force_limit: float
    margin: Annotated[float, Means("share of the limit kept to spare")]
    acceleration: Annotated[float, Means(unit="m/s^2")]
    time: FloatArray
    drive_speed: Annotated[FloatArray, Means("straight lines between", shape="(n,)")]
    film_temperature: FloatArray
    roll_temperature: FloatArray
    drag: Annotated[FloatArray, Means("of sliding steadily; null at standstill", shape="(n,)", open=True)]
    start: Annotated[float, Means("of the drive; null if it cannot start", open=True)]
    full_speed: Annotated[float, Means("from when on; null if not within the time looked at", open=True)]
    slides_from: Annotated[float, Means("from when on the belt slides for good; null if never", open=True)]
    peak_force: Annotated[float, Means("of the spring, in the motion")]
    drag_at_once: Annotated[float, Means("greatest, at full speed from the start on")]
    within_at_once: Annotated[float, Means("when that keeps the limit; null if not in time", open=True)]
    full_speed_standing: Annotated[float, Means("by standing until warm; null if not in time", open=True)]
    rounds: int
    warnings: tuple[str, ...]
    response: Trajectory

    @property
    def found(self) -> bool:
        """Whether full speed is reached, and the belt slides."""
        return math.isfinite(max(self.full_speed, self.slides_from))

    @property
    def schedule(self) -> Schedule:
        """Drive speed against time, m/s."""
        return Schedule(self.time, self.drive_speed)

    @property
    def profile(self) -> Schedule:
        """Film temperature against time, K, thinned: the ``temperature`` of `plan_profile`."""
        kept = np.unique(np.linspace(0, self.time.size - 1, _OF_PROFILE).round().astype(int))
        return Schedule(self.time[kept], self.film_temperature[kept])

    def verdict(self) -> str:
        """Return the course in a sentence or two."""
        end = _warmth(self, -1)
        target = _speed(self.target_speed)
        if not math.isfinite(self.start):
            return (
                f"The drive cannot start within {self.time[-1]:.4g} s: at the {end} reached by then no speed "
                f"up to {target} slides with less than {self.kept_below:.4g} N."
            )
        first = "Start at once" if self.start == 0 else f"Stand for {self.start:.4g} s, then start"
        if not math.isfinite(self.full_speed):
            last = _speed(float(self.drive_speed[-1]))
            return f"{first}; {target} is not reached within {self.time[-1]:.4g} s: {last} at {end}."
        at = int(np.searchsorted(self.time, self.full_speed))
        sliding = "" if math.isfinite(self.slides_from) else " The belt sticks at it."
        how = "" if self.full_speed - self.start <= self._least_ramp else ", slow until warm"
        when = f"full speed {target} after {self.full_speed:.4g} s, at {_warmth(self, at)}"
        return f"{first}{how}: {when}.{sliding}"

    @property
    def kept_below(self) -> float:
        """The limit less the margin, N."""
        return self.force_limit * (1.0 - self.margin)

    @property
    def _least_ramp(self) -> float:
        """Time that the acceleration alone takes, and the points of the course make of it, s."""
        return self.target_speed / self.acceleration + 2.0 * float(self.time[1])

    def beside(self) -> list[str]:
        """Return what the two other ways would do, a sentence each."""
        times = self.drag_at_once / self.force_limit
        if not math.isfinite(self.within_at_once):
            until = f"not below it within {self.time[-1]:.4g} s"
        else:
            until = f"below it from {self.within_at_once:.4g} s on" if self.within_at_once > 0 else "below it"
        at_once = f"Full speed at once: {self.drag_at_once:.4g} N, {times:.3g} times the limit, {until}."
        if not math.isfinite(self.full_speed_standing):
            return [at_once, f"Standing until warm: no full speed within {self.time[-1]:.4g} s."]
        return [at_once, f"Standing until warm: full speed after {self.full_speed_standing:.4g} s."]

    def table(self) -> str:
        """Return the course as CSV, which `hersey plan --temperature-profile` reads, too."""
        lines = ["time [s],drive speed [m/s],temperature [degC],roll [degC]"]
        columns = (
            self.time,
            self.drive_speed,
            celsius(self.film_temperature),
            celsius(self.roll_temperature),
        )
        lines += [",".join(f"{value:.9g}" for value in row) for row in zip(*columns, strict=True)]
        return "\n".join(lines) + "\n"

    def summary(self) -> str:
        """Return the course, what it keeps, the other ways and warnings as text."""
        limit = f"{self.force_limit:.4g} N less {100 * self.margin:.3g} %"
        lines = [self.verdict(), f"Drag stays below {self.kept_below:.4g} N ({limit}).", *self.beside(), ""]
        if not math.isfinite(self.start):
            del lines[1]
        lines.append(f"  {'time (s)':>9s}  {'drive (mm/s)':>12s}  {'film (degC)':>11s}  {'roll (degC)':>11s}")
        last = min(self.time.size - 1, int(np.searchsorted(self.time, self.full_speed)))
        for i in np.unique(np.linspace(0, last, _ROWS).round().astype(int)).tolist():
            film, roll = celsius(self.film_temperature[i]), celsius(self.roll_temperature[i])
            lines.append(
                f"  {self.time[i]:9.4g}  {1e3 * self.drive_speed[i]:12.4g}  {film:11.1f}  {roll:11.1f}"
            )
        return "\n".join([*lines, *(f"- {warning}" for warning in self.warnings)])

    def headline(self) -> str:
        """Return target and time."""
        target = f"warm-up to {_speed(self.target_speed)}"
        return f"{target}, {self.full_speed:.4g} s" if self.found else f"{target}: not reached"

    def to_frame(self) -> pl.DataFrame:
        """Return the course, a row per point."""
        import polars as pl

        return pl.DataFrame(
            {
                "time (s)": self.time,
                "drive speed (m/s)": self.drive_speed,
                "film (K)": self.film_temperature,
                "roll (K)": self.roll_temperature,
                "drag (N)": self.drag,
            }
        )


@takes_si(target_speed="belt speed", force_limit="force", acceleration="acceleration", longest="time")
def warm_up(
    train: Drivetrain,
    drag: AnyDrag,
    heat: HeatBalance,
    *,
    target_speed: float,
    force_limit: float,
    acceleration: float,
    margin: float = 0.1,
    longest: float = 1800.0,
) -> WarmUp:
    """Return the quickest course of drive speed whose steady drag, the rest included, keeps below a limit.

    The drive stands while the speed allowed lies below the speeds at which a belt that comes from rest
    sticks (V* of `hysteresis`, or the transition speed where V* is above the target), and once it runs it
    stops only below the transition speed.

    Parameters
    ----------
    drag
        A law that varies with temperature.
    heat
        With the temperatures of the cold start.
    target_speed
        m/s.
    force_limit
        N: the least of grip, motor torque over roll radius, and what the spring may bear.
    acceleration
        Of the drive, m/s^2, up and down.
    margin
        Share of the limit that is kept to spare: the limit is of drag, the motion needs some force, too.
    longest
        Time looked at, s, where the target is not reached before.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name, or the drag does not vary with temperature.
    UnfinishedError
        If speed and temperature do not come to agree, or a motion cannot be finished.

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
    for name, value in (
        ("target_speed", target_speed),
        ("force_limit", force_limit),
        ("acceleration", acceleration),
        ("longest", longest),
    ):
        if not 0 < value < math.inf:
            raise ParameterError(f"{name} is {value:g}: it must be greater than 0, and finite")
    if not 0 <= margin < 1:
        raise ParameterError(f"margin is {margin:g}: it is a share of the limit, from 0 to below 1")
    rule = _Rule(train, drag, target_speed, force_limit * (1.0 - margin))
    lap = train.free_period

    def moved(speed: float | Schedule, duration: float) -> Trajectory:
        count = _FINER * (_POINTS - 1) + 1
        return simulate(train, drag, drive_speed=speed, temperature=heat, duration=duration, samples=count)

    resting = moved(0.0, longest)
    warm = np.flatnonzero(rule.allowed(_film(resting)) >= target_speed)
    end = longest
    if warm.size:
        needed = _BEYOND * resting.time[_FINER * warm[0]] + 2.0 * target_speed / acceleration + _LAPS * lap
        end = min(longest, needed)
    time = np.linspace(0.0, end, _POINTS)
    still = moved(0.0, end)
    film, rounds = _film(still), 0
    while True:
        rounds += 1
        speed = _ramped(rule.course(film), acceleration * float(time[1]))
        run = moved(Schedule(time, speed), end)
        off = float(np.max(np.abs(_film(run) - film)))
        film = _film(run)
        if off < _ALIKE:
            break
        if rounds == _ROUNDS:
            raise UnfinishedError(
                f"speed and temperature do not agree after {rounds} rounds: they differ by {off:.2g} K. "
                "Give a smaller target, or a larger heat capacity",
                quantity="temperature",
                value=off,
                unit="K",
            )
    standing = rule.allowed(_film(still)) >= target_speed
    from_rest = _ramped(np.where(standing, target_speed, 0.0), acceleration * float(time[1]))
    drag_at_once, within = _at_once(train, drag, heat, target_speed, force_limit, end)
    running = speed > 0
    peak = float(np.max(np.abs(run.spring_force)))
    result = WarmUp(
        target_speed=float(target_speed),
        force_limit=float(force_limit),
        margin=float(margin),
        acceleration=float(acceleration),
        time=time,
        drive_speed=speed,
        film_temperature=film,
        roll_temperature=_of(run.roll_temperature),
        drag=_steady(drag, speed, film),
        start=float(time[max(int(np.argmax(running)) - 1, 0)]) if running.any() else math.inf,
        full_speed=_full(time, speed, target_speed),
        slides_from=_slides_from(run) if running.any() else math.inf,
        peak_force=max([peak, *(train.stiffness * abs(event.stretch) for event in run.events)]),
        drag_at_once=drag_at_once,
        within_at_once=within,
        full_speed_standing=_full(time, from_rest, target_speed),
        rounds=rounds,
        warnings=(),
        response=run,
    )
    return replace(result, warnings=tuple(_warnings(result, rule, resting)))


class _Rule:
    """Which drive speed is allowed at which film temperature."""

    def __init__(self, train: Drivetrain, drag: AnyDrag, target: float, limit: float) -> None:
        self.train, self.drag, self.target, self.limit = train, drag, target, limit
        self._transition = _Between(self._transition_at, _STEP)
        self._allowed = _Between(self._allowed_at, _STEP)
        self._fold = _Between(self._fold_at, _FOLD_STEP)

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
    """A function of temperature, computed at whole steps where it is asked for, straight lines between."""

    def __init__(self, function: Callable[[float], float], step: float) -> None:
        self._function, self._step = function, step
        self._known: dict[int, float] = {}

    def __call__(self, kelvin: float) -> float:
        below = math.floor(kelvin / self._step)
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


def _warnings(warm: WarmUp, rule: _Rule, resting: Trajectory) -> list[str]:
    """What the course does not keep, and what comes after it."""
    said = []
    if warm.peak_force > warm.force_limit:
        said.append(
            f"the spring takes up to {warm.peak_force:.4g} N where the belt breaks away or speeds up, more "
            f"than the limit of {warm.force_limit:.4g} N, which is kept in steady sliding"
        )
    if math.isfinite(warm.full_speed) and warm.slides_from > warm.full_speed:
        said.append(
            "the belt slides for good only "
            + (f"from {warm.slides_from:.4g} s on" if math.isfinite(warm.slides_from) else "beyond the end")
            + ": seek a start for it with plan_profile, over the temperature profile of this warm-up"
        )
    later = _film(resting)
    late = (resting.time[::_FINER] > warm.full_speed) & (rule.transition(later) >= warm.target_speed)
    if late.any():
        said.append(
            f"the film goes on warming: from {celsius(float(later[late][0])):.4g} degC on the transition "
            "speed is above the target, and sliding at it is unstable"
        )
    return said


def _warmth(warm: WarmUp, at: int) -> str:
    film, roll = celsius(warm.film_temperature[at]), celsius(warm.roll_temperature[at])
    return f"{film:.4g} degC (roll {roll:.4g} degC)"


def _speed(speed: float) -> str:
    return f"{1e3 * speed:.4g} mm/s"
