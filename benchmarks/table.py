"""The table of all ratios against peers and limits: writes RESULTS.md, or prints the parts that are named.

Usage: python -m benchmarks.table [read motion fold film models verbs start] [--runs 7] [--size "275 MB"]
"""

from __future__ import annotations

import argparse
import platform
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from benchmarks import candidates, fold, motion, read_csv, reynolds, start, verbs
from benchmarks.lines import Line, table

RUNS = 7
WORDS = """# hersey beside its peers

{machine}; Python {python}. `make benchmark` writes this page: medians of {runs} runs, each in turn with its
peer in the same run. Times are wall times, of one thread for the motion core; those of commands include the
start of Python, and those of version and help are processor time. A peer that takes long runs a part, scaled
to all. An error is the largest relative one: of the frequency of W1 and W2, of V* in W3, of the film.

W1: one trajectory of the paper's baseline. W2: 10,000 parameter sets, 10 s each. W3: a map of V*. More tools
are in [MOTION.md](MOTION.md), [FOLD.md](FOLD.md), [REYNOLDS.md](REYNOLDS.md) and
[CANDIDATES.md](CANDIDATES.md), every verb in [START.md](START.md).
"""


def parts(size: str) -> dict[str, Callable[[int], list[Line]]]:
    """Return what makes the lines of each part, by its name."""
    return {
        "read": partial(read_csv.lines, size=size),
        "motion": motion.lines,
        "fold": fold.lines,
        "film": reynolds.lines,
        "models": candidates.lines,
        "verbs": verbs.lines,
        "start": start.lines,
    }


def main() -> None:
    """Measure, print, and write the page if every part was measured."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", metavar="part", help="of the table; else all")
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--size", default="275 MB", help="of the log that is read")
    given = parser.parse_args()
    known, lines = parts(given.size), []
    for name in given.parts or known:
        begin = time.perf_counter()
        lines += known[name](given.runs)
        print(f"{name}: {time.perf_counter() - begin:.0f} s", file=sys.stderr, flush=True)
    rows = "\n".join(table(lines))
    print(rows)
    if not given.parts:
        words = WORDS.format(machine=motion.machine(), python=platform.python_version(), runs=given.runs)
        Path(__file__).with_name("RESULTS.md").write_text(f"{words}\n{rows}\n")


if __name__ == "__main__":
    main()
