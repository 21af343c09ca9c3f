"""From a log: ``hersey report`` and ``hersey fit``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import AsJson, Force, Logs, Reading, reads_logs
from hersey.cli.shell import app, command, may_write, may_write_folder, working

FuserFile = Annotated[
    Path | None,
    typer.Option("--fuser", metavar="TOML", help="Drivetrain of the machine, for the simulation."),
]


@app.command()
@reads_logs
def report(
    logs: Logs,
    reading: Reading,
    out: Annotated[
        Path | None, typer.Option("--out", help="The page to write.  [default: report.html]")
    ] = None,
    figures: Annotated[
        Path | None,
        typer.Option("--figures", metavar="DIR", help="Also write each chart as SVG, PNG and PDF."),
    ] = None,
    fuser: FuserFile = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Write a report: regime, damping surface, data quality and a stick-slip simulation, in one HTML page.

    Example: [bold]hersey report examples/bench.csv --fuser examples/fuser.toml --tare standing[/bold]

    With --json the analysis document goes to stdout, and a page is written only if --out is given.
    """
    from hersey.analysis import analyse
    from hersey.fuser import read_fuser
    from hersey.report import render, write_atomically

    page = out or (None if as_json else Path("report.html"))
    if page is not None:
        may_write(page, force, inputs=[*logs, *([fuser] if fuser else [])])
    if figures is not None:
        may_write_folder(figures, force)
    machine = None if fuser is None else read_fuser(fuser)
    log = reading.log(logs)
    with working("fitting the surface"):
        points = reading.points(log)
        document = analyse(
            log, points, command=command(), temperature_scale=reading.temperature_scale, fuser=machine
        )
    if page is not None:
        with working("drawing the page"):
            write_atomically(page, render(document), overwrite=True)
    if figures is not None:
        from hersey.charts import write_figures

        with working("writing the figures"):
            write_figures(document, figures)
    if as_json:
        print(document.model_dump_json(indent=1))
        return
    print(document.regime.verdict)
    for warning in document.warnings:
        print(f"- {warning}")
    print(document.fit.summary)
    print(f"report: {page}")


@app.command()
@reads_logs
def fit(
    logs: Logs,
    reading: Reading,
    as_json: AsJson = False,
) -> None:
    """Fit the damping surface B = a T^b w^c and print it, with the verdict on the regime.

    Example: [bold]hersey fit examples/bench.csv --tare standing[/bold]
    """
    from hersey.analysis import analyse

    log = reading.log(logs)
    with working("fitting the surface"):
        points = reading.points(log)
        document = analyse(log, points, command=command(), temperature_scale=reading.temperature_scale)
    if as_json:
        chosen = document.model_dump(
            mode="json", include={"fit", "regime", "points", "files", "hersey_version", "command"}
        )
        print(json.dumps(chosen, indent=1))
        return
    print(document.fit.summary)
    print(document.regime.verdict)
