"""The damping of two logs compared: ``hersey compare``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped
from hersey.cli.options import Reading
from hersey.cli.printing import Printing
from hersey.cli.progress import working

if TYPE_CHECKING:
    from hersey.damping.compare import Change, LogComparison


@grouped
def compare(
    a: Annotated[Path, argument("A", "Log of one lubricant, age or specimen.")],
    b: Annotated[Path, argument("B", "Log of the other, read with the same options.")],
    *,
    reading: Reading,
    printing: Printing,
) -> None:
    """Compare the damping of two logs: of two lubricants, ages or specimens.

    Example: [bold]hersey compare examples/bench.csv examples/bench.csv --tare standing[/bold]

    Compare a log with itself to see how small a difference could be detected.
    """
    from hersey.damping.compare import compare as compared

    of_a, of_b = (reading.points_of([log], others=[other]) for log, other in ((a, b), (b, a)))
    with working("comparing"):
        comparison = compared(of_a, of_b, names=(str(a), str(b)))
    if printing.json(comparison):
        return
    printing.conclusion(lambda: _lines(comparison), comparison.summary(), *comparison.warnings)


def _lines(found: LogComparison) -> list[str]:
    """The verdict, the mean ratio of damping, and what else the law has, with its change."""
    from hersey.cli.figures import columns, within

    mean = found.mean_ratio
    lines = [
        found.verdict,
        f"Damping of B over A, mean: {within((mean.value, mean.low, mean.high))} (95 %)",
        "",
    ]
    rows = [_row(change) for change in found.changes]
    head = ("", "A", "B", "change, 95 %", "p")
    return [*lines, *columns(head, rows), f"  A: {found.a}", f"  B: {found.b}"]


def _row(change: Change) -> tuple[str, ...]:
    """A quantity of both laws, and how it changes: a ratio for a speed, else a difference."""
    from hersey.cli.figures import three, within
    from hersey.units import rpm

    moved = within((change.change.value, change.change.low, change.change.high))
    p = f"{change.p_value:.2g}"
    if change.is_ratio:
        speeds = (three(float(rpm(each)), "rpm") for each in (change.of_a, change.of_b))
        return (change.name, *speeds, f"x {moved}", p)
    return (change.name, three(change.of_a), three(change.of_b), f"{moved}", p)
