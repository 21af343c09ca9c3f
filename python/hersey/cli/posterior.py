"""V* and the drive's parameters from dwells, starts and stick-slip together: ``hersey posterior``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import Force, Logs, Reading, Traces
from hersey.cli.outputs import may_write
from hersey.cli.printing import Printing
from hersey.cli.progress import bar
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.posterior.result import Posterior

#: Units in which the numbers of a drive are printed, and how many make one in SI.
_SHOWN = {"stick_speed": ("mm/s", 1e3), "stiffness": ("N/mm", 1e-3), "mass": ("kg", 1.0)}
#: Steps of the progress bar.
_STEPS = 100
_MACHINE = "Machine file with drivetrain and limits."


@grouped
def posterior(
    logs: Logs,
    *,
    machine_file: Annotated[Path, option(_MACHINE, "--machine", metavar="TOML")],
    trace: Traces = None,
    draws: Annotated[int, option("Number of draws.")] = 4000,
    seed: Annotated[int, option("Random seed.")] = 1,
    out: Annotated[Path | None, option("Write one row per draw (.csv, .parquet or .nc).")] = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Estimate V*, stick speed, stiffness, mass and closure from log and machine file.

    Example: [bold]hersey posterior examples/bench.csv --machine examples/machine.toml --tare standing[/bold]
    """
    table = may_write(out, force, reading.inputs(logs, machine_file, trace), ends=[*TABLES, ".nc"])

    from hersey.damping.curves import fit_curves
    from hersey.damping.fit import fit
    from hersey.machine.machine import read_machine
    from hersey.posterior.sampling import posterior as drawn

    machine = read_machine(machine_file)
    log = reading.log(logs, machine)
    traces = [reading.trace(path, machine) for path in trace or []]
    points = reading.points(logs, log, machine)
    surface = fit(points)
    curves = fit_curves(points, surface, machine.mixed)
    with bar("drawing", "%") as progress:
        found = drawn(
            points,
            machine,
            surface=surface,
            curves=curves,
            traces=traces,
            draws=draws,
            seed=seed,
            progress=lambda share: progress(round(_STEPS * share), _STEPS),
            threads=os.cpu_count() or 1,
        )
    if out is not None:
        table.write(_content(found, out))
    if printing.json(found):
        return
    printing.text(*_lines(found))
    printing.details("", found.summary())
    printing.files(out)


def _lines(found: Posterior) -> list[str]:
    """V*, the safe speed, and the numbers of the drive."""
    from hersey.cli.figures import labelled, three, within
    from hersey.units import celsius

    kelvin = found.temperature
    where = "" if kelvin is None else f" at {celsius(kelvin):.0f} °C"
    fold = within(found.fold_interval(kelvin), "mm/s", factor=1e3)
    safe = three(1e3 * found.safe_speed(kelvin), "mm/s")
    lines = [f"V*{where}: {fold} (95 %). Smooth from any start above {safe} (97.5 %)."]
    if not found.convergence.converged:
        lines.append("The draws have not converged: use more with --draws.")
    closures = sorted(found.closures().items(), key=lambda each: -each[1])
    rows = [
        ("closure", ", ".join(f"{name} {100 * share:.0f} %" for name, share in closures if share >= 0.005))
    ]
    for name, values in found.intervals().items():
        unit, factor = _SHOWN.get(name, ("", 1.0))
        estimated = " (estimated)" if name == "stick_speed" else ""  # beside the value of the machine file
        rows.append((f"{name.replace('_', ' ')}{estimated}", within(values, unit, factor=factor)))
    return [*lines, *labelled(rows)]


def _content(found: Posterior, out: Path) -> bytes:
    """A row per draw, or with ``.nc`` what ArviZ reads."""
    from tempfile import TemporaryDirectory

    from hersey.files.tables import table

    if out.suffix in TABLES:
        return table(found.to_frame(), out.suffix)
    with TemporaryDirectory() as folder:
        netcdf = Path(folder) / out.name
        found.dataset().to_netcdf(netcdf, engine="scipy")
        return netcdf.read_bytes()
