"""A drive profile that ends smooth: ``hersey plan``."""

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
    Traces,
    beyond_the_log,
    heat_of,
    reads_logs,
    target_of,
    temperature_of,
)
from hersey.cli.outputs import give, may_write_table_and_figure
from hersey.cli.progress import bar, working
from hersey.errors import ParameterError

#: What a plan rests on that knows no dwells.
_FIT_ALONE = (
    "--fit holds one law with two branches: give the log to count other drag curves, both closures and starts"
)


@reads_logs
def plan(
    machine_file: Annotated[
        Path,
        typer.Argument(metavar="MACHINE", help="TOML file of the drivetrain, its limits and uncertainty."),
    ],
    reading: Reading,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    trace: Traces = None,
    target: Annotated[
        str, typer.Option(help="Target speed of the belt, as '60 mm/s', or of the roll, as '40 rpm'.")
    ] = "",
    at: Annotated[str, typer.Option(help="Temperature, as '150 degC'.")] = "",
    profile_file: Annotated[
        Path | None,
        typer.Option(
            "--temperature-profile",
            metavar="FILE",
            help="Instead: temperature against time, in any format that a log may have.",
        ),
    ] = None,
    heat: Annotated[
        bool,
        typer.Option("--heat", help="Instead: the temperature that \\[heat] of the file and the plan make."),
    ] = False,
    start: Annotated[
        str, typer.Option("--from", help="With --heat: of the cold start.  [default: that of \\[heat]]")
    ] = "",
    confidence: Annotated[
        float, typer.Option("--confidence", help="Share of the belts that must run smoothly, 0.5 to 0.999.")
    ] = 0.95,
    seed: Annotated[int, typer.Option("--seed", help="Of all random draws.", min=0)] = 1,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="CSV", help="Write the profile for a motor controller.")
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Draw profile and motion: .html, .png, .svg or .pdf.")
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find the quickest profile of drive speed from rest that ends smooth, and say how surely it does.

    Example: [bold]hersey plan examples/machine.toml examples/bench.csv --tare standing --target "60 mm/s"
    --at "150 degC" --out profile.csv --figure plan.png[/bold]

    Exit code 1 says that no profile exists; then nothing is written.
    """
    inputs = reading.inputs(machine_file, logs, fit_file, profile_file, trace)
    replaced = may_write_table_and_figure(out, figure, force, inputs)
    if sum((bool(at), profile_file is not None, heat)) > 1:
        raise ParameterError("give one of --at, --temperature-profile and --heat")
    if start and not heat:
        raise ParameterError("--from goes with --heat")

    import numpy as np

    from hersey.decision.start_up import plan_start_up
    from hersey.decision.warming import plan_warm_start
    from hersey.log import memory_limit
    from hersey.machine.machine import read_machine
    from hersey.machine.temperature_profile import read_temperature_profile
    from hersey.stability.plan import check_temperature, plan_of_log

    machine = read_machine(machine_file)
    wanted = target_of(target, machine)
    kelvin = temperature_of(at)
    with memory_limit(reading.max_memory):
        profile = None if profile_file is None else read_temperature_profile(profile_file)
    changing = heat_of(machine, machine_file, start) if heat else profile
    surface, drawn = reading.surface_and_posterior(logs, fit_file, machine, trace, seed=seed)
    if drawn is not None and changing is None:
        check_temperature(surface, kelvin)
        with working("planning"):
            planned = plan_start_up(drawn, kelvin, wanted, confidence=confidence)
        give("plan", planned, called="profile", table=out, figure=figure, replace=replaced, as_json=as_json)
        return
    with bar("planning", unit="profiles") as progress:
        if drawn is not None and changing is not None:
            planned = plan_warm_start(
                drawn,
                wanted,
                temperature=changing,
                confidence=confidence,
                seed=seed,
                progress=progress,
            )
        else:
            planned = plan_of_log(
                surface,
                machine,
                target_speed=wanted,
                temperature=kelvin if changing is None else changing,
                confidence=confidence,
                seed=seed,
                progress=progress,
            )
            planned = replace(planned, warnings=(*planned.warnings, _FIT_ALONE))
    course = planned.course if heat else profile
    if course is not None:
        film = np.asarray(course.values)
        said = beyond_the_log(surface, float(film.min()), float(film.max()))
        planned = replace(planned, warnings=(*planned.warnings, *said))
    give(
        "plan",
        planned,
        called="profile",
        table=out,
        figure=figure,
        replace=replaced,
        as_json=as_json,
        temperature=course,
    )
