"""The shipped campaign as it is followed, its logs neither read nor fitted as runs."""

from __future__ import annotations

import copyreg
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any

import polars as pl
import pytest

import hersey
from hersey.life import ageing_maps, other_uses
from hersey.life.age import Age
from hersey.life.campaign import Entry
from hersey.life.campaign.conversion import entry_of
from hersey.life.growth import fit as growth_module
from hersey.life.growth import marginal
from hersey.life.growth import posterior as growth_posterior
from hersey.life.growth.laws import LAWS, Law
from hersey.life.indicators import sticking
from hersey.life.maintenance import Event
from hersey.machine.machine import Machine, read_machine
from hersey.testbench.stand import RPM
from hersey.units import ZERO_CELSIUS
from tests.conftest import ROOT, made_once

FOLDER = ROOT / "examples" / "life"


@cache
def machine() -> Machine:
    """The machine of the shipped campaign."""
    return read_machine(ROOT / "examples" / "machine.toml")


@cache
def truth() -> list[dict[str, Any]]:
    """The truth of each specimen."""
    units: list[dict[str, Any]] = json.loads((FOLDER / "truth.json").read_text())["units"]
    return units


class Campaign(SimpleNamespace):
    """What answers as a campaign without maintenance does; functions know it by its name."""

    def events(self) -> list[Event]:
        return []


@cache
def film(units: int = 8) -> hersey.FilmLife:
    """The film of some of the shipped specimens."""
    return hersey.film_life(campaign(units), machine())


def campaign(units: int = 8) -> hersey.Campaign:
    """What a campaign of some of the shipped specimens answers."""
    listed = pl.read_csv(FOLDER / "runs.csv").with_row_index("run", offset=1)
    listed = listed.filter(pl.col("unit").is_in([f"U{k}" for k in range(1, units + 1)]))
    listed = listed.with_columns(
        pl.col("age").str.extract(r"(\d+)").cast(float), pl.col("run").cast(pl.Int64)
    )
    rest = machine().rest
    assert rest is not None
    frames = []
    for row in listed.iter_rows(named=True):
        log = pl.read_csv(FOLDER / row["log"], comment_prefix="#")
        speed = log["speed [rpm]"].cast(float).to_numpy() * RPM
        kelvin = log["temperature [degC]"].cast(float).to_numpy() + ZERO_CELSIUS
        frames.append(
            pl.DataFrame(
                {
                    "run_id": [row["run"]] * log.height,
                    "speed (rad/s)": speed,
                    "temperature (K)": kelvin,
                    "torque (N m)": log["torque [N*m]"].to_numpy() - rest.torque(speed, temperature=kelvin),
                    "torque error (N m)": log["torque error [N*m]"].to_numpy(),
                }
            )
        )
    of_runs = listed.select(pl.col("run").alias("run_id"), "unit", pl.col("age").alias("age (pages)"))
    dwells = pl.concat(frames).join(of_runs, on="run_id", maintain_order="left")
    stub: Any = Campaign(
        path=Path("life.hersey"), age_unit="pages", runs=lambda: listed, dwells=lambda: dwells
    )
    answer: hersey.Campaign = stub
    return answer


@cache
def _sample() -> Entry:
    """What is kept of some run, which lends the rest to others."""
    table = {"speed [rpm]": [10, 20, 40, 80], "torque [mN*m]": [5.0, 5.6, 6.3, 7.2]}
    return entry_of(hersey.SteadyPoints.from_table(table, isothermal=True), "sample.csv")


def add(
    campaign: hersey.Campaign, unit: str, age: float, rows: list[tuple[float, float, float, float]]
) -> None:
    """Add a run without reading or fitting it: rows of speed (rad/s), torque and its error (N m), and K."""
    number = len(campaign)
    dwells = [
        [0, 0.0, 0.0, speed, 0.0, torque, error, heat, 0.0, 1, 1.0, 0, "", None, 0.0]
        for speed, torque, error, heat in rows
    ]
    path = str(Path(f"log{number}.csv").absolute())
    entry = replace(_sample(), sha256=f"{number:064x}", path=path, dwells=dwells)
    campaign.add_entries([(entry, unit, Age(age, "pages"))])


_FOLDER = TemporaryDirectory()


@cache
def opened(units: int = 2) -> hersey.Campaign:
    """A campaign in a file, of some of the shipped specimens."""
    return hersey.Campaign.open(write(Path(_FOLDER.name) / f"life-{units}.hersey", units), write=False)


def fewer(patch: pytest.MonkeyPatch) -> None:
    """A third of the draws: what they would tell better is the matter of the benchmark."""
    patch.setattr(growth_posterior, "_ROUNDS", (100, 100, 100, 200))
    patch.setattr(growth_posterior, "_MOST", 2.0)
    patch.setattr(marginal, "_POPULATION", 64)
    patch.setattr(growth_module, "_DRAWS", 1000)


@contextmanager
def few() -> Iterator[None]:
    """Look for V* in few runs, uses and places of a map, at a second each: tests of their own see all."""
    with pytest.MonkeyPatch.context() as patch:
        fewer(patch)
        patch.setattr(sticking, "MOST_FOLDS", 4)
        patch.setattr(sticking, "_DRAWS", 2)
        patch.setattr(ageing_maps, "TEMPERATURES", 7)
        patch.setattr(other_uses, "_LIMITS", (0.8, 1.0, 1.25))
        yield


def _by_name(law: Law) -> tuple[Callable[[str], Law], tuple[str]]:
    return _law_of, (law.name,)


def _law_of(name: str) -> Law:
    return next(law for law in LAWS if law.name == name)


copyreg.pickle(Law, _by_name)  # it holds functions without names, and there is one of each


@cache
def followed(units: int = 2) -> hersey.LifeTest:
    """What ends some of the shipped specimens, and when; of few ways, which is quicker."""
    less = replace(machine(), limits=hersey.Limits(motor_torque=1.0), points=machine().points[:1])
    with few():
        return made_once(f"followed-{units}", lambda: hersey.follow(opened(units), less))


def write(path: Path, units: int = 2) -> Path:
    """Write a campaign of the dwells of some of the shipped specimens, whole torques, every second dwell."""
    whole = campaign(units)
    rest = machine().rest
    assert rest is not None
    with hersey.Campaign.create(path) as written:
        names = ("speed (rad/s)", "torque (N m)", "torque error (N m)", "temperature (K)")
        for (unit, age), dwells in whole.dwells().group_by("unit", "age (pages)", maintain_order=True):
            speed, torque, error, kelvin = (dwells[name].to_numpy()[::2] for name in names)
            torque = torque + rest.torque(speed, temperature=kelvin)
            rows = zip(*(each.tolist() for each in (speed, torque, error, kelvin)), strict=True)
            add(written, str(unit), float(age), list(rows))  # type: ignore[arg-type]
    return path
