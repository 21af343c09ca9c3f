"""The file of a campaign: adding, reading back, what is told, and what can go wrong with the file."""

from __future__ import annotations

import json
import os
import resource
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import HerseyError, MissingFileError, OutputError, ParameterError, UnitError
from hersey.life.age import Age
from hersey.life.campaign import Campaign, Entry, dwells
from hersey.life.campaign import store as storing
from hersey.life.campaign.conversion import entry_of, points_of
from hersey.life.campaign.guarded import GuardedConnection
from hersey.log.impossible import Impossible
from hersey.log.impossible import Reason as Cause
from hersey.schema.domain import Domain
from tests.conftest import ROOT

pytestmark = pytest.mark.usefixtures("one_branch")
TABLE = "speed [rpm],torque [mN*m],temperature [degC]\n"


def means(path: Path, level: float = 5.0) -> Path:
    """A small table of means."""
    rows = [
        f"{speed},{level * speed**0.3 * (1 + 0.01 * (speed % 3)) * (150 / hot):.6f},{hot}"
        for hot in (100, 150)
        for speed in (10, 20, 40, 80, 160)
    ]
    path.write_text(TABLE + "\n".join(rows) + "\n")
    return path


@cache
def sample() -> Entry:
    """What is kept of such a table."""
    table = {"speed [rpm]": [10, 20, 40, 80], "torque [mN*m]": [5.0, 5.6, 6.3, 7.2]}
    return entry_of(hersey.SteadyPoints.from_table(table, isothermal=True), "sample.csv")


def another(number: int) -> Entry:
    """The same of another log."""
    return replace(sample(), sha256=f"{number:064x}", path=str(Path(f"log{number}.csv").absolute()))


@pytest.fixture
def run_csv(tmp_path: Path) -> Path:
    return means(tmp_path / "run.csv")


@pytest.fixture
def campaign(tmp_path: Path) -> Iterator[Campaign]:
    with Campaign.create(tmp_path / "life.hersey") as opened:
        yield opened


def add(campaign: Campaign, run_csv: Path, unit: str = "F12", age: str = "1000 pages", **more: bool) -> str:
    points = hersey.SteadyPoints.from_table(run_csv)
    return campaign.add(points, log=run_csv, unit=unit, age=age, **more).outcome


def test_what_was_read_is_not_read_again_until_the_file_changes(
    campaign: Campaign, run_csv: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    add(campaign, run_csv)
    said, execute = [], GuardedConnection.execute

    def counted(self: GuardedConnection, sql: str, parameters: Any = (), /) -> sqlite3.Cursor:
        said.append(sql)
        return execute(self, sql, parameters)

    def read() -> set[str]:
        said.clear()
        for each in (campaign.runs, campaign.drives, campaign.measured, campaign.dwells):
            each()
        return set(said) - {"PRAGMA data_version"}

    monkeypatch.setattr(GuardedConnection, "execute", counted)
    assert len([sql for sql in read() if "FROM dwells NOT INDEXED" in sql]) == 1  # the check of all dwells
    assert read() == set()
    campaign.add_entries([(another(1), "F13", Age(0.0, "pages"))])
    assert len(campaign.drives()) == len(campaign.runs()) == 2


def test_the_numbers_for_computing_are_those_of_the_dwells(campaign: Campaign, run_csv: Path) -> None:
    add(campaign, run_csv)
    campaign.add_entries([(another(1), "F13", Age(0.0, "pages"))])
    of_run, numbers = campaign.measured()
    dwells = campaign.dwells().sort("run_id", maintain_order=True)
    names = ("speed (rad/s)", "temperature (K)", "torque (N m)", "torque error (N m)")
    assert of_run.tolist() == dwells["run_id"].to_list()
    for column, name in zip(numbers.T, names, strict=True):
        assert np.array_equal(column, dwells[name].cast(float).fill_null(np.nan), equal_nan=True), name
    rests = campaign.drives()
    assert set(rests) == set(of_run.tolist())
    assert rests[1][0] is None


def test_many_runs_may_be_named(campaign: Campaign) -> None:
    """More than one statement of SQLite may name; those that are not there change nothing."""
    campaign.add_entries((another(n), f"F{n}", Age(0.0, "pages")) for n in range(3))
    for named in (range(20_000, 0, -1), [3, 1, 2, 3, *range(10**15 - 20_000, 10**15)]):
        for found, every in zip(campaign.measured(named), campaign.measured(), strict=True):
            assert np.array_equal(found, every, equal_nan=True)
        assert campaign.drives(named).keys() == campaign.drives().keys()
    assert set(campaign.measured([3, 2])[0].tolist()) == {2, 3}
    assert campaign.measured([])[0].size == len(campaign.drives([])) == 0


def test_points_come_back_whole(campaign: Campaign, points: hersey.SteadyPoints, bench_csv: Path) -> None:
    rest = hersey.NoLoadTorque.stated(constant=1e-4, uncertainty=0.1)
    for number, each in enumerate((points, points.without(rest)), 1):
        surface = hersey.fit(each)
        fresh = replace(each.log.files[0], sha256=f"{number:064x}")
        each = replace(each, log=replace(each.log, files=(fresh,)))
        added = campaign.add(each, log=bench_csv, unit=f"F{number}", age="0 pages", fit=surface, force=True)
        again = campaign.points(added.run)
        assert again.table.equals(each.table)
        assert again.to_dict() == each.to_dict()
        assert again.log.rows == each.log.rows
        assert (
            replace(hersey.fit(again), data_sha256=()).to_dict()
            == surface.to_dict()
            == campaign.fit(added.run)
        )


def test_points_of_every_sample_of_friction_come_back_whole(
    campaign: Campaign, points: hersey.SteadyPoints, run_csv: Path
) -> None:
    rows = len(points)
    shares = {"window_errors": 1e-5, "relaxation_errors": 2e-5}
    friction = Domain("friction coefficient", "sliding speed")
    spoilt = Impossible("torque", "COF", "", Cause.CODE, 1, ((9e301, 1),), 9e301, 9e301, "row 7")
    file = replace(points.log.files[0], impossible=(spoilt,))
    why = replace(points.rejected[0].why, domain=friction)
    each = replace(
        points,
        of_every_sample=True,
        rejected=(replace(points.rejected[0], why=why),),
        temperature_rates=np.full(rows, 1e-3),
        log=replace(
            points.log, files=(file,), runs=tuple(replace(run, domain=friction) for run in points.log.runs)
        ),
        **{name: np.full((rows, 1), share) for name, share in shares.items()},
    )
    again = campaign.points(campaign.add(each, log=run_csv, unit="F1", age="0 pages").run)
    assert again.domain == friction
    assert again.of_every_sample
    assert again.rejected == each.rejected
    assert again.log.files == (file,)
    assert again.to_dict() == each.to_dict()
    assert np.array_equal(again.zero_errors, each.zero_errors)
    assert np.array_equal(again.temperature_rates, each.temperature_rates)


def test_points_kept_before_friction_was_read_are_torques(points: hersey.SteadyPoints) -> None:
    kept = entry_of(points, "a.csv")
    older = json.loads(kept.reduction)
    del older["log"]["domain"]
    for name in ("relaxation_errors", "window_errors", "temperature_rates", "of_every_sample"):
        del older[name]
    again = points_of(json.dumps(older), kept.dwells)
    assert again.domain.is_torque
    assert not again.of_every_sample


def test_means_come_back_whole(campaign: Campaign, run_csv: Path) -> None:
    points = hersey.SteadyPoints.from_table(run_csv)
    run = campaign.add(points, log=run_csv, unit="F12", age="1 h", settings={"tare": "none"}).run
    assert hersey.fit(campaign.points(run)).to_dict() == hersey.fit(points).to_dict()
    assert campaign.settings(run) == {"tare": "none"}
    isothermal = hersey.SteadyPoints.from_table(means(run_csv.with_name("b.csv"), 6.0), isothermal=True)
    run = campaign.add(isothermal, log=run_csv.with_name("b.csv"), unit="F12", age="2 h").run
    assert hersey.fit(campaign.points(run)).b is None


def test_the_same_log_twice_is_one_run(campaign: Campaign, run_csv: Path) -> None:
    assert add(campaign, run_csv) == "added"
    assert add(campaign, run_csv) == "already there"
    assert add(campaign, run_csv, age="1e3 page") == "already there"
    assert len(campaign) == 1


def test_a_changed_log_is_told_and_replaced_when_forced(campaign: Campaign, run_csv: Path) -> None:
    add(campaign, run_csv)
    means(run_csv, level=6.0)
    with pytest.raises(
        ParameterError, match=r"run\.csv has changed .* run 1 .F12 at 1000 pages.\. Use force=True"
    ):
        add(campaign, run_csv)
    assert add(campaign, run_csv, force=True) == "replaced"
    assert campaign.runs()["run"].to_list() == [2]
    means(run_csv, level=7.0)
    with pytest.raises(ParameterError, match="keep that run"):
        add(campaign, run_csv, age="2000 pages")
    assert add(campaign, run_csv, age="2000 pages", force=True) == "added"
    assert campaign.runs()["age"].to_list() == [1000.0, 2000.0]


def test_the_same_content_elsewhere_is_told(campaign: Campaign, run_csv: Path) -> None:
    add(campaign, run_csv)
    copy = run_csv.with_name("copy.csv")
    copy.write_bytes(run_csv.read_bytes())
    assert add(campaign, copy) == "already there"
    with pytest.raises(ParameterError, match=r"same content as run 1 .F12 at 1000 pages."):
        add(campaign, copy, unit="F13")
    with pytest.raises(ParameterError, match="Use force=True to move it to F12 at 2000 pages"):
        add(campaign, run_csv, age="2000 pages")
    assert add(campaign, run_csv, age="2000 pages", force=True) == "replaced"
    assert campaign.runs()["age"].to_list() == [2000.0]


def test_another_reading_is_told(campaign: Campaign) -> None:
    age = Age(1.0, "h")
    campaign.add_entries([(sample(), "F1", age)])
    other = replace(sample(), settings='{"tare": "standing"}')
    with pytest.raises(ParameterError, match="read with other settings"):
        campaign.add_entries([(other, "F1", age)])
    assert campaign.add_entries([(other, "F1", age)], force=True)[0].outcome == "replaced"


def test_a_unit_renamed_is_told(campaign: Campaign, run_csv: Path) -> None:
    add(campaign, run_csv)
    other = means(run_csv.with_name("other.csv"), 6.0)
    with pytest.raises(ParameterError, match="'f-12' differs only slightly from the existing 'F12'"):
        add(campaign, other, unit="f-12")
    for unit in ("", " ", "x" * 61, "F\x1b[2J"):
        with pytest.raises(ParameterError, match="is not valid"):
            add(campaign, other, unit=unit)
    with pytest.raises(ParameterError, match="Did you mean 'F12'"):
        campaign.runs("F1")


def test_a_campaign_has_one_unit_of_age(campaign: Campaign, run_csv: Path) -> None:
    add(campaign, run_csv, age="2 h")
    other = means(run_csv.with_name("other.csv"), 6.0)
    with pytest.raises(UnitError, match="Give it in h"):
        add(campaign, other, age="5 pages")
    add(campaign, other, age="30 min")
    assert campaign.runs()["age"].to_list() == [0.5, 2.0]
    assert campaign.age_unit == "h"


def test_all_or_none(campaign: Campaign) -> None:
    """A run that is refused takes back those before it."""
    one, pages = another(1), Age(1.0, "pages")
    with pytest.raises(UnitError):
        campaign.add_entries([(one, "F1", pages), (another(2), "F1", Age(1.0, "h"))])
    assert len(campaign) == 0
    assert campaign.age_unit == ""


def test_a_run_without_a_fit_is_kept_and_told(campaign: Campaign, tmp_path: Path) -> None:
    (tmp_path / "short.csv").write_text(TABLE + "10,5,100\n20,6,100\n")
    points = hersey.SteadyPoints.from_table(tmp_path / "short.csv")
    added = campaign.add(points, log=tmp_path / "short.csv", unit="F1", age="1 h")
    assert [each.kind for each in added.warnings] == ["added without a fit"]
    assert "added without a fit" in added.summary()
    assert campaign.fit(added.run) is None
    (no_fit,) = campaign.check().warnings
    assert (no_fit.kind, no_fit.where) == ("no fit", "run 1, F1 at 1 h: short.csv")
    assert no_fit.values["reason"] == added.warnings[0].values["reason"]
    assert "1 without a fit" in campaign.summary()


def test_check_finds_what_is_planted(campaign: Campaign, tmp_path: Path) -> None:
    for number in range(4):
        log = means(tmp_path / f"{number}.csv", 5.0 + number)
        os.utime(log, (1e9 + 1e4 * number, 1e9 + 1e4 * number))
        add(campaign, log, age=f"{[0, 1, 3, 2][number]} pages")
    found = campaign.check()
    assert [(each.kind, each.values["run"]) for each in found.warnings] == [("age backwards", 3)]
    (tmp_path / "0.csv").unlink()
    with (tmp_path / "1.csv").open("a") as file:
        file.write("\n")
    found = campaign.check()
    assert {(each.kind, each.values["run"]) for each in found.warnings} == {
        ("log missing", 1),
        ("log changed", 2),
        ("age backwards", 3),
    }
    assert found.summary().startswith("4 runs: 3 warnings")
    assert found.to_frame().height == len(found.to_dict()["warnings"]) == 3


def test_the_folder_can_move_with_its_logs(campaign: Campaign, run_csv: Path, tmp_path: Path) -> None:
    add(campaign, run_csv)
    campaign.close()
    moved = tmp_path / "moved"
    moved.mkdir()
    for path in tmp_path.glob("*.*"):
        path.rename(moved / path.name)
    with Campaign.open(moved / "life.hersey", write=False) as again:
        assert again.check().ok


def test_export_has_a_row_per_dwell(campaign: Campaign, run_csv: Path, tmp_path: Path) -> None:
    add(campaign, run_csv)
    add(campaign, means(tmp_path / "b.csv", 6.0), unit="F13", age="5 pages")
    (tmp_path / "out.parquet").write_bytes(campaign.export(".parquet"))
    table = pl.read_parquet(tmp_path / "out.parquet")
    assert table.equals(campaign.dwells())
    assert table.height == 20
    assert table["unit"].to_list() == ["F12"] * 10 + ["F13"] * 10
    assert table["age (pages)"].unique().sort().to_list() == [5.0, 1000.0]
    torque = campaign.points(2).column("torque")
    assert table.filter(pl.col("run_id") == 2)["torque (N m)"].to_list() == torque.tolist()
    assert campaign.export(".csv").count(b"\n") == 21
    with pytest.raises(OutputError, match=r"\.parquet or \.csv"):
        campaign.export(".xlsx")


def test_dwells_say_what_was_taken_off_as_the_rest(campaign: Campaign) -> None:
    hot = [380.0, 380.0, 420.0, 420.0]
    table = {"speed [rad/s]": [1, 2, 4, -8], "torque [N*m]": [5, 6, 7, -8], "temperature [K]": hot}
    rest = hersey.NoLoadTorque.stated(
        constant=1.0, per_speed=0.1, temperature_slope=-0.01, reference_temperature=400.0
    )
    whole = hersey.SteadyPoints.from_table(table)
    for age, points in (("0 pages", whole), ("5 pages", whole.without(rest))):
        campaign.add_entries([(replace(entry_of(points, f"{age}.csv"), sha256=age), "F12", Age.parse(age))])
    dwells = campaign.dwells()
    assert dwells["rest (N m)"].to_list() == pytest.approx([0.0] * 4 + [1.32, 1.44, 1.12, -1.44])
    assert (dwells["torque (N m)"] + dwells["rest (N m)"]).to_list() == pytest.approx([5, 6, 7, -8] * 2)


def test_two_hold_it_at_once_and_one_waits_then_is_told(campaign: Campaign) -> None:
    with Campaign.open(campaign.path, wait=0.05) as other:
        campaign._database.execute("BEGIN IMMEDIATE")
        with pytest.raises(OutputError, match=r"in use by another program. Wait until"):
            other.add_entries([(sample(), "F1", Age(1.0, "h"))])
        assert len(other) == 0  # one may read meanwhile
        campaign._database.execute("ROLLBACK")
        other.add_entries([(sample(), "F1", Age(1.0, "h"))])
    assert len(campaign) == 1


def test_two_writers_at_once_both_complete(tmp_path: Path) -> None:
    """They also make the file at once."""
    path = tmp_path / "new.hersey"

    def write(unit: int) -> None:
        for number in range(25):
            with Campaign.create(path) as opened:
                opened.add_entries([(another(100 * unit + number), f"F{unit}", Age(float(number), "h"))])

    with ThreadPoolExecutor(3) as pool:
        for done in [pool.submit(write, unit) for unit in range(1, 4)]:
            done.result()
    with Campaign.open(path) as opened:
        assert opened.runs()["unit"].to_list() == ["F1"] * 25 + ["F2"] * 25 + ["F3"] * 25
        assert not [each for each in opened.check().warnings if each.kind == "damaged"]


def test_kills_lose_nothing(tmp_path: Path) -> None:
    """Ten; `python -m tests.life.kills 200` for more."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.life.kills", "10"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([*sys.path, str(ROOT)])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.endswith(": 0 faults\n")


def test_what_is_no_campaign_is_refused_and_left_as_it_is(tmp_path: Path, run_csv: Path) -> None:
    foreign = tmp_path / "foreign.hersey"
    with sqlite3.connect(foreign) as database:
        database.execute("CREATE TABLE mine (x)")
    for path in (run_csv, foreign):
        before = path.read_bytes()
        for way in (Campaign.open, Campaign.create):
            with pytest.raises(ParameterError, match=r"is not a campaign file. Name a file"):
                way(path)
        assert path.read_bytes() == before
    with pytest.raises(MissingFileError, match=r"Create it with: hersey.Campaign.create\("):
        Campaign.open(tmp_path / "none.hersey")
    with pytest.raises(ParameterError, match="is not a file"):
        Campaign.create(tmp_path)
    with pytest.raises(ParameterError, match=r"ends in \.hersey"):
        Campaign.create(tmp_path / "life.csv")
    with pytest.raises(OutputError, match=r"there is no directory .*Make it first"):
        Campaign.create(tmp_path / "none" / "life.hersey")


def test_another_version_is_refused_or_brought_up_to_date(
    campaign: Campaign, monkeypatch: pytest.MonkeyPatch
) -> None:
    campaign.add_entries([(sample(), "F1", Age(1.0, "h"))])
    campaign.close()
    monkeypatch.setattr(storing, "VERSION", storing.VERSION + 1)
    with pytest.raises(ParameterError, match=r"older version of hersey .* 'hersey campaign add"):
        Campaign.open(campaign.path, write=False)
    with pytest.raises(ParameterError, match=r"cannot update. Add the logs to a new campaign"):
        Campaign.open(campaign.path)

    def halfway(database: sqlite3.Connection) -> None:
        database.execute("ALTER TABLE runs ADD COLUMN remark TEXT")
        raise sqlite3.OperationalError("database or disk is full")

    monkeypatch.setitem(storing.MIGRATIONS, storing.VERSION - 1, halfway)
    with pytest.raises(HerseyError):
        Campaign.open(campaign.path)
    monkeypatch.setitem(
        storing.MIGRATIONS,
        storing.VERSION - 1,
        lambda database: database.execute("ALTER TABLE runs ADD COLUMN remark TEXT") and None,
    )
    with Campaign.open(campaign.path) as again:
        assert len(again) == 1
    monkeypatch.undo()
    with pytest.raises(ParameterError, match="a newer version"):
        Campaign.open(campaign.path)


def test_a_file_for_reading_alone_is_told(campaign: Campaign) -> None:
    with (
        Campaign.open(campaign.path, write=False) as other,
        pytest.raises(OutputError, match="Check the permissions"),
    ):
        other.add_entries([(sample(), "F1", Age(1.0, "h"))])


@contextmanager
def room(size: int) -> Iterator[None]:
    """Let no file of this process grow beyond a size, as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_is_told_and_loses_nothing(campaign: Campaign) -> None:
    campaign.add_entries([(another(1), "F1", Age(1.0, "h"))])
    wal = campaign.path.with_name("life.hersey-wal").stat().st_size
    many = [(another(number), "F1", Age(2.0, "h")) for number in range(2, 40)]
    with room(wal + 5000), pytest.raises(OutputError, match="earlier runs are kept"):
        campaign.add_entries(many)
    assert len(campaign) == 1
    campaign._database.execute("PRAGMA max_page_count = 30")
    with pytest.raises(OutputError, match=r"the disk is full. Free some space"):
        campaign.add_entries(many)
    assert campaign._database.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
    campaign._database.execute("PRAGMA max_page_count = 1000000")
    campaign.add_entries(many)
    assert len(campaign) == 39


def test_a_damaged_file_is_told(campaign: Campaign) -> None:
    campaign.add_entries([(another(number), f"F{number}", Age(1.0, "h")) for number in range(30)])
    campaign.close()
    content = bytearray(campaign.path.read_bytes())
    content[4096:-4096] = b"\xff" * (len(content) - 8192)
    campaign.path.write_bytes(content)
    with pytest.raises(ParameterError, match=r"is damaged .* backup"), Campaign.open(campaign.path) as again:
        again.dwells()


def test_a_thousand_runs_are_listed(campaign: Campaign) -> None:
    campaign.add_entries((another(n), f"F{n % 20}", Age(float(n), "pages")) for n in range(1000))
    assert campaign.runs().height == 1000
    assert len(campaign.summary().splitlines()) == 21
    assert json.loads(json.dumps(campaign.to_dict()))["runs"][0]["unit"] == "F0"


def test_added_runs_are_compared_with_a_part_of_many(campaign: Campaign) -> None:
    """With their own specimen, the 20 added last, and 20 of the rest from first to last."""
    campaign.add_entries((another(n), f"F{n:03}", Age(float(n // 100), "h")) for n in range(100))
    (added,) = campaign.add_entries([(another(100), "F050", Age(5.0, "h"))])
    found = campaign.diagnose([added.run]).runs
    units = sorted(set(found.unit))
    assert len(units) == 41
    assert {"F000", "F050", "F079"}.union(f"F{n:03}" for n in range(80, 100)).issubset(units)
    assert found.unit.count("F050") == 2
    assert found.of_run.size == sum(len(another(0).dwells) for _ in range(42))
    assert campaign.diagnose().runs.number == tuple(campaign.runs()["run"])


def test_dwells_are_read_once_until_somebody_changes_the_file(
    campaign: Campaign, monkeypatch: pytest.MonkeyPatch
) -> None:
    campaign.add_entries([(another(0), "F1", Age(1.0, "h"))])
    reads, read = [0], dwells.measured_of

    def counted(*given: Any) -> Any:
        reads[0] += 1
        return read(*given)

    monkeypatch.setattr(dwells, "measured_of", counted)
    of_run, table = campaign.measured()
    table[:] = 0.0
    assert campaign.measured()[1].any()
    assert reads == [1]
    campaign.add_entries([(another(1), "F2", Age(1.0, "h"))])
    assert campaign.measured()[0].size == 2 * of_run.size
    with Campaign.open(campaign.path) as other:
        other.add_entries([(another(2), "F3", Age(1.0, "h"))])
    assert campaign.measured()[0].size == 3 * of_run.size
    assert reads == [3]


def test_among_few_runs_all_are_compared(campaign: Campaign) -> None:
    added = campaign.add_entries((another(n), f"F{n}", Age(1.0, "h")) for n in range(12))
    assert len(campaign.diagnose([added[3].run]).runs.number) == 12


def test_a_fit_with_a_transition_is_kept_whole(
    campaign: Campaign, points: hersey.SteadyPoints, surface: hersey.DampingSurface, bench_csv: Path
) -> None:
    run = campaign.add(points, log=bench_csv, unit="F1", age="0 pages", fit=surface).run
    assert surface.transition is not None
    assert campaign.runs()["transition_speed"].to_list() == [surface.transition.speed.value]
    assert campaign.fit(run) == json.loads(json.dumps(surface.to_dict()))


def test_a_log_that_is_overwritten_is_named_with_the_age_it_had(campaign: Campaign, run_csv: Path) -> None:
    add(campaign, run_csv)
    run_csv.write_text(run_csv.read_text() + "7,0.1,100\n")
    points = hersey.SteadyPoints.from_table(run_csv)
    added = campaign.add(points, log=run_csv, unit="F12", age="2000 pages", force=True)
    (stays,) = added.warnings
    assert (stays.kind, stays.severity) == ("log overwritten", "watch")
    assert stays.values == {"run": 1, "unit": "F12", "age": 1000.0, "age_unit": "pages"}


def test_a_run_of_many_dwells_is_added_and_read_again(campaign: Campaign) -> None:
    """A table of means may have as many rows as a log: what a statement may take grows with the file."""
    entry = sample()
    many = replace(entry, dwells=(entry.dwells * (40_000 // len(entry.dwells) + 1))[:40_000])
    (added,) = campaign.add_entries([(many, "F12", Age.parse("1000 pages"))])
    assert added.dwells == 40_000
    with Campaign.open(campaign.path) as again:
        assert again.runs()["dwells"].to_list() == [40_000]
