"""How many motions are worked out: how exactly, and by whom."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from hersey.motion.parameters import MOST_STEPS
from hersey.units import takes_si

if TYPE_CHECKING:
    from distributed import Client

    from hersey.scale.local import LocalWorkers


@takes_si()
@dataclass(frozen=True)
class Work:
    """How a sweep is computed.

    Parameters
    ----------
    tolerance
        Relative tolerance of the steps. Default: that of the function.
    most_steps
        Limit of work per motion, as for `hersey.simulate`; a motion that exceeds it is among the failures.
    threads
        Number of threads. The result is identical for any number.
    client
        A ``distributed.Client``, or the address of a scheduler, whose workers compute the chunks. The result
        is identical on processors and systems of the same kind.
    chunk
        Sets per chunk. Default: as many as take a second or two.
    progress
        Called with (done, total) about twenty times a second; an exception ends the sweep.

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
        """Return the tolerance, or ``usual`` if none is set."""
        return usual if self.tolerance is None else float(self.tolerance)


#: What to write for a setting of a sweep that is no argument of its own.
HELD = {each.name: f"work=Work({each.name}=...)" for each in fields(Work)} | {
    name: f"out=SweepFolder(..., {name}=...)" for name in ("resume", "overwrite")
}
#: One thread of this process, as exactly as each function does.
ALONE = Work()
