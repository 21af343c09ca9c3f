"""What a belt settles to: ``hersey simulate``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from hersey.cli.belt import Belt
from hersey.cli.groups import grouped, option
from hersey.cli.options import FitFile, Force, Start, drawn, finished_fit
from hersey.cli.outputs import may_draw, may_write
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.quantities import amount_of, target_of
from hersey.cli.warming import beyond_the_log, heat_of, refuse_below_zero, start_of, warming_drag
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.cli.amounts import Amounts
    from hersey.machine.motor import MotorUse
    from hersey.motion.schedule import Schedule
    from hersey.motion.simulation import StickSlipCycle
    from hersey.motion.trajectory import Trajectory
    from hersey.schema.noun import Noun

#: Time simulated with --heat if none is given.
_WARMING = "60 s"
_SPEED = "Speed of the drive, e.g. '30 mm/s'.  [default: 1]"
_PROFILE = "CSV of the drive speed, columns 'time (s)' and 'speed (mm/s)', instead of a constant speed."
_DURATION = "Time to simulate for --csv, --figure and --check, e.g. '2 s'.  [default: 2]"
_CHECK = "Simulate with a second integrator too, and compare."
_HEAT = "Simulate heating from cold, with \\[heat] of --machine and the drag of --fit."
_FROM = "Temperature at the start, with --heat.  [default: that of \\[heat]]"
#: What the motion settles to, in words.
_KINDS = {
    "stick_slip": "The {part} sticks and slips.",
    "steady_sliding": "The {part} slides steadily.",
    "oscillation": "The {part} oscillates without sticking.",
    "unsettled": "The motion has not settled.",
    "stalled": "The {part} stalls: the grip does not suffice to move it.",
    "grip_slip": "The {part} slides steadily, slower than it is driven: the grip does not suffice.",
}


@dataclass(frozen=True)
class _Drive:
    """How the drive moves, from what start and for how long."""

    drive_speed: Annotated[str | None, option(_SPEED)] = None
    profile: Annotated[Path | None, option(_PROFILE, metavar="FILE")] = None
    start: Start = "rest"
    duration: Annotated[str | None, option(_DURATION)] = None
    check: Annotated[bool, option(_CHECK, "--check")] = False

    def course(self) -> Schedule | None:
        """Return the profile, if there is one."""
        if self.profile is None:
            return None
        from hersey.cli.columns import read_profile

        return read_profile(self.profile)


@dataclass(frozen=True)
class _Heat:
    """Whether heating is simulated, and from which fit and temperature."""

    heat: Annotated[bool, option(_HEAT, "--heat")] = False
    fit_file: FitFile = None
    begin: Annotated[str, option(_FROM, "--from")] = ""

    def refuse_beside(self, drive: _Drive) -> None:
        """Refuse options that exclude each other."""
        if drive.profile is not None and (self.heat or drive.drive_speed is not None):
            other = "--heat" if self.heat else "--drive-speed"
            raise ParameterError(f"--profile and {other} exclude each other: give one of them")
        if not self.heat and (self.fit_file is not None or self.begin):
            raise ParameterError(f"{'--from' if self.begin else '--fit'} needs --heat")


#: Fields of the JSON beside the cycle; null if not asked for.
_BESIDE = ("energy", "check", "motor", "warming")


class _Motion(NamedTuple):
    """A simulated motion, what it settles to, the other fields of the JSON, and the text to print.

    ``whole`` says all of what it settles to and of the motion; ``after`` is said of both.
    """

    run: Trajectory | None
    cycle: StickSlipCycle
    beside: dict[str, Any]
    before: list[str]
    settled: list[str]
    whole: str
    after: list[str]


@grouped
def simulate(
    *,
    drive: _Drive,
    csv: Annotated[Path | None, option("Write the motion as CSV.", metavar="FILE")] = None,
    heat: _Heat,
    figure: Annotated[Path | None, drawn("the motion")] = None,
    belt: Belt,
    printing: Printing,
    force: Force = False,
) -> None:
    """Simulate the motion at a drive speed or over a profile.

    Give all numbers with units, e.g. '11 N/mm', or all bare in any consistent set of units. The defaults are
    the paper's baseline, in inches, ounces of force and seconds.

    Example: [bold]hersey simulate --stiffness 2000 --drive-speed 1.3[/bold]
    """
    inputs = [path for path in (belt.machine, heat.fit_file, drive.profile) if path is not None]
    table = may_write(csv, force, inputs, flag="--csv", ends=[".csv"])
    drawing = may_draw(figure, force, inputs)
    heat.refuse_beside(drive)
    found = _warmed(belt, drive, heat) if heat.heat else _settled(belt, drive, bool(csv or figure))
    if found.run is not None:
        if csv is not None:
            table.write(_rows(found.run))
        drawing.draw(found.run)
    if printing.json(found.cycle, **dict.fromkeys(_BESIDE) | found.beside):
        return
    printing.text(*found.before)
    printing.conclusion(lambda: found.settled, found.whole)
    printing.text(*found.after)
    printing.files(csv, figure)


def _settled(belt: Belt, drive: _Drive, written: bool) -> _Motion:
    """What the belt settles to, and its motion from the start if that is written or adds to the result."""
    from hersey.motion.simulation import simulate as moved
    from hersey.motion.simulation import stick_slip

    course, speed_given = drive.course(), drive.drive_speed
    if course is not None:  # it has units, so all other numbers need units too
        speed_given = f"{course.at(float('inf'))} m/s"
    train, drag, numbers = belt.parts(
        needed=("drive_speed", "duration"), drive_speed=speed_given, duration=drive.duration
    )
    speed, time = (numbers.values[name] or 0.0 for name in ("drive_speed", "duration"))
    run, motor = None, None
    if written or any((drive.check, belt.machine, course)):
        run = moved(
            train, drag, drive_speed=course or speed, duration=time, start=drive.start, check=drive.check
        )
        motor = belt.motor_use(run)
    ended = None if course is None or run is None else _end(run)
    cycle = stick_slip(train, drag, drive_speed=speed, start=ended or drive.start)
    before = [] if course is None else [f"After {numbers.shown(time, 'time')} of the profile:"]
    beside = {} if run is None else {"energy": run.energy, "check": run.check, "motor": motor}
    lines = [] if run is None else _of_run(run, motor, time, numbers)
    whole = "\n".join([cycle.summary(), *([] if run is None else [run.summary()])])
    after = [*lines, *numbers.words]
    return _Motion(run, cycle, beside, before, _cycle(cycle, numbers, train.part), whole, after)


def _cycle(cycle: StickSlipCycle, numbers: Amounts, part: Noun) -> list[str]:
    """What the motion settles to."""
    from hersey.cli.figures import labelled, three

    kind = cycle.kind.replace("_", " ").capitalize()
    lines = [_KINDS[cycle.kind].format(part=part) if cycle.kind in _KINDS else f"{kind}."]
    if cycle.frequency == 0:
        speed = numbers.shown(cycle.speed_max, "belt speed")
        stretch = numbers.shown(cycle.stretch_max, "length")
        return [*lines, *labelled([("sliding speed", speed), ("stretch", stretch)])]
    rows = [
        ("frequency", numbers.shown(cycle.frequency, "frequency")),
        ("stuck", f"{three(100 * cycle.stuck_fraction)} % of the time"),
        ("sliding speed", numbers.shown_range(cycle.speed_min, cycle.speed_max, "belt speed")),
        ("stretch", numbers.shown_range(cycle.stretch_min, cycle.stretch_max, "length")),
        ("drag work", f"{numbers.shown(cycle.drag_work, 'energy')} per cycle"),
    ]
    if cycle.grip_slip_duration > 0:
        rows.append(("drive slips", f"{numbers.shown(cycle.grip_slip_duration, 'time')} per cycle"))
    return [*lines, *labelled(rows)]


def _of_run(run: Trajectory, motor: MotorUse | None, time: float, numbers: Amounts) -> list[str]:
    """What the motion over the time simulated adds: the check, slipping of the roll, and the motor."""
    lines = [] if run.check is None else [f"Check: {run.check}."]
    slipping = run.slipping_in_words(lambda duration: numbers.shown(duration, "time"))
    slips = f"In {numbers.shown(time, 'time')} of motion {slipping}."
    lines += [slips] if run.roll_slips else []
    return lines + ([] if motor is None else [_motor(motor)])


def _motor(motor: MotorUse) -> str:
    """The torque that the motion needs beside that of the motor."""
    from hersey.cli.figures import three

    needs = f"the motion needs up to {three(motor.torque)} of the {three(motor.limit, 'N·m')} of the motor"
    if motor.exceeded_from is None:
        return f"The motor is strong enough: {needs}."
    when = f"first after {three(motor.exceeded_from, 's')}, {three(100 * motor.exceeded)} % of the time"
    return f"The motor is too weak: {needs} ({when})."


def _end(run: Trajectory) -> tuple[float, float]:
    """Belt speed and stretch at the end of a run."""
    return float(run.belt_speed[-1]), float(run.stretch[-1])


def _rows(run: Trajectory) -> bytes:
    """A motion as a CSV, one row per sample."""
    import polars as pl

    from hersey.files.tables import table

    names = ("time", "belt_speed", "stretch", "spring_force", "mode")
    columns = {name: getattr(run, name) for name in names} | {"roll_slips": run.slipping}
    bodies = {name: getattr(run, name) for name in ("film_temperature", "roll_temperature")}
    columns |= {name: kelvin for name, kelvin in bodies.items() if kelvin is not None}
    return table(pl.DataFrame(columns), ".csv")


def _warmed(belt: Belt, drive: _Drive, heat: _Heat) -> _Motion:
    """The motion with heating, and what it settles to at the last temperature."""
    from hersey.cli.amounts import Amounts
    from hersey.cli.figures import three
    from hersey.machine.machine import read_machine
    from hersey.motion.simulation import simulate as moved
    from hersey.motion.simulation import stick_slip
    from hersey.units import celsius

    if belt.machine is None or heat.fit_file is None:
        raise ParameterError(
            "--heat needs --machine TOML with [heat], and --fit with the file that hersey fit --json printed"
        )
    if belt != Belt(machine=belt.machine):
        raise ParameterError(
            "--heat uses the drive of --machine and the drag of --fit: omit the other options of the drive"
        )
    if drive.drive_speed is None:
        raise ParameterError("--heat needs the speed of the drive: add --drive-speed '30 mm/s'")
    machine = read_machine(belt.machine)
    balance = heat_of(machine, belt.machine, heat.begin)
    speed = target_of(drive.drive_speed, machine, "--drive-speed")
    time = amount_of("time", drive.duration or _WARMING, "--duration")
    surface = finished_fit(heat.fit_file, machine, belt.machine)
    refuse_below_zero(surface, balance, start_of(belt.machine, heat.begin), heat.fit_file)
    train, drag = machine.train, warming_drag(surface, machine)
    asked: dict[str, Any] = {"duration": time, "start": drive.start, "check": drive.check}
    with working("simulating"):
        run = moved(train, drag, drive_speed=speed, temperature=balance, **asked)
    film = run.film_temperature
    assert film is not None
    last = float(film[-1])
    cycle = stick_slip(train, drag, drive_speed=speed, temperature=last, start=_end(run))
    numbers = Amounts({}, in_si=True)
    warmed = (
        f"In {three(time, 's')} the film heats from {celsius(film[0]):.0f} to {celsius(last):.0f} °C. Then:"
    )
    beyond = [f"- {each.sentence}" for each in beyond_the_log(surface, film)]
    after = [*_of_run(run, None, time, numbers), *beyond]
    beside = {"energy": run.energy, "check": run.check, "warming": run}
    whole = "\n".join([cycle.summary(), run.summary()])
    return _Motion(run, cycle, beside, [warmed], _cycle(cycle, numbers, train.part), whole, after)
