"""Whether the decisions of a report hold on the machine that it is about.

True machines are drawn, their logs written, `hersey report --json` is asked about each, and what it says is
tried on the true machine. The same seed gives the same machines.

Usage: python -m benchmarks.decisions [--machines 40] [--seed 1] [--first 0] [--keep FOLDER] [--workers 2]
[--evidence dwells|stick-slip|starts|mixed] [--closure retained|stiction|mixed] [--shape NAME]
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from benchmarks.decisions.belt import CLOSURES
from benchmarks.decisions.curves import FAMILIES
from benchmarks.decisions.judged import Judged, draw_and_judge
from benchmarks.decisions.machines import EVIDENCE, Kind
from benchmarks.decisions.table import lines


def main() -> int:
    """Judge as many machines as asked for, and print the table."""
    given = _parser().parse_args()
    results, began = list[Judged](), time.perf_counter()
    try:
        for result in _results(given):
            results.append(result)
            spent = time.perf_counter() - began
            print(f"{result.number} after {spent:.0f} s: {result.fault or result.said}", file=sys.stderr)
            print(*result.wrong, sep="\n", end="\n" * bool(result.wrong), file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        print("interrupted: the table holds the machines judged so far", file=sys.stderr)
    chosen = f"evidence {given.evidence}, closure {given.closure}, shape {given.shape}"
    print(f"\nseed {given.seed}, {len(results)} machines, {chosen}\n", *lines(results), sep="\n")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--machines", type=int, default=40, help="how many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first machine")
    parser.add_argument("--keep", type=Path, help="folder for logs, machine files and documents")
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    parser.add_argument("--evidence", choices=[*EVIDENCE, "mixed"], default="mixed")
    parser.add_argument("--closure", choices=[*CLOSURES, "mixed"], default="mixed")
    parser.add_argument("--shape", choices=[*FAMILIES, "mixed"], default="mixed")
    return parser


def _results(given: argparse.Namespace) -> Iterator[Judged]:
    """Yield the results of the machines, in the order of their numbers."""
    keep = given.keep and given.keep.absolute()
    task = partial(draw_and_judge, given.seed, Kind(given.evidence, given.closure, given.shape), keep)
    numbers = range(given.first, given.first + given.machines)
    if given.workers == 1:
        yield from map(task, numbers)
        return
    fresh = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(given.workers, mp_context=fresh) as pool:
        try:
            yield from pool.map(task, numbers)
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            raise


if __name__ == "__main__":
    sys.exit(main())
