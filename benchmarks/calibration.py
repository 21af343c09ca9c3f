"""Whether the posterior is as wide as it should be: simulation-based calibration with its own draws.

The draws that the dwells of the shipped log leave open are the prior here. One of them is the truth; of it
stretches of stick-slip, starts and a break-away force are made with noise, and the posterior is asked. If
sampler and likelihood are right, the rank of the truth among its draws is uniform (Talts et al.,
arXiv 1804.06788). Unlike `benchmarks.decisions` this shares all assumptions with the product: it finds
mistakes of the sampler and the likelihood, not of the model.

Usage: python -m benchmarks.calibration [--truths 100] [--seed 1] [--draws 600] [--workers 2]
"""

from __future__ import annotations

import argparse
import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

import hersey
from hersey.damping.distributions import square_above
from hersey.posterior import Posterior
from hersey.posterior.drives import Drives
from hersey.posterior.evidence import BreakAway, CycleFigures, Evidence, Start, StickSlip
from hersey.posterior.likelihood import OF_CYCLES, break_away_force
from hersey.posterior.priors import DrivePriors

ROOT = Path(__file__).parent.parent
#: Of the first posterior, whose draws are the truths.
PRIOR_DRAWS = 2000
#: Shares of a transition at which stick-slip is recorded, and of a V* at which starts are made. Both are of
#: another draw: speeds that follow the truth would tell of it what no likelihood counts.
SLIPS, STARTS = (0.3, 0.7), (0.8, 1.2)
#: Relative errors of figures and of a break-away force, as stated to the posterior.
FIGURES, FORCE = 0.01, 0.04
BINS = 10
KINDS = ("starts", "stick-slip", "break-away")
NAMES = ("V*", "transition", "stick speed", "stiffness", "mass", "static ratio")


def evidence_of(
    found: Posterior, truth: Drives, other: Drives, kind: str, random: np.random.Generator
) -> list[Evidence]:
    """What one draw shows at speeds about another, with noise as large as the posterior takes it to be."""
    model, kelvin = found.model, found.temperature
    about = model.folds(other, kelvin)
    fold, turn = float(about.upper[0]), float(about.transition[0])
    out: list[Evidence] = []
    if kind == "starts":
        for share in STARTS:
            speed = share * fold
            slides = bool(model.start_ups(truth, kelvin, [(0.0, speed)]).slides[0])
            out.append(Start(kelvin, speed, slides))
    if kind == "stick-slip":
        for share in SLIPS:
            speed = share * turn
            seen = model.starts(truth, kelvin, speed)
            if not seen.sticks[0]:
                out.append(Start(kelvin, speed, slid=True))
                continue
            error = float(np.hypot(FIGURES, OF_CYCLES))
            top, low = float(seen.pull_max[0]), float(seen.pull_min[0])
            noise = np.exp(error * random.standard_normal(3)).tolist()
            period, pull, drop = (
                v * n for v, n in zip((float(seen.period[0]), top, top - low), noise, strict=True)
            )
            figures = CycleFigures((period, FIGURES), (pull, FIGURES), (drop, FIGURES), None)
            out.append(StickSlip(kelvin, speed, 20.0, figures))
    if kind == "break-away":
        force = float(break_away_force(model, truth, kelvin)[0])
        out.append(BreakAway(kelvin, force * float(np.exp(FORCE * random.standard_normal())), FORCE))
    return out


def quantities(found: Posterior, drives: Drives) -> list[np.ndarray]:
    """V*, transition and the numbers of draws."""
    folds = found.model.folds(drives, found.temperature)
    return [np.maximum(folds.upper, folds.transition), folds.transition, *found.model.numbers(drives).T]


@dataclass(frozen=True)
class Ranked:
    """What came of one truth: the rank of each quantity, recordings excluded, and whether it converged."""

    ranks: list[float]
    excluded: int
    converged: bool


@cache
def _machine() -> hersey.Machine:
    return hersey.read_machine(ROOT / "examples" / "machine.toml")


@cache
def _points() -> hersey.SteadyPoints:
    rest = _machine().rest
    assert rest is not None
    return hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing").without(rest)


@cache
def _prior(seed: int) -> Posterior:
    """The draws that the dwells of the shipped log leave open."""
    return hersey.posterior(_points(), _machine(), evidence=(), draws=PRIOR_DRAWS, seed=seed)


def ranked(seed: int, draws: int, number: int) -> Ranked:
    """Draw a truth and rank it."""
    prior, random = _prior(seed), np.random.default_rng([seed, number])
    which = int(random.integers(len(KINDS)))
    model = prior.model
    # a measured break-away force widens the prior of static friction: so for the truth
    wide = DrivePriors.of(model.machine, break_away_known=KINDS[which] == "break-away")
    from_ = replace(prior, model=replace(model, priors=wide))
    truth, other = (
        prior.drives.take(np.array([random.integers(len(prior.drives))], dtype=np.intp)) for _ in range(2)
    )
    seen = evidence_of(from_, truth, other, KINDS[which], random)
    found = hersey.posterior(
        _points(),
        model.machine,
        surface=model.surface,
        curves=model.curves,
        evidence=seen,
        draws=draws,
        seed=number + 1,
    )
    pairs = zip(quantities(found, found.drives), quantities(from_, truth), strict=True)
    ranks = [float(np.mean(d < t[0]) + random.random() * np.mean(d == t[0])) for d, t in pairs]
    return Ranked(ranks, len(found.warnings), found.convergence.converged)


def main() -> None:
    """Draw as many truths as asked for and print the table of ranks."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--truths", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--draws", type=int, default=600)
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    given = parser.parse_args()
    began = time.perf_counter()
    with ProcessPoolExecutor(given.workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        results = list(pool.map(partial(ranked, given.seed, given.draws), range(given.truths)))
    kept = np.array([each.ranks for each in results])
    print(
        f"seed {given.seed}: {len(kept)} truths, {given.draws} draws each, "
        f"{sum(each.excluded for each in results)} recordings excluded, "
        f"{sum(not each.converged for each in results)} not converged, {time.perf_counter() - began:.0f} s"
    )
    print("| quantity | ranks in tenths | p of uniform | in the 95 % interval |\n|---|---|---|---|")
    for name, column in zip(NAMES, kept.T, strict=True):
        counts = np.bincount(np.minimum((column * BINS).astype(int), BINS - 1), minlength=BINS)
        expected = len(column) / BINS
        p = float(square_above(float(np.sum((counts - expected) ** 2 / expected)), BINS - 1))
        inside = float(np.mean((column > 0.025) & (column < 0.975)))
        print(f"| {name} | {' '.join(map(str, counts))} | {p:.3f} | {100 * inside:.0f} % |")


if __name__ == "__main__":
    main()
