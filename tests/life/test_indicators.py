"""What the runs of a campaign say of each way to fail: against the truth of units that age."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import InsufficientDataError
from hersey.life.age import Age
from hersey.life.campaign import Campaign, Entry
from hersey.life.campaign.kept import entry_of
from hersey.life.indicator import Indicator, Indicators
from hersey.life.indicators import indicators_of
from hersey.life.torque_surface import RunDwells
from hersey.machine import Limits, Machine
from hersey.testbench import population
from hersey.testbench.ageing import AgedTruth
from hersey.testbench.drive import example_drive
from hersey.units import ZERO_CELSIUS
from tests.life.test_torque_surface import dwells_of

AGES = (0.0, 70e3, 140e3, 170e3)


@cache
def sample() -> Entry:
    table = {"speed [rpm]": [10, 20, 40, 80], "torque [mN*m]": [5.0, 5.6, 6.3, 7.2]}
    return entry_of(hersey.SteadyPoints.from_table(table, isothermal=True), "sample.csv")


def add(campaign: Campaign, unit: str, age: float, run: RunDwells, sense: float = 1.0) -> None:
    """Add the dwells of a run with their whole torque: no rest was taken off, the machine states it."""
    number = len(campaign)
    heats = [None if np.isnan(each) else each for each in run.temperature.tolist()]
    columns = zip(run.speed, run.whole, run.error, heats, strict=True)
    dwells = [
        [0, 0.0, 0.0, sense * speed, 0.0, sense * torque, error, heat, 0.0, 1, 1.0, 0, "", None, 0.0]
        for speed, torque, error, heat in columns
    ]
    path = str(Path(f"log{number}.csv").absolute())
    entry = replace(sample(), sha256=f"{number:064x}", path=path, dwells=dwells)
    campaign.add_entries([(entry, unit, Age(age, "pages"))])


@cache
def truths() -> dict[tuple[str, float], AgedTruth]:
    """Units of the campaign that ships: one that stalls cold, one that wears into stick-slip."""
    units = population(*example_drive(), units=6, seed=3)
    return {(units[i].name, age): units[i].at(age) for i in (0, 3, 5) for age in AGES}


def machine(**limits: float) -> Machine:
    bare, rest = example_drive()
    return replace(bare, rest=rest, limits=Limits(**limits))


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    opened = Campaign.create(tmp_path_factory.mktemp("life") / "life.hersey")
    for number, ((unit, age), truth) in enumerate(truths().items()):
        add(opened, unit, age, dwells_of(truth, number), sense=-1.0 if number == 2 else 1.0)
    return opened


def named(found: Indicators, name: str) -> Indicator:
    return next(each for each in found.each if each.name == name)


def test_the_torque_of_the_motor_at_both_corners(campaign: Campaign) -> None:
    found = indicators_of(campaign, machine(motor_torque=1.0))
    assert found.runs.unit == tuple(unit for unit, _ in truths())
    assert found.runs.age.tolist() == [age for _, age in truths()]
    for name, speed, level in (("cold and fast", 0.2, 60.0), ("hot and slow", 0.045, 180.0)):
        each = named(found, f"motor torque, {name}")
        at = np.array([speed / 0.015]), np.array([level])
        true = np.array([truth.torque(*at)[0] for truth in truths().values()])
        normal = np.log(each.value / true) / each.error
        assert np.all(np.abs(normal) < 4.0)
        assert 0.5 < np.sqrt(np.mean(normal**2)) < 1.6
        assert each.limit == 1.0
        assert each.limit_error == pytest.approx(0.01 / 1.96)
    notes = named(found, "motor torque, cold and fast").notes
    assert "127.3 rpm and 60 degC" in notes[0]
    assert notes[1].startswith("extrapolated in 1 of 12 runs")
    assert "U4 at 170000 pages, 1.34 times the speed of the nearest dwell" in notes[1]


def test_what_the_machine_does_not_state_is_said(campaign: Campaign) -> None:
    found = indicators_of(campaign, machine())
    assert found.each == ()
    assert any('[limits] lacks motor_torque = "1 N*m"' in line for line in found.unsaid)


def test_runs_that_do_not_tell_are_named(tmp_path: Path) -> None:
    """One of few dwells, one of another temperature alone, and dwells that stand."""
    truth = truths()["U1", 0.0]
    whole = dwells_of(truth, 0)
    cold = whole.temperature < 61.0 + ZERO_CELSIUS

    def part(keep: slice | np.ndarray) -> RunDwells:
        return RunDwells(*(values[keep] for values in vars(whole).values()))

    with Campaign.create(tmp_path / "few.hersey") as opened:
        add(opened, "A", 0.0, whole)
        add(opened, "A", 1.0, part(slice(3)))
        add(opened, "A", 2.0, part(~cold & (whole.temperature < 100.0 + ZERO_CELSIUS)))
        standing = part(slice(0, 40))
        standing.speed[0] = 0.0
        add(opened, "A", 3.0, standing)
        found = indicators_of(opened, machine(motor_torque=1.0))
    each = named(found, "motor torque, cold and fast")
    assert np.isnan(each.value).tolist() == [False, True, True, False]
    assert any("not told by 1 runs of other temperatures: A at 2 pages" in note for note in each.notes)
    assert any("fewer than 4 dwells" in line and line.endswith(": 2") for line in found.unsaid)
    assert any("left out: 1 of run 4" in line for line in found.unsaid)


def test_without_temperature(tmp_path: Path) -> None:
    truth = truths()["U1", 0.0]
    whole = dwells_of(truth, 0)
    hot = whole.temperature > 179.0 + ZERO_CELSIUS
    run = RunDwells(*(values[hot] for values in vars(whole).values()))
    run.temperature[:] = np.nan
    with Campaign.create(tmp_path / "one.hersey") as opened:
        add(opened, "A", 0.0, run)
        found = indicators_of(opened, machine(motor_torque=1.0))
    fast = np.array([0.2 / 0.015]), np.array([180.0])
    each = named(found, "motor torque, cold and fast")
    assert each.value == pytest.approx(truth.torque(*fast), rel=0.04)
    assert each.notes == ("cold and fast: 127.3 rpm ([[points]])",)


def test_an_empty_campaign_is_refused(tmp_path: Path) -> None:
    with (
        Campaign.create(tmp_path / "none.hersey") as opened,
        pytest.raises(InsufficientDataError, match="no run with dwells"),
    ):
        indicators_of(opened, machine(motor_torque=1.0))
