"""A page from a log: ``hersey report``."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.loading import loading
from hersey.cli.options import (
    AsJson,
    Force,
    Logs,
    MachineFile,
    Reading,
    Traces,
    reads_logs,
)
from hersey.cli.outputs import PAGES, command, may_write, may_write_folder, print_document
from hersey.cli.progress import steps, working
from hersey.cli.terminal import say


@reads_logs
def report(
    logs: Logs,
    reading: Reading,
    out: Annotated[
        Path | None, typer.Option("--out", help="The page to write, .html.  [default: report.html]")
    ] = None,
    figures: Annotated[
        Path | None,
        typer.Option("--figures", metavar="DIR", help="Also write each chart as SVG, PNG and PDF."),
    ] = None,
    machine_file: MachineFile = None,
    against: Annotated[
        list[Path] | None,
        typer.Option(
            "--against",
            metavar="LOG",
            help="An earlier log, read alike, to compare this one with; again for each further file of it.",
        ),
    ] = None,
    trace: Traces = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Write a report: regime, damping surface, data quality and a stick-slip simulation, in one HTML page.

    Example: [bold]hersey report examples/bench.csv --machine examples/machine.toml --tare standing[/bold]

    With --json the analysis document goes to stdout, and a page is written only if --out is given.
    """
    page = out or (None if as_json else Path("report.html"))
    overwrite = False
    if page is not None:
        inputs = reading.inputs(logs, machine_file, [*(against or []), *(trace or [])])
        overwrite = may_write(page, force, inputs, ends=PAGES)
    if figures is not None:
        may_write_folder(figures, force)

    with loading():
        from hersey.document.assembly import document_of
        from hersey.files.writing import write_atomically
        from hersey.machine.machine import read_machine
        from hersey.report.page import render
        from hersey.study import study

    machine = None if machine_file is None else read_machine(machine_file)
    log = reading.log(logs, machine)
    other = reading.points_of(against, machine) if against else None
    traces = [reading.trace(path, machine) for path in trace or []]
    with steps() as step:
        step("finding the dwells")
        points = reading.points(log, machine)
        found = study(
            points,
            machine,
            against=other,
            traces=traces,
            temperature_scale=reading.temperature_scale,
            machine_file=machine_file,
            step=step,
        )
    document = document_of(found, command=command(), made=datetime.now(UTC).isoformat(timespec="seconds"))
    if page is not None:
        with working("drawing the page"):
            write_atomically(page, render(document), overwrite=overwrite)
    if figures is not None:
        from hersey.charts.analysis import write_figures

        with working("writing the figures"):
            write_figures(document, figures, overwrite=force)
    if as_json:
        print_document(document)
        return
    say(*found.summary().splitlines())
    say(f"report: {page}")
