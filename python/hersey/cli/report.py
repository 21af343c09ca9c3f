"""A page from a log: ``hersey report``."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.loading import loading
from hersey.cli.options import AsJson, Figures, Force, Logs, Reading, SaveRecipe, Traces
from hersey.cli.outputs import (
    PAGES,
    command,
    may_save_recipe,
    may_write,
    may_write_folder,
    print_document,
    say_written,
)
from hersey.cli.progress import steps, working
from hersey.cli.terminal import say

if TYPE_CHECKING:
    from hersey.study import Study

_MACHINE = "Drivetrain of the machine, for the simulation."
_AGAINST = "An earlier log, read alike, to compare this one with; again for each further file of it."


@grouped
def report(
    logs: Logs,
    *,
    out: Annotated[Path | None, option("The page to write, .html.  [default: report.html]")] = None,
    figures: Figures = None,
    machine_file: Annotated[Path | None, option(_MACHINE, "--machine", metavar="TOML")] = None,
    against: Annotated[list[Path] | None, option(_AGAINST, metavar="LOG")] = None,
    trace: Traces = None,
    save_recipe: SaveRecipe = None,
    reading: Reading,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Write a report: regime, damping surface, data quality and a stick-slip simulation, in one HTML page.

    Example: [bold]hersey report examples/bench.csv --machine examples/machine.toml --tare standing[/bold]

    With --json the analysis document goes to stdout, and a page is written only if --out is given.
    """
    page = out or (None if as_json else Path("report.html"))
    inputs = reading.inputs(logs, machine_file, against, trace)
    written = may_write(page, force, inputs, ends=PAGES)
    kept = may_save_recipe(save_recipe, force, inputs)
    may_write_folder(figures, force)

    with loading():
        from hersey.document.assembly import document_of
        from hersey.report.page import render

    found = _studied(logs, reading, machine_file, against, trace)
    document = document_of(found, command=command(), made=datetime.now(UTC).isoformat(timespec="seconds"))
    if page is not None:
        with working("drawing the page"):
            written.write(render(document))
    if save_recipe is not None:
        kept.write(reading.recipe(logs).toml(save_recipe.parent))
    if figures is not None:
        from hersey.charts.analysis import write_figures

        with working("writing the figures"):
            write_figures(document, figures, overwrite=force)
    if as_json:
        print_document(document)
        return
    say(*found.summary().splitlines())
    say_written(report=page, recipe=save_recipe)


def _studied(
    logs: list[Path],
    reading: Reading,
    machine_file: Path | None,
    against: list[Path] | None,
    trace: list[Path] | None,
) -> Study:
    """Everything for one log and one machine."""
    from hersey.machine.machine import read_machine
    from hersey.study import study

    machine = None if machine_file is None else read_machine(machine_file)
    log = reading.log(logs, machine)
    other = reading.points_of(against, machine) if against else None
    traces = [reading.trace(path, machine) for path in trace or []]
    with steps() as step:
        step("finding the dwells")
        points = reading.points(logs, log, machine)
        return study(
            points,
            machine,
            against=other,
            traces=traces,
            temperature_scale=reading.temperature_scale,
            machine_file=machine_file,
            step=step,
        )
