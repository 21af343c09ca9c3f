"""The damping surface of a log: ``hersey fit``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import AsJson, Force, KeepGoing, Logs, Reading, SensorsFile
from hersey.cli.outputs import may_write, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.cli.workers import Crew
from hersey.errors import ParameterError
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.machine.machine import Machine

_EACH = "Fit each log by itself: a row per log, in a .csv or .parquet."


@grouped
def fit(
    logs: Logs,
    *,
    each: Annotated[Path | None, option(_EACH, metavar="TABLE")] = None,
    machine_file: SensorsFile = None,
    keep_going: KeepGoing = False,
    crew: Crew,
    reading: Reading,
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
    if each is None and (keep_going or force or crew.scheduler or crew.count):
        raise ParameterError("--keep-going, --scheduler, --workers and --force go with --each TABLE")
    machine = None
    if machine_file is not None:
        from hersey.machine.machine import read_machine

        machine = read_machine(machine_file)
    if each is None:
        _fit_one(logs, reading, machine, as_json)
        return
    from hersey.cli.fitting_each import fit_each

    table = may_write(each, force, reading.inputs(logs, machine_file), flag="--each", ends=TABLES)
    fit_each(logs, reading, machine, table, keep_going, crew)


def _fit_one(logs: list[Path], reading: Reading, machine: Machine | None, as_json: bool) -> None:
    """Fit the logs as one."""
    log = reading.log(logs, machine)

    from hersey.damping.curves import fit_curves
    from hersey.damping.curves.words import drag_curves
    from hersey.damping.fit import fit as fitted
    from hersey.document.assembly import fit_document
    from hersey.verdict.regime import regime
    from hersey.verdict.warnings import warnings_of

    with working("fitting the surface"):
        points = reading.points(logs, log, machine)
        surface = fitted(points, temperature_scale=reading.temperature_scale)
        curves = fit_curves(points, surface, None if machine is None else machine.mixed)
    if as_json:
        print_json(fit_document(log, points, surface, curves))
        return
    doubts = [f"- {warning.sentence}" for warning in warnings_of(points, surface)]
    say(surface.summary(), drag_curves(curves.table), regime(points, surface).verdict, *doubts)
