"""What hersey says of logs of an independent generator: intervals, verdicts, transitions.

Every log is written by the generator in ``benchmarks/independent``, which shares no code with the virtual
test stand, and read as a user's would be. The parts and what counts as true stand in its modules. The same
seed gives the same logs, whoever works and whichever settings are chosen.

Usage: python -m benchmarks.coverage [--part generator|coverage|verdicts|transitions]
[--settings 'plain,visit5*'] [--logs 200] [--workers 2] [--scheduler ADDRESS] [--seed 1]
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from fnmatch import fnmatch
from functools import partial
from typing import Any, NamedTuple

from benchmarks.independent import intervals, own, transitions, verdicts
from benchmarks.working import takes_workers, worked

#: Results between two lines of progress.
_TOLD_EVERY = 20


class Part(NamedTuple):
    """A part: its settings, how one log of one is judged, how all are told, and how many logs by default."""

    title: str
    names: tuple[str, ...]
    one_log: Callable[[int, str, int], Any]
    table: Callable[[dict[str, list[Any]]], list[str]]
    logs: Callable[[str, int | None], int]


def _logs_of_transitions(name: str, asked: int | None) -> int:
    """As many as asked of each kind without a transition, and as a share of those with one."""
    asked = transitions.LOGS if asked is None else asked
    with_one = max(1, round(asked * transitions.LOGS_WITH / transitions.LOGS))
    return with_one if name.startswith("with") else asked


PARTS = {
    "generator": Part(
        "The generator by itself",
        own.NAMES,
        own.one_log,
        own.table,
        lambda name, asked: asked or own.LOGS,
    ),
    "coverage": Part(
        "Coverage of 95 % intervals",
        intervals.NAMES,
        intervals.one_log,
        intervals.table,
        lambda name, asked: asked or 200,
    ),
    "verdicts": Part(
        "Regimes named",
        verdicts.NAMES,
        verdicts.one_log,
        verdicts.table,
        lambda name, asked: asked or verdicts.LOGS,
    ),
    "transitions": Part(
        "Transitions",
        transitions.NAMES,
        transitions.one_log,
        transitions.table,
        _logs_of_transitions,
    ),
}


def _run(seed: int, log: tuple[str, str, int]) -> Any:
    part, name, index = log
    return PARTS[part].one_log(seed, name, index)


def _chosen(part: Part, patterns: str) -> tuple[str, ...]:
    wanted = patterns.split(",")
    return tuple(n for n in part.names if any(fnmatch(n, p) for p in wanted))


class _Progress:
    """How many logs of all are judged, on the terminal's second channel."""

    def __init__(self, total: int) -> None:
        self.total, self.done, self.began = total, 0, time.perf_counter()

    def one_more(self, name: str) -> None:
        """Count one; tell now and then."""
        self.done += 1
        if self.done % _TOLD_EVERY == 0 or self.done == self.total:
            spent = time.perf_counter() - self.began
            left = spent / self.done * (self.total - self.done)
            print(
                f"{self.done} of {self.total} logs, {left:.0f} s left ({name})", file=sys.stderr, flush=True
            )


def main() -> int:
    """Judge all logs asked for and print the tables; after Ctrl-C those of the logs that are done."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--part", choices=PARTS, action="append", help="one part; may be repeated")
    parser.add_argument("--settings", default="*", help="names or patterns, with commas")
    parser.add_argument("--logs", type=int, help="of each setting")
    takes_workers(parser)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    tasks = [
        (label, name, i)
        for label in given.part or PARTS
        for name in _chosen(PARTS[label], given.settings)
        for i in range(PARTS[label].logs(name, given.logs))
    ]
    if not tasks:
        parser.error(f"no setting is called {given.settings}")
    results, whole = _judge(tasks, worked(partial(_run, given.seed), tasks, given))
    for label, rows in results.items():
        print(f"\n## {PARTS[label].title}\n\nseed {given.seed}\n", *PARTS[label].table(rows), sep="\n")
    return 0 if whole else 130


def _judge(
    tasks: list[tuple[str, str, int]], found: Iterator[Any]
) -> tuple[dict[str, dict[str, list[Any]]], bool]:
    """Return results by part and setting, and whether they are all."""
    results: dict[str, dict[str, list[Any]]] = {}
    progress = _Progress(len(tasks))
    try:
        for (part, name, _), result in zip(tasks, found, strict=True):
            results.setdefault(part, {}).setdefault(name, []).append(result)
            progress.one_more(name)
    except KeyboardInterrupt:
        print("interrupted: what follows holds the logs judged so far", file=sys.stderr)
        return results, False
    return results, True


if __name__ == "__main__":
    sys.exit(main())
