"""Part C: transitions announced where there is none, and missed where there is one.

Without: power laws, exponents that drift with speed or with temperature (torque rises with speed everywhere),
and power laws with much scatter of dwells and visits. With: a falling branch of exponent -1.15 to -1.4, at
least four of the speeds on each side of the transition at every temperature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.independent.judged import generator, judged
from benchmarks.independent.laws import RPM, DriftingExponent, TorqueLaw, TwoBranches
from benchmarks.independent.logs import Errors, Plan, record

SPEEDS = tuple(np.geomspace(8.0, 160.0, 12).round(2).tolist())
PLAN = Plan(SPEEDS, (110.0, 123.0, 137.0, 150.0))
#: Speeds that each branch has at least.
SIDE = 4
WITHOUT = ("power", "drift-speed", "drift-temperature", "scattered")
STRENGTHS = (-1.15, -1.2, -1.3, -1.4)
NAMES = (*(f"none/{kind}" for kind in WITHOUT), *(f"with/{mixed:g}" for mixed in STRENGTHS))
#: Logs of each kind without a transition, and with one: 540 and 240 in all.
LOGS, LOGS_WITH = 135, 60


@dataclass(frozen=True)
class Announced:
    """Whether a transition is announced, and if not, why."""

    transition: bool
    why: str


def one_log(seed: int, name: str, index: int) -> Announced | str:
    """Return what is said of one log, or the message with which it was refused."""
    rng = generator(seed, name, index)
    law, errors = _truth(name, rng)
    found = judged(record(law, PLAN, errors, rng), verdict=False)
    if found.surface is None:
        return found.refusal
    return Announced(found.surface.transition is not None, found.surface.rejected_transition)


def _truth(name: str, rng: np.random.Generator) -> tuple[TorqueLaw, Errors]:
    side, kind = name.split("/")
    if side == "with":
        return _two_branches(float(kind), rng), Errors(scatter=rng.uniform(0.003, 0.015))
    b = rng.uniform(-1.5, -0.3)
    if kind == "drift-speed":
        law = DriftingExponent(b=b, c=rng.uniform(-0.72, -0.4), by_speed=rng.uniform(-0.15, 0.15))
        return law, Errors(scatter=rng.uniform(0.003, 0.01))
    if kind == "drift-temperature":
        law = DriftingExponent(b=b, c=rng.uniform(-0.9, -0.4), by_kelvin=rng.uniform(-0.0025, 0.0025))
        return law, Errors(scatter=rng.uniform(0.003, 0.01))
    law = DriftingExponent(b=b, c=rng.uniform(-0.97, -0.2))
    much = Errors(scatter=rng.uniform(0.01, 0.03), visit=rng.uniform(0.0, 0.03))
    return law, much if kind == "scattered" else Errors(scatter=rng.uniform(0.003, 0.01))


def _two_branches(mixed: float, rng: np.random.Generator) -> TwoBranches:
    """A transition somewhere between the speeds that leave enough on each side at all temperatures."""
    low, high = SPEEDS[SIDE - 1] * RPM, SPEEDS[-SIDE] * RPM
    coldest, hottest = PLAN.temperatures[0], PLAN.temperatures[-1]
    while True:
        law = TwoBranches(b=rng.uniform(-1.0, -0.5), c=rng.uniform(-0.75, -0.55), mixed=mixed)
        at = law.transition_speed(np.array([coldest, hottest])) / law.at
        if low / at[0] < high / at[1]:
            place = float(np.exp(rng.uniform(np.log(low / at[0]), np.log(high / at[1]))))
            return TwoBranches(law.a, law.b, law.c, mixed=mixed, at=place)


def table(results: dict[str, list[Announced | str]]) -> list[str]:
    """Return the lines: per kind of truth how many logs, transitions announced, and what is wrong."""
    lines = ["| truth | logs | refused | transition announced | wrong |", "|---|---|---|---|---|"]
    for side, fault in (("none", "false"), ("with", "missed")):
        kinds = {n: each for n, each in results.items() if n.startswith(side)}
        together = [r for each in kinds.values() for r in each]
        for label, rows in (*kinds.items(), (f"**{side}**", together)):
            kept = [r for r in rows if isinstance(r, Announced)]
            said = sum(r.transition for r in kept)
            wrong = said if side == "none" else len(rows) - said
            refused = len(rows) - len(kept)
            lines.append(f"| {label} | {len(rows)} | {refused} | {said} | {wrong} {fault} |")
    return [*lines, "", *_why(results)]


def _why(results: dict[str, list[Announced | str]]) -> list[str]:
    missed = [
        f"- {name}, log {i}: {row if isinstance(row, str) else row.why}"
        for name, rows in results.items()
        for i, row in enumerate(rows)
        if name.startswith("with") and not (isinstance(row, Announced) and row.transition)
    ]
    false = [
        f"- {name}, log {i}: false"
        for name, rows in results.items()
        for i, row in enumerate(rows)
        if name.startswith("none") and isinstance(row, Announced) and row.transition
    ]
    return false + missed[:20]
