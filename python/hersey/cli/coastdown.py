"""Friction from coast-downs: ``hersey coastdown``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import Force, Logs, Reading, drawn
from hersey.cli.outputs import may_draw, may_write
from hersey.cli.printing import Printing
from hersey.cli.progress import bar, working
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.coast_down import CoastDown

_POINTS = "Write the torque in windows of speed, for 'hersey fit CSV --means'."
_FIGURE = "the speeds with the fitted curve, and the torque against speed"


@grouped
def coastdown(
    logs: Logs,
    *,
    points: Annotated[Path | None, option(_POINTS, metavar="CSV")] = None,
    figure: Annotated[Path | None, drawn(_FIGURE)] = None,
    force: Force = False,
    reading: Reading,
    printing: Printing,
) -> None:
    """Find the friction torque from coast-downs: speed over time and a moment of inertia.

    Example: [bold]hersey coastdown examples/coast-down.csv --inertia "0.012 kg*m^2 ± 2 %"[/bold]

    No torque is needed. Standstill, run-up and braking are detected and excluded.
    """
    reading.refuse_dwells("a coast-down", "inertia")
    if not reading.inertia:
        raise ParameterError("the moment of inertia is missing: add --inertia '0.012 kg*m^2 ± 2 %'")
    written = may_write(points, force, reading.inputs(logs), flag="--points", ends=[".csv"])
    drawing = may_draw(figure, force, reading.inputs(logs))

    from hersey.damping.coast_down import coast_down
    from hersey.damping.inertia import inertia_of
    from hersey.log import memory_limit

    known = inertia_of(reading.inertia, "--inertia")
    with bar("reading") as progress, memory_limit(reading.max_memory):
        log = replace(reading, inertia="").recipe(logs).speeds(progress=progress)
    with working("fitting the coasts"):
        found = coast_down(log, inertia=known)
    if points is not None:
        written.write(found.table())
    drawing.draw(found, "drawing the coasts")
    if printing.json(found):
        return
    printing.conclusion(lambda: _lines(found), found.summary(), *found.warnings)
    printing.files(points, figure)


def _lines(found: CoastDown) -> list[str]:
    """The torque at three speeds, and the terms."""
    from hersey.cli.figures import columns, within
    from hersey.damping.coast_down.result import NAMES
    from hersey.units import rpm

    largest = float(found.torque.max())
    unit, factor = ("mN m", 1e3) if largest < 1.0 else ("N m", 1.0)
    rows = []
    for i in (found.speeds.size - 1, found.speeds.size // 2, 0):
        torque = within((found.torque[i], found.low[i], found.high[i]), unit, factor=factor)
        rows.append((f"{rpm(float(found.speeds[i])):.3g} rpm", torque))
    lines = [f"{_counted(len(found.coasts))}.", "", *columns(("speed", "friction torque, 95 %"), rows), ""]
    for name, term, own in zip(
        NAMES, (found.coulomb, found.viscous, found.windage), _units(unit), strict=True
    ):
        value = within((term.value, term.low, term.high), own, factor=factor)
        most = within((term.high,) * 3, own, factor=factor).split(" [")[0]
        lines.append(f"{name}: {value}" if term.low > 0 else f"{name}: not shown, at most {most} {own}")
    return lines


def _units(torque: str) -> tuple[str, str, str]:
    """Units of the terms."""
    return torque, f"{torque} s/rad", f"{torque} s^2/rad^2"


def _counted(coasts: int) -> str:
    return f"{coasts} coast-down{'s' if coasts > 1 else ''} found"
