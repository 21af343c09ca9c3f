"""Where the belt runs smoothly: ``hersey map``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, FitFile, Force, Reading, SomeLogs, Traces
from hersey.cli.outputs import may_draw, show
from hersey.cli.progress import working

_OUT = "The picture: .html, .png, .svg or .pdf.  [default: map.html]"


@grouped
def map_(
    machine_file: Annotated[Path, argument("MACHINE", "TOML file of the drivetrain and its limits.")],
    *,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    trace: Traces = None,
    out: Annotated[Path | None, option(_OUT)] = None,
    reading: Reading,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Map where the belt runs smoothly, sticks and slips, or stalls: temperature across, drive speed up.

    Example: [bold]hersey map examples/machine.toml examples/bench.csv --tare standing[/bold]

    With --json the whole map goes to stdout, and a picture is drawn only if --out is given.
    """
    path = out or (None if as_json else Path("map.html"))
    drawing = may_draw(path, force, reading.inputs(machine_file, logs, fit_file, trace), flag="--out")

    from hersey.decision.mapping import map_of
    from hersey.machine.machine import read_machine
    from hersey.stability.operating_map import operating_map

    machine = read_machine(machine_file)
    threads = os.cpu_count() or 1
    surface, drawn = reading.surface_and_posterior(logs, fit_file, machine, trace)
    with working("finding the bands"):
        if drawn is not None:
            found = map_of(drawn, threads=threads)
        else:
            found = operating_map(surface, machine, threads=threads)
    tooltips = path is not None and path.suffix == ".html"
    drawing.draw(found, "drawing the map", tooltips=tooltips)
    show(found, as_json, *(f"- {warning}" for warning in found.warnings), map=path)
