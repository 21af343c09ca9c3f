"""Laws against each other: ``hersey models``."""

from __future__ import annotations

from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Logs,
    Reading,
    reads_logs,
)
from hersey.cli.outputs import print_json
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say


@reads_logs
def models(
    logs: Logs,
    reading: Reading,
    bootstrap: Annotated[
        int, typer.Option("--bootstrap", help="Resampled fits for that interval; 0 leaves it out.", min=0)
    ] = 300,
    seed: Annotated[int, typer.Option("--seed", help="Of the resampling.", min=0)] = 1,
    as_json: AsJson = False,
) -> None:
    """Fit every candidate law to the same dwells, choose one, and say why; energies and Hersey collapse.

    Example: [bold]hersey models examples/bench.csv --tare standing[/bold]
    """
    log = reading.log(logs)

    from hersey.damping.candidates import compare_models

    with working("reducing to dwells"):
        points = reading.points(log)
    with bar("fitting", unit="candidates") as progress:
        comparison = compare_models(points, bootstrap=bootstrap, seed=seed, progress=progress)
    if as_json:
        print_json("models", comparison.to_dict())
        return
    say(comparison.summary())
