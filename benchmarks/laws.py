"""Whether exact logs of seven laws are read as what they are.

Each log has 11 speeds at 5 temperatures, with 1 % scatter of the dwells, of one law of the Hersey number.
Counted are true laws that the drag curves reject, claims that torque rises or falls where it does not, fits
that claim a transition where torque falls nowhere, and exact power laws of which one exponent is denied.

Usage: python -m benchmarks.laws [--logs 100] [--seed 1] [--workers 2]
"""

from __future__ import annotations

import argparse
import multiprocessing
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import hersey
from hersey.damping.candidates.observations import Observations
from hersey.damping.curves import fit_curves
from hersey.damping.trend import trend_of
from hersey.log.means import read_means
from hersey.verdict.regime import regime

Array = NDArray[np.float64]
TEMPERATURES = (70.0, 95.0, 120.0, 145.0, 170.0)
SPEEDS = np.geomspace(0.5, 40.0, 11)
SCATTER = 0.01
#: Power of viscosity in degC, and its reference.
VISCOSITY, AT = -2.0, 120.0


class Law(NamedTuple):
    """Torque (N m) over viscosity times speed, what it does, and the drag curve that it is, if one is."""

    torque: Callable[[Array], Array]
    rises: bool
    falls: bool
    curve: str = ""


LAWS = {
    "power of speed": Law(lambda h: 0.5 * h**0.4, True, False),
    "Coulomb and viscous": Law(lambda h: 0.3 + 0.05 * h, True, False, "plus"),
    "constant": Law(lambda h: 0.4 * np.ones_like(h), False, False),
    "corner": Law(lambda h: 0.4 * np.maximum((h / 3) ** 0.4, (h / 3) ** -0.5), True, True, "sharp"),
    "sum of two powers": Law(lambda h: 0.2 * ((h / 3) ** 0.4 + (h / 3) ** -0.5), True, True, "blend"),
    "exponential Stribeck": Law(
        lambda h: 0.3 + 0.4 * np.exp(-((h / 2) ** 1.3)) + 0.03 * h, True, True, "stribeck"
    ),
    "saturating": Law(
        lambda h: 0.05 + 0.5 / (1 + (h / 1.5) ** 1.2) + 0.06 * h**0.6, True, True, "saturating"
    ),
}


class Reading(NamedTuple):
    """What came of one log."""

    rejected: bool
    p_value: float
    heaviest: bool
    wrong_trend: bool
    false_transition: bool
    denied: bool


def read(seed: int, task: tuple[str, int]) -> Reading:
    """Write one log of a law and read it."""
    name, number = task
    law = LAWS[name]
    random = np.random.default_rng([seed, number, list(LAWS).index(name)])
    rows = ["Speed [rad/s],Torque [N*m],Temperature [degC]"]
    for temperature in TEMPERATURES:
        torque = law.torque(SPEEDS * (temperature / AT) ** VISCOSITY)
        torque *= np.exp(SCATTER * random.standard_normal(SPEEDS.size))
        rows += [f"{w:.9g},{t:.9g},{temperature}" for w, t in zip(SPEEDS, torque, strict=True)]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.csv"
        path.write_text("\n".join(rows) + "\n")
        points = hersey.SteadyPoints.from_table(read_means([path]))
    surface = hersey.fit(points)
    mixture, trend, found = (
        fit_curves(points, surface),
        trend_of(Observations.of(points)),
        regime(points, surface),
    )
    weights: dict[str, float] = {}
    for each in mixture.table:
        weights[each.name] = weights.get(each.name, 0.0) + each.weight
    true = [each for each in mixture.table if each.name == law.curve]
    return Reading(
        rejected=any(each.rejected for each in true),
        p_value=min((each.p_value for each in true), default=1.0),
        heaviest=bool(true) and max(weights, key=lambda each: weights[each]) == law.curve,
        wrong_trend=(trend.rises, trend.falls) != (law.rises, law.falls),
        false_transition=surface.transition is not None and not law.falls,
        denied=found.lack_of_fit is not None and found.lack_of_fit.in_speed and not law.curve,
    )


def main() -> None:
    """Read as many logs as asked for and print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--logs", type=int, default=100, help="of each law")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    given = parser.parse_args()
    began = time.perf_counter()
    tasks = [(name, number) for name in LAWS for number in range(given.logs)]
    with ProcessPoolExecutor(given.workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        every = list(pool.map(partial(read, given.seed), tasks, chunksize=5))
    print(f"seed {given.seed}, {given.logs} logs of each law, {time.perf_counter() - began:.0f} s\n")
    print("| law | rejected | least p | heaviest | wrong trend | false transition | one exponent denied |")
    print("|---|---|---|---|---|---|---|")
    for name, law in LAWS.items():
        mine = [each for each, (of, _) in zip(every, tasks, strict=True) if of == name]
        count = len(mine)
        least = f"{min(each.p_value for each in mine):.1e}" if law.curve else "-"
        rejected = f"{sum(each.rejected for each in mine)} of {count}" if law.curve else "-"
        heaviest = f"{sum(each.heaviest for each in mine)} of {count}" if law.curve else "-"
        wrong, turn, denied = (
            sum(getattr(each, of) for each in mine) for of in ("wrong_trend", "false_transition", "denied")
        )
        print(f"| {name} | {rejected} | {least} | {heaviest} | {wrong} | {turn} | {denied} |")


if __name__ == "__main__":
    main()
