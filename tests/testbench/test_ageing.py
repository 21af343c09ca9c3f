"""Units that age: the physics by itself, the same bits from a seed, and files as a campaign reads them."""

from __future__ import annotations

import csv
import json
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.errors import ParameterError
from hersey.log.mean_signs import is_means_table
from hersey.lubrication.film import drag_torque
from hersey.machine.machine import Machine, read_machine
from hersey.testbench import (
    Ageing,
    PhysicalTruth,
    Stand,
    Unit,
    VirtualCampaign,
    ages_of,
    population,
)
from hersey.testbench.campaign import Corners
from hersey.testbench.drive import example_drive
from hersey.units import ZERO_CELSIUS
from tests.cli.command import run
from tests.conftest import ROOT

LIFE = ROOT / "examples" / "life"
STILL = Ageing(
    supply=None,
    side_flow=0.0,
    evaporation=0.0,
    thickening=0.0,
    roughening=0.0,
    boundary_growth=0.0,
    rest_growth=0.0,
    spread={},
)
SPEED, LEVEL = np.array([0.5, 1.8, 3.0, 13.0]), np.array([180.0, 180.0, 90.0, 60.0])
SMALL = Stand(temperatures_degC=(60.0, 180.0), speeds_rpm=(10.0, 30.0, 130.0))


@pytest.fixture(scope="module")
def drive() -> tuple[Machine, NoLoadTorque]:
    return example_drive()


@pytest.fixture(scope="module")
def told() -> dict[str, object]:
    document: dict[str, object] = json.loads((LIFE / "truth.json").read_text())
    return document


def unit(drive: tuple[Machine, NoLoadTorque], **ageing: object) -> Unit:
    return Unit("U", *drive, replace(STILL, **ageing))  # type: ignore[arg-type]


def exponent(truth: PhysicalTruth, speed: float, level: float) -> float:
    """Exponent of the contact's damping in speed."""
    near = speed * np.array([0.99, 1.01])
    torque = truth.contact_torque(near, np.full(2, level))  # type: ignore[attr-defined]
    return float(np.diff(np.log(torque))[0] / np.diff(np.log(near))[0]) - 1.0


def test_the_drive_is_that_of_the_examples(drive: tuple[Machine, NoLoadTorque]) -> None:
    machine, rest = drive
    read = read_machine(ROOT / "examples" / "machine.toml")
    for name in ("contact", "lubricant", "asperities", "boundary", "limits", "points", "train"):
        assert getattr(machine, name) == getattr(read, name), name
    generator = runpy.run_path(str(ROOT / "examples" / "bench_drive.py"))
    assert rest.to_dict() == generator["REST"].to_dict()


def test_a_new_unit_is_the_physical_truth_of_its_machine(drive: tuple[Machine, NoLoadTorque]) -> None:
    truth, new = PhysicalTruth(drive[0].mixed, drive[1]), unit(drive).at(1e5)
    assert new.torque(SPEED, LEVEL) == pytest.approx(truth.torque(SPEED, LEVEL), rel=1e-12)
    assert new.transition_speed(LEVEL) == pytest.approx(truth.transition_speed(LEVEL), rel=1e-12)
    assert new.drag(180.0, 0.015, 3e-4) == truth.drag(180.0, 0.015, 3e-4)
    flooded = unit(drive, supply=1.0).at(0.0)  # with so much oil the other way to the same numbers
    assert flooded.torque(SPEED, LEVEL) == pytest.approx(truth.torque(SPEED, LEVEL), rel=1e-6)
    assert flooded.transition_speed(LEVEL) == pytest.approx(truth.transition_speed(LEVEL), rel=1e-4)


def test_the_drag_of_an_old_unit_has_its_rest(drive: tuple[Machine, NoLoadTorque]) -> None:
    old, speed = population(*drive, units=1, seed=3)[0].at(150e3), np.array([1.0, 5.0, 13.0])
    force = old.drag(180.0, 0.015, 3e-4).force(speed * 0.015)
    assert force * 0.015 == pytest.approx(old.torque(speed, np.array(180.0)), rel=1e-3)


def test_side_flow_and_evaporation_are_their_closed_forms() -> None:
    ages, h0, k, e = (0.0, 1e4, 3e5), 20e-6, 1e5, 3e-6
    flow = replace(STILL, supply=h0, side_flow=k)
    assert [flow.supply_at(t) for t in ages] == pytest.approx([(h0**-2 + k * t) ** -0.5 for t in ages])
    dry = replace(STILL, supply=h0, evaporation=e)
    assert [dry.supply_at(t) for t in ages] == pytest.approx([h0 * np.exp(-e * t) for t in ages])
    both = replace(flow, evaporation=e)
    h, step = h0, 100.0
    for _ in range(3000):  # the midpoint rule on dh/dt = -K h^3/2 - e h
        half = h - 0.5 * step * (0.5 * k * h**3 + e * h)
        h -= step * (0.5 * k * half**3 + e * half)
    assert both.supply_at(3e5) == pytest.approx(h, rel=1e-5)


def test_a_starved_film_is_that_of_the_film_solver(drive: tuple[Machine, NoLoadTorque]) -> None:
    """Where no asperity touches: shear and rolling as `drag_torque` has them, by another way."""
    machine, _ = drive
    assert machine.contact is not None
    assert machine.lubricant is not None
    cool = replace(machine.lubricant, conductivity=None)
    for supply in (20e-6, 5e-6):
        truth = unit(drive, supply=supply).at(0.0)
        torque = truth.contact_torque(np.array([3.0, 13.0]), np.array([60.0, 60.0]))
        solved = drag_torque(
            replace(machine.contact, supply=supply), cool, speed=[3.0, 13.0], temperature=60.0 + ZERO_CELSIUS
        )
        assert torque == pytest.approx(solved, rel=0.01)


def test_a_starving_film_stays_as_thick_as_its_layer(drive: tuple[Machine, NoLoadTorque]) -> None:
    """Its damping no longer falls with speed: the exponent goes from that of the soft film to 0."""
    exponents = [
        exponent(unit(drive, supply=supply).at(0.0), 13.0, 60.0) for supply in (1e-3, 2e-5, 1e-5, 4e-6)
    ]
    assert exponents == sorted(exponents)
    assert exponents[0] == pytest.approx(-0.57, abs=0.05)
    assert exponents[-1] == pytest.approx(0.0, abs=0.02)


def test_what_ages_moves_the_way_it_must(drive: tuple[Machine, NoLoadTorque]) -> None:
    ages = (0.0, 5e4, 1e5, 2e5)
    cold, hot = (np.array(13.3), np.array(60.0)), (np.array(1.0), np.array(180.0))
    moved = {
        "evaporation": (3e-6, cold),
        "side_flow": (1e5, cold),
        "thickening": (5e-6, cold),
        "rest_growth": (2e-6, cold),
        "boundary_growth": (2e-6, hot),
        "roughening": (2e-6, hot),
    }
    for name, (rate, at) in moved.items():
        one = unit(drive, supply=2e-5, **{name: rate})
        assert np.all(np.diff([float(one.at(age).torque(*at)) for age in ages]) > 0), name
    transitions = {
        name: [float(unit(drive, **{name: 4e-6}).at(age).transition_speed(hot[1])) for age in ages]
        for name in ("roughening", "boundary_growth", "thickening")
    }
    assert np.all(np.diff(transitions["roughening"]) > 0)
    assert np.all(np.diff(transitions["boundary_growth"]) > 0)
    assert transitions["thickening"] == pytest.approx(
        [transitions["thickening"][0] * np.exp(-4e-6 * age) for age in ages]
    )
    # rougher by a factor, the contact is that of its machine with such faces
    machine, rest = drive
    assert machine.contact is not None
    rough = replace(machine, contact=replace(machine.contact, roughness=1e-6))
    worn = unit(drive, roughening=1e-5).at(1e5)
    assert worn.torque(SPEED, LEVEL) == pytest.approx(
        PhysicalTruth(rough.mixed, rest).torque(SPEED, LEVEL), rel=1e-3
    )


def test_an_age_at_a_limit(drive: tuple[Machine, NoLoadTorque]) -> None:
    one = unit(drive, supply=2e-5, side_flow=1e5, thickening=2e-6)
    at = {"speed": 13.3, "temperature": 60.0}
    age = one.age_at(0.6, **at, within=1e6)
    assert age is not None
    torques = [float(one.at(t).torque(np.array(13.3), np.array(60.0))) for t in (age - 2.0, age)]
    assert torques[0] < 0.6 <= torques[1]
    assert one.age_at(0.6, **at, within=0.9 * age) is None
    assert one.age_at(0.1, **at, within=1e6) == 0.0


def test_a_seed_and_its_units(drive: tuple[Machine, NoLoadTorque]) -> None:
    eight, two = (population(*drive, units=count, seed=4) for count in (8, 2))
    assert [u.ageing for u in eight[:2]] == [u.ageing for u in two]
    assert eight[0].ageing != eight[1].ageing != population(*drive, units=2, seed=5)[1].ageing
    drawn = [population(*drive, units=1, seed=seed)[0].ageing.thickening for seed in range(200)]
    assert np.median(drawn) == pytest.approx(Ageing().thickening, rel=0.1)
    assert np.std(np.log(drawn)) == pytest.approx(Ageing().spread["thickening"], rel=0.2)
    first, again = (VirtualCampaign(two, (0.0, 5e4), 4, SMALL).files() for _ in range(2))
    assert first == again
    assert VirtualCampaign(two, (5e4,), 4, SMALL).files()["U2-50000.csv"] == first["U2-50000.csv"]


def test_a_drive_that_stalls_has_no_such_dwell(drive: tuple[Machine, NoLoadTorque]) -> None:
    old = Unit("U1", *drive, replace(STILL, supply=2e-6))
    files = VirtualCampaign((old,), (0.0,), 0, SMALL).files()
    truth = json.loads(files["truth.json"])["units"][0]
    assert truth["stalled dwells"] == {"0": 1}
    assert truth["first"] == "torque limit, cold and fast"
    assert "130,60," not in files["U1-0.csv"]
    gone = Unit("U1", *drive, replace(STILL, supply=1e-8))
    weak = replace(drive[0], limits=replace(drive[0].limits, motor_torque=0.1))
    files = VirtualCampaign((replace(gone, machine=weak),), (0.0,), 0, SMALL).files()
    assert files["runs.csv"] == "log,unit,age\n"


def test_the_shipped_units(told: dict[str, object], drive: tuple[Machine, NoLoadTorque]) -> None:
    rows = list(csv.DictReader((LIFE / "runs.csv").open()))
    assert set(rows[0]) == {"log", "unit", "age"}
    assert len(rows) == 48
    assert rows[1] == {"log": "U1-35000.csv", "unit": "U1", "age": "35000 pages"}
    assert all((LIFE / row["log"]).is_file() for row in rows)
    assert sum(path.stat().st_size for path in LIFE.iterdir()) < 2e6
    units = told["units"]
    assert isinstance(units, list)
    first = [one["first"] for one in units]
    assert {name: first.count(name) for name in set(first)} == {
        "torque limit, cold and fast": 5,
        "starvation": 2,
        "stick-slip range": 1,
    }
    script = runpy.run_path(str(ROOT / "examples" / "life_units.py"))
    campaign = script["campaign"]()
    one = campaign.units[5]  # that of the stick-slip range
    assert units[5]["ageing"] == pytest.approx(one.ageing.numbers())
    turn = one.at(units[5]["ends"]["stick-slip range"]).transition_speed(np.array(180.0))
    slow = Corners.of(*(drive[0], campaign.stand)).slow[0]
    assert float(turn) == pytest.approx(slow, rel=1e-3)
    for kept, of in zip(units, campaign.units, strict=True):
        for name, excess in Corners.of(of.machine, campaign.stand).ends().items():
            end = kept["ends"][name]
            if end is None:
                assert excess(of.at(170e3)) < 0
            else:
                assert excess(of.at(end - 10.0)) < 0 < excess(of.at(end + 10.0))
    again = replace(campaign, units=campaign.units[:1], ages=(35e3,)).files()["U1-35000.csv"].splitlines()
    there = (LIFE / "U1-35000.csv").read_text().splitlines()
    assert again[:2] == there[:2]
    values = [np.array([line.split(",")[:4] for line in lines[2:]], dtype=float) for lines in (again, there)]
    assert values[0] == pytest.approx(values[1], abs=2e-5)


def test_a_table_is_read_as_means() -> None:
    path = LIFE / "U1-35000.csv"
    assert is_means_table(path, {}, {})
    points = hersey.SteadyPoints.from_table(path)
    assert len(points) == 95


def test_the_command_writes_a_campaign(tmp_path: Path) -> None:
    typed = ("testbench", "--units", "1", "--ages", "0, 20 kpages", "--out-dir", "campaign", "--seed", "3")
    done = run(*typed, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "Synthetic campaign, seed 3: 2 runs of 1 specimen\ncampaign\n"
    folder = tmp_path / "campaign"
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        ("runs.csv", "truth.json", "U1-0.csv", "U1-20000.csv")
    )
    assert json.loads((folder / "truth.json").read_text())["synthetic"] is True
    again = run(*typed, cwd=tmp_path)
    assert (again.returncode, again.stdout) == (2, "")
    assert "campaign is not empty: use --force to write into it" in again.stderr


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        (("--units", "8"), "also needs --ages"),
        (("--ages", "0, 5 kpages", "--out-dir", "x"), "also needs --units"),
        (
            ("--units", "2", "--ages", "0, 5 kpages", "--out-dir", "x", "--out", "y"),
            "--out is for a single log",
        ),
        (("--units", "2", "--ages", "5, 2 kpages", "--out-dir", "x"), "must ascend"),
        (("--units", "2", "--ages", "0, 5 h", "--out-dir", "x"), "'h' is not a unit of pages"),
        (("--units", "2", "--ages", "0, 50.000 Seiten", "--out-dir", "x"), "'Seiten' is not a unit of pages"),
        (
            ("--units", "2", "--ages", "0, 50.000, 100.000 pages", "--out-dir", "x"),
            "Write '50000 pages' or '50 pages'",
        ),
    ],
)
def test_what_the_command_refuses(typed: tuple[str, ...], said: str, tmp_path: Path) -> None:
    done = run("testbench", *typed, cwd=tmp_path)
    assert done.returncode == 2
    assert said in done.stderr
    assert not list(tmp_path.iterdir())


def test_bad_numbers_are_named(drive: tuple[Machine, NoLoadTorque]) -> None:
    assert ages_of("0, 50, 100 kpages") == (0.0, 5e4, 1e5)
    assert ages_of("0 pages, 2 kpages, 1 Mpages") == (0.0, 2e3, 1e6)
    assert ages_of("0, 50.5, 100.25 kpages") == (0.0, 50_500.0, 100_250.0)
    with pytest.raises(ParameterError, match="side_flow is -1"):
        Ageing(side_flow=-1.0)
    with pytest.raises(ParameterError, match="'oil' is not known: supply, side_flow"):
        Ageing(spread={"oil": 0.1})
    with pytest.raises(ParameterError, match="age is -1"):
        unit(drive).at(-1.0)
    bare = replace(drive[0], limits=replace(drive[0].limits, motor_torque=None))
    with pytest.raises(ParameterError, match="a specimen fails at the motor torque"):
        VirtualCampaign(population(bare, drive[1], units=1), (0.0,))
    with pytest.raises(ParameterError, match="units is 0"):
        population(*drive, units=0)
