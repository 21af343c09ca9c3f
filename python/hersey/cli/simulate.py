"""What a belt settles to: ``hersey simulate``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.belt import Belt
from hersey.cli.options import (
    AsJson,
    FitFile,
    Force,
    Reading,
    beyond_the_log,
    heat_of,
    takes,
    target_of,
    warming_drag,
)
from hersey.cli.outputs import may_draw, may_write, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.motion.trajectory import Trajectory

#: Time simulated with temperature as a state if none is given.
_WARMING = "60 s"


@takes(Belt, "belt")
def simulate(
    belt: Belt,
    drive_speed: Annotated[
        str | None, typer.Option(help="Speed of the drive, as '30 mm/s'.  [default: 1]")
    ] = None,
    profile: Annotated[
        Path | None,
        typer.Option(
            "--profile",
            metavar="FILE",
            help="Instead of it: a CSV of drive speeds, columns 'time (s)' and 'speed (mm/s)'.",
        ),
    ] = None,
    start: Annotated[str, typer.Option(help="rest, or steady (sliding with the drive).")] = "rest",
    duration: Annotated[
        str | None, typer.Option(help="Time simulated, for --csv and --check, as '2 s'.  [default: 2]")
    ] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Simulate with a second integrator too, and compare.")
    ] = False,
    csv: Annotated[
        Path | None, typer.Option("--csv", metavar="FILE", help="Write the motion as CSV.")
    ] = None,
    heat: Annotated[
        bool,
        typer.Option(
            "--heat",
            help="Temperature as a state, by \\[heat] of --machine and the drag of --fit, from cold.",
        ),
    ] = False,
    fit_file: FitFile = None,
    begin: Annotated[
        str,
        typer.Option("--from", help="With --heat: temperature at the start.  [default: that of \\[heat]]"),
    ] = "",
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Draw the motion: .html, .png, .svg or .pdf.")
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Simulate the belt at a drive speed or over a profile: what it settles to (defaults: the paper's).

    Numbers carry units, as '11 N/mm', or are bare in any consistent set of units; those of the paper are
    inches, ounces of force and seconds. With units, results are in SI.

    Example: [bold]hersey simulate --stiffness 2000 --drive-speed 1.3[/bold]
    """
    inputs = [path for path in (belt.machine, fit_file, profile) if path is not None]
    replace = {}
    if csv is not None:
        replace[csv] = may_write(csv, force, inputs, flag="--csv", ends=[".csv"])
    if figure is not None:
        replace[figure] = may_draw(figure, force, inputs)
    if profile is not None and (heat or drive_speed is not None):
        raise ParameterError(f"--profile and {'--heat' if heat else '--drive-speed'} exclude each other")
    if heat:
        _warming(belt, fit_file, drive_speed, duration, start, begin, check, csv, figure, replace, as_json)
        return
    if fit_file is not None or begin:
        raise ParameterError(f"{'--from' if begin else '--fit'} goes with --heat")

    from hersey.motion import simulation as motion
    from hersey.result import json_value

    course = None
    if profile is not None:
        from hersey.cli.profile import read_profile

        course = read_profile(profile)
        # the last speed stays, and has a unit: so must all others
        drive_speed = f"{course.at(float('inf'))} m/s"
    train, drag, numbers = belt.parts(
        needed=("drive_speed", "duration"), drive_speed=drive_speed, duration=duration
    )
    speed, time = (numbers.values[name] or 0.0 for name in ("drive_speed", "duration"))
    run = None
    motor = None
    if any((csv, check, figure, belt.machine, course)):
        run = motion.simulate(
            train, drag, drive_speed=course or speed, duration=time, start=start, check=check
        )
    state: str | tuple[float, float] = start
    if course is not None and run is not None:
        state = float(run.belt_speed[-1]), float(run.stretch[-1])
    cycle = motion.stick_slip(train, drag, drive_speed=speed, start=state)
    if run is not None:
        motor = belt.motor_use(run)
        _write(run, csv, figure, replace)
    if as_json:
        ran = {} if run is None else {"energy": json_value(run.energy), "check": json_value(run.check)}
        ran |= {} if motor is None else {"motor": json_value(motor)}
        print_json("simulate", cycle.to_dict() | ran)
        return
    lines = [
        cycle.summary()
        if course is None
        else f"After {time:g} s of the profile it settles:\n{cycle.summary()}"
    ]
    if run is not None:
        lines.append(f"energy balance: {run.energy.residual:.1e} of the energy turned over is missing")
    if run is not None and run.check is not None:
        lines.append(str(run.check))
    if run is not None and run.roll_slips:
        lines.append(f"over {time:g} s {run.slipping_in_words()}")
    if motor is not None:
        lines.append(str(motor))
    say("\n".join([*lines, *numbers.words]))


def _write(run: Trajectory, csv: Path | None, figure: Path | None, replace: Mapping[Path, bool]) -> None:
    from hersey.files.tables import table
    from hersey.files.writing import write_atomically

    if csv is not None:
        import polars as pl

        names = ("time", "belt_speed", "stretch", "spring_force", "mode")
        columns = {name: getattr(run, name) for name in names} | {"roll_slips": run.slipping}
        bodies = {name: getattr(run, name) for name in ("film_temperature", "roll_temperature")}
        columns |= {name: kelvin for name, kelvin in bodies.items() if kelvin is not None}
        write_atomically(csv, table(pl.DataFrame(columns), ".csv"), overwrite=replace[csv])
    if figure is not None:
        from hersey.charts import chart_of
        from hersey.charts.render import picture

        with working("drawing"):
            content = picture(chart_of(run), figure.suffix)
        write_atomically(figure, content, overwrite=replace[figure])


def _warming(
    belt: Belt,
    fit_file: Path | None,
    drive_speed: str | None,
    duration: str | None,
    start: str,
    begin: str,
    check: bool,
    csv: Path | None,
    figure: Path | None,
    replace: Mapping[Path, bool],
    as_json: bool,
) -> None:
    """Simulate with temperature as a state, and say what the motion settles to where it ends."""
    from hersey.machine.machine import read_machine
    from hersey.motion.simulation import simulate as moved
    from hersey.motion.simulation import stick_slip
    from hersey.result import json_value
    from hersey.units import celsius, parse

    if belt.machine is None or fit_file is None:
        raise ParameterError(
            "--heat needs --machine with [heat], and --fit with what hersey fit --json printed"
        )
    if belt != Belt(machine=belt.machine):
        raise ParameterError(
            "--heat takes belt and drag from --machine and --fit: leave the other numbers out"
        )
    if drive_speed is None:
        raise ParameterError("give the speed of the drive: --drive-speed '30 mm/s'")
    machine = read_machine(belt.machine)
    warmth = heat_of(machine, belt.machine, begin)
    speed, time = target_of(drive_speed, machine, "--drive-speed"), parse("time", duration or _WARMING)
    surface = Reading().surface(None, fit_file, machine)
    drag = warming_drag(surface, machine)
    with working("simulating"):
        run = moved(
            machine.train,
            drag,
            drive_speed=speed,
            temperature=warmth,
            duration=time,
            start=start,
            check=check,
        )
    film = run.film_temperature
    assert film is not None
    state = float(run.belt_speed[-1]), float(run.stretch[-1])
    cycle = stick_slip(machine.train, drag, drive_speed=speed, temperature=float(film[-1]), start=state)
    _write(run, csv, figure, replace)
    if as_json:
        beside = {"energy": json_value(run.energy), "check": json_value(run.check), "warming": run.to_dict()}
        print_json("simulate", cycle.to_dict() | beside)
        return
    said = beyond_the_log(surface, float(film.min()), float(film.max()))
    settled = f"At {celsius(float(film[-1])):.4g} degC it settles to {cycle.headline()}."
    say("\n".join([run.summary(), settled, *(f"- {each}" for each in said)]))
