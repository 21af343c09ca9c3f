"""Two logs against each other: ``hersey compare``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from hersey.cli.groups import argument, grouped
from hersey.cli.options import AsJson, Reading
from hersey.cli.outputs import show
from hersey.cli.progress import working


@grouped
def compare(
    a: Annotated[Path, argument("A", "Log of one lubricant, age or unit.")],
    b: Annotated[Path, argument("B", "Log of the other; read in the same way.")],
    *,
    reading: Reading,
    as_json: AsJson = False,
) -> None:
    """Compare two lubricants, ages or units: ratio of damping, change of exponents and of the transition.

    Example: [bold]hersey compare examples/bench.csv examples/bench.csv --tare standing[/bold]

    Both logs are read by the same options; a log against itself shows how small a difference could be seen.
    """
    from hersey.damping.compare import compare as compared

    of_a, of_b = (reading.points_of([path]) for path in (a, b))
    with working("comparing"):
        comparison = compared(of_a, of_b, names=(str(a), str(b)))
    show(comparison, as_json)
