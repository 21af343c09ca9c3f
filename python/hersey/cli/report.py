"""A page from a log: ``hersey report``."""

from __future__ import annotations

from contextlib import nullcontext
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.loading import loading
from hersey.cli.options import Figures, Force, Logs, Reading, SaveRecipe, Traces
from hersey.cli.outputs import PAGES, command, may_save_recipe, may_write, may_write_folder, print_document
from hersey.cli.printing import Printing
from hersey.cli.progress import steps, working
from hersey.errors import sentence

if TYPE_CHECKING:
    from hersey.study import Study
    from hersey.study.first_screen.result import DecisionPart

#: Section of the page whose finding is printed with the decision.
_COMPARED = "compare"
_MACHINE = "Machine file, for safe speeds, the operating map and start-up profiles."
_AGAINST = "Compare with an earlier log, read with the same options; repeat for more files."


@grouped
def report(
    logs: Logs,
    *,
    out: Annotated[Path | None, option("Write the page here, .html.  [default: report.html]")] = None,
    figures: Figures = None,
    machine_file: Annotated[Path | None, option(_MACHINE, "--machine", metavar="TOML")] = None,
    against: Annotated[list[Path] | None, option(_AGAINST, metavar="LOG")] = None,
    trace: Traces = None,
    save_recipe: SaveRecipe = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Write the report of a log as one HTML page, and print its decision.

    Example: [bold]hersey report examples/bench.csv --machine examples/machine.toml --tare standing[/bold]

    With --json the whole document is printed instead, and a page is written only if --out is given.
    """
    page = out or (None if printing.as_json else Path("report.html"))
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
    if printing.as_json:
        print_document(document)
        return
    _print(found, printing)
    printing.files(page, save_recipe, figures)


def _print(found: Study, printing: Printing) -> None:
    """Print the decision, the comparison, and the warnings; with --verbose all that is behind them."""
    decision = found.decision
    printing.text(*_decision(decision))
    judged = {each.point.name for each in found.behaviour.points} if found.behaviour is not None else set()
    points = [each for each in decision.points if printing.verbose or each.name not in judged]
    printing.text(*(f"{each.name}: {sentence(each.words)}" for each in points))
    if found.comparison is not None:
        printing.text(f"Compared with {found.comparison.names[0]}: {found.comparison.verdict}")
    flags = [flag for flag in decision.flags if flag.where != _COMPARED]
    printing.text(*(f"- {flag.title}: {flag.text}" for flag in printing.chosen(flags)))
    if printing.verbose:
        said = {flag.text for flag in flags}
        printing.warnings(*(each for each in found.warnings if not {each.text, str(each)} & said))
        printing.text("", *found.verdict, "", found.surface.summary())


def _decision(decision: DecisionPart) -> list[str]:
    """The instruction, the interval behind it, and what to do next."""
    behind = " ".join(filter(None, (decision.interval, decision.otherwise)))
    return [*filter(None, (decision.instruction, behind, decision.next))]


def _studied(
    logs: list[Path],
    reading: Reading,
    machine_file: Path | None,
    against: list[Path] | None,
    trace: list[Path] | None,
) -> Study:
    """The study of a log and a machine."""
    from hersey.machine.machine import read_machine
    from hersey.study import study

    machine = None if machine_file is None else read_machine(machine_file)
    alone = partial(reading.one_of_several, logs, against) if against else nullcontext
    with alone():
        log = reading.log(logs, machine)
    other = reading.points_of(against, machine, logs) if against else None
    traces = [reading.trace(path, machine) for path in trace or []]
    with steps() as step:
        step("finding the dwells")
        with alone():
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
