"""How small X over V* could be with dwells alone: the drag curve is known at every speed, the rest is not.

For each machine of a seed whose evidence is slow dwells, V* is computed with the true curve, and with stick
speed, stiffness and mass drawn from what its machine file states. The closure is open: half of the draws
come to rest gradually, half stop abruptly. X is the speed that 97.5 % of them are below. No report can
promise less without more evidence.

Usage: python -m benchmarks.decisions.floor [--machines 40] [--seed 1] [--draws 40]
"""

from __future__ import annotations

import argparse
import math
import statistics
from dataclasses import replace

import numpy as np

from benchmarks.decisions.belt import CLOSURES
from benchmarks.decisions.fold import fold
from benchmarks.decisions.machines import Kind, Machine, drawn

#: Probability with which X is smooth, and relative accuracy of a V*.
SAFE, ACCURACY = 0.975, 5e-3


def floor(machine: Machine, draws: int, random: np.random.Generator) -> float:
    """Return X over V* of one machine."""
    stated, speeds = machine.stated, list[float]()
    low, high = stated.stick
    for closure in CLOSURES:
        for _ in range(draws):
            stiffness, mass = (
                value * math.exp(math.log1p(share) / 1.96 * random.standard_normal())
                for value, share in zip((stated.stiffness, stated.mass), stated.share, strict=True)
            )
            stick = low * (high / low) ** random.random()
            belt = replace(machine.rig, stick=stick, stiffness=stiffness, mass=mass, closure=closure)
            speeds.append(fold(belt, ACCURACY))
    return float(np.quantile(speeds, SAFE)) / fold(machine.rig, ACCURACY)


def main() -> None:
    """Print the ratio of each machine, and the medians."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--machines", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--draws", type=int, default=40, help="of each closure")
    given = parser.parse_args()
    ratios: dict[str, list[float]] = {}
    for number in range(given.machines):
        machine = drawn(given.seed, number, Kind())
        if machine.evidence != "dwells":
            continue
        ratio = floor(machine, given.draws, np.random.default_rng([given.seed, number, 2]))
        ratios.setdefault(machine.closure, []).append(ratio)
        print(f"{number:4d} {machine.curve.family:16s} {machine.closure:9s} {ratio:6.2f}", flush=True)
    every = [ratio for each in ratios.values() for ratio in each]
    for name, values in (("all", every), *sorted(ratios.items())):
        print(f"{name}: {len(values)} machines, median {statistics.median(values):.2f}")


if __name__ == "__main__":
    main()
