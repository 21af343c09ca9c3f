"""What dwells, starts and stick-slip say together: ``hersey posterior``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import AsJson, Force, Logs, Reading, Traces, reads_logs
from hersey.cli.outputs import may_write, print_json
from hersey.cli.progress import bar
from hersey.cli.terminal import say
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.posterior.result import Posterior

#: Steps of the progress bar.
_STEPS = 100


@reads_logs
def posterior(
    logs: Logs,
    reading: Reading,
    machine_file: Annotated[
        Path, typer.Option("--machine", metavar="FILE", help="TOML file of the drivetrain and its limits.")
    ],
    trace: Traces = None,
    draws: Annotated[int, typer.Option("--draws", help="Number of draws.")] = 4000,
    seed: Annotated[int, typer.Option("--seed", help="Random seed.")] = 1,
    out: Annotated[
        Path | None, typer.Option("--out", help="Also write one row per draw: .csv, .parquet or .nc.")
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Draw V*, stick speed, stiffness, mass and closure from everything that log and machine file show.

    Example: [bold]hersey posterior examples/bench.csv --machine examples/machine.toml --tare standing[/bold]
    """
    overwrite = False
    if out is not None:
        inputs = reading.inputs(logs, machine_file, trace)
        overwrite = may_write(out, force, inputs, ends=[*TABLES, ".nc"])

    from hersey.machine.machine import read_machine
    from hersey.posterior.sampling import posterior as drawn

    machine = read_machine(machine_file)
    log = reading.log(logs, machine)
    traces = [reading.trace(path, machine) for path in trace or []]
    points = reading.points(log, machine)
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
        _write(found, out, overwrite)
    if as_json:
        print_json("posterior", found.to_dict())
        return
    say(found.summary())
    if out is not None:
        say(f"draws: {out}")


def _write(found: Posterior, out: Path, overwrite: bool) -> None:
    """Write a row per draw, or with ``.nc`` what ArviZ reads."""
    from tempfile import TemporaryDirectory

    from hersey.files.tables import table
    from hersey.files.writing import write_atomically

    if out.suffix in TABLES:
        content = table(found.to_frame(), out.suffix)
    else:
        with TemporaryDirectory() as folder:
            netcdf = Path(folder) / out.name
            found.dataset().to_netcdf(netcdf, engine="scipy")
            content = netcdf.read_bytes()
    write_atomically(out, content, overwrite=overwrite)
