"""The damping surface of a log: ``hersey fit``."""

from __future__ import annotations

from hersey.cli.options import (
    AsJson,
    Logs,
    Reading,
    reads_logs,
)
from hersey.cli.outputs import print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say


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

    from hersey.damping.fit import fit as fitted
    from hersey.document.assembly import fit_document
    from hersey.verdict.cautions import cautions
    from hersey.verdict.regime import regime

    with working("fitting the surface"):
        points = reading.points(log)
        surface = fitted(points, temperature_scale=reading.temperature_scale)
    if as_json:
        print_json("fit", fit_document(log, points, surface))
        return
    say(surface.summary())
    say(regime(points, surface).verdict)
    for caution in cautions(points, surface):
        say(f"- {caution}")
