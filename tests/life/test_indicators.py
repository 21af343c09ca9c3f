"""What the runs of a campaign say of each failure mode: against the truth of specimens that age."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.errors import InsufficientDataError, ParameterError, UnitError
from hersey.life.age import Age
from hersey.life.campaign import Campaign, Entry
from hersey.life.campaign.conversion import entry_of
from hersey.life.indicator import NOT_JUDGED, Indicator, Indicators
from hersey.life.indicators import at_states, sticking
from hersey.life.indicators.of_campaign import indicators_of
from hersey.life.indicators.sticking import stick_speed_at
from hersey.life.indicators.torque_surface import RunDwells
from hersey.lubrication.lubricant import Lubricant
from hersey.machine import Limits, Machine
from hersey.machine.duty import GearTable, LifeTable
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
    """Add the dwells of a run with the torque of the drive, from which nothing was subtracted."""
    number = len(campaign)
    temperatures = [None if np.isnan(each) else each for each in run.temperature.tolist()]
    columns = zip(run.speed, run.drive_torque, run.error, temperatures, strict=True)
    dwells = [
        [0, 0.0, 0.0, sense * speed, 0.0, sense * torque, error, kelvin, 0.0, 1, 1.0, 0, "", None, 0.0]
        for speed, torque, error, kelvin in columns
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


@cache
def in_use(campaign: Campaign) -> Indicators:
    """All that a machine can be asked."""
    points = tuple(
        replace(point, share=share)
        for point, share in zip(example_drive()[0].points, (0.6, 0.4), strict=True)
    )
    life = LifeTable(travel=0.3, energy=10.0, continuous_torque=0.5)
    gear = GearTable(3.0, 1e6, 7.0, ratio=3.5, starts=(20.0, "1000 pages"))
    bare = machine(motor_torque=1.0, roll_friction=0.6, nip_load=300.0)
    return indicators_of(campaign, replace(bare, points=points, life=life, gear=gear))


@pytest.fixture
def no_folds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out V*, which takes longest and is not asked for."""
    monkeypatch.setattr(sticking, "MOST_FOLDS", 0)


def test_the_torque_of_the_motor_at_both_corners(campaign: Campaign) -> None:
    found = in_use(campaign)
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
    state, beyond = named(found, "motor torque, cold and fast").warnings
    assert (state.kind, state.where) == ("state of the value", "cold and fast")
    assert state.values["speed"] == pytest.approx(0.2 / 0.015, rel=1e-12)
    assert state.values["temperature"] == pytest.approx(60.0 + ZERO_CELSIUS, abs=0.5)
    assert "127.3 rpm and 60 degC" in str(state)
    assert (beyond.kind, beyond.values["count"], beyond.values["runs"]) == ("extrapolated", 1, 12)
    assert "U4 at 170000 pages, 1.34 times the speed of the nearest dwell" in str(beyond)


def test_what_the_least_torque_of_all_runs_has_in_common_is_an_error_of_the_limit(
    campaign: Campaign, monkeypatch: pytest.MonkeyPatch
) -> None:
    """That of the speed sensor and it, added as squares; the speeds are put back."""
    name = "stick-slip, thick paper"
    monkeypatch.setattr(at_states, "alike_in_all", lambda _: (0.0, 0.0))
    alone = named(in_use.__wrapped__(campaign), name)
    monkeypatch.setattr(at_states, "alike_in_all", lambda _: (0.03, 0.07))
    common = named(in_use.__wrapped__(campaign), name)
    assert alone.limit_error > 0.0
    assert common.limit_error**2 - alone.limit_error**2 == pytest.approx(0.07**2)
    assert common.value == pytest.approx(alone.value * 0.9704455, nan_ok=True)  # exp(-0.03)


def test_the_coldest_start_is_that_of_the_machine(campaign: Campaign) -> None:
    colder = replace(machine(motor_torque=1.0), points=(), life=LifeTable(coldest=318.15))
    cold = named(indicators_of(campaign, colder), "motor torque, cold and fast")
    assert cold.warnings[0].values["temperature"] == 318.15
    assert "45 degC" in str(cold.warnings[0])
    assert "[life] coldest" in str(cold.warnings[0].values["origin"])
    assert np.all(cold.value > named(in_use(campaign), cold.name).value)


def test_what_the_machine_does_not_state_is_said(campaign: Campaign) -> None:
    found = indicators_of(campaign, replace(machine(), points=()))
    assert found.each == ()
    for lacks in (
        'motor_torque = "1 N*m" to [limits]',
        'roll_friction = 0.6 and nip_load = "300 N" to [limits]',
        "[[points]] with speed and temperature",
        "[gear] with torque, cycles and slope",
        'continuous_torque = "0.5 N*m" to [life]',
        'energy = "10 J" to [life]',
    ):
        assert sum(f"Add {lacks}" in each.text for each in found.warnings if each.kind == NOT_JUDGED) == 1
    assert found.warnings[0].values == {"table": "limits", "keys": 'motor_torque = "1 N*m"'}


@pytest.mark.usefixtures("no_folds")
@pytest.mark.parametrize(
    ("life", "gear", "lacks"),
    [
        ({"energy": 10.0}, {}, 'energy per page: add travel = "300 mm" to [life] of the machine file'),
        (
            {},
            {},
            'gear fatigue: [gear] states no load. Add starts = "20 per 1000 pages", or duty and duty_age',
        ),
    ],
)
def test_half_a_table_is_said(
    campaign: Campaign, life: dict[str, Any], gear: dict[str, Any], lacks: str
) -> None:
    half = replace(machine(), life=LifeTable(**life), gear=GearTable(3.0, 1e6, 7.0, **gear))
    assert lacks in map(str, indicators_of(campaign, half).warnings)


def test_a_point_comes_to_lie_on_the_falling_branch(campaign: Campaign) -> None:
    """Of the specimen that wears the speed of least torque passes the slow point; of the others it falls."""
    found = named(in_use(campaign), "stick-slip, thick paper")
    true = np.array([float(truth.transition_speed(np.array(180.0))) * 0.015 for truth in truths().values()])
    told = np.isfinite(found.value)
    assert told.sum() >= 10
    normal = np.log(found.value / true)[told] / found.error[told]
    assert np.sqrt(np.mean(normal**2)) < 1.7
    assert found.limit == 0.045
    assert not found.sign
    worn = np.array([unit == "U6" and age > 0 for unit, age in truths()])
    assert np.array_equal(worn, true > 0.045)
    assert np.all(found.value[worn] > 0.045)
    assert np.all(found.value[told & ~worn] < 0.045)


def test_starting_from_rest_is_a_sign_and_comes_earlier(campaign: Campaign) -> None:
    found = in_use(campaign)
    fold, transition = (named(found, f"stick-slip{name}, thick paper") for name in (" from rest", ""))
    assert fold.sign
    told = np.isfinite(fold.value)
    assert told.sum() >= 6
    assert np.all(fold.value[told] > transition.value[told])
    young = truths()["U1", 0.0]
    drag = young.drag(180.0, 0.015, 3e-3)
    true = hersey.hysteresis(machine(roll_friction=0.6, nip_load=300.0).train, drag, sensitivity=False).upper
    assert fold.value[0] == pytest.approx(true, rel=0.3)
    assert fold.limit_error < 0.01  # the machine states no uncertainty of its own numbers


def test_the_belt_alone_against_the_grip(campaign: Campaign) -> None:
    found = in_use(campaign)
    cold = named(found, "grip, cold and fast")
    at = np.array([0.2 / 0.015]), np.array([60.0])
    true = np.array([(t.torque(*at) - t.rest.torque(at[0]))[0] for t in truths().values()])
    # The machine's rest is that of a new specimen: what it grows by counts as the belt's.
    grown = np.array([(t.rest.torque(at[0]) - machine().rest.torque(at[0]))[0] for t in truths().values()])  # type: ignore[union-attr]
    assert np.all(np.abs(np.log(cold.value / (true + grown)) / cold.error) < 4.0)
    assert cold.limit == pytest.approx(0.6 * 300.0 * 0.015)
    rest = named(found, "grip, from rest")
    assert "break-away by rule" in [each.kind for each in rest.warnings]
    stated = replace(machine(roll_friction=0.6, nip_load=300.0), points=(), static_friction=0.07)
    young = named(indicators_of(campaign, stated), "grip, from rest")
    new = [place for place, (_, age) in enumerate(truths()) if age == 0.0]
    assert np.median(young.value[new]) == pytest.approx(0.07 * 300.0 * 0.015)


def test_energy_and_heat_of_the_motor(campaign: Campaign) -> None:
    found = in_use(campaign)
    speeds, shares = np.array([0.2, 0.045]), np.array([0.6, 0.4])
    torque = np.array([t.torque(speeds / 0.015, np.full(2, 180.0)) for t in truths().values()])
    time = 0.3 / (shares @ speeds)
    true = (torque * speeds / 0.015) @ shares * time
    energy = named(found, "energy per page")
    assert energy.value == pytest.approx(true, rel=0.03)
    assert np.all(np.abs(np.log(energy.value / true)) < 4.0 * energy.error)
    heat = named(found, "continuous torque")
    assert heat.value == pytest.approx(np.sqrt(torque**2 @ shares), rel=0.03)
    assert (energy.limit, heat.limit) == (10.0, 0.5)


def test_damage_of_starts_by_hand_and_of_stick_slip(campaign: Campaign) -> None:
    found = named(in_use(campaign), "gear fatigue")
    assert found.accumulates
    assert found.limit == 1.0
    torque = np.array([t.torque(np.array(0.2 / 0.015), np.array(60.0)) for t in truths().values()])
    by_hand = 0.02 / (1e6 * (3.0 / (3.5 * torque / 2.0)) ** 7.0)
    worn = np.array([unit == "U6" and age > 0 for unit, age in truths()])
    last = np.array([age == 170e3 for _, age in truths()])
    assert found.value[~worn & ~last] == pytest.approx(by_hand[~worn & ~last], rel=0.25)
    assert found.error[0] == pytest.approx(7.0 * 0.008, rel=0.2)
    assert found.limit_error == pytest.approx(7.0 * 0.01 / 1.96)  # a torque 1 % off at 95 %, to the slope
    assert np.all(found.value[worn & last] > 10.0 * by_hand[worn & last])
    (sticks,) = (each for each in found.warnings if each.kind == "stick-slip counted")
    assert sticks.values == {"point": "thick paper", "count": worn.sum()}
    (starts,) = (each for each in found.warnings if each.kind == "starts counted")
    assert starts.values == {"starts": pytest.approx(0.02, rel=1e-12), "age_unit": "page"}


@pytest.mark.usefixtures("no_folds")
def test_a_duty_grows_with_the_torque(campaign: Campaign, tmp_path: Path) -> None:
    torque = 0.2 + 0.1 * np.tile([-1.0, 1.0], 50)
    rows = "\n".join(f"{0.01 * i:.2f},50,{each:.3f}" for i, each in enumerate(torque))
    (tmp_path / "duty.csv").write_text(f"time [s],speed [rpm],torque [N*m]\n{rows}\n")
    duty = {"duty": str(tmp_path / "duty.csv"), "duty_age": "10 pages"}
    machined = replace(
        machine(), points=machine().points[:1], gear=GearTable(3.0, 1e6, 7.0, ratio=3.5, **duty)
    )
    found = named(indicators_of(campaign, machined), "gear fatigue")
    scale = np.array([t.torque(np.array(0.2 / 0.015), np.array(180.0)) for t in truths().values()])
    new = np.median([each for each, (_, age) in zip(scale, truths(), strict=True) if age == 0.0])
    by_hand = 5.0 / (1e6 * (3.0 / (3.5 * 0.1 * scale / new)) ** 7.0)
    assert found.value == pytest.approx(by_hand, rel=0.3)
    wrong = replace(machined, gear=replace(machined.gear, duty_age="10 h"))  # type: ignore[type-var]
    with pytest.raises(UnitError, match=r"\[gear\] duty_age: an age is in h, but the others are in pages"):
        indicators_of(campaign, wrong)


def test_a_part_that_breaks_or_takes_no_harm_has_no_rate(campaign: Campaign) -> None:
    starts: dict[str, Any] = {"ratio": 3.5, "starts": (20.0, "1000 pages")}
    bare = replace(machine(), points=())
    weak = GearTable(0.5, 1e6, 7.0, ultimate=2.0, **starts)
    found = named(indicators_of(campaign, replace(bare, gear=weak)), "gear fatigue")
    assert 0 < np.isnan(found.value).sum() < 12
    (without,) = (each for each in found.warnings if each.kind == "runs without a rate")
    assert without.values == {"count": np.isnan(found.value).sum()}
    assert "a peak that breaks the part" in str(without)
    sound = GearTable(3.0, 1e6, 7.0, endurance=2.9, **starts)
    assert np.isnan(named(indicators_of(campaign, replace(bare, gear=sound)), "gear fatigue").value).all()
    with pytest.raises(ParameterError, match=r"\[gear\]: endurance is 4"):
        indicators_of(campaign, replace(bare, gear=replace(sound, endurance=4.0)))


@pytest.mark.usefixtures("no_folds")
def test_runs_without_a_value_are_named(tmp_path: Path) -> None:
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
    (without,) = (one for one in each.warnings if one.kind == "runs without a value")
    assert without.values == {"count": 1, "runs": 4, "which": "A at 2 pages"}
    standing_dwells, few = found.warnings[-2:]
    assert (few.kind, few.values) == ("runs of few dwells", {"count": 1, "fewest": 4, "which": "2"})
    assert str(few) == "1 run has fewer than 4 dwells and is not used here: 2"
    assert standing_dwells.values == {"which": "1 of run 4", "count": 1}


@pytest.mark.usefixtures("no_folds")
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
    (state,) = each.warnings
    assert str(state) == "cold and fast: 127.3 rpm ([[points]])"
    assert state.values["temperature"] is None


def test_an_empty_campaign_is_refused(tmp_path: Path) -> None:
    with (
        Campaign.create(tmp_path / "none.hersey") as opened,
        pytest.raises(InsufficientDataError, match="no run with dwells"),
    ):
        indicators_of(opened, machine(motor_torque=1.0))


def test_the_stick_speed_moves_as_one_over_the_viscosity() -> None:
    """2 mm/s where the oil has 20 mPa s, 4 mm/s where it has 10 mPa s."""
    oil = Lubricant("arrhenius", ((423.15, 0.02), (453.15, 0.01)))
    stated = replace(machine(), stick_speed=2e-3, stick_speed_temperature=423.15, lubricant=oil)
    assert stick_speed_at(stated, 453.15) == pytest.approx(4e-3, rel=1e-9)
    assert stick_speed_at(stated, 423.15) == pytest.approx(2e-3, rel=1e-9)
    assert stick_speed_at(replace(stated, stick_speed_rule="fixed"), 453.15) == 2e-3
