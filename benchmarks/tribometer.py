"""Friction of tribometers whose laws are known: a constant coefficient must be read as constant.

Every log is made here, by code that hersey does not share: a staircase of sliding speeds, the law of the
friction coefficient, noise of the load cell with a memory, an error of each run's calibration. Runs differ
in radius or in load, and are recorded as a coefficient, a force or a torque. Counted is how often the verdict
says what the law does, and how often the value and its exponent lie in their 95 % intervals.

    python -m benchmarks.tribometer [--logs 100] [--seed 2]
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass

import numpy as np
import polars as pl

import hersey
from hersey import SteadyPoints

#: Staircase up and down: sliding speeds, m/s, each held so long (s) at so many rows per second.
UP = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
HELD, RATE = 10.0, 20.0
#: Coefficient at 0.1 m/s, and exponents of speed of the three laws.
COEFFICIENT, LAWS = 0.12, {"constant": 0.0, "rising": 0.08, "falling": -0.08}
#: Noise of a reading and its memory (AR(1)), error of a run's calibration; all relative.
NOISE, MEMORY, CALIBRATION = 0.02, 0.5, 0.002


@dataclass(frozen=True)
class Rig:
    """What differs between three runs, and what is recorded."""

    name: str
    quantity: str  # coefficient, force or torque
    radii: tuple[float, float, float]
    loads: tuple[float, float, float]
    states: tuple[str, ...]  # what the reader is told


SAME = (10.0, 10.0, 10.0)
RIGS = (
    Rig("coefficient at three radii", "coefficient", (0.01, 0.02, 0.04), SAME, ()),
    Rig("force at three radii, one load", "force", (0.01, 0.02, 0.04), SAME, ("load",)),
    Rig("torque at three radii, one load", "torque", (0.01, 0.02, 0.04), SAME, ("load", "radius")),
    Rig("force at three loads", "force", (0.02, 0.02, 0.02), (5.0, 10.0, 20.0), ("load",)),
    Rig("torque at three loads", "torque", (0.02, 0.02, 0.02), (5.0, 10.0, 20.0), ("load", "radius")),
)


def recorded(rig: Rig, exponent: float, rng: np.random.Generator) -> list[pl.DataFrame]:
    """Return the three runs as tables."""
    tables = []
    for radius, load in zip(rig.radii, rig.loads, strict=True):
        rows = int(HELD * RATE)
        speed = np.repeat([*UP, *reversed(UP[:-1])], rows)
        innovation = rng.normal(0.0, NOISE * math.sqrt(1.0 - MEMORY**2), speed.size)
        noise = np.zeros(speed.size)
        for i in range(1, speed.size):
            noise[i] = MEMORY * noise[i - 1] + innovation[i]
        friction = (
            COEFFICIENT * (speed / 0.1) ** exponent * math.exp(rng.normal(0.0, CALIBRATION)) * (1.0 + noise)
        )
        time = np.arange(speed.size) / RATE
        if rig.quantity == "torque":
            columns = {"Torque [N*m]": friction * load * radius, "Speed [rad/s]": speed / radius}
        elif rig.quantity == "force":
            columns = {"Friction force [N]": friction * load, "Sliding speed [m/s]": speed}
        else:
            columns = {"COF": friction, "Sliding speed [m/s]": speed}
        tables.append(pl.DataFrame({"Time [s]": time} | columns))
    return tables


def points_of(rig: Rig, tables: list[pl.DataFrame]) -> SteadyPoints:
    """Return the dwells of all runs."""
    stated = {"load": rig.loads if len(set(rig.loads)) > 1 else rig.loads[0], "radius": rig.radii}
    if len(set(rig.radii)) == 1:
        stated["radius"] = rig.radii[0]
    return hersey.read(tables, isothermal=True, **{name: stated[name] for name in rig.states}).steady()


def counted(rig: Rig, law: str, logs: int, seed: int) -> tuple[int, int, int]:
    """Return how often the verdict is right, and the exponent and the value lie in their intervals."""
    exponent, rng = LAWS[law], np.random.default_rng(seed)
    right = inside = level = 0
    words = {"constant": "is constant", "rising": " rises with", "falling": " falls with"}[law]
    for _ in range(logs):
        points = points_of(rig, recorded(rig, exponent, rng))
        surface = hersey.fit(points)
        right += words in hersey.regime(points, surface).verdict
        inside += surface.c.low <= exponent - 1.0 <= surface.c.high
        band = surface.predict(speed=surface.reference_speed)
        truth = COEFFICIENT * (surface.reference_speed / 0.1) ** exponent
        level += bool(band.confidence[0] <= truth <= band.confidence[1])
    return right, inside, level


def main() -> None:
    """Print a row for each rig and law."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--logs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=2)
    asked = parser.parse_args()
    logs, seed = asked.logs, 100_000 * asked.seed
    print("| runs | law | verdict right | exponent in its interval | value in its interval |")
    print("|---|---|---|---|---|")
    for i, rig in enumerate(RIGS):
        for j, law in enumerate(LAWS):
            right, inside, level = counted(rig, law, logs, seed + 1000 * i + j)
            print(f"| {rig.name} | {law} | {right} of {logs} | {inside} | {level} |", flush=True)


if __name__ == "__main__":
    main()
