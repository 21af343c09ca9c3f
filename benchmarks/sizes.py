"""The works whose time is followed over their size, each with what it needs: `benchmarks.growth_of_time`."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import cycle, islice
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

import hersey
from benchmarks.motion import DRAG, TRAIN
from hersey.damping.candidates.candidate import all_candidates
from hersey.life.failures.estimate import weibull

EXAMPLES = Path(__file__).parents[1] / "examples"
GROUPS = ("rows", "dwells", "candidates", "draws", "specimens", "sets")
#: Why some works grow faster than what they are given.
_OF_VISITS = (
    "How far visits scatter follows from the eigenvalues of a matrix with a row for each visit; a visit has "
    "eight dwells here. From some thousand dwells on they take most of the time."
)
_OF_ZERO = (
    "The error of the torque zero is shared by the dwells: every two have a covariance, for each size of "
    "drift that the standing stretches allow."
)
#: Dwells of a log whose rows grow, and rows of a dwell where they grow.
DWELLS, ROWS = 100, 100
_FOLDER = tempfile.TemporaryDirectory()


@dataclass(frozen=True, eq=False)
class Series:
    """A work over its size: what is made ready, and what is timed."""

    group: str
    work: str
    sizes: tuple[int, ...]
    prepare: Callable[[int], Any]
    run: Callable[[Any], Any]
    more: tuple[int, ...] = ()
    why: str = ""


def log(dwells: int, rows: int) -> pl.DataFrame:
    """Return a log of so many dwells, of so many rows each at 10 Hz, that stands still at both ends."""
    rng = np.random.default_rng(1)
    rpm = np.concatenate([[0.0], np.resize(np.geomspace(4.0, 160.0, 8), dwells), [0.0]])
    level = np.concatenate([[0], np.arange(dwells) // 8 % 4, [3]])
    speed, celsius = np.repeat(rpm, rows), np.repeat(np.array([90.0, 120.0, 150.0, 180.0])[level], rows)
    omega = np.maximum(speed, 1e-9) * np.pi / 30
    torque = np.where(speed > 0, 0.5 * (celsius / 100) ** -1.2 * omega**0.405, 0.0)
    torque = torque * (1 + 0.004 * rng.standard_normal(speed.size)) + 1e-4 * rng.standard_normal(speed.size)
    return pl.DataFrame(
        {
            "Time (s)": np.arange(speed.size) / 10,
            "Speed (rpm)": speed,
            "Torque (N*m)": torque.round(5),
            "Temp (degC)": celsius + 0.05 * rng.standard_normal(speed.size).round(2),
        }
    )


def text(rows: int) -> Path:
    """Return a CSV of so many rows and `DWELLS` dwells."""
    path = Path(_FOLDER.name) / "rows.csv"
    log(DWELLS, rows // (DWELLS + 2)).write_csv(path)
    return path


def read(dwells: int, rows: int) -> hersey.TorqueLog:
    """Return a log as read."""
    return hersey.read(log(dwells, rows))


def steady(found: hersey.TorqueLog) -> hersey.SteadyPoints:
    """Return its dwells."""
    return found.steady(tare="standing")


@cache
def points(dwells: int) -> hersey.SteadyPoints:
    """Return so many dwells."""
    return steady(read(dwells, ROWS))


@cache
def example() -> tuple[hersey.SteadyPoints, hersey.DampingSurface, hersey.Machine]:
    """Return the shipped log's dwells, fit and machine."""
    stated = hersey.read_machine(EXAMPLES / "machine.toml")
    found = hersey.read(EXAMPLES / "bench.csv").steady(tare="standing")
    if stated.rest is not None:
        found = found.without(stated.rest)
    return found, hersey.fit(found), stated


def compared(candidates: int) -> Any:
    """Compare so many laws on 200 dwells: nine, each several times."""
    laws = tuple(islice(cycle(all_candidates()[::4]), candidates))
    return hersey.compare_models(points(200), candidates=laws, bootstrap=0, cross_validate=False)


def uniform(sets: int) -> dict[str, np.ndarray]:
    """Return so many sets of stiffness and drag at the transition."""
    random = np.random.default_rng(2015)
    return {"stiffness": random.uniform(500, 2000, sets), "transition_force": random.uniform(25, 100, sets)}


def growing(specimens: int) -> tuple[list[str], np.ndarray, np.ndarray]:
    """Return ten runs each of so many specimens: names, ages and values."""
    rng = np.random.default_rng(3)
    age = np.tile(np.linspace(0.0, 1.0, 10), specimens)
    rate = np.repeat(rng.lognormal(-0.5, 0.3, specimens), 10)
    names = [f"unit {i // 10}" for i in range(10 * specimens)]
    return names, age, (1 + rate * age) * rng.lognormal(0.0, 0.02, age.size)


def life_test(specimens: int) -> Path:
    """Return the folder of a life test with so many specimens, copies of the shipped ones but for noise."""
    folder = Path(_FOLDER.name) / f"life-{specimens}"
    folder.mkdir(exist_ok=True)
    shipped = pl.read_csv(EXAMPLES / "life" / "runs.csv")
    names, rng, rows = shipped["unit"].unique().sort().to_list(), np.random.default_rng(4), []
    for i in range(specimens):
        for file, _, age in shipped.filter(pl.col("unit") == names[i % len(names)]).rows():
            means = pl.read_csv(EXAMPLES / "life" / file, comment_prefix="#")
            torque = next(name for name in means.columns if "torque" in name.lower())
            scale = 1 + 1e-4 * rng.standard_normal()
            means.with_columns(pl.col(torque) * scale).write_csv(folder / f"{i}-{file}")
            rows.append((f"{i}-{file}", f"S{i}", age))
    pl.DataFrame(rows, schema=["log", "unit", "age"], orient="row").write_csv(folder / "runs.csv")
    return folder


def typed(folder: Path, *words: str) -> None:
    """Run a command in a folder."""
    command, around = [sys.executable, "-m", "hersey.cli", *words], os.environ | {"HERSEY_CACHE": "off"}
    subprocess.run(command, cwd=folder, capture_output=True, check=True, env=around)


def add(folder: Path) -> None:
    """Add every run of a folder to a new campaign."""
    (folder / "life.hersey").unlink(missing_ok=True)
    machine = str(EXAMPLES / "machine.toml")
    typed(folder, "campaign", "add", "life.hersey", "--table", "runs.csv", "--means", "--machine", machine)


def follow(folder: Path) -> None:
    """Follow the campaign of a folder to what ends its specimens."""
    typed(folder, "life", "life.hersey", "--machine", str(EXAMPLES / "machine.toml"), "--json")


def decades(first: float, last: float) -> tuple[int, ...]:
    """Return 1, 3, 10, 30 ... between two numbers."""
    exponents = np.arange(round(2 * np.log10(first)), round(2 * np.log10(last)) + 1)
    return tuple(int(10 ** (k // 2) * (3 if k % 2 else 1)) for k in exponents)


def _posterior(draws: int) -> Any:
    found, surface, stated = example()
    return hersey.posterior(found, stated, surface=surface, draws=draws)


def _map(draws: int) -> Any:
    _, surface, stated = example()
    return hersey.operating_map(surface, stated, draws=draws)


def _same(size: int) -> int:
    return size


SERIES = (
    Series("rows", "read a CSV of 100 dwells", decades(1e5, 1e7), text, hersey.read, (30_000_000, 10**8)),
    Series("rows", "dwells of a log with 100", decades(1e5, 1e7), lambda n: read(DWELLS, n // 102), steady),
    Series(
        "dwells",
        "dwells of a log, 100 rows each",
        decades(1e2, 1e5),
        lambda n: read(n, ROWS),
        steady,
        why=_OF_ZERO,
    ),
    Series("dwells", "fit", decades(1e2, 1e5), points, hersey.fit, why=_OF_VISITS),
    Series(
        "dwells",
        "models, no bootstrap",
        (50, 100, 200, 400, 800),
        points,
        lambda found: hersey.compare_models(found, bootstrap=0),
        why=_OF_VISITS,
    ),
    Series("candidates", "models of 200 dwells", (9, 18, 36, 72, 144, 288), _same, compared),
    Series(
        "draws",
        "models, resampled logs",
        (100, 200, 400, 800, 1600),
        _same,
        lambda n: hersey.compare_models(points(200), bootstrap=n, cross_validate=False),
    ),
    Series("draws", "posterior", decades(1e2, 1e4), _same, _posterior),
    Series("draws", "operating map", decades(1e2, 1e4), _same, _map),
    Series(
        "specimens", "growth, ten runs each", (4, 8, 16, 32, 64), growing, lambda g: hersey.fit_growth(*g)
    ),
    Series(
        "specimens",
        "Weibull",
        decades(10, 3e3),
        lambda n: np.random.default_rng(5).weibull(2.0, n),
        lambda ages: weibull(ages, [True] * ages.size),
    ),
    Series("specimens", "campaign add, six runs each", (2, 4, 8, 16), life_test, add, (32, 64)),
    Series("specimens", "life, six runs each", (2, 4, 8, 16), life_test, follow, (32, 64)),
    Series(
        "sets",
        "sweep to the cycle",
        decades(1e3, 1e6),
        uniform,
        lambda sets: hersey.sweep(TRAIN, DRAG, **sets, drive_speed=1.0, zip=True),
        (10**7,),
    ),
    Series(
        "sets",
        "hysteresis, both edges",
        decades(1e3, 1e5),
        uniform,
        lambda sets: hersey.hysteresis_sweep(TRAIN, DRAG, **sets, zip=True),
        (10**6,),
    ),
)
