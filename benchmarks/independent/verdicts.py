"""Part B: whether a regime is named that is not the truth's.

A regime is wrong if the table of regimes does not hold the truth's mechanism. What is right:

- A power law in speed (also with Vogel's viscosity): the regime of its exponent.
- Soft film plus constant torque: soft EHL, because that is its film.
- Coulomb plus viscous, Carreau, Stribeck, shear heating: none.

Fair limits, the same rule for all: a torque that is everywhere, at every temperature, within 0.5 % of a power
law with a regime's exponent (thus constant within 1 % for dry friction) is that regime too, because the
gain of an ordinary torque sensor is not known better; and a torque that falls by more than 1 % from the
slowest to the fastest speed and nowhere rises is a falling branch. With 12 ratios from 0.05 to 20 no
Coulomb-viscous log is within these limits: at 20 Coulomb friction is still 9 % at the slow end of 25 to 100
rpm.
"Coulomb + viscous" and "constant film + constant torque" are one law, and either counts as the truth listed.
"Other curvature" names no law and does not count.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from benchmarks.independent.judged import generator, judged
from benchmarks.independent.laws import (
    MIDDLE,
    RPM,
    Carreau,
    Film,
    PowerLaw,
    ShearHeating,
    Stribeck,
    TorqueLaw,
    Vogel,
    VogelPower,
)
from benchmarks.independent.logs import Errors, Plan, record

LOGS = 20
DRY, FALLING = "dry Coulomb friction or a rigid film", "falling branch"
#: Exponents of damping that each regime has, least and greatest.
EXPONENTS = {
    "constant film": (0.0, 0.0),
    "soft EHL": (-0.60, -0.56),
    "rigid piezoviscous film": (-2 / 3, -2 / 3),
    "Dowson-Higginson EHL": (-0.70, -0.70),
    DRY: (-1.0, -1.0),
}
#: Half of the band, in ln torque, within which a torque is a power law as far as a sensor's gain can tell.
WITHIN = 0.005
RATIOS = tuple(float(r) for r in np.geomspace(0.05, 20.0, 12).round(3))
RANGES = {"8-160": (8.0, 160.0), "25-100": (25.0, 100.0)}
SHARES = (0.1, 0.2, 0.25, 0.3, 0.4, 0.5)
TRUE = {"constant film": 0.0, "soft EHL": -0.58, "rigid piezoviscous film": -2 / 3}
TRUE |= {"Dowson-Higginson EHL": -0.70, DRY: -1.0}
#: Exponent of viscosity in T (degC) for which T^b of the power laws stands.
_VISCOSITY_POWER = -3.0


@dataclass(frozen=True)
class Case:
    """A truth: its law, what may be named, and the explanations any of which is the truth."""

    law: TorqueLaw
    regimes: frozenset[str]
    keys: frozenset[str]
    speeds: tuple[float, float] = RANGES["8-160"]

    def plan(self, setting: str) -> Plan:
        """Return the plan of the test, speeds up and down."""
        speeds, temperatures = _TESTS[setting]
        return Plan(tuple(np.geomspace(*self.speeds, speeds).round(2).tolist()), temperatures)


#: Number of speeds, temperatures; of an ordinary and of a poorer test.
_TESTS = {"good": (10, (90.0, 115.0, 140.0, 165.0)), "poor": (8, (100.0, 130.0, 160.0))}


def _errors(setting: str, rng: np.random.Generator) -> Errors:
    return Errors(scatter=float(rng.uniform(0.002, 0.005)) if setting == "good" else 0.01)


def _middle(speeds: tuple[float, float]) -> float:
    return float(np.sqrt(speeds[0] * speeds[1])) * RPM


def _cases() -> dict[str, Case]:
    cases: dict[str, Case] = {}
    wide, none = RANGES["8-160"], frozenset[str]()
    at, top = _middle(wide), wide[1] * RPM
    two = frozenset({"Coulomb + viscous", "constant film + constant torque"})
    for name, speeds in RANGES.items():
        for ratio in RATIOS:
            law = Film(ratio / (1 + ratio), 1 / (1 + ratio), 0.0, _middle(speeds))
            cases[f"coulomb-{name}/{ratio:g}"] = Case(law, none, two, speeds)
    for share in SHARES:
        film = Film(1.0 - share, share, -0.6, at)
        cases[f"soft/{share:g}"] = Case(
            film, frozenset({"soft EHL"}), frozenset({"soft EHL + constant torque"})
        )
    for regime, c in TRUE.items():
        power, names = 1.0 + c, frozenset({regime})
        b = _VISCOSITY_POWER * power if power else -0.2
        cases[f"power/{c:.3g}"] = Case(PowerLaw(MIDDLE**-b * at**-power, b, c), names, names)
        cases[f"vogel/{c:.3g}"] = Case(VogelPower(1.0, c, power or 0.1, at), names, names)
    for n in (0.3, 0.5, 0.7):
        cases[f"carreau/{n:g}"] = Case(Carreau(1.0, n, at), none, frozenset({"shear thinning"}))
    for ratio in (1.5, 2.0, 3.0):  # the viscous share puts the minimum near the middle
        law_of_stribeck = Stribeck(ratio, 1.0, 0.5 * at, 0.17 * (ratio - 1.0), at)
        cases[f"stribeck/{ratio:g}"] = Case(law_of_stribeck, none, frozenset({"Stribeck curve"}))
    for strength in (0.3, 1.0, 3.0):
        heated = ShearHeating(1.0, 0.0, at, Vogel()).heated(strength, top)
        cases[f"heating/{strength:g}"] = Case(heated, none, frozenset({"shear heating"}))
    return cases


CASES = _cases()
NAMES = tuple(f"{case}/{setting}" for case in CASES for setting in _TESTS)


def limits(law: TorqueLaw, plan: Plan) -> frozenset[str]:
    """Return the regimes that the law cannot be told from by a torque sensor (see above)."""
    speeds = np.array(plan.speeds) * RPM
    rows = [np.log(law.torque(speeds, np.full(speeds.size, t))) for t in plan.temperatures]
    z = np.log(speeds)
    alike = {
        name
        for name, ends in EXPONENTS.items()
        if any(all(np.ptp(y - (1 + c) * z) <= 2 * WITHIN for y in rows) for c in np.linspace(*ends, 5))
    }
    falls = all(np.all(np.diff(y) < 0) and y[0] - y[-1] > 2 * WITHIN for y in rows)
    return frozenset(alike | ({FALLING} if falls else set()))


@dataclass(frozen=True)
class Verdict:
    """Of one log: the regimes named, whether one of them is right, whether the truth is listed."""

    named: tuple[str, ...]
    wrong: bool
    right: bool
    listed: bool


def one_log(seed: int, name: str, index: int) -> Verdict | str:
    """Return the verdict on one log, or the message with which it was refused."""
    case, setting = CASES[name.rpartition("/")[0]], name.rpartition("/")[2]
    rng, plan = generator(seed, name, index), case.plan(setting)
    found = judged(record(case.law, plan, _errors(setting, rng), rng))
    if found.surface is None:
        return found.refusal
    alike = limits(case.law, plan)
    right = case.regimes | alike
    return Verdict(
        named=tuple(sorted(found.named)),
        wrong=bool(found.named) and not found.named & right,
        right=bool(found.named) and found.named <= right,
        listed=bool(found.explanations & (case.keys | alike)),
    )


def table(results: dict[str, list[Verdict | str]]) -> list[str]:
    """Return the lines: a row per kind of truth and test, one for all, and the cells with a wrong regime."""
    groups: dict[str, list[Verdict | str]] = {}
    for name, rows in results.items():
        kind, _, setting = name.split("/")
        groups.setdefault(f"{kind}, {setting}", []).extend(rows)
    everything = [row for rows in results.values() for row in rows]
    powers = [row for name, rows in results.items() if name.startswith(("power", "vogel")) for row in rows]
    head = ["| truth | logs | a regime named | wrong | the truth's alone | truth among the explanations |"]
    lines = [*head, "|---|---|---|---|---|---|", *(_line(g, rows) for g, rows in groups.items())]
    lines += [_line("**true power laws**", powers), _line("**all**", everything), ""]
    lines += [line for name, rows in results.items() for line in _wrong(name, rows)]
    return lines + _not_listed(results)


def _line(label: str, rows: list[Verdict | str]) -> str:
    """One row; a log that was refused names nothing and lists nothing."""
    kept = [row for row in rows if isinstance(row, Verdict)]
    if not rows:
        return f"| {label} | 0 | | | | |"
    sums = [sum(bool(r.named) for r in kept), *(sum(getattr(r, w) for r in kept) for w in _COUNTED)]
    return f"| {label} | {len(rows)} | " + " | ".join(f"{s / len(rows):.1%}" for s in sums) + " |"


_COUNTED = ("wrong", "right", "listed")


def _wrong(name: str, rows: list[Verdict | str]) -> list[str]:
    """What was wrongly named, and why logs were refused."""
    kept = [row for row in rows if isinstance(row, Verdict)]
    lines = []
    if wrong := Counter(n for row in kept if row.wrong for n in row.named):
        what = ", ".join(f"{n} x {regime}" for regime, n in wrong.most_common())
        lines.append(f"- {name}: wrong {sum(r.wrong for r in kept)} of {len(rows)} ({what})")
    if refused := [row for row in rows if isinstance(row, str)]:
        lines.append(f"- {name}: {len(refused)} refused: {refused[0][:80]}")
    return lines


def _not_listed(results: dict[str, list[Verdict | str]]) -> list[str]:
    """In which cells the truth is not among the explanations, and how often, in one line."""
    missed = {n: sum(not (isinstance(r, Verdict) and r.listed) for r in rows) for n, rows in results.items()}
    cells = ", ".join(f"{n} {m} of {len(results[n])}" for n, m in missed.items() if m)
    return [f"- truth not among the explanations: {cells}"] if cells else []
