"""Whether what the first screen of a report says of a machine holds on the machine.

Machines of a truth of their own are drawn, their logs written, `hersey report --json` asked of each, and what
it says is tried on the true machine. The same seed gives the same machines.

Usage: python -m benchmarks.decisions [--machines 40] [--seed 1] [--first 0] [--keep FOLDER]
[--workers 2] [--scheduler ADDRESS]
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time
from collections import Counter
from functools import partial
from pathlib import Path

from benchmarks.decisions.judged import Judged, judged
from benchmarks.decisions.machines import drawn
from benchmarks.working import takes_workers, worked

#: Letters of an instruction that tell it from others.
_FIRST = 28


def main() -> int:
    """Judge as many machines as asked for, and print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--machines", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--keep", type=Path, help="where logs, machine files and documents are left")
    takes_workers(parser)
    given = parser.parse_args()
    results, began = [], time.perf_counter()
    numbers = range(given.first, given.first + given.machines)
    task = partial(_one, given.seed, given.keep and given.keep.absolute())
    try:
        for last in worked(task, numbers, given):
            results.append(last)
            spent = time.perf_counter() - began
            print(
                f"{last.number} after {spent:.0f} s: {last.fault or last.said}", file=sys.stderr, flush=True
            )
            print(*last.wrong, sep="\n", end="\n" if last.wrong else "", file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        print("interrupted: what follows holds the machines judged so far", file=sys.stderr)
    print(f"\nseed {given.seed}, {len(results)} machines\n", *table(results), sep="\n")
    return 0


def _one(seed: int, keep: Path | None, number: int) -> Judged:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) if keep is None else keep / str(number)
        folder.mkdir(parents=True, exist_ok=True)
        return judged(drawn(seed, number), number, seed, folder)


def table(results: list[Judged]) -> list[str]:
    """Return the lines: what is said and holds, how far above V* the instruction lies, what else is said."""
    folds = [r.holds_fold for r in results if r.holds_fold is not None]
    claims: dict[str, list[bool]] = {}
    for result in results:
        for kind, held in result.claims.items():
            claims.setdefault(kind, []).extend(held)
    lines = [
        "| said | times | holds |",
        "|---|---|---|",
        f"| V* lies in its interval | {len(folds)} | {sum(folds)} |",
    ]
    lines += [f"| {kind} | {len(held)} | {sum(held)} |" for kind, held in sorted(claims.items())]
    over = sorted(r.over for r in results if r.over is not None)
    if over:
        middle = statistics.median(over)
        lines += [
            "",
            f"X of `run above X` over V*: median {middle:.2f}, least {over[0]:.2f}, greatest {over[-1]:.2f}",
        ]
    other = Counter(_first_words(r.said) for r in results if r.over is None and not r.fault)
    lines += ["", *(f"- {count} times: {words} ..." for words, count in other.most_common())]
    lines += [f"- no report: machine {r.number}: {r.fault}" for r in results if r.fault]
    return [*lines, *(f"- false: {words}" for r in results for words in r.wrong)]


def _first_words(text: str) -> str:
    """The beginning of an instruction, without its temperature."""
    cut = text.split(" °C ", 1)[-1]
    return cut[:_FIRST].rsplit(" ", 1)[0]


if __name__ == "__main__":
    sys.exit(main())
