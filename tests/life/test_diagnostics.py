"""Slips planted into the runs of the shipped life test: which are named, and what they move."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.life.age import Age
from hersey.life.diagnostics.compared import Compared
from hersey.life.diagnostics.diagnosis import Diagnosis, diagnosed
from hersey.life.diagnostics.fingerprint import Fingerprints
from hersey.life.diagnostics.measured import MeasuredRuns
from hersey.life.growth.fit import fit_growth
from hersey.life.indicator import Indicator, Indicators, Runs
from hersey.life.maintenance import RE_GREASED, Event
from hersey.testbench.stand import RPM
from tests.cli.command import run as typed
from tests.conftest import ROOT
from tests.life.shipped import FOLDER


@dataclass(frozen=True)
class Run:
    """A run that a slip may change."""

    unit: str
    age: float
    speed: np.ndarray
    kelvin: np.ndarray
    torque: np.ndarray


@cache
def shipped() -> tuple[Run, ...]:
    """The shipped runs, every second dwell."""
    runs = []
    for row in pl.read_csv(FOLDER / "runs.csv").iter_rows(named=True):
        log = pl.read_csv(FOLDER / row["log"], comment_prefix="#")[::2]
        speed = log["speed [rpm]"].cast(float).to_numpy() * RPM
        kelvin = log["temperature [degC]"].cast(float).to_numpy() + 273.15
        runs.append(
            Run(row["unit"], float(row["age"].split()[0]), speed, kelvin, log["torque [N*m]"].to_numpy())
        )
    return tuple(runs)


def measured(runs: list[Run], events: tuple[Event, ...] = ()) -> MeasuredRuns:
    """Runs as a campaign hands them over, numbered by specimen and age."""
    runs = sorted(runs, key=lambda each: (each.unit, each.age))
    joined = [np.concatenate([getattr(run, name) for run in runs]) for name in ("speed", "kelvin", "torque")]
    return MeasuredRuns(
        tuple(range(1, len(runs) + 1)),
        tuple(run.unit for run in runs),
        np.array([run.age for run in runs]),
        "pages",
        np.repeat(np.arange(len(runs)), [run.speed.size for run in runs]),
        *joined,
        events,
    )


def changed(change: Callable[[Run], Run], runs: tuple[Run, ...] | None = None) -> list[Run]:
    return [change(run) for run in runs or shipped()]


def at(unit: str, age: float | None = None) -> Callable[[Run], bool]:
    return lambda run: run.unit == unit and age in (None, run.age)


def exchanged(one: Callable[[Run], bool], other: Callable[[Run], bool]) -> list[Run]:
    """The runs with the logs of two exchanged."""
    (first,), (second,) = ([run for run in shipped() if which(run)] for which in (one, other))
    of = {
        id(first): replace(second, unit=first.unit, age=first.age),
        id(second): replace(first, unit=second.unit, age=second.age),
    }
    return changed(lambda run: of.get(id(run), run))


def times(factor: float, which: Callable[[Run], bool]) -> list[Run]:
    return changed(lambda run: replace(run, torque=factor * run.torque) if which(run) else run)


def aged(factor: float, which: Callable[[Run], bool]) -> list[Run]:
    return changed(lambda run: replace(run, age=factor * run.age) if which(run) else run)


def other_oil(run: Run) -> Run:
    """A run with an oil that is thicker hot than cold."""
    return replace(run, torque=run.torque * np.exp(0.2 + 0.2 * (run.kelvin - 390.0) / 50.0))


def facts(found: Diagnosis) -> list[dict[str, Any]]:
    """Kind and numbers of each slip, without the words."""
    return [
        {"kind": each.kind, **{k: v for k, v in each.values.items() if k != "how"}} for each in found.warnings
    ]


def test_the_shipped_runs_are_as_they_should_be() -> None:
    found = diagnosed(measured(list(shipped())))
    assert found.warnings == ()
    assert found.excluded == []


def test_a_campaign_without_runs_has_no_slip(tmp_path: Path) -> None:
    with hersey.Campaign.create(tmp_path / "empty.hersey") as campaign:
        assert campaign.diagnose().slips == ()
        assert campaign.check().warnings == ()


def test_logs_of_two_specimens_exchanged() -> None:
    found = diagnosed(measured(exchanged(at("U4", 140000.0), at("U8", 140000.0))))
    assert facts(found) == [
        {
            "kind": "logs exchanged",
            "unit": "U4",
            "run": 23,
            "age": 140000.0,
            "age_unit": "pages",
            "other_unit": "U8",
            "other_run": 47,
            "other_age": 140000.0,
        }
    ]
    assert str(found.warnings[0]).startswith("logs of U4 and U8 at 140000 pages look exchanged. If they are")
    assert found.excluded == [22, 46]
    assert found.concerning({47}) == found.warnings
    assert found.concerning({1, 2}) == ()


@pytest.mark.nightly
def test_logs_of_one_specimen_exchanged() -> None:
    (slip,) = facts(diagnosed(measured(exchanged(at("U4", 35000.0), at("U4", 140000.0)))))
    assert {**slip, "run": 0, "other_run": 0} == {
        "kind": "ages exchanged",
        "unit": "U4",
        "run": 0,
        "age": 35000.0,
        "age_unit": "pages",
        "other_unit": "U4",
        "other_run": 0,
        "other_age": 140000.0,
    }


@cache
def of_scaled_ages(unit: str, factor: float) -> Diagnosis:
    """What is found if the ages of a specimen are so many times theirs."""
    return diagnosed(measured(aged(factor, at(unit))))


@pytest.mark.parametrize(
    ("unit", "factor"), [("U3", 1e-3), pytest.param("U7", 60.0, marks=pytest.mark.nightly)]
)
def test_ages_of_a_specimen_in_another_unit(unit: str, factor: float) -> None:
    found = of_scaled_ages(unit, factor)
    (slip,) = facts(found)
    assert (slip["kind"], slip["unit"], slip["runs"]) == ("ages scaled", unit, 6)
    assert slip["factor"] == pytest.approx(factor)
    assert len(found.excluded) == 6
    words = "1000 times smaller" if factor < 1 else "60 times larger"
    assert str(found.warnings[0]).startswith(f"ages of {unit} look {words} than those of the others")


@pytest.mark.nightly
def test_an_age_that_was_typed_wrong() -> None:
    (slip,) = facts(diagnosed(measured(aged(10.0, at("U2", 105000.0)))))
    assert (slip["kind"], slip["unit"], slip["age"]) == ("age scaled", "U2", 1050000.0)
    assert slip["factor"] == pytest.approx(10.0)


@pytest.mark.nightly
def test_torques_of_a_specimen_in_another_unit() -> None:
    (slip,) = facts(diagnosed(measured(times(141.612, at("U2")))))
    assert (slip["kind"], slip["unit"]) == ("torques scaled", "U2")
    assert slip["factor"] == pytest.approx(141.612)


def test_slips_of_single_runs_are_each_named() -> None:
    """A copied log, a torque in another unit, a run of another machine, and one with another lubricant."""
    (copied,) = [run for run in shipped() if at("U1", 70000.0)(run)]
    made: list[tuple[Callable[[Run], bool], Callable[[Run], Run]]] = [
        (at("U1", 105000.0), lambda run: replace(copied, age=run.age)),
        (at("U2", 70000.0), lambda run: replace(run, torque=141.612 * run.torque)),
        (at("U5", 70000.0), lambda run: replace(run, torque=1.4 * run.torque)),
        (at("U7", 105000.0), other_oil),
    ]
    runs = changed(lambda run: next((change(run) for which, change in made if which(run)), run))
    found = diagnosed(measured(runs))
    by_kind = {slip["kind"]: slip for slip in facts(found)}
    assert set(by_kind) == {"same log", "torque scaled", "another machine", "another lubricant or machine"}
    assert len(found.slips) == 4
    assert (by_kind["same log"]["run"], by_kind["same log"]["other_run"]) == (3, 4)
    torque, machine = by_kind["torque scaled"], by_kind["another machine"]
    assert (torque["unit"], torque["run"], torque["age"]) == ("U2", 9, 70000.0)
    assert torque["factor"] == pytest.approx(141.612)
    assert (machine["unit"], machine["run"], machine["age"]) == ("U5", 27, 70000.0)
    assert machine["factor"] == pytest.approx(1.4, rel=0.05)
    lubricant = by_kind["another lubricant or machine"]
    assert (lubricant["unit"], lubricant["run"]) == ("U7", 40)
    assert found.excluded == [2, 3, 8, 26, 39]
    table = found.to_frame()
    far = table.filter(pl.col("distance (1)") > 5.0)["run"].to_list()
    assert far == [9, 27, 40]  # each among the others as they should be
    assert dict(zip(table["run"], table["slip"], strict=True))[9] == "torque scaled"


def test_a_few_runs_are_not_doubted() -> None:
    for count, ages in ((1, 3), (2, 3), (3, 2)):
        some = [
            run for run in times(1.5, at("U2", 35000.0)) if run.unit in [f"U{k + 1}" for k in range(count)]
        ]
        some = [run for run in some if run.age < 35000.0 * ages]
        assert diagnosed(measured(some)).warnings == ()
    assert diagnosed(measured(list(shipped())[:1])).warnings == ()


def test_torque_that_falls_at_maintenance_is_no_slip() -> None:
    greased = tuple(Event(unit, Age(120000.0, "pages"), RE_GREASED, None) for unit in ("U4", "U8"))
    runs = changed(
        lambda run: (
            replace(run, torque=0.7 * run.torque) if run.age > 120000.0 and run.unit in ("U4", "U8") else run
        )
    )
    assert diagnosed(measured(runs, greased)).warnings == ()


def medians(runs: list[Run], excluded: list[int]) -> dict[str, float]:
    """Age at twice the torque when new of each specimen, by the mean torque of its runs."""
    runs = sorted(runs, key=lambda each: (each.unit, each.age))
    kept = [run for i, run in enumerate(runs) if i not in excluded]
    value = [float(np.exp(np.log(run.torque[run.kelvin < 350.0]).mean())) for run in kept]
    growth = fit_growth(
        [run.unit for run in kept], [run.age for run in kept], value, 0.01, laws=["linear", "exponential"]
    )
    return {each.unit: each.age.value for each in growth.reaches(0.5).units}


def test_slips_do_not_move_the_other_specimens() -> None:
    right = medians(list(shipped()), [])
    runs = aged(1e-3, at("U3"))
    found = of_scaled_ages("U3", 1e-3)
    moved = medians(runs, found.excluded)
    others = [unit for unit in right if unit != "U3"]
    assert max(abs(moved[unit] / right[unit] - 1.0) for unit in others) < 0.03


def test_indicators_are_unknown_at_runs_that_do_not_fit() -> None:
    runs = Runs((1, 2, 3), ("A", "A", "A"), np.array([0.0, 1.0, 2.0]), "h")
    one = Indicator("torque", "torque", "N m", 2.0, np.array([1.0, 1.1, 1.2]), np.full(3, 0.01))
    every = Indicators(runs, (one,))
    assert every.without_runs([]) is every
    assert np.isnan(every.without_runs([1]).each[0].value).tolist() == [False, True, False]


@pytest.mark.nightly
def test_the_terminal_names_exchanged_logs_when_they_are_added(tmp_path: Path) -> None:
    table = (FOLDER / "runs.csv").read_text()
    table = re.sub(
        r"U([48])-140000\.csv,U\d", lambda match: f"U{match[1]}-140000.csv,U{12 - int(match[1])}", table
    )
    table = re.sub(r"^(U\d)", rf"{FOLDER}/\1", table, flags=re.MULTILINE)
    (tmp_path / "runs.csv").write_text(table)
    machine = ROOT / "examples" / "machine.toml"
    added = typed(
        "campaign", "add", "life.hersey", "--table", "runs.csv", "--means", "--machine", machine, cwd=tmp_path
    )
    assert "logs of U4 and U8 at 140000 pages look exchanged" in " ".join(added.stderr.split())
    checked = typed("campaign", "check", "life.hersey", cwd=tmp_path)
    assert checked.returncode == 1
    assert "logs of U4 and U8 at 140000 pages look exchanged" in checked.words


def of_some_runs() -> tuple[np.ndarray, np.ndarray, Fingerprints]:
    """Numbers of 20 runs of four specimens: level and slope, with errors that differ."""
    random = np.random.default_rng(4)
    specimen, age = np.repeat(np.arange(4), 5), np.tile(np.linspace(0.0, 1.0, 5), 4)
    level = 0.02 * random.standard_normal(4)[specimen] + 0.3 * age + 0.03 * random.standard_normal(20)
    value = np.column_stack([level, 0.5 * level + 0.01 * random.standard_normal(20)])
    variance = random.uniform(1e-4, 9e-4, (20, 2))
    return specimen, age, Fingerprints(value, variance, np.ones(20, dtype=bool), 0.01)


def test_whitened_numbers_have_the_variance_of_the_sum() -> None:
    specimen, age, prints = of_some_runs()
    found = Compared.of(specimen, age, prints)
    there = found.with_runs(specimen, age, prints)
    for i in range(20):
        covariance = found.whiten @ np.diag(prints.variance[i]) @ found.whiten.T
        for rows in (found.rows, there.rows):
            np.testing.assert_allclose(rows.variance[i // 5, i % 5], np.diag(covariance), rtol=1e-12)
            np.testing.assert_allclose(rows.value[i // 5, i % 5], found.whiten @ prints.value[i], rtol=1e-12)


def test_distance_and_influence_are_those_of_a_trend_without_the_run() -> None:
    """By regression of a Gaussian process on the other runs alone, one after the other."""
    specimen, age, prints = of_some_runs()
    at = Compared.of(specimen, age, prints)

    def common(one: np.ndarray, other: np.ndarray, term: int) -> np.ndarray:
        level, slope, walk, _ = (
            getattr(at.spreads, name)[term] ** 2 for name in ("level", "slope", "walk", "run")
        )
        return np.asarray(level + slope * np.outer(one, other) + walk * np.minimum.outer(one, other))

    def trend(kept: np.ndarray, to: float, term: int) -> tuple[float, float]:
        times = age[kept]
        left = (prints.value[kept] @ at.whiten.T - at.mean.at(times))[:, term]
        own = np.diag(prints.variance[kept] @ (at.whiten**2).T[:, term] + at.spreads.run[term] ** 2)
        weight = np.linalg.solve(common(times, times, term) + own, common(times, np.array([to]), term)[:, 0])
        spread = common(np.array([to]), np.array([to]), term)[0, 0]
        return float(weight @ left), float(spread - weight @ common(times, np.array([to]), term)[:, 0])

    for i in range(20):
        of = np.flatnonzero(specimen == specimen[i])
        others = of[of != i]
        squares = []
        for term in range(2):
            expected, variance = trend(others, age[i], term)
            variance += float(prints.variance[i] @ (at.whiten[term] ** 2) + at.spreads.run[term] ** 2)
            own = float(at.whiten[term] @ prints.value[i] - at.mean.at(age[[i]])[0, term])
            squares.append((own - expected) ** 2 / variance)
        assert at.distance[i] == pytest.approx(np.sqrt(np.mean(squares)), rel=1e-6)
        moved = (trend(others, 1.0, 0)[0] - trend(of, 1.0, 0)[0]) / at.whiten[0, 0]
        assert at.influence[i] == pytest.approx(np.expm1(moved), rel=1e-6, abs=1e-9)
