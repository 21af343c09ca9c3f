"""Campaigns with one mistake each, as people make them, and whether hersey names it.

`Slip` says which runs are wrong and how.
"""

from __future__ import annotations

import json
import math
import os
import re
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator

from benchmarks.life_tests import campaign as drawn
from benchmarks.life_tests import modes, product, tables
from benchmarks.life_tests.campaign import Campaign
from benchmarks.life_tests.drive import draw_drive

Runs = dict[tuple[str, int], str]

#: Kinds of the warnings that name each mistake. One log does not tell another machine from another lubricant.
KINDS = {
    "swapped logs": ("logs exchanged",),
    "ages of a specimen too small": ("ages scaled",),
    "age of a run too small": ("age scaled",),
    "another machine": ("another machine", "another lubricant or machine"),
    "another lubricant": ("another lubricant or machine",),
    "torque unit": ("torque scaled",),
}
#: Kinds of warnings that suspect a run of a mistake.
SUSPECTS = {
    *(kind for kinds in KINDS.values() for kind in kinds),
    "ages exchanged",
    "torques scaled",
    "same log",
}
#: Factor within which a factor is named.
CLOSE = 2.0
#: Least difference of two specimens, relative, by which an exchange of their logs can be seen.
VISIBLE = 0.06
#: Difference of two ages over the last one at which logs get exchanged: they are of one day at the stand.
SAME_AGE = 0.15
#: Torques that are taken for N m: by how much a number is too large.
TORQUE_UNITS = {"lbf*in": 8.851, "kgf*cm": 10.197, "N*cm": 100.0, "ozf*in": 141.61, "mN*m": 1000.0}


@dataclass(frozen=True)
class Slip:
    """One mistake: its kind, the specimens, the ages as typed (none: all of the specimen), and its factor."""

    kind: str
    units: tuple[str, ...]
    ages: tuple[int, ...] = ()
    factor: float = 1.0


def _difference(one: Campaign, first: int, second: int, column: int) -> float:
    """Return by how much two specimens differ at a run, in the torque that differs most; relative."""
    values = []
    for unit in (first, second):
        state = one.state(unit)
        found = modes.indicators(one.drive, one.use, state)
        values.append([found[name][0, column] for name in (modes.COLD_FAST, modes.HOT_SLOW, modes.ENERGY)])
    return float(np.max(np.abs(np.log(np.divide(*values)))))


def swapped(one: Campaign, runs: Runs, rng: Generator) -> tuple[Runs, Slip]:
    """Return runs of which the logs of two specimens are exchanged at one age, where they differ most."""
    units = range(len(one.units))
    pairs = [
        (_difference(one, a, b, column), a, b, column)
        for a in units
        for b in units[a + 1 :]
        for column in range(2, min(len(one.ages[a]), len(one.ages[b])))
        if abs(one.ages[a][column] - one.ages[b][column]) < SAME_AGE * one.ages[a][-1]
    ]
    likely = [pair for pair in sorted(pairs)[-max(3, len(pairs) // 5) :] if pair[0] > VISIBLE]
    if not likely:
        return scaled_ages(one, runs, rng)
    _, a, b, column = likely[rng.integers(len(likely))]
    keys = [(one.units[unit], int(one.ages[unit][column])) for unit in (a, b)]
    changed = {**runs, keys[0]: runs[keys[1]], keys[1]: runs[keys[0]]}
    return changed, Slip("swapped logs", (keys[0][0], keys[1][0]), (keys[0][1], keys[1][1]))


def _aged(runs: Runs, unit: str, factor: float, only: int | None = None) -> Runs:
    """Return runs whose ages are divided by a factor, of one specimen or one run of it."""
    return {
        (name, round(age / factor) if name == unit and only in (None, age) else age): text
        for (name, age), text in runs.items()
    }


def scaled_ages(one: Campaign, runs: Runs, rng: Generator) -> tuple[Runs, Slip]:
    """Return runs with the ages of one specimen a thousand times too small."""
    unit = str(rng.choice(one.units))
    return _aged(runs, unit, 1000), Slip("ages of a specimen too small", (unit,), (), 1000)


def hours(one: Campaign, runs: Runs, rng: Generator) -> tuple[Runs, Slip]:
    """Return runs with the ages of one specimen in hours, at 10 to 40 pages in a minute."""
    unit, factor = str(rng.choice(one.units)), float(rng.uniform(10, 40) * 60)
    return _aged(runs, unit, factor), Slip("ages of a specimen too small", (unit,), (), factor)


def thousands(one: Campaign, runs: Runs, rng: Generator) -> tuple[Runs, Slip]:
    """Return runs with the age of the last run of a specimen in thousands."""
    unit = int(rng.integers(len(one.units)))
    age, name = int(one.ages[unit][-1]), one.units[unit]
    return _aged(runs, name, 1000, age), Slip("age of a run too small", (name,), (round(age / 1000),), 1000)


def _replaced(one: Campaign, runs: Runs, rng: Generator, kind: str) -> tuple[Runs, Slip]:
    """Return runs of which one is that of another machine or another lubricant."""
    unit = int(rng.integers(len(one.units)))
    column = int(rng.integers(1, len(one.ages[unit])))
    drive = one.drive
    if kind == "another lubricant":
        a, b, c = drive.oil
        ratio, slope = float(np.exp(rng.uniform(np.log(2), np.log(4)))), rng.uniform(0.8, 1.25)
        ratio = ratio if rng.random() < 0.5 else 1 / ratio
        drive = replace(drive, oil=(a * ratio * float(np.exp(b * (1 - slope) / (420 - c))), b * slope, c))
    else:
        other = draw_drive(rng, film=drive.film, rolling=one.mechanism.rolling)
        layer = drive.layer * float(np.exp(rng.normal(0, 0.3)))
        rest = (drive.rest[0] * rng.uniform(1.3, 2), drive.rest[1] * rng.uniform(0.5, 2))
        drive = replace(other, layer=layer, oil=drive.oil, rest=rest)
    state = one.state(unit).at(slice(None), [column])
    key = (one.units[unit], int(one.ages[unit][column]))
    return {**runs, key: tables.table(one, drive, state, rng)}, Slip(kind, (key[0],), (key[1],))


def machine(one: Campaign, runs: Runs, rng: Generator) -> tuple[Runs, Slip]:
    """Return runs of which one is that of another machine."""
    return _replaced(one, runs, rng, "another machine")


def lubricant(one: Campaign, runs: Runs, rng: Generator) -> tuple[Runs, Slip]:
    """Return runs of which one is that of another lubricant."""
    return _replaced(one, runs, rng, "another lubricant")


def torque(one: Campaign, runs: Runs, rng: Generator) -> tuple[Runs, Slip]:
    """Return runs of which one has its torque in another unit than its heading says."""
    unit = int(rng.integers(len(one.units)))
    key = (one.units[unit], int(rng.choice(one.ages[unit][1:])))
    factor = TORQUE_UNITS[str(rng.choice(list(TORQUE_UNITS)))]
    head, *rows = runs[key].splitlines()
    cells = [row.split(",") for row in rows]
    rows = [f"{v},{t},{float(q) * factor:.5g},{float(e) * factor:.4g},{way}" for v, t, q, e, way in cells]
    return {**runs, key: "\n".join([head, *rows]) + "\n"}, Slip("torque unit", (key[0],), (key[1],), factor)


MAKERS = (swapped, scaled_ages, hours, thousands, machine, lubricant, torque)
#: Those that leave a trace where nothing ages.
LASTING = (scaled_ages, hours, machine, lubricant, torque)


def seeds(first: int, count: int) -> list[int]:
    """Return seeds from ``first`` on without re-greased campaigns, in which a jump is no mistake."""
    return [seed for seed in range(first, first + 2 * count) if seed % 10 != 8][:count]


def made_of(seed: int, *, slip: bool, number: int) -> tuple[Campaign, Runs, Slip | None]:
    """Return the campaign of a seed, its runs with or without the mistake of a number, and the mistake."""
    one = drawn.draw(seed)
    rng = np.random.default_rng([36, seed])
    runs = tables.tables(one)
    if not slip:
        return one, runs, None
    makers = MAKERS if one.mechanism.leads else LASTING
    return one, *makers[number % len(makers)](one, runs, rng)


def write(seed: int, folder: Path, *, slip: bool, number: int) -> None:
    """Write the campaign of a seed with or without the mistake of a number."""
    one, runs, made = made_of(seed, slip=slip, number=number)
    tables.write_runs(runs, folder)
    for log in folder.glob("U*.csv"):  # as after copying: their times say nothing
        os.utime(log, (1.7e9, 1.7e9))
    (folder / "machine.toml").write_text(tables.machine_file(one))
    stated = {"seed": seed, "mechanism": one.mechanism.name, "slip": asdict(made) if made else None}
    (folder / "slip.json").write_text(json.dumps(stated, indent=1) + "\n")


def row(folder: Path) -> dict[str, Any]:
    """Return what hersey warns of, of the campaign in a folder, beside the mistake."""
    import hersey

    stated = json.loads((folder / "slip.json").read_text())
    with hersey.Campaign.open(product.campaign_file(folder), write=False) as campaign:
        said = campaign.check().to_dict()
    return {**stated, "said": said, "refused": product.refused(folder)}


def warnings(found: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the warnings of a row that say that a run may be mistaken."""
    every = [each for value in found["said"].values() if isinstance(value, list) for each in value]
    return [each for each in every if isinstance(each, dict) and each.get("kind") in SUSPECTS]


def found_run(found: dict[str, Any]) -> bool:
    """Return whether a warning has the specimens of the mistake and, of single runs, their ages."""
    slip = found["slip"]
    wanted = [*slip["units"], *(f"{age}" for age in slip["ages"])]
    return any(_words(each).issuperset(wanted) for each in warnings(found))


def named(found: dict[str, Any]) -> bool:
    """Return whether a warning has, beside the runs of the mistake, its kind and about its factor."""
    slip = found["slip"]
    factor = 1 / slip["factor"] if slip["kind"].startswith("age") else slip["factor"]
    right = [
        each
        for each in warnings(found)
        if each["kind"] in KINDS[slip["kind"]]
        and (factor == 1 or abs(math.log(each["values"].get("factor", 1.0) / factor)) < math.log(CLOSE))
    ]
    return found_run({**found, "said": {"warnings": right}})


def _words(warning: dict[str, Any]) -> set[str]:
    """Return the words and numbers of the facts of a warning."""
    text = re.sub(r"(?<=\d),(?=\d{3})", "", json.dumps(warning["values"]))
    words = set(re.findall(r"[\w.]+", text))
    return words | {word.removesuffix(".0") for word in words}


def report(rows: list[dict[str, Any]]) -> str:
    """Return how many mistakes are named, by kind, and how many clean campaigns are suspected."""
    wrong, clean = [row for row in rows if row["slip"]], [row for row in rows if not row["slip"]]
    lines = ["| mistake | campaigns | named rightly | run named | some warning |", "|---|---|---|---|---|"]
    groups = {kind: [row for row in wrong if row["slip"]["kind"] == kind] for kind in KINDS} | {"all": wrong}
    for name, those in groups.items():
        counts = (
            sum(map(named, those)),
            sum(map(found_run, those)),
            sum(bool(warnings(row)) for row in those),
        )
        lines.append(f"| {name} | {len(those)} | {' | '.join(map(str, counts))} |")
    suspected = sum(bool(warnings(row)) for row in clean)
    return "\n".join([*lines, "", f"Without a mistake: {len(clean)} campaigns, {suspected} suspected."])
