"""Maintenance: kept in the campaign, read from the table of runs, and growth that begins anew."""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.charts.growth import growth_chart
from hersey.errors import ChannelError, InsufficientDataError, ParameterError, UnitError, UnreadableLogError
from hersey.life.age import Age
from hersey.life.campaign import Campaign, read_runs
from hersey.life.campaign.store import SCHEMAS
from hersey.life.growth import marginal
from hersey.life.growth.limit_ages import Earliest, ages_at_limit
from hersey.life.indicator import Indicator, Indicators, OwnAges, Runs
from hersey.life.maintenance import OF_DAMAGE, OF_FRICTION, Event, Followed
from hersey.life.time_to_failure.estimate import time_to_failure
from hersey.life.time_to_failure.way import FittedWay
from tests.cli.command import run
from tests.life import shipped
from tests.life.shipped import fewer

AGES = np.linspace(0.0, 600.0, 7)
RATE = np.array([0.0008, 0.0009, 0.0010, 0.0011, 0.0012, 0.0013])
NAMES = tuple(f"F{i + 1}" for i in range(6) for _ in AGES)
NUMBERS = tuple(range(1, len(NAMES) + 1))
#: F3 is re-greased at 300, just before its fourth run, which is run 18.
GREASED = Event("F3", Age(300.0, "pages"), "re-greased", 18)


def runs(*events: Event) -> Runs:
    return Runs(NUMBERS, NAMES, np.tile(AGES, 6), "pages", events)


def grown(since: float) -> np.ndarray:
    """Torque 1 + rate times age; that of F3 begins anew at an age."""
    age = np.tile(AGES, (6, 1))
    age[2, since <= AGES] -= since
    noise = np.random.default_rng(5).normal(0.0, 0.01, age.shape)
    return np.asarray(((1.0 + RATE[:, None] * age) * np.exp(noise)).ravel())


def torque(since: float) -> Indicator:
    value = grown(since)
    return Indicator("torque", "torque", "N m", 2.0, value, np.full(value.shape, 0.003))


def test_a_segment_begins_with_each_event() -> None:
    found = runs(GREASED).segments(OF_FRICTION)
    assert found.begun == {"F1": 0.0, "F2": 0.0, "F3": 300.0, "F4": 0.0, "F5": 0.0, "F6": 0.0}
    assert found.name[14:21] == ("F3 before 300",) * 3 + ("F3",) * 4
    assert found.age[14:21].tolist() == [0.0, 100.0, 200.0, 0.0, 100.0, 200.0, 300.0]
    assert runs(GREASED).segments(OF_DAMAGE).name == NAMES


def test_a_run_of_the_age_of_an_event_was_measured_before_it_unless_it_is_said_otherwise() -> None:
    found = runs(Event("F3", Age(300.0, "pages"), "cleaned")).segments(OF_FRICTION)
    assert found.name[14:21] == ("F3 before 300",) * 4 + ("F3",) * 3
    assert found.age[17:19].tolist() == [300.0, 100.0]


def test_after_two_events_age_counts_from_the_later() -> None:
    found = runs(Event("F3", Age(150.0, "pages"), "cleaned"), GREASED).segments(OF_FRICTION)
    assert found.name[14:21] == ("F3 before 150",) * 2 + ("F3 before 300",) + ("F3",) * 4
    assert found.age[14:21].tolist() == [0.0, 100.0, 50.0, 0.0, 100.0, 200.0, 300.0]
    assert found.begun["F3"] == 300.0


def test_growth_begins_anew_from_a_re_greasing(monkeypatch: pytest.MonkeyPatch) -> None:
    fewer(monkeypatch)
    found = time_to_failure(Indicators(runs(GREASED), (torque(300.0),)))
    ends = {each.unit: each.age for each in found.units}
    assert list(ends) == [f"F{i}" for i in range(1, 7)]
    assert ends["F3"].age.value == pytest.approx(300.0 + 1.0 / RATE[2], rel=0.1)
    assert ends["F3"].age.low < 1300.0 < ends["F3"].age.high
    assert ends["F3"].last == 600.0
    assert ends["F4"].age.value == pytest.approx(1.0 / RATE[3], rel=0.06)
    # without the event the same runs show a slower growth, and nothing of the truth
    without = time_to_failure(Indicators(runs(), (torque(300.0),)))
    assert {e.unit: e.age for e in without.units}["F3"].age.value > 1.2 * ends["F3"].age.value


def test_after_a_re_greasing_the_age_followed_counts_from_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of what a re-greasing at 500 renews, runs to 600 show 100: ages from 500 + 175 on are open."""
    fewer(monkeypatch)
    monkeypatch.setattr(marginal, "_POPULATION", 16)
    flat = np.random.default_rng(3).normal(0.0, 0.01, 42)
    steady = Indicator("torque", "torque", "N m", 2.0, np.exp(flat), np.full(42, 0.003))
    gear = Indicator("gear", "gear", "1", 1.0, np.full(42, 1e-4), np.full(42, 0.01), accumulates=True)
    greased = tuple(Event(f"F{i}", Age(500.0, "pages"), "re-greased") for i in range(1, 7))
    some = time_to_failure(Indicators(runs(greased[2]), (steady, gear)), until=700.0)
    torque_, damage = (mode.ages.units[2] for mode in some.modes)
    assert (torque_.begun, torque_.last) == (500.0, 600.0)
    assert torque_.age.low == 500.0 + 1.75 * 100.0
    # damage is not reset by grease
    assert (damage.begun, damage.age.low) == (0.0, 1.75 * 600.0)
    of_first = some.units[2].age
    assert (of_first.begun, of_first.age.low, of_first.age.high) == (500.0, 675.0, math.inf)
    assert some.units[1].age.age.low == 1.75 * 600.0
    assert some.followed_failing is not None
    assert some.followed_failing.failed.high == 1.0  # F3 may fail before 700
    assert some.ageing.none_before == 1.75 * 600.0
    # no run shows torque of new specimens beyond 500
    every = time_to_failure(Indicators(runs(*greased), (steady, gear)))
    assert every.modes[0].ages.b50 is not None
    assert every.modes[0].ages.b50.age.low == 1.75 * 500.0
    assert every.modes[1].ages.b50 is not None
    assert every.modes[1].ages.b50.age.low == 1.75 * 600.0
    assert every.b50 is not None
    assert every.b50.age.low == 1.75 * 500.0
    assert every.ageing.followed == 600.0


def test_of_a_specimen_re_greased_after_its_last_run_the_others_show_how_far() -> None:
    ages = np.full(100, 5000.0)
    own = OwnAges(np.stack([ages, ages], axis=1), np.full((100, 8), 5000.0))
    followed = Followed({"A": 300.0, "B": 300.0}, {"A": 0.0, "B": 350.0}, 300.0)
    found = ages_at_limit("torque", "pages", 2.0, followed, own, ())
    assert [each.age.low for each in found.units] == [525.0, 350.0 + 525.0]
    assert [each.shown(2.0) for each in found.units] == [600.0, 350.0 + 600.0]
    assert [each.far for each in found.units] == [True, True]


def test_a_film_of_specimens_not_seen_since_maintenance_is_not_followed() -> None:
    whole: Any = shipped.campaign(2)
    events = [Event(unit, Age(180000.0, "pages"), "re-greased") for unit in ("U1", "U2")]
    whole.events = lambda: events
    with pytest.raises(InsufficientDataError, match="no specimen has a run since"):
        hersey.film_life(whole, shipped.machine())


def test_the_chart_shows_the_age_of_the_specimen_and_a_mark_at_the_event(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fewer(monkeypatch)
    (mode,) = time_to_failure(Indicators(runs(GREASED), (torque(300.0),))).modes
    of_f3 = [each for each in mode.stretches if each.unit == "F3"]
    assert [(each.name, each.begun) for each in of_f3] == [("F3 before 300", 0.0), ("F3", 300.0)]
    drawn = growth_chart(mode.growth, ages=mode.ages, stretches=mode.stretches).to_dict()
    panels = {panel["title"]["text"]: panel for row in drawn["vconcat"] for panel in row["hconcat"]}
    assert list(panels) == [f"F{i}" for i in range(1, 7)]
    values = [layer["data"]["values"] for layer in panels["F3"]["layer"]]
    seen = [row["age"] for rows in values for row in rows if row.keys() == {"age", "value"}]
    assert seen == AGES.tolist()
    assert [{"age": 300.0}] in values
    curves = [[row["age"] for row in rows] for rows in values if len(rows) > 7 and "median" in rows[0]]
    assert max(curves[0]) <= 300.0 == min(curves[-1])
    assert time_to_failure(Indicators(runs(), (torque(300.0),))).modes[0].stretches == ()


def test_damage_goes_back_with_new_parts_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    fewer(monkeypatch)
    steady = Indicator("gear", "gear", "1", 1.0, np.full(42, 1e-3), np.full(42, 0.01), accumulates=True)
    ages = {}
    for kind in ("re-greased", "replaced"):
        at = Event("F3", Age(300.0, "pages"), kind, 18)
        found = time_to_failure(Indicators(runs(at), (steady,)))
        ages[kind] = {each.unit: each.age.age.value for each in found.units}["F3"]
    assert ages["re-greased"] == pytest.approx(1000.0, rel=0.02)
    assert ages["replaced"] == pytest.approx(1300.0, rel=0.02)


@pytest.fixture
def campaign(tmp_path: Path, dwell_table: Callable[[float], str]) -> Path:
    for i in range(3):
        (tmp_path / f"U1-{i}.csv").write_text(dwell_table(1.0 + 0.1 * i))
    (tmp_path / "runs.csv").write_text(
        "log,unit,age [pages],event\n"
        "U1-0.csv,U1,0,\nU1-1.csv,U1,1000,regreased\n,U1,1500,cleaned\nU1-2.csv,U1,2000,\n"
    )
    return tmp_path


@pytest.fixture
def dwell_table() -> Callable[[float], str]:
    def table(scale: float) -> str:
        rows = [
            f"{n},{scale * 100 * n**0.4 * (t / 100) ** -0.9:.6g},{t}"
            for t in (100, 150)
            for n in (5, 10, 20, 40, 80)
        ]
        return "\n".join(["speed [rpm],torque [mN*m],temp [degC]", *rows]) + "\n"

    return table


def test_the_table_of_runs_names_events_and_the_campaign_keeps_them(campaign: Path) -> None:
    for _ in range(2):  # adding them again changes nothing
        done = run("campaign", "add", "life.hersey", "--table", "runs.csv", cwd=campaign)
        assert done.returncode == 0, done.stderr
        with Campaign.open(campaign / "life.hersey") as opened:
            assert opened.events() == [
                Event("U1", Age(1000.0, "pages"), "re-greased", 2),
                Event("U1", Age(1500.0, "pages"), "cleaned", None),
            ]
    listed = run("campaign", "list", "life.hersey", cwd=campaign).stdout.splitlines()
    assert listed[2:] == ["  re-greased at 1000 pages", "  cleaned at 1500 pages"]
    printed = json.loads(run("campaign", "list", "life.hersey", "--json", cwd=campaign).stdout)
    assert printed["events"][0] == {"unit": "U1", "age": 1000.0, "kind": "re-greased", "run": 2}


def test_an_event_is_recorded_moved_with_its_run_and_removed(campaign: Path) -> None:
    run("campaign", "add", "life.hersey", "--table", "runs.csv", cwd=campaign)
    line = ("campaign", "event", "life.hersey", "replaced", "--unit", "U1", "--age", "1800 pages")
    assert run(*line, cwd=campaign).stdout == "U1: replaced at 1800 pages\n"
    (campaign / "U1-1.csv").write_text((campaign / "U1-1.csv").read_text().replace("\n5,", "\n5.1,"))
    again = ("campaign", "add", "life.hersey", "U1-1.csv", "--unit", "U1", "--age", "1000 pages", "--force")
    assert run(*again, cwd=campaign).returncode == 0
    with Campaign.open(campaign / "life.hersey") as opened:
        kinds = [(each.kind, each.run) for each in opened.events()]
    assert kinds == [("re-greased", 4), ("cleaned", None), ("replaced", None)]
    assert run(*line, "--remove", cwd=campaign).stdout == "U1: removed replaced at 1800 pages\n"
    gone = run(*line, "--remove", cwd=campaign)
    assert gone.returncode == 2
    assert gone.stderr == "hersey: specimen 'U1' has no event 'replaced' at 1800 pages\n"


@pytest.mark.parametrize(
    ("rows", "error", "message"),
    [
        ("U1-0.csv,U1,0,painted", ParameterError, r"line 2, column 'event': event 'painted' is unknown"),
        (",U1,0,", UnreadableLogError, "line 2: column 'log' is empty"),
        ("U1-0.csv,U1,,cleaned", UnreadableLogError, "line 2: column 'age' is empty"),
    ],
)
def test_a_bad_row_is_named(tmp_path: Path, rows: str, error: type[Exception], message: str) -> None:
    (tmp_path / "runs.csv").write_text(f"log,unit,age [pages],event\n{rows}\n")
    with pytest.raises(error, match=message):
        read_runs(tmp_path / "runs.csv")


def test_two_columns_of_events_are_refused(tmp_path: Path) -> None:
    (tmp_path / "runs.csv").write_text("log,unit,age,event,Event\na.csv,U1,0 h,,\n")
    with pytest.raises(ChannelError, match="more than one column 'event'"):
        read_runs(tmp_path / "runs.csv")


def test_an_event_of_nothing_is_refused(campaign: Path) -> None:
    run("campaign", "add", "life.hersey", "--table", "runs.csv", cwd=campaign)
    with Campaign.open(campaign / "life.hersey") as opened:
        with pytest.raises(ParameterError, match=r"life\.hersey has no specimen 'X2'\. Specimens: U1$"):
            opened.add_event("X2", "5 pages", "cleaned")
        with pytest.raises(UnitError, match="in h, but the others are in pages"):
            opened.add_event("U1", "5 h", "cleaned")
        with pytest.raises(ParameterError, match="an event names run 1, which is of another specimen or age"):
            opened.add_event("U1", "5 pages", "cleaned", run=1)
        assert len(opened.events()) == 2


def test_spaces_of_a_name_do_not_count(tmp_path: Path) -> None:
    with Campaign.create(tmp_path / "life.hersey") as opened:
        shipped.add(opened, "U 1", 0.0, [(1.0, 0.1, 0.001, 400.0)])
        added = opened.add_event(" U  1 ", "5 pages", "cleaned")
        assert opened.events() == [added] == [Event("U 1", Age(5.0, "pages"), "cleaned", None)]
        for name in (" U  1 ", "U 1"):
            assert opened.runs(name)["unit"].to_list() == ["U 1"]
            assert [each["unit"] for each in opened.to_dict(name)["events"]] == ["U 1"]
        with pytest.raises(ParameterError, match=r"has no specimen '  '\. Specimens: U 1$"):
            opened.runs("  ")
        opened.remove_event(" U  1 ", "5 pages", "cleaned")
        assert opened.events() == []


def test_a_file_without_events_is_read_and_brought_up_to_date(campaign: Path) -> None:
    run("campaign", "add", "life.hersey", "--table", "runs.csv", cwd=campaign)
    with sqlite3.connect(campaign / "life.hersey") as database:
        database.execute("DROP TABLE events")
        database.execute("PRAGMA user_version = 2")
    database.close()
    assert "events" not in SCHEMAS[2]
    with Campaign.open(campaign / "life.hersey", write=False) as opened:
        assert opened.events() == []
    with Campaign.open(campaign / "life.hersey") as opened:
        assert opened.add_event("U1", "1000 pages", "cleaned", run=2).run == 2


def test_a_renewed_layer_thins_from_its_own_age(monkeypatch: pytest.MonkeyPatch) -> None:
    """From 105000 pages on the logs of U1 are those of a new specimen: it lives its life again from there."""
    fewer(monkeypatch)
    whole = shipped.campaign(4)
    runs, dwells = whole.runs(), whole.dwells()
    again = {
        4: 1,
        5: 2,
        6: 3,
    }  # runs at 105000, 140000 and 175000 have the dwells of those at 0, 35000, 70000
    runs = runs.with_columns(age=pl.when(pl.col("run") == 6).then(175000.0).otherwise(pl.col("age")))
    parts = [dwells.filter(~pl.col("run_id").is_in(list(again)))]
    for run_id, source in again.items():
        parts.append(dwells.filter(pl.col("run_id") == source).with_columns(run_id=pl.lit(run_id, pl.Int64)))
    answers = {
        "path": whole.path,
        "age_unit": "pages",
        "runs": lambda: runs,
        "dwells": lambda: pl.concat(parts),
    }
    event = Event("U1", Age(105000.0, "pages"), "re-greased", 4)
    renewed: Any = shipped.Campaign(**answers)
    renewed.events = lambda: [event]
    found = hersey.film_life(renewed, shipped.machine())
    usual = hersey.film_life(whole, shipped.machine())
    ages, before = ({each.unit: each.age for each in film.starves[0].units} for film in (found, usual))
    assert list(ages) == ["U1", "U2", "U3", "U4"]
    assert ages["U1"].value == pytest.approx(105000.0 + before["U1"].value, rel=0.1)
    assert ages["U2"].value == pytest.approx(before["U2"].value, rel=0.05)
    young = found.ages < 105000.0
    assert np.isnan(found.curves[0].value[0, young]).all()
    assert np.isfinite(found.curves[0].value[0, ~young]).all()
    assert np.isfinite(found.curves[0].value[1:]).all()


def test_values_foretold_count_from_the_last_event() -> None:
    asked: list[tuple[int, list[float]]] = []
    growth = SimpleNamespace(drawn_values=lambda row, age: asked.append((row, age.tolist())))
    mode: Any = SimpleNamespace(growth=growth)
    none = np.zeros((1, 2))
    followed = Followed({"U1": 600.0}, {"U1": 300.0}, 300.0)
    way = FittedWay(mode, none, none, none[0], {"U1": 1}, 0.1, followed, Earliest.unknown(1))
    way.drawn_values("U1", np.array([300.0, 500.0]))
    assert asked == [(1, [0.0, 200.0])]
