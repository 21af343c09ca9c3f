"""The paper's figures drawn anew: ``hersey figures``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Force,
    Reading,
    reads_logs,
)
from hersey.cli.outputs import may_write_folder, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.machine.machine import Machine
    from hersey.paper_figures import Measured


@reads_logs
def figures(
    reading: Reading,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the figures.")] = Path(
        "figures"
    ),
    machine_file: Annotated[
        Path | None,
        typer.Option("--machine", metavar="TOML", help="Your machine, for Figs. 1, 5, 6 and 8."),
    ] = None,
    log: Annotated[
        list[Path] | None,
        typer.Option("--log", help="Your log, for Figs. 2, 3, 4, 7 and 8; may be given again."),
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Draw the paper's Figs. 1-14 anew and two of our own; say of each claim whether it holds and how well.

    Example: [bold]hersey figures --out figures[/bold]

    Figs. 1-8 are drawn of your machine and log; without both of the example's.
    """
    may_write_folder(out, force, flag="--out")
    if not log and reading != Reading():
        raise ParameterError("options that say how to read a log need --log")

    from hersey import paper_figures as paper

    measured, machine = _given(reading, machine_file, log)
    with working("drawing the drive"):
        of_drive, left_out = paper.drive_figures(measured, machine)
    with working("simulating"):
        drawings = (*of_drive, *paper.all_figures())
    with working("drawing"):
        paper.write(drawings, out, overwrite=force)
    say(*left_out, file=sys.stderr)
    if as_json:
        print_json("figures", json.loads(paper.as_json(drawings)))
        return
    for figure in drawings:
        say(figure.heading)
        for claim in figure.claims:
            say(f"  {claim.verdict.value}: {claim.statement} ({claim.evidence})")
    say(f"figures: {out}")


def _given(
    reading: Reading, machine_file: Path | None, log: list[Path] | None
) -> tuple[Measured | None, Machine | None]:
    """The user's log and machine, or those that ship where neither is given."""
    from hersey.machine.machine import read_machine
    from hersey.paper_figures import Measured, shipped

    if machine_file is None and not log:
        with working("reading the example"):
            return shipped()
    machine = None if machine_file is None else read_machine(machine_file)
    if not log:
        return None, machine
    points = reading.points(reading.log(log, machine), machine)
    with working("fitting the surface"):
        return Measured.of(points, temperature_scale=reading.temperature_scale), machine
