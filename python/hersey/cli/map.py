"""Where the drive runs smoothly: ``hersey map``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.loading import loading
from hersey.cli.options import FitFile, Force, Reading, SomeLogs, Traces
from hersey.cli.outputs import may_draw
from hersey.cli.printing import Printing
from hersey.cli.progress import working

if TYPE_CHECKING:
    from hersey.stability.operating_map import OperatingMap

_MACHINE = "Machine file with drivetrain and limits."
_OUT = "Draw the map here (.html, .png, .svg or .pdf).  [default: map.html]"
#: Temperatures of the table.
_ROWS = 5


@grouped
def map_(
    machine_file: Annotated[Path, argument("MACHINE", _MACHINE)],
    *,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    trace: Traces = None,
    out: Annotated[Path | None, option(_OUT)] = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Map over temperature and speed where the drive runs smoothly, sticks or stalls.

    Example: [bold]hersey map examples/machine.toml examples/bench.csv --tare standing[/bold]

    With --json the whole map is printed, and drawn only if --out is given.
    """
    path = out or (None if printing.as_json else Path("map.html"))
    drawing = may_draw(path, force, reading.inputs(machine_file, logs, fit_file, trace), flag="--out")

    with loading():
        from hersey.decision.mapping import map_of
        from hersey.machine.machine import read_machine
        from hersey.stability.operating_map import operating_map

    machine = read_machine(machine_file)
    threads = os.cpu_count() or 1
    surface, drawn = reading.surface_and_posterior(logs, fit_file, machine, trace, machine_file=machine_file)
    with working("computing the map"):
        if drawn is not None:
            found = map_of(drawn, threads=threads)
        else:
            found = operating_map(surface, machine, threads=threads)
    tooltips = path is not None and path.suffix == ".html"
    drawing.draw(found, "drawing the map", tooltips=tooltips)
    if printing.json(found):
        return
    printing.text(*_points(found), *_table(found))
    printing.details("", found.summary())
    printing.warnings(*found.warnings)
    printing.files(path)


def _points(found: OperatingMap) -> list[str]:
    """What happens at each operating point."""
    from hersey.cli.figures import three
    from hersey.units import celsius

    lines = []
    for point in found.points:
        at = "" if found.temperature is None else f", {celsius(point.temperature):.0f} °C"
        where = f"{three(1e3 * point.speed, 'mm/s')}{at}, {three(1e3 * point.at.torque, 'mN·m')}"
        lines.append(f"{point.name} ({where}): {point.verdict()}")
    return [*lines, ""] if lines else []


def _table(found: OperatingMap) -> list[str]:
    """The speeds that divide the behaviour, at a few temperatures within the log."""
    import numpy as np

    from hersey.cli.figures import columns, three, within
    from hersey.units import celsius

    at = list(range(found.lower.size))
    if found.temperature is not None and found.measured_temperature is not None:
        wanted = np.searchsorted(found.temperature, np.linspace(*found.measured_temperature, _ROWS))
        at = np.unique(wanted.clip(0, found.lower.size - 1)).tolist()
    rows = []
    for i in at:
        kelvin = found.temperature
        ends = (found.transition, found.transition_interval), (found.upper, found.upper_interval)
        intervals = [within((v[i], *limits[:, i]), factor=1e3) for v, limits in ends]
        first = "all" if kelvin is None else f"{celsius(float(kelvin[i])):.0f} °C"
        sticks, stalls = (three(1e3 * float(each[i])) for each in (found.lower, found.stall_above))
        stalls = "not known" if found.torque_limit is None else "never" if stalls == "infinite" else stalls
        rows.append((first, sticks, *intervals, stalls))
    head = ("", "sticks below", "least torque", "smooth above (V*)", "stalls above")
    return [*columns(head, rows), "  speeds in mm/s, 95 % intervals in brackets"]
