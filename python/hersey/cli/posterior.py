"""What dwells, starts and stick-slip say together: ``hersey posterior``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import AsJson, Force, Logs, Reading, Traces
from hersey.cli.outputs import may_write, show
from hersey.cli.progress import bar
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.posterior.result import Posterior

#: Steps of the progress bar.
_STEPS = 100
_MACHINE = "TOML file of the drivetrain and its limits."


@grouped
def posterior(
    logs: Logs,
    *,
    machine_file: Annotated[Path, option(_MACHINE, "--machine", metavar="FILE")],
    trace: Traces = None,
    draws: Annotated[int, option("Number of draws.")] = 4000,
    seed: Annotated[int, option("Random seed.")] = 1,
    out: Annotated[Path | None, option("Also write one row per draw: .csv, .parquet or .nc.")] = None,
    reading: Reading,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Draw V*, stick speed, stiffness, mass and closure from everything that log and machine file show.

    Example: [bold]hersey posterior examples/bench.csv --machine examples/machine.toml --tare standing[/bold]
    """
    table = may_write(out, force, reading.inputs(logs, machine_file, trace), ends=[*TABLES, ".nc"])

    from hersey.machine.machine import read_machine
    from hersey.posterior.sampling import posterior as drawn

    machine = read_machine(machine_file)
    log = reading.log(logs, machine)
    traces = [reading.trace(path, machine) for path in trace or []]
    points = reading.points(logs, log, machine)
    with bar("drawing", "%") as progress:
        found = drawn(
            points,
            machine,
            traces=traces,
            draws=draws,
            seed=seed,
            progress=lambda share: progress(round(_STEPS * share), _STEPS),
            threads=os.cpu_count() or 1,
        )
    if out is not None:
        table.write(_content(found, out))
    show(found, as_json, draws=out)


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
