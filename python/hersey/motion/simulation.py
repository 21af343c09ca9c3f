"""Motion of the belt: names, units and results over the core's physics.

Arguments are in SI, or in any consistent set of units (the paper's baseline is in inches, ounces and
seconds). A rotor driven by a torque is the same equation (Eq. 11): inertia for mass, torsional stiffness
for stiffness, angular speed for belt speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial
from operator import attrgetter
from typing import Annotated, Any, TypedDict, Unpack

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray, refuse_unknown
from hersey.errors import HerseyError, ParameterError
from hersey.motion.belt import BeltDrag, Drivetrain, Train, belt_of
from hersey.motion.drag import AnyDrag
from hersey.motion.heat import HeatBalance
from hersey.motion.parameters import MOST_STEPS, whole
from hersey.motion.schedule import Schedule
from hersey.motion.trajectory import Energy, Event, SelfCheck, Trajectory
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Relative tolerance of the steps.
TOLERANCE = 1e-9
#: Times at which a motion is returned.
SAMPLES = 2001
#: Share of the drive speed by which a steady start is off.
NUDGE = _core.NUDGE


class Numerics(TypedDict, total=False):
    """How a motion is integrated, each by its name.

    Parameters
    ----------
    samples
        Times at which it is returned, equally spaced, both ends among them; 2001 if not given.
    tolerance
        Relative tolerance of the steps; 1e-9 if not given.
    check
        Whether it is also integrated with Dormand and Prince's Runge-Kutta pair, and the difference reported.
    most_steps
        Work that the motion may take, in steps of a microsecond or so; a step of a stiff motion, or with
        bristles, counts for 40.
    """

    samples: int
    tolerance: float
    check: bool
    most_steps: float


#: What is said of a kind in which the roll slips.
_MEANT = {
    "stalled": ": the drive slips and moves nothing",
    "grip_slip": ": the drive slips, and what it moves slides more slowly",
}


@dataclass(frozen=True, repr=False)
class StickSlipCycle(Result):
    """What the motion settles to.

    ``kind`` is one of `stick_slip`'s. Frequency is in cycles per unit of time, 0 without cycles;
    ``drag_work`` is the work against drag per cycle, ``grip_slip_duration`` the time per cycle during which
    the roll slips. With bristles, or a static force that grows at rest, the motion may repeat only after
    ``laps_per_period`` cycles; then frequency, durations and work are means over these cycles, and extremes
    those of all. So near to V* that rounding decides, some cycles may stick and others not: reported is one
    that sticks.
    With a smooth closure, which never holds the belt, the belt counts as stuck while it creeps below the
    stick speed.
    """

    also_stated = ("stuck_fraction",)

    kind: str
    frequency: Annotated[float, Means("cycles per unit of time", "Hz")]
    slip_duration: Annotated[float, Means(unit="s")]
    stick_duration: Annotated[float, Means(unit="s")]
    speed_min: Annotated[float, Means(unit="m/s")]
    speed_max: Annotated[float, Means(unit="m/s")]
    stretch_min: Annotated[float, Means(unit="m")]
    stretch_max: Annotated[float, Means(unit="m")]
    grip_slip_duration: Annotated[float, Means("per cycle", "s")]
    drag_work: Annotated[float, Means("per cycle", "J")]
    laps_per_period: int
    laps: int

    @property
    def stuck_fraction(self) -> float:
        """Share of a cycle during which the belt sticks."""
        return self.stick_duration * self.frequency

    def summary(self) -> str:
        """Return what the motion settles to as text, in the units of the arguments."""
        return "\n".join(
            [
                f"{self.kind.replace('_', ' ')}{_MEANT.get(self.kind, '')}",
                f"  frequency       {self.frequency:.6f}",
                f"  stuck fraction  {self.stuck_fraction:.6f}",
                f"  sliding speed   {self.speed_min:.6f} to {self.speed_max:.6f}",
                f"  stretch         {self.stretch_min:.6f} to {self.stretch_max:.6f}",
                f"  drag work       {self.drag_work:.6f} per cycle",
                *(
                    [f"  drive slips     {self.grip_slip_duration:.6f} per cycle"]
                    * (self.grip_slip_duration > 0)
                ),
            ]
        )

    def headline(self) -> str:
        """Return kind, frequency and stuck fraction."""
        return (
            f"{self.kind.replace('_', ' ')}, frequency {self.frequency:.6g}, stuck {self.stuck_fraction:.3g}"
        )


@takes_si(
    drive_speed="belt speed", drive_torque=("force", "torque"), temperature="temperature", duration="time"
)
def simulate(
    train: Train,
    drag: BeltDrag,
    *,
    drive_speed: float | Schedule | None = None,
    drive_torque: float | Schedule | None = None,
    temperature: float | Schedule | HeatBalance | None = None,
    duration: float,
    start: str | tuple[float, float] = "rest",
    **numerics: Unpack[Numerics],
) -> Trajectory:
    """Return the motion over ``duration``, with events located to rounding.

    Parameters
    ----------
    train, drag
        As for `stick_slip`.
    drive_speed
        Speed at the far end of the spring (Eqs. 12-16).
    drive_torque
        Alternative to ``drive_speed``: force on the mass, or torque on the rotor, which a spring holds to the
        ground (Eq. 11). Only here may the stiffness be zero.
    temperature
        Temperature, K; needed if the drag depends on it. Or a `HeatBalance`: then temperature is a state, and
        friction heats it too.
    duration
        s.
    start
        ``rest`` (belt at rest, spring slack), ``steady`` (sliding at the drive speed at time 0), or a pair of
        belt speed and stretch.
    **numerics
        Any of ``samples``, ``tolerance``, ``check`` and ``most_steps``; see `Numerics`.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name.
    UnfinishedError
        If the allowed work is exceeded, or the motion cannot be continued.

    Examples
    --------
    >>> from hersey import Drag
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> run = simulate(Drivetrain(1000, 1), drag, drive_speed=1.0, duration=1.0, check=True)
    >>> run.events[0].guard, round(run.events[0].time, 6)
    ('holding_force', 0.341401)
    >>> abs(run.energy.residual) < 1e-8, run.check.same_events
    (True, True)
    """
    known = tuple(Numerics.__annotations__)
    refuse_unknown("simulate", numerics, known, {"heat": "temperature=HeatBalance(...)"})
    samples = whole("samples", numerics.get("samples", SAMPLES), 2)
    steps = whole("most_steps", numerics.get("most_steps", MOST_STEPS))
    train, drag, temperature = belt_of(train, drag, temperature, drive_speed=drive_speed)
    check_inputs(drag, drive_speed, drive_torque, temperature)
    kind, given = ("torque", drive_torque or 0.0) if drive_speed is None else ("speed", drive_speed)
    drive = Schedule.of(given)
    law, zero = drag.law(), drag.temperature_zero
    heat = temperature if isinstance(temperature, HeatBalance) else None
    stated = temperature.film_temperature if isinstance(temperature, HeatBalance) else temperature
    film = None if stated is None else Schedule.of(stated).shifted(-zero)
    state = start_state(train, law, drive, film, start, is_torque=kind == "torque")

    def run(integrator: str) -> _core.Trajectory:
        return _core.simulate(
            train._arguments,
            law,
            (kind, drive.arguments),
            None if film is None or heat is not None else film.arguments,
            state,
            float(duration),
            samples,
            float(numerics.get("tolerance", TOLERANCE)),
            integrator,
            steps,
            None if heat is None else heat.arguments(zero),
        )

    return _trajectory(run, train.stiffness, check=bool(numerics.get("check")))


def _trajectory(run: Callable[[str], _core.Trajectory], stiffness: float, *, check: bool) -> Trajectory:
    """The motion by the usual integrator, and its check by the other if that is asked for."""
    found = run("adaptive")
    film, roll = (None, None) if found.temperature is None else found.temperature
    columns = attrgetter(*Event._fields)(found.events)
    return Trajectory(
        time=found.time,
        belt_speed=found.belt_speed,
        stretch=found.stretch,
        spring_force=stiffness * found.stretch,
        mode_index=found.mode_index,
        slipping=found.slipping,
        film_temperature=film,
        roll_temperature=roll,
        # as Event._make, of which there are hundreds
        events=tuple(map(partial(tuple.__new__, Event), zip(*columns, strict=True))),
        energy=Energy(**{field.name: getattr(found.energy, field.name) for field in fields(Energy)}),
        steps=found.steps,
        check=_self_check(lambda: run("dormand-prince"), found) if check else None,
    )


def check_inputs(drag: AnyDrag, drive_speed: Any, drive_torque: Any, temperature: Any) -> None:
    """Refuse inputs of a motion that do not go together, or that its drag does not know."""
    if (drive_speed is None) == (drive_torque is None):
        raise ParameterError("give either drive_speed or drive_torque, not both")
    if drag.varies_with_temperature and temperature is None:
        raise ParameterError("the drag depends on temperature. Give temperature")
    if temperature is not None and not drag.varies_with_temperature:
        what = "heat" if isinstance(temperature, HeatBalance) else "temperature"
        raise ParameterError(f"{what} is given, but the drag does not depend on temperature")


def _self_check(run: Callable[[], _core.Trajectory], first: _core.Trajectory) -> SelfCheck:
    name = "Dormand-Prince 5(4)"
    try:
        other = run()
    except HerseyError as error:
        unfinished = Warning("check not finished", "{error}", severity="watch", where=name, error=str(error))
        return SelfCheck(name, None, None, False, (unfinished,))
    changes = [(m.events.from_mode, m.events.to_mode, m.events.guard) for m in (first, other)]
    return SelfCheck(
        name,
        _difference(first.belt_speed, other.belt_speed),
        _difference(first.stretch, other.stretch),
        changes[0] == changes[1],
    )


def _difference(first: FloatArray, other: FloatArray) -> float:
    """The greatest difference as a share of the greatest value."""
    greatest = float(np.max(np.abs(first)))
    return float(np.max(np.abs(first - other))) / greatest if greatest > 0 else float(np.max(np.abs(other)))


@takes_si(drive_speed="belt speed", temperature="temperature")
def stick_slip(
    train: Train,
    drag: BeltDrag,
    *,
    drive_speed: float,
    temperature: float | None = None,
    start: str | tuple[float, float] = "rest",
    tolerance: float = TOLERANCE,
    most_steps: float = MOST_STEPS,
) -> StickSlipCycle:
    """Return the final motion at constant drive speed, starting from ``start``.

    Between the transition speed and the fold, both sliding and stick-slip are possible, and the start
    decides. ``steady`` starts at the drive speed minus a disturbance of 0.1 %, because no real belt can stay
    in an unstable balance; a pair is the initial belt speed and stretch. ``most_steps`` limits the work, as
    for `simulate`.

    The kinds of final motion:

    ``steady_sliding``
        The belt moves at the drive speed; the roll grips it.
    ``oscillation``
        The belt oscillates without sticking; the roll may slip on it for part of the cycle.
    ``stick_slip``
        The belt alternately sticks and slips. It is held, or with a smooth closure creeps below the stick
        speed. The roll may slip on it for part of the cycle (``grip_slip_duration``).
    ``stalled``
        The roll slips on a belt that never starts: it is held, or with a smooth closure creeps below the
        stick speed.
    ``grip_slip``
        The roll slips on a belt that slides steadily, slower than the roll but no slower than the stick
        speed, where drag equals the grip.
    ``unsettled``
        None of these was reached within the cycles or the time allowed.

    Parameters
    ----------
    train, drag
        A drivetrain and its drag; or a machine (`hersey.read_machine`) and the surface fitted to its log,
        which take radius, stick speed and grip from the machine file.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name.
    UnfinishedError
        If the allowed work is exceeded, or the motion cannot be continued.

    Examples
    --------
    >>> from hersey import Drag
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> cycle = stick_slip(Drivetrain(1000, 1), drag, drive_speed=1.0)
    >>> cycle.kind, round(cycle.frequency, 5)
    ('stick_slip', 3.94031)
    """
    train, drag, temperature = belt_of(train, drag, temperature, drive_speed=drive_speed)
    law = drag.law_at(temperature)
    state = start_state(train, law, Schedule.of(drive_speed), None, start, is_torque=False, nudged=True)
    steps = whole("most_steps", most_steps)
    cycle = _core.stick_slip(train._arguments, law, float(drive_speed), state, None, float(tolerance), steps)
    return StickSlipCycle(*attrgetter(*(field.name for field in fields(StickSlipCycle)))(cycle))


def steady_start(
    train: Drivetrain, drag: AnyDrag, speed: float, temperature: float | None = None
) -> tuple[float, float]:
    """Return belt speed and stretch of sliding at ``speed``, the spring stretched by just the drag there."""
    law = drag.law_at(temperature)
    state = _core.steady_start(train._arguments, law, float(speed), nudged=False)
    return state.belt_speed, state.stretch


def start_state(
    train: Drivetrain,
    law: _core.Law,
    drive: Schedule,
    temperature: Schedule | None,
    start: str | tuple[float, float],
    *,
    is_torque: bool,
    nudged: bool = False,
) -> tuple[float, float]:
    """Return belt speed and stretch of a start of `simulate`, the temperature in the scale of the law."""
    if not isinstance(start, str):
        speed, stretch = start
        return float(speed), float(stretch)
    if start == "rest":
        return 0.0, 0.0
    if start != "steady":
        raise ParameterError(f"start is '{start}': it must be rest, steady, or (sliding speed, stretch)")
    if is_torque:
        raise ParameterError("start 'steady' needs a drive_speed")
    now = law if temperature is None else law.at(temperature.first)
    state = _core.steady_start(train._arguments, now, drive.first, nudged)
    return state.belt_speed, state.stretch
