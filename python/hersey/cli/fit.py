"""The damping surface of a log: ``hersey fit``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Force,
    KeepGoing,
    Logs,
    Reading,
    reads_logs,
)
from hersey.cli.outputs import may_write, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.cli.workers import Scheduler, Workers
from hersey.errors import ParameterError
from hersey.files.tables import TABLES


@reads_logs
def fit(
    logs: Logs,
    reading: Reading,
    each: Annotated[
        Path | None,
        typer.Option(
            "--each", metavar="TABLE", help="Fit each log by itself: a row per log, in a .csv or .parquet."
        ),
    ] = None,
    machine_file: Annotated[
        Path | None,
        typer.Option("--machine", metavar="TOML", help="Machine's file: rest of the drive, sensors."),
    ] = None,
    keep_going: KeepGoing = False,
    scheduler: Scheduler = None,
    count: Workers = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Fit the damping surface B = a T^b w^c and print it, with the verdict on the regime.

    Example: [bold]hersey fit examples/bench.csv --tare standing[/bold]

    Several logs are runs of one machine, unless --each says that each is fitted by itself: then nothing is
    written if one fails, or with --keep-going the others are, with exit code 1.
    """
    if each is not None and as_json:
        raise ParameterError("--each writes a table, and --json prints one fit: leave one of them out")
    if each is None and (keep_going or force or scheduler or count):
        raise ParameterError("--keep-going, --scheduler, --workers and --force go with --each TABLE")
    machine = None
    if machine_file is not None:
        from hersey.machine.machine import read_machine

        machine = read_machine(machine_file)
    if each is not None:
        from hersey.cli.fitting_each import fit_each

        overwrite = may_write(each, force, reading.inputs(logs, machine_file), flag="--each", ends=TABLES)
        fit_each(logs, reading, machine, each, overwrite, keep_going, scheduler, count)
        return
    log = reading.log(logs, machine)

    from hersey.damping.curves import fit_curves
    from hersey.damping.curves.words import drag_curves
    from hersey.damping.fit import fit as fitted
    from hersey.document.assembly import fit_document
    from hersey.verdict.cautions import cautions
    from hersey.verdict.regime import regime

    with working("fitting the surface"):
        points = reading.points(log, machine)
        surface = fitted(points, temperature_scale=reading.temperature_scale)
        curves = fit_curves(points, surface, None if machine is None else machine.mixed)
    if as_json:
        print_json("fit", fit_document(log, points, surface, curves))
        return
    say(surface.summary())
    say(drag_curves(curves.table))
    say(regime(points, surface).verdict)
    for caution in cautions(points, surface):
        say(f"- {caution}")
