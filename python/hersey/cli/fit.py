"""The damping surface of a log: ``hersey fit``."""

from __future__ import annotations

import json

from hersey.cli.options import (
    AsJson,
    Logs,
    Reading,
    reads_logs,
)
from hersey.cli.outputs import command
from hersey.cli.progress import working


@reads_logs
def fit(
    logs: Logs,
    reading: Reading,
    as_json: AsJson = False,
) -> None:
    """Fit the damping surface B = a T^b w^c and print it, with the verdict on the regime.

    Example: [bold]hersey fit examples/bench.csv --tare standing[/bold]
    """
    log = reading.log(logs)

    from hersey.document.assembly import analyse

    with working("fitting the surface"):
        points = reading.points(log)
        document = analyse(log, points, command=command(), temperature_scale=reading.temperature_scale)
    if as_json:
        chosen = document.model_dump(
            mode="json", include={"fit", "regime", "points", "files", "hersey_version", "command"}
        )
        print(json.dumps(chosen, indent=1))
        return
    print(document.fit.summary)
    print(document.regime.verdict)
