"""Coverage of the bounds and forecasts of `hersey weibull`: ``python -m benchmarks.weibull --seed 2``."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable

import numpy as np

from benchmarks.failure_samples import (
    Row,
    of_b10,
    of_fleet,
    of_inspections,
    of_life,
    of_modes,
    of_stress,
)
from benchmarks.working import takes_workers, worked


def line(name: str, task: Callable[..., Row], cases: list[tuple[object, ...]], given: Namespace) -> None:
    """Print a row of the table: how often both bounds hold, and each of them."""
    rows = [row for row in worked(task, cases, given) if row is not None]
    low, high = 100 * np.mean(rows, axis=0)
    kept = f"{len(rows)} of {len(cases)}"
    print(f"| {name} | {kept} | {100 - low - high:.1f} | {100 - low:.1f} | {100 - high:.1f} |", flush=True)


def main() -> None:
    """Print the table."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=1000, help="samples of each row on B10")
    takes_workers(parser)
    given = parser.parse_args()
    first = 100_000 * given.seed

    def cases(begin: int, count: int, *case: object) -> list[tuple[object, ...]]:
        return [(*case, first + begin + number) for number in range(count)]

    def censored(kind: str, begin: int, calibrate: bool = True) -> list[tuple[object, ...]]:
        shapes = [1.0, 2.0, 3.0, 4.0]
        return [(kind, shapes[n % 4], calibrate, first + begin + n) for n in range(given.count)]

    print("| what | samples with a law | both bounds | lower alone | upper alone |\n|---|---|---|---|---|")
    line("B10, type II", of_b10, censored("type II", 0), given)
    line("B10, type I", of_b10, censored("type I", 2000), given)
    line("B10, type II, not calibrated", of_b10, censored("type II", 0, calibrate=False), given)
    line("B10, type I, not calibrated", of_b10, censored("type I", 2000, calibrate=False), given)
    some = given.count // 5
    line("B10, complete", of_b10, cases(4000, some, "complete", 2.0, True), given)
    line("B10, random", of_b10, cases(5000, some, "random", 2.0, True), given)
    line("B10, 20 looked at five times", of_inspections, cases(6000, some, 2.0, True), given)
    line("B10, two failure modes", of_modes, cases(7000, some, 1.0, 3.0), given)
    line("B10 at half of the least load tested", of_stress, cases(8000, some, 2.0, True), given)
    line("failures of a fleet of 400", of_fleet, cases(9000, some, 2.0), given)
    line("failure of one specimen", of_life, cases(10_000, some, 2.0), given)


if __name__ == "__main__":
    main()
