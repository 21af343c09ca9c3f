"""Coverage of the intervals and choice of the law, over virtual logs whose truth is known.

Every log is written by the virtual test stand, read and reduced to dwells as a user's would be. Coverage:
the share of logs whose 95 % interval of a parameter holds the truth, by method, in the regular setting
(four temperatures, ten speeds up and down). Choice: the share of logs of each candidate on which it is
chosen, or tied with the one chosen (AICc within 2).

Usage: python -m benchmarks.choice [--logs 500] [--first 0] [--choice 100] [--workers 2] [--scheduler ADDRESS]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import numpy as np

import hersey
from benchmarks.working import takes_workers, worked
from hersey import testbench
from hersey.damping.candidates import Observations, compare_models
from hersey.damping.candidates.branched import FREE, HELD, ONE
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.comparison import TIED
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.intervals import METHODS, bootstrap_draws, estimates
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, GAS_CONSTANT, KELVIN, VFT

#: Apparent activation energy of torque of the truths, J/mol: that of `Truth` at 150 degC.
ENERGY = 0.9 * GAS_CONSTANT * 423.15**2 / 150.0
STAND = testbench.Stand(stick_slip=False)
BELOW_ALL_SPEEDS = 1e-6

TRUTHS: dict[Candidate, testbench.Truth] = {
    Candidate(CELSIUS, ONE): testbench.ThermalTruth(
        law="degC", activation_energy=ENERGY, transition_speed_rpm=BELOW_ALL_SPEEDS
    ),
    Candidate(KELVIN, ONE): testbench.ThermalTruth(
        law="K", activation_energy=ENERGY, transition_speed_rpm=BELOW_ALL_SPEEDS
    ),
    Candidate(ARRHENIUS, ONE): testbench.ThermalTruth(
        law="Arrhenius", activation_energy=ENERGY, transition_speed_rpm=BELOW_ALL_SPEEDS
    ),
    Candidate(VFT, ONE): testbench.ThermalTruth(
        law="VFT",
        activation_energy=ENERGY,
        vogel_temperature=200.0,
        transition_speed_rpm=BELOW_ALL_SPEEDS,
    ),
    Candidate(CELSIUS, HELD): testbench.Truth(),
    Candidate(KELVIN, HELD): testbench.ThermalTruth(law="K", activation_energy=ENERGY),
    Candidate(ARRHENIUS, HELD): testbench.ThermalTruth(law="Arrhenius", activation_energy=ENERGY),
    Candidate(VFT, HELD): testbench.ThermalTruth(
        law="VFT", activation_energy=ENERGY, vogel_temperature=200.0
    ),
    Candidate(CELSIUS, FREE): testbench.ThermalTruth(
        law="degC", activation_energy=ENERGY, transition_share=0.5
    ),
    Candidate(ARRHENIUS, FREE): testbench.ThermalTruth(
        law="Arrhenius", activation_energy=ENERGY, transition_share=0.5
    ),
    Candidate(VFT, FREE): testbench.ThermalTruth(
        law="VFT", activation_energy=ENERGY, vogel_temperature=200.0, transition_share=0.5
    ),
    Candidate(ARRHENIUS, ONE, per_temperature=True): testbench.ThermalTruth(
        law="Arrhenius",
        activation_energy=ENERGY,
        transition_speed_rpm=BELOW_ALL_SPEEDS,
        exponent_drift=1e-3,
    ),
    Candidate(ARRHENIUS, ONE, stribeck=True): testbench.StribeckTruth(
        law="Arrhenius", activation_energy=ENERGY, transition_speed_rpm=25.0
    ),
}


def observed(seed: int, truth: testbench.Truth, stand: testbench.Stand = STAND) -> Observations:
    """Return the dwells of one virtual log, read from its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.csv"
        testbench.run(seed=seed, truth=truth, stand=stand).write(path)
        return Observations.of(hersey.read(path).steady(tare="standing"))


def truths_of(data: Observations, truth: testbench.Truth) -> dict[str, float]:
    """Return the true values of the parameters of a power law in degC with two branches."""
    assert data.reference_kelvin is not None
    celsius = np.array(data.reference_kelvin - 273.15)
    level = truth.a * float(celsius) ** truth.b * data.reference_speed**truth.c
    return {
        "damping at reference": level,
        "b": truth.b,
        "c": truth.c,
        "c below the transition": truth.mixed_exponent,
        "transition speed": float(truth.transition_speed(celsius)),
    }


def covered(seed: int) -> dict[tuple[str, str], bool]:
    """Return for each parameter and method whether its interval holds the truth, on one log."""
    truth = testbench.Truth()
    data = observed(seed, truth)
    fit = fit_law(Candidate(CELSIUS, HELD).law(data), data)
    found = estimates(fit, data, draws=bootstrap_draws(fit, data, 200, seed))
    known = truths_of(data, truth)
    held = {}
    for parameter in found:
        for method in METHODS:
            low, high = parameter.intervals.get(method, (np.inf, -np.inf))
            held[parameter.name, method] = low <= known[parameter.name] <= high
    return held


def chosen(drawn: tuple[int, int]) -> tuple[str, str, bool]:
    """Return the true candidate (number, then seed), the one chosen, and whether they are one or tied."""
    number, seed = drawn
    candidate, truth = list(TRUTHS.items())[number]
    found = compare_models(observed(10_000 + seed, truth), bootstrap=0, cross_validate=False)
    right = found.candidate(candidate.key)
    gap = right.fit.aicc - found.chosen.fit.aicc
    return candidate.key, found.chosen.candidate.key, right is found.chosen or abs(gap) < TIED


def _report_coverage(results: list[dict[tuple[str, str], bool]]) -> None:
    print(f"\nCoverage of 95 % intervals, {len(results)} logs:\n")
    print("| parameter | " + " | ".join(METHODS) + " |")
    print("|---" * (len(METHODS) + 1) + "|")
    for name in dict.fromkeys(name for name, _ in results[0]):
        shares = [float(np.mean([r[name, method] for r in results])) for method in METHODS]
        print(f"| {name} | " + " | ".join(f"{share:.1%}" for share in shares) + " |")
    print(f"\nOf a true 95 % the standard error is {np.sqrt(0.95 * 0.05 / len(results)):.1%}.")


def _report_choice(results: list[tuple[str, str, bool]]) -> None:
    found: dict[str, list[tuple[str, bool]]] = defaultdict(list)
    for candidate, picked, right in results:
        found[candidate].append((picked, right))
    print("\n| truth | logs | chosen | chosen or tied | most often instead |")
    print("|---|---|---|---|---|")
    for candidate, each in found.items():
        exactly = np.mean([picked == candidate for picked, _ in each])
        others = [picked for picked, right in each if not right]
        worst = max(set(others), key=others.count) if others else "-"
        either = np.mean([right for _, right in each])
        print(f"| {candidate} | {len(each)} | {exactly:.0%} | {either:.0%} | {worst} |")
    print(f"\nall: chosen or tied {np.mean([right for _, _, right in results]):.1%}")


def main() -> None:
    """Run both parts and print their tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--logs", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--choice", type=int, default=100, help="logs of each candidate")
    takes_workers(parser)
    given = parser.parse_args()
    began = time.perf_counter()
    seeds = range(given.first, given.first + max(given.logs, given.choice))
    if given.logs:
        _report_coverage(list(worked(covered, seeds[: given.logs], given)))
    if given.choice:
        drawn = [(number, seed) for number in range(len(TRUTHS)) for seed in seeds[: given.choice]]
        _report_choice(list(worked(chosen, drawn, given)))
    print(f"\nseeds from {given.first}; {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
