"""A warm-up that keeps grip and motor: ``hersey warmup``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    FitFile,
    Force,
    Reading,
    SomeLogs,
    beyond_the_log,
    heat_of,
    reads_logs,
    share,
    target_of,
    warming_drag,
)
from hersey.cli.outputs import give, may_write_table_and_figure
from hersey.cli.progress import working
from hersey.errors import ParameterError


@reads_logs
def warmup(
    machine_file: Annotated[
        Path, typer.Argument(metavar="MACHINE", help="TOML file of the drivetrain, its limits and \\[heat].")
    ],
    reading: Reading,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    target: Annotated[
        str, typer.Option(help="Full speed of the belt, as '120 mm/s', or of the roll, as '80 rpm'.")
    ] = "",
    start: Annotated[
        str, typer.Option("--from", help="Temperature of the cold start.  [default: that of \\[heat]]")
    ] = "",
    margin: Annotated[str, typer.Option(help="Share of the limit of force that is kept to spare.")] = "10 %",
    longest: Annotated[str, typer.Option(help="Time looked at, with its unit.")] = "30 min",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="CSV", help="Write the course; plan --temperature-profile reads it."),
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option("--figure", help="Draw speed, drag and temperatures: .html, .png, .svg or .pdf."),
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find the quickest warm-up whose drag stays below grip and motor: slow until warm.

    Example: [bold]hersey warmup examples/machine.toml examples/bench.csv --tare standing --target "120 mm/s"
    --from "20 degC" --figure warm-up.png[/bold]

    Exit code 1 says that full speed is not reached; then nothing is written.
    """
    inputs = reading.inputs(machine_file, logs, fit_file)
    replaced = may_write_table_and_figure(out, figure, force, inputs)

    from hersey.machine.machine import read_machine
    from hersey.stability.warm_up import warm_up
    from hersey.units import parse

    machine = read_machine(machine_file)
    speed, spare, time = target_of(target, machine), share("--margin", margin), parse("time", longest)
    heat = heat_of(machine, machine_file, start)
    limit = machine.limits.force(machine.roll_radius)
    if limit is None:
        raise ParameterError(
            f"{machine_file.name} states no limit of force: add motor_torque, or roll_friction and nip_load, "
            "to [limits]"
        )
    if machine.limits.acceleration is None:
        raise ParameterError(f"{machine_file.name} states no acceleration: add it to [limits]")
    surface = reading.surface(logs, fit_file, machine)
    with working("warming up"):
        warm = warm_up(
            machine.train,
            warming_drag(surface, machine),
            heat,
            target_speed=speed,
            force_limit=limit[1],
            acceleration=machine.limits.acceleration,
            margin=spare,
            longest=time,
        )
    film = warm.film_temperature
    said = beyond_the_log(surface, float(film.min()), float(film.max()))
    warm = replace(warm, warnings=(*warm.warnings, f"the limit is that of the {limit[0]}", *said))
    give("warmup", warm, called="course", table=out, figure=figure, replace=replaced, as_json=as_json)
