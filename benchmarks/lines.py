"""A line of the table of all ratios: a work and its time, its peer in the same run, and what is asked."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

HEAD = ["work", "hersey", "peer", "its time", "ratio", "asked", "met", "error or memory"]


@dataclass(frozen=True)
class Line:
    """A work and its peer, in seconds, and what is asked of it.

    One of three may be asked: to be ``faster`` than the peer so many times at least, to take at most
    ``slower`` times its time, or a ``limit`` in seconds. ``beside`` is its error or its memory.
    """

    work: str
    seconds: float
    peer: str = ""
    peer_seconds: float = math.nan
    faster: float | None = None
    slower: float | None = None
    limit: float | None = None
    beside: str = ""

    @property
    def is_met(self) -> bool | None:
        """Whether the demand is met; nothing where none is made."""
        if self.faster is not None:
            return self.peer_seconds >= self.faster * self.seconds
        most = self.limit if self.slower is None else self.slower * self.peer_seconds
        return None if most is None else self.seconds <= most

    def cells(self) -> list[str]:
        """Return the cells of its row."""
        ratio = asked = ""
        if self.peer:
            fast, slow = self.peer_seconds / self.seconds, self.seconds / self.peer_seconds
            longer = self.slower is not None or (self.faster is None and slow > 1.0)
            ratio = f"{slow:.2f} x its time" if longer else f"{fast:.3g} x as fast"
        if self.faster is not None:
            asked = f"at least {self.faster:g} x"
        elif self.slower is not None:
            asked = f"at most {self.slower:g} x"
        elif self.limit is not None:
            asked = f"at most {self.limit:g} s"
        theirs = shown(self.peer_seconds) if self.peer else ""
        met = {True: "yes", False: "no", None: ""}[self.is_met]
        return [self.work, shown(self.seconds), self.peer, theirs, ratio, asked, met, self.beside]


def shown(seconds: float) -> str:
    """Return a time with three figures."""
    return f"{1e3 * seconds:.3g} ms" if seconds < 0.1 else f"{seconds:.3g} s"


def table(lines: Iterable[Line]) -> list[str]:
    """Return the lines as rows of Markdown."""
    rows = [HEAD, ["---"] * len(HEAD), *(line.cells() for line in lines)]
    return [f"| {' | '.join(row)} |" for row in rows]


def timed(call: Callable[[], Any], repeats: int = 1) -> float:
    """Return the wall time of a call, s, the mean of several."""
    begin = time.perf_counter()
    for _ in range(repeats):
        call()
    return (time.perf_counter() - begin) / repeats


def in_turn(works: dict[str, Callable[[], float]], runs: int) -> dict[str, float]:
    """Return the median of what each work returns, all run in turn."""
    found: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(runs):
        for name, work in works.items():
            found[name].append(work())
    return {name: statistics.median(times) for name, times in found.items()}
