"""How many motions are worked out: how exactly, and by whom."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from hersey.motion.parameters import MOST_STEPS

if TYPE_CHECKING:
    from distributed import Client

    from hersey.scale.local import LocalWorkers


@dataclass(frozen=True)
class Work:
    """How a sweep is worked out.

    Parameters
    ----------
    tolerance
        Relative tolerance of the steps; by default that of the function.
    most_steps
        Work that each belt may take, as for `hersey.simulate`; one that does not suffice is among the
        failures.
    threads
        Threads to use. The result is the same, bit for bit, for any number.
    client
        A ``distributed.Client``, or the address of a scheduler: its workers do the work, in chunks. The
        result is the same, bit for bit, on processors and systems of one kind.
    chunk
        Sets of a chunk, where a sweep is cut into some; by default as many as take a second or two.
    progress
        Called with (done, all) some twenty times a second; what it raises ends the sweep.

    Examples
    --------
    >>> Work(threads=2).threads
    2
    """

    tolerance: float | None = None
    most_steps: float = MOST_STEPS
    threads: int = 1
    client: Client | LocalWorkers | str | None = None
    chunk: int | None = None
    progress: Callable[[int, int], object] | None = None

    def within(self, usual: float) -> float:
        """Return the tolerance, ``usual`` where none is stated."""
        return usual if self.tolerance is None else float(self.tolerance)


#: What to write for a setting of a sweep that is no argument of its own.
HELD = {each.name: f"work=Work({each.name}=...)" for each in fields(Work)} | {
    name: f"out=SweepFolder(..., {name}=...)" for name in ("resume", "overwrite")
}
#: One thread of this process, as exactly as each function does.
ALONE = Work()
