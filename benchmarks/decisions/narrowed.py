"""How much a recording narrows V*: the judged machines once more, without their traces.

`python -m benchmarks.decisions --keep FOLDER` leaves logs, traces and documents there. Each machine with a
trace is reported again without it. With 20 s of stick-slip the interval of V* should be at most a third as
wide; with starts on both sides of V* no wider than from the fastest that stuck to the slowest that slid.

Usage: python -m benchmarks.decisions.narrowed FOLDER --seed N [--workers 2]
"""

from __future__ import annotations

import argparse
import json
import math
import multiprocessing
import statistics
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import NamedTuple

from benchmarks.decisions.judged import reported
from benchmarks.decisions.logs import Files
from benchmarks.decisions.machines import Kind, Machine, drawn
from benchmarks.decisions.motion import from_rest
from benchmarks.decisions.said import read


class Narrowed(NamedTuple):
    """Widths of the interval of V* (m/s) of one machine, and the spacing of its starts."""

    number: int
    evidence: str
    with_trace: float
    without: float
    spacing: float


def narrowed(folder: Path, seed: int, number: int) -> Narrowed | None:
    """Compare one machine; None without a trace, or without V*."""
    machine, place = drawn(seed, number, Kind()), folder / str(number)
    document = place / "document.json"
    if machine.evidence == "dwells" or not document.exists():
        return None
    seen = read(json.loads(document.read_text())).fold
    alone = read(json.loads(reported(Files(place / "log.csv", place / "machine.toml", None)).stdout)).fold
    if seen is None or alone is None:
        return None
    return Narrowed(number, machine.evidence, seen[1] - seen[0], alone[1] - alone[0], _spacing(machine))


def _spacing(machine: Machine) -> float:
    """From the fastest start that stuck to the slowest that slid; infinite without both."""
    stuck, slid = 0.0, math.inf
    for start in machine.trace:
        if from_rest(machine.rig, start.speed, start.acceleration).outcome == "slides":
            slid = min(slid, start.speed)
        else:
            stuck = max(stuck, start.speed)
    return slid - stuck if stuck else math.inf


def main() -> None:
    """Print each machine, and the shares that keep the limits."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    numbers = sorted(int(each.name) for each in given.folder.iterdir() if each.name.isdigit())
    with ProcessPoolExecutor(given.workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        found = [each for each in pool.map(partial(narrowed, given.folder, given.seed), numbers) if each]
    for each in found:
        ratio = each.with_trace / each.without
        print(
            f"{each.number:4d} {each.evidence:10s} with/without {ratio:5.2f}  "
            f"width/spacing {each.with_trace / each.spacing:5.2f}"
        )
    slips = [each.with_trace / each.without for each in found if each.evidence == "stick-slip"]
    both = [each for each in found if each.evidence == "starts" and 0.0 < each.spacing < math.inf]
    starts = [each.with_trace / each.spacing for each in both]
    limits = (("stick-slip, with/without", slips, 1 / 3), ("starts, width/spacing", starts, 1.0))
    for name, values, limit in limits:
        if values:
            kept = sum(value <= limit for value in values)
            print(
                f"{name}: median {statistics.median(values):.2f}, {kept} of {len(values)} at most {limit:.2f}"
            )


if __name__ == "__main__":
    main()
