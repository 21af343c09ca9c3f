"""Where the belt runs smoothly: ``hersey map``."""

from __future__ import annotations

import os
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
    reads_logs,
)
from hersey.cli.outputs import may_draw, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say


@reads_logs
def map_(
    machine_file: Annotated[
        Path, typer.Argument(metavar="MACHINE", help="TOML file of the drivetrain and its limits.")
    ],
    reading: Reading,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    trace: Traces = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="The picture: .html, .png, .svg or .pdf.  [default: map.html]"),
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Map where the belt runs smoothly, sticks and slips, or stalls: temperature across, drive speed up.

    Example: [bold]hersey map examples/machine.toml examples/bench.csv --tare standing[/bold]

    With --json the whole map goes to stdout, and a picture is drawn only if --out is given.
    """
    path = out or (None if as_json else Path("map.html"))
    overwrite = False
    if path is not None:
        inputs = reading.inputs(machine_file, logs, fit_file, trace)
        overwrite = may_draw(path, force, inputs, flag="--out")

    from hersey.decision.mapping import map_of
    from hersey.files.writing import write_atomically
    from hersey.machine.machine import read_machine
    from hersey.stability.operating_map import operating_map

    machine = read_machine(machine_file)
    threads = os.cpu_count() or 1
    surface, drawn = reading.surface_and_posterior(logs, fit_file, machine, trace)
    with working("finding the bands"):
        if drawn is not None:
            map_of_belt = map_of(drawn, threads=threads)
        else:
            map_of_belt = operating_map(surface, machine, threads=threads)
    if path is not None:
        from hersey.charts import chart_of
        from hersey.charts.render import picture

        with working("drawing the map"):
            chart = chart_of(map_of_belt, tooltips=path.suffix == ".html")
            write_atomically(path, picture(chart, path.suffix), overwrite=overwrite)
    if as_json:
        print_json("map", map_of_belt.to_dict())
        return
    say(map_of_belt.summary())
    for warning in map_of_belt.warnings:
        say(f"- {warning}")
    say(f"map: {path}")
