"""What a belt settles to: ``hersey simulate``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from hersey.cli.belt import Belt
from hersey.cli.groups import grouped, option
from hersey.cli.options import AsJson, FitFile, Force, Start, drawn, finished_fit
from hersey.cli.outputs import may_draw, may_write, print_json
from hersey.cli.progress import working
from hersey.cli.quantities import target_of
from hersey.cli.terminal import say
from hersey.cli.warming import beyond_the_log, heat_of, warming_drag
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.machine.motor import MotorUse
    from hersey.motion.schedule import Schedule
    from hersey.motion.simulation import StickSlipCycle
    from hersey.motion.trajectory import Trajectory

#: Time simulated with temperature as a state if none is given.
_WARMING = "60 s"
_PROFILE = "Instead of it: a CSV of drive speeds, columns 'time (s)' and 'speed (mm/s)'."
_DURATION = "Time simulated, for --csv and --check, as '2 s'.  [default: 2]"
_HEAT = "Temperature as a state, by \\[heat] of --machine and the drag of --fit, from cold."
_FROM = "With --heat: temperature at the start.  [default: that of \\[heat]]"


@dataclass(frozen=True)
class _Drive:
    """How the drive moves, from what start and for how long."""

    drive_speed: Annotated[str | None, option("Speed of the drive, as '30 mm/s'.  [default: 1]")] = None
    profile: Annotated[Path | None, option(_PROFILE, metavar="FILE")] = None
    start: Start = "rest"
    duration: Annotated[str | None, option(_DURATION)] = None
    check: Annotated[bool, option("Simulate with a second integrator too, and compare.", "--check")] = False

    def course(self) -> Schedule | None:
        """Return the profile, if there is one."""
        if self.profile is None:
            return None
        from hersey.cli.columns import read_profile

        return read_profile(self.profile)


@dataclass(frozen=True)
class _Heat:
    """Whether temperature is a state, and what then makes it."""

    heat: Annotated[bool, option(_HEAT, "--heat")] = False
    fit_file: FitFile = None
    begin: Annotated[str, option(_FROM, "--from")] = ""

    def refuse_beside(self, drive: _Drive) -> None:
        """Refuse options that exclude each other."""
        if drive.profile is not None and (self.heat or drive.drive_speed is not None):
            other = "--heat" if self.heat else "--drive-speed"
            raise ParameterError(f"--profile and {other} exclude each other")
        if not self.heat and (self.fit_file is not None or self.begin):
            raise ParameterError(f"{'--from' if self.begin else '--fit'} goes with --heat")


#: What JSON says beside the cycle; null where it is not asked for.
_BESIDE = ("energy", "check", "motor", "warming")


class _Motion(NamedTuple):
    """A motion that was simulated, what it settles to, what JSON says beside, and all of it in lines."""

    run: Trajectory | None
    cycle: StickSlipCycle
    beside: dict[str, Any]
    lines: list[str]


@grouped
def simulate(
    *,
    drive: _Drive,
    csv: Annotated[Path | None, option("Write the motion as CSV.", metavar="FILE")] = None,
    heat: _Heat,
    figure: Annotated[Path | None, drawn("the motion")] = None,
    belt: Belt,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Simulate the belt at a drive speed or over a profile: what it settles to (defaults: the paper's).

    Numbers carry units, as '11 N/mm', or are bare in any consistent set of units; those of the paper are
    inches, ounces of force and seconds. With units, results are in SI.

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
    if as_json:
        print_json(found.cycle, **dict.fromkeys(_BESIDE) | found.beside)
        return
    say(*found.lines)


def _settled(belt: Belt, drive: _Drive, written: bool) -> _Motion:
    """What the belt settles to, and the run from its start if it is written or says more."""
    from hersey.motion.simulation import simulate as moved
    from hersey.motion.simulation import stick_slip

    course, speed_given = drive.course(), drive.drive_speed
    if course is not None:  # the last speed stays, and has a unit: so must all others
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
    before = "" if course is None else f"After {time:g} s of the profile it settles:\n"
    beside = {} if run is None else {"energy": run.energy, "check": run.check, "motor": motor}
    lines = [] if run is None else _of_run(run, motor, time)
    return _Motion(run, cycle, beside, [before + cycle.summary(), *lines, *numbers.words])


def _of_run(run: Trajectory, motor: MotorUse | None, time: float) -> list[str]:
    lines = [f"energy balance: {run.energy.residual:.1e} of the energy turned over is missing"]
    lines += [] if run.check is None else [str(run.check)]
    lines += [f"over {time:g} s {run.slipping_in_words()}"] if run.roll_slips else []
    return lines + ([] if motor is None else [str(motor)])


def _end(run: Trajectory) -> tuple[float, float]:
    """Belt speed and stretch at the end of a run."""
    return float(run.belt_speed[-1]), float(run.stretch[-1])


def _rows(run: Trajectory) -> bytes:
    """A motion as a CSV, a row per step."""
    import polars as pl

    from hersey.files.tables import table

    names = ("time", "belt_speed", "stretch", "spring_force", "mode")
    columns = {name: getattr(run, name) for name in names} | {"roll_slips": run.slipping}
    bodies = {name: getattr(run, name) for name in ("film_temperature", "roll_temperature")}
    columns |= {name: kelvin for name, kelvin in bodies.items() if kelvin is not None}
    return table(pl.DataFrame(columns), ".csv")


def _warmed(belt: Belt, drive: _Drive, heat: _Heat) -> _Motion:
    """The motion with temperature as a state, and what it settles to where it ends."""
    from hersey.machine.machine import read_machine
    from hersey.motion.simulation import simulate as moved
    from hersey.motion.simulation import stick_slip
    from hersey.units import celsius, parse

    if belt.machine is None or heat.fit_file is None:
        raise ParameterError(
            "--heat needs --machine with [heat], and --fit with what hersey fit --json printed"
        )
    if belt != Belt(machine=belt.machine):
        raise ParameterError(
            "--heat takes belt and drag from --machine and --fit: leave the other numbers out"
        )
    if drive.drive_speed is None:
        raise ParameterError("give the speed of the drive: --drive-speed '30 mm/s'")
    machine = read_machine(belt.machine)
    balance = heat_of(machine, belt.machine, heat.begin)
    speed = target_of(drive.drive_speed, machine, "--drive-speed")
    time = parse("time", drive.duration or _WARMING)
    surface = finished_fit(heat.fit_file, machine)
    train, drag = machine.train, warming_drag(surface, machine)
    asked: dict[str, Any] = {"duration": time, "start": drive.start, "check": drive.check}
    with working("simulating"):
        run = moved(train, drag, drive_speed=speed, temperature=balance, **asked)
    film = run.film_temperature
    assert film is not None
    last = float(film[-1])
    cycle = stick_slip(train, drag, drive_speed=speed, temperature=last, start=_end(run))
    beyond = [f"- {each}" for each in beyond_the_log(surface, film)]
    settled = f"At {celsius(last):.4g} degC it settles to {cycle.headline()}."
    beside = {"energy": run.energy, "check": run.check, "warming": run}
    return _Motion(run, cycle, beside, [run.summary(), settled, *beyond])
