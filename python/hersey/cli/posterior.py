"""What dwells, starts and stick-slip say together: ``hersey posterior``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import AsJson, Force, Logs, Reading, Traces, reads_logs
from hersey.cli.outputs import may_write, print_json
from hersey.cli.progress import bar
from hersey.cli.terminal import say

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
    from hersey.errors import ParameterError

    if out is not None:
        if out.suffix not in _WRITERS:
            raise ParameterError(f"{out}: write draws to a file that ends in {', '.join(_WRITERS)}")
        may_write(out, force, inputs=reading.inputs(logs, machine_file, trace))

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
        _WRITERS[out.suffix](found, out)
    if as_json:
        print_json("posterior", found.to_dict())
        return
    say(found.summary())
    if out is not None:
        say(f"draws: {out}")


def _table(found: object, out: Path) -> None:
    from hersey.files.writing import write_atomically

    frame = found.to_frame()  # type: ignore[attr-defined]
    if out.suffix == ".csv":
        write_atomically(out, frame.write_csv(), overwrite=True)
    else:
        frame.write_parquet(out)


def _netcdf(found: object, out: Path) -> None:
    found.dataset().to_netcdf(out, engine="scipy")  # type: ignore[attr-defined]


_WRITERS = {".csv": _table, ".parquet": _table, ".nc": _netcdf}
