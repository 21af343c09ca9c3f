"""Friction forces and coefficients, several runs in a file, clocks that are odd, cells that are bad."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import (
    ChannelError,
    ParameterError,
    TimeOrderError,
    UnitError,
    UnreadableLogError,
    UnstatedRoleError,
)
from hersey.log import list_channels
from hersey.log.text import blocks
from hersey.schema.domain import Domain
from tests.conftest import shared

TORQUE_DOMAIN = Domain()
FORCE_SLIDING = Domain("friction force", "sliding speed")
COEFFICIENT = Domain("friction coefficient", "sliding speed")
ROWS = 200
TIME = np.arange(ROWS) * 0.1
FORCE = 5.0 + 0.01 * np.arange(ROWS)
SLIDING = 20.0 + 0.1 * np.arange(ROWS)  #: mm/s
LOAD = 50.0 + np.arange(ROWS) // 100  #: N
RADIUS = 25.0 + np.arange(ROWS) // 100  #: mm


def text(separator: str = ",", **columns: object) -> str:
    """A table of columns called as the keywords, one blank for each underline."""
    table = pl.DataFrame({name: np.broadcast_to(np.asarray(v), ROWS) for name, v in columns.items()})
    return table.write_csv(separator=separator)


def write(path: Path, content: str) -> Path:
    path.write_text(content, encoding="utf-8")
    return path


FRICTION = {"Time [s]": TIME, "Friction force [N]": FORCE, "Sliding speed [mm/s]": SLIDING}


def test_a_friction_force_with_its_radius_is_a_torque(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", text(**FRICTION))
    (run,) = hersey.read(path, isothermal=True).runs  # asks for no radius: it stays what it is
    np.testing.assert_array_equal(run.torque, FORCE)
    np.testing.assert_allclose(run.speed, SLIDING * 1e-3, rtol=1e-12)
    assert run.domain == FORCE_SLIDING
    log = hersey.read(path, isothermal=True, radius="25 mm")
    assert log.domain == TORQUE_DOMAIN
    (run,) = log.runs
    np.testing.assert_allclose(run.torque, FORCE * 0.025, rtol=1e-12)
    np.testing.assert_allclose(run.speed, SLIDING * 1e-3 / 0.025, rtol=1e-12)
    assert run.load is None
    of_torque, of_speed = log.files[0].warnings
    assert (of_torque.kind, of_speed.kind) == ("torque computed", "speed computed")
    assert of_torque.values["radius"] == of_speed.values["radius"] == 0.025
    assert str(of_torque) == "torque is 'Friction force' x radius (0.025 m)"
    assert str(of_speed) == "speed is 'Sliding speed' / radius (0.025 m)"
    with pytest.raises(ParameterError, match=r"radius is -0\.025"):
        hersey.read(path, isothermal=True, radius="-25 mm")
    with pytest.raises(UnitError, match="radius"):
        hersey.read(path, isothermal=True, radius="25 N")


def test_load_and_radius_per_row(tmp_path: Path) -> None:
    columns = FRICTION | {"Radius [mm]": RADIUS, "Normal load [N]": LOAD}
    path = write(tmp_path / "a.csv", text(**columns))
    stated = {"radius": "Radius", "load": "Normal load"}
    (run,) = hersey.read(path, isothermal=True, channels=stated).runs
    np.testing.assert_allclose(run.torque, FORCE / LOAD, rtol=1e-12)
    np.testing.assert_allclose(run.speed, SLIDING * 1e-3, rtol=1e-12)
    assert run.domain == COEFFICIENT
    assert run.load is not None
    np.testing.assert_allclose(run.load, LOAD)
    (same,) = hersey.read(pl.DataFrame(columns), isothermal=True, channels=stated).runs  # the other way
    np.testing.assert_allclose(same.torque, run.torque, rtol=1e-12)
    np.testing.assert_allclose(same.speed, run.speed, rtol=1e-12)
    assert same.load is not None
    np.testing.assert_allclose(same.load, LOAD)
    assert "load (N)" in hersey.read(path, isothermal=True, channels=stated).to_frame().columns


@pytest.mark.parametrize("name", ["COF", "Friction coefficient", "µ [1]", "Friction coefficient [-]"])
def test_a_coefficient_needs_a_load_only_to_become_a_torque(name: str, tmp_path: Path) -> None:
    columns = {"Time [s]": TIME, name: 0.1, "v [m/s]": 0.02}
    path = write(tmp_path / "a.csv", text(**columns))
    for given in ({}, {"radius": 0.025}, {"load": 40.0}):
        (run,) = hersey.read(path, isothermal=True, **given).runs
        np.testing.assert_allclose((run.torque[0], run.speed[0]), (0.1, 0.02))
        assert run.domain == COEFFICIENT
    for source in (path, pl.DataFrame(columns | {"Time [s]": TIME})):
        (run,) = hersey.read(source, isothermal=True, radius=0.025, load="40 N").runs
        np.testing.assert_allclose(run.torque, 0.1 * 40 * 0.025, rtol=1e-12)
        np.testing.assert_allclose(run.speed, 0.8, rtol=1e-12)
        assert run.load is not None
        np.testing.assert_allclose(run.load, 40.0)


def test_a_row_of_units_may_hold_that_of_a_coefficient(tmp_path: Path) -> None:
    lines = ["t;mu;v;Load", "s;1;mm/s;N", *(f"{i};0,1;20,5;50" for i in range(30))]
    path = write(tmp_path / "a.csv", "\n".join(lines))
    log = hersey.read(path, isothermal=True, radius="25 mm", channels={"load": "Load"})
    np.testing.assert_allclose(log.runs[0].torque, 0.1 * 50 * 0.025)  # one radius, and one load throughout
    assert log.rows == 30


def test_a_torque_goes_before_a_force(tmp_path: Path) -> None:
    columns = FRICTION | {"Torque [N*m]": 0.3, "Speed [rpm]": 60.0}
    (run,) = hersey.read(write(tmp_path / "a.csv", text(**columns)), isothermal=True).runs
    np.testing.assert_allclose(run.torque, 0.3)
    np.testing.assert_allclose(run.speed, 2 * np.pi)


def test_only_a_load_that_is_named_costs_rows(tmp_path: Path) -> None:
    load = ["50.0"] * ROWS
    load[7] = "OVERLOAD"
    columns = FRICTION | {"Radius [mm]": RADIUS, "Load [N]": load}
    path = write(tmp_path / "a.csv", text(**columns))
    log = hersey.read(path, isothermal=True, channels={"radius": "Radius"})
    assert log.rows == ROWS
    assert log.runs[0].load is None
    named = hersey.read(path, isothermal=True, channels={"radius": "Radius", "load": "Load"})
    assert named.rows == ROWS - 1
    assert named.runs[0].load is not None


@pytest.mark.parametrize("wrong", [0.0, -25.0])
@pytest.mark.parametrize("turning", [False, True])
def test_a_radius_of_zero_or_less_costs_its_row(wrong: float, turning: bool, tmp_path: Path) -> None:
    radius = RADIUS.copy()
    radius[3] = wrong
    columns = FRICTION | {"Radius [mm]": radius}
    if turning:
        columns = {n: v for n, v in columns.items() if "Sliding" not in n} | {"Speed [rpm]": SLIDING}
    for source in (write(tmp_path / "a.csv", text(**columns)), pl.DataFrame(columns)):
        log = hersey.read(source, isothermal=True, channels={"radius": "Radius"})
        assert (log.rows, log.files[0].missing_rows) == ((ROWS - 1, 1) if turning or wrong < 0 else (ROWS, 0))


LENGTHS = ["Wear [um]", "Stroke [mm]", "Roll radius [mm]", "Gap [in]"]
FORCES = ["Clamp [kN]", "Normal load [N]", "Axial force [N]"]


@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("way", ["text", "frame", "means"])
def test_no_column_becomes_the_radius_by_its_unit_or_name(length: str, way: str, tmp_path: Path) -> None:
    read: Any
    source: Any
    turning = {"Time [s]": TIME, "Torque [N*m]": FORCE, "Sliding speed [mm/s]": SLIDING}
    columns = turning | {length: RADIUS}
    read, source = hersey.read, pl.DataFrame(columns)
    if way == "text":
        source = write(tmp_path / "a.csv", text(**columns))
    elif way == "means":
        read, source = hersey.SteadyPoints.from_table, source.drop("Time [s]")
    with pytest.raises(UnstatedRoleError, match="which needs the radius") as caught:
        read(source, isothermal=True)
    assert caught.value.role == "radius"
    assert caught.value.proposed == (("Roll radius",) if "radius" in length else ())
    if "radius" in length:
        assert "Column 'Roll radius [mm]' may be the radius: channels={'radius': 'Roll radius'}" in str(
            caught.value
        )


@pytest.mark.parametrize("force", FORCES)
def test_no_column_becomes_the_load_by_its_unit_or_name(force: str, tmp_path: Path) -> None:
    columns = FRICTION | {force: LOAD}
    name = force.partition(" [")[0]
    proposal = f"column '{force}' may be the normal load, but is not used. If it is, use channels="
    for source in (write(tmp_path / "a.csv", text(**columns)), pl.DataFrame(columns)):
        log = hersey.read(source, isothermal=True, radius="25 mm")
        assert log.runs[0].load is None
        said = [str(each) for each in log.files[0].warnings if each.kind == "column may play a role"]
        assert said == ([] if name == "Clamp" else [f"{proposal}{{'load': '{name}'}}"])
    coefficient = {"Time [s]": TIME, "COF": 0.1, "v [m/s]": 0.02, force: LOAD}
    log = hersey.read(pl.DataFrame(coefficient), isothermal=True, radius=0.025)
    assert (log.domain, log.runs[0].load) == (COEFFICIENT, None)


def test_a_unit_of_a_radius_names_no_column(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", text(**(TORQUE | {"Radius": RADIUS})))
    assert hersey.read(path, isothermal=True).rows == ROWS
    with pytest.raises(UnstatedRoleError, match="a unit is given for the radius, but no value or column"):
        hersey.read(path, isothermal=True, units={"radius": "mm"})


def test_a_torque_in_percent_is_no_coefficient(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", text(**{"Time [s]": TIME, "Torque [%]": FORCE, "Speed [rpm]": SLIDING}))
    with pytest.raises(UnitError, match="needs the torque at 100 %"):
        hersey.read(path, isothermal=True, radius=0.02, load=10.0)


def test_a_load_and_a_radius_for_each_run(tmp_path: Path) -> None:
    time = np.concatenate([TIME[:80], TIME[:120]])
    force = write(tmp_path / "force.csv", text(**(FRICTION | {"Time [s]": time})))
    log = hersey.read(force, isothermal=True, radius=["25 mm", "50 mm"], load=(10.0, 20.0))
    for run, rows, load in zip(log.runs, (slice(80), slice(80, 200)), (10.0, 20.0), strict=True):
        np.testing.assert_allclose(run.torque, FORCE[rows] / load, rtol=1e-12)
        np.testing.assert_allclose(run.speed, SLIDING[rows] * 1e-3, rtol=1e-12)
        assert run.load is not None
        np.testing.assert_allclose(run.load, load)
    cof = write(tmp_path / "cof.csv", text(**{"Time [s]": time, "COF": 0.1, "v [m/s]": 0.02}))
    log = hersey.read(cof, isothermal=True, radius=0.025, load=[10.0, 20.0])
    np.testing.assert_allclose([run.torque[0] for run in log.runs], [0.1, 0.1], rtol=1e-12)
    assert "load is 2 values, one for each run" in map(str, log.files[0].warnings)
    log = hersey.read(cof, isothermal=True, radius=[0.025, 0.05], load=[10.0, 20.0])
    np.testing.assert_allclose([run.torque[0] for run in log.runs], [0.1, 0.1], rtol=1e-12)
    np.testing.assert_allclose([run.speed[0] for run in log.runs], [0.02, 0.02], rtol=1e-12)
    with pytest.raises(ParameterError, match=r"load has 3 values for 2 runs. Give one value for each run"):
        hersey.read(cof, isothermal=True, radius=0.025, load=[10.0, 20.0, 30.0])
    with pytest.raises(ParameterError, match="load is -5"):
        hersey.read(cof, isothermal=True, radius=0.025, load=[10.0, -5.0])


# Bad cells ------------------------------------------------------------------------------------------------

TORQUE = {"Time [s]": TIME, "Torque [N*m]": FORCE, "Speed [rpm]": SLIDING}
BAD = ["#N/A", "", "OVERFLOW", "inf", "1e99", "9.9e37", "high", "NaN", "1.5.5", "--"]


def with_cells(column: str, cells: dict[int, str]) -> str:
    written = [repr(float(v)) for v in TORQUE[column]]
    for row, cell in cells.items():
        written[row] = cell
    return text(**(TORQUE | {column: written}))


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("column", list(TORQUE))
def test_one_bad_cell_costs_its_row(column: str, bad: str, tmp_path: Path) -> None:
    log = hersey.read(write(tmp_path / "a.csv", with_cells(column, {57: bad})), isothermal=True)
    assert (log.rows, log.files[0].missing_rows) == (ROWS - 1, 1)
    np.testing.assert_array_equal(log.runs[0].torque, np.delete(FORCE, 57))
    (warning,) = log.files[0].warnings
    assert warning.values["rows"] == 1
    assert f"line 59, column '{column.partition(' ')[0]}'" in str(warning)


def test_a_bad_cell_beside_a_time_of_day_passes_no_midnight(tmp_path: Path) -> None:
    lines = ["Time,Torque [N*m],Speed [rpm]"]
    for i in range(100):  # over 16 hours
        lines.append(f"{i // 6:02}:{i % 6}0:00,{'oops' if i == 50 else 1},60")
    log = hersey.read(write(tmp_path / "a.csv", "\n".join(lines) + "\n"), isothermal=True)
    np.testing.assert_allclose(log.runs[0].time, 600.0 * np.delete(np.arange(100.0), 50))


def test_many_bad_cells_are_refused_with_the_first(tmp_path: Path) -> None:
    some = write(tmp_path / "some.csv", with_cells("Torque [N*m]", dict.fromkeys(range(20, 60), "OVL")))
    with pytest.raises(
        UnreadableLogError,
        match=r"line 22, .*'OVL' .*first of 40 such rows, of 200\)\. .*drop_missing=True",
    ):
        hersey.read(some, isothermal=True)
    log = hersey.read(some, isothermal=True, drop_missing=True)
    assert (log.rows, log.files[0].missing_rows) == (160, 40)
    (warning,) = log.files[0].warnings
    assert (warning.kind, warning.values["rows"], warning.values["others"]) == ("rows left out", 40, 30)
    assert str(warning).startswith("40 rows were excluded: line 22")
    assert str(warning).endswith("; and 30 more")
    most = write(tmp_path / "most.csv", with_cells("Torque [N*m]", dict.fromkeys(range(20, 160), "off")))
    with pytest.raises(UnreadableLogError, match=r"'off' is not a number \(the first of 140 .*Too few rows"):
        hersey.read(most, isothermal=True, drop_missing=True)


def test_one_bad_cell_does_not_cost_the_other_files(tmp_path: Path) -> None:
    paths = [write(tmp_path / f"{i}.csv", with_cells("Speed [rpm]", {9: f"1{i}"})) for i in range(3)]
    paths.append(write(tmp_path / "bad.csv", with_cells("Speed [rpm]", {5: "ERR"})))
    log = hersey.read(paths, isothermal=True)
    assert log.rows == 4 * ROWS - 1


def test_a_cell_that_reads_in_two_ways_costs_its_row_and_is_named(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", with_cells("Torque [N*m]", {57: '"1.299,5"'}).replace('"""', '"'))
    (file,) = hersey.read(path, isothermal=True).files
    assert file.missing_rows == 1
    assert any("line 59" in str(warning) for warning in file.warnings)


# Runs and clocks ------------------------------------------------------------------------------------------


def test_a_clock_that_starts_anew_begins_a_run(tmp_path: Path) -> None:
    time = np.concatenate([TIME[:80], TIME[:70], TIME[:50]])
    columns = TORQUE | {"Time [s]": time}
    for source in (write(tmp_path / "a.csv", text(**columns)), pl.DataFrame(columns)):
        log = hersey.read(source, isothermal=True)
        assert [run.time.size for run in log.runs] == [80, 70, 50]
        np.testing.assert_array_equal(np.concatenate([run.torque for run in log.runs]), FORCE)
        assert [file.rows for file in log.files] == [80, 70, 50]
        assert log.runs[1].name.endswith(", run 2 of 3")
    (warning,) = hersey.read(tmp_path / "a.csv", isothermal=True).files[1].warnings
    assert (warning.kind, warning.values["run"], warning.values["runs"]) == ("run of a file", 2, 3)
    assert str(warning) == "run 2 of 3 in a.csv begins at line 82"
    assert "3 runs" in hersey.read(tmp_path / "a.csv", isothermal=True).summary()


def test_the_number_of_a_run_in_a_column(tmp_path: Path) -> None:
    runs = np.repeat([1, 2], 100)
    time = np.concatenate([TIME[:100], TIME[50:150]])  # falls back, but not to the start
    path = write(tmp_path / "a.csv", text(**(TORQUE | {"Time [s]": time, "Test": runs})))
    with pytest.raises(TimeOrderError, match="line 102: time runs backwards"):
        hersey.read(path, isothermal=True)
    log = hersey.read(path, isothermal=True, channels={"run": "Test"})
    assert [run.time.size for run in log.runs] == [100, 100]


def test_the_clock_of_the_run_goes_before_that_of_a_step(tmp_path: Path) -> None:
    columns = {"Step time [s]": np.tile(TIME[:50], 4)} | TORQUE
    log = hersey.read(write(tmp_path / "a.csv", text(**columns)), isothermal=True)
    (run,) = log.runs
    np.testing.assert_allclose(run.time, TIME)


@pytest.mark.parametrize("row", [30, 198])
@pytest.mark.parametrize("odd", [0.0, 1e6])
def test_a_time_that_lies_apart_costs_its_row(odd: float, row: int, tmp_path: Path) -> None:
    time = TIME.copy()
    time[row] = odd
    log = hersey.read(write(tmp_path / "a.csv", text(**(TORQUE | {"Time [s]": time}))), isothermal=True)
    np.testing.assert_allclose(log.runs[0].time, np.delete(TIME, row))
    (warning,) = log.files[0].warnings
    assert (warning.values["low"], warning.values["reason"]) == (odd, "clock")
    assert f"line {row + 2}, column 'Time': impossible time {odd:.0f} s (once), out of line" in str(warning)


def test_rows_without_a_clock_and_their_interval(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    columns = {name: values for name, values in TORQUE.items() if name != "Time [s]"}
    path = write(tmp_path / "a.csv", text(**columns))
    with pytest.raises(ChannelError, match=r"no time column found. .* every=0.002"):
        hersey.read(path, isothermal=True)
    for source in (path, pl.DataFrame(columns)):
        log = hersey.read(source, isothermal=True, every="2 ms")
        np.testing.assert_allclose(log.runs[0].time, np.arange(ROWS) * 2e-3, rtol=1e-12)
        assert log.files[0].channels[0].unit == "0.002 s"
        with pytest.raises(ParameterError, match="Do not name a time column as well"):
            hersey.read(source, isothermal=True, every="2 ms", channels={"time": "Speed"})
    bad = write(tmp_path / "b.csv", path.read_text().replace("5.03,", "ERR,", 1))
    for block in (blocks.BLOCK, 100):
        monkeypatch.setattr(blocks, "BLOCK", block)
        time = hersey.read(bad, isothermal=True, every=1.0).runs[0].time
        np.testing.assert_allclose(time, np.delete(np.arange(float(ROWS)), 3))  # a gap, not a shift


HALVES = {
    "10:59:59 PM": "{0}:{1:02}:{2:02} {3}",
    "with a date": "3/14/2024 {0}:{1:02}:{2:02} {3}",
    "p.m.": "{0}:{1:02}:{2:02}.0 {4}",
    "ISO date": "2024-03-14 {0}:{1:02}:{2:02} {3}",
    "day first": "14/03/2024 {0}:{1:02}:{2:02}{3}",
}


@pytest.mark.parametrize("style", HALVES)
def test_clocks_with_am_and_pm(style: str, tmp_path: Path) -> None:
    lines = ["Time,Torque [N*m],Speed [rpm]"]
    for i in range(120):
        second = 12 * 3600 - 60 + i  # over noon
        half = "PM" if second >= 12 * 3600 else "AM"
        clock = ((second // 3600 - 1) % 12 + 1, second // 60 % 60, second % 60)
        stamp = HALVES[style].format(*clock, half, half.lower().replace("m", ".m."))
        lines.append(f"{stamp},1.5,{60 + i}")
    log = hersey.read(write(tmp_path / "a.csv", "\n".join(lines) + "\n"), isothermal=True)
    np.testing.assert_allclose(log.runs[0].time, np.arange(120.0), atol=1e-9)
    (warning,) = log.files[0].warnings
    assert warning.kind == "time stamps read"
    assert "AM and PM and was read as seconds since" in str(warning)


# Blanks between cells -------------------------------------------------------------------------------------

HEADS = {
    "one blank": "Time[s] Torque[N*m] Speed[rpm]",
    "a unit behind a blank": "Time [s]  Torque [N*m]   Speed [rpm]",
    "wide": "  Drive time [s]     Drive torque [N*m]\tDrive speed [rpm]  ",
    "a row of units": "t Tq n\ns N*m rpm",
}


@pytest.mark.parametrize("head", HEADS)
@pytest.mark.parametrize("end", ["", "  ", "\t", "\r"])
@pytest.mark.parametrize("comma", [False, True])
def test_any_run_of_blanks_may_separate(head: str, end: str, comma: bool, tmp_path: Path) -> None:
    gaps = itertools.cycle([" ", "   ", "\t", " \t "])
    rows = []
    for row in zip(*TORQUE.values(), strict=True):
        line = "".join(f"{next(gaps)}{value:.4f}" for value in row) + end
        rows.append(line.replace(".", ",") if comma else line)
    path = write(tmp_path / "a.txt", HEADS[head] + "\n" + "\n".join(rows) + "\n")
    log = hersey.read(path, isothermal=True)
    np.testing.assert_allclose(log.runs[0].time, TIME, atol=1e-4)
    np.testing.assert_allclose(log.runs[0].torque, FORCE, atol=1e-4)
    assert len(list_channels(path)) == 3
    inspection = hersey.inspect(path)
    assert inspection.files[0].rows == ROWS
    assert [c.role for c in inspection.files[0].channels] == ["time", "torque", "speed"]


def test_blanks_without_a_header_are_named_by_number(tmp_path: Path) -> None:
    path = write(tmp_path / "a.txt", text("\t", **TORQUE).partition("\n")[2].replace("\t", "  "))
    chosen = {"time": "#1", "torque": "#2", "speed": "#3"}
    log = hersey.read(
        path, channels=chosen, units={"time": "s", "torque": "N*m", "speed": "rpm"}, isothermal=True
    )
    np.testing.assert_allclose(log.runs[0].torque, FORCE)


def test_a_blank_as_thousands_mark_between_tabs_separates_nothing(tmp_path: Path) -> None:
    rows = [f"{i / 10}\t{1.5 + i / 100:.2f}\t{60 + i} 000" for i in range(40)]
    path = write(tmp_path / "a.txt", "\n".join(["t [s]\tTorque [N*m]\tSpeed [1e-3 rpm]", *rows, ""]))
    (run,) = hersey.read(path, isothermal=True).runs
    np.testing.assert_allclose(run.speed * 30 / np.pi, 60.0 + np.arange(40))


@pytest.mark.parametrize("ends", [",", ",,", ", ,"])
def test_trailing_separators_cost_nothing(ends: str, tmp_path: Path) -> None:
    for head in ("", ends):
        lines = text(**TORQUE).splitlines()
        path = write(
            tmp_path / "a.csv", "\n".join([lines[0] + head, *(line + ends for line in lines[1:])]) + "\n"
        )
        log = hersey.read(path, isothermal=True)
        assert (log.rows, log.files[0].warnings) == (ROWS, ())
        assert len(list_channels(path)) == 3


# Which channel --------------------------------------------------------------------------------------------


def test_a_dead_channel_is_not_taken(tmp_path: Path) -> None:
    columns = TORQUE | {"Speed 2 [rpm]": 0.0, "Speed 3 [rpm]": 3.14}
    for source in (write(tmp_path / "a.csv", text(**columns)), pl.DataFrame(columns)):
        log = hersey.read(source, isothermal=True)
        np.testing.assert_allclose(log.runs[0].speed, SLIDING * np.pi / 30)
        passed_over = [each for each in log.files[0].warnings if each.kind == "constant channel passed over"]
        assert [each.values["column"] for each in passed_over] == ["Speed 2 [rpm]", "Speed 3 [rpm]"]
    live = columns | {"Speed 3 [rpm]": SLIDING}
    with pytest.raises(
        ChannelError, match=r"speed column could be 'Speed \[rpm\]' or 'Speed 3 \[rpm\]'. Choose"
    ):
        hersey.read(write(tmp_path / "b.csv", text(**live)), isothermal=True)


def test_a_unit_tells_more_than_a_name(tmp_path: Path) -> None:
    columns = {
        "Time [s]": TIME,
        "Moment of inertia [kg*m^2]": 0.1,
        "Reaction [N*m]": FORCE,
        "n": np.arange(ROWS),
        "Speed [rpm]": SLIDING,
    }
    (file,) = hersey.read(write(tmp_path / "a.csv", text(**columns)), isothermal=True).files
    assert {c.role: c.name for c in file.channels} == {"time": "Time", "torque": "Reaction", "speed": "Speed"}


# Files by others ------------------------------------------------------------------------------------------


def test_pin_on_disc_by_its_force_its_load_and_its_radius() -> None:
    path = shared("data/friction/te67_pin_on_disc/PPS_60N_2.tsv")
    log = hersey.read(
        path,
        channels={
            "time": "Time",
            "torque": "Friction Force#1",
            "speed": "Speed",
            "temperature": "Specimen Temp",
            "radius": "Radius",
            "load": "Load",
        },
        units={"torque": "N", "speed": "rpm", "temperature": "degC", "radius": "mm", "load": "N"},
    )
    (run,) = log.runs
    assert run.torque[1] == pytest.approx(1.3 / 59.841)
    assert log.domain == COEFFICIENT
    assert run.load is not None
    assert run.load[0] == pytest.approx(59.841)


def test_step_times_of_a_tribometer_start_anew() -> None:
    path = shared("data/friction/newport_oil_stribeck/Motor_oil_glass/1rps1N.txt")
    units = {"time": "s", "torque": "N*m", "speed": "rev/s", "load": "-1 N"}
    total = hersey.read(
        path,
        channels={"time": "#2", "torque": "#4", "speed": "#6", "load": "#3"},
        units=units,
        isothermal=True,
    )
    steps = hersey.read(
        path,
        channels={"time": "#1", "torque": "#4", "speed": "#6", "load": "#3"},
        units=units,
        isothermal=True,
    )
    assert len(total.runs) == 1
    np.testing.assert_array_equal(
        np.concatenate([run.torque for run in steps.runs]), total.runs[0].torque[1:]
    )  # the first row is the end of the step before, and no run
    assert total.runs[0].load is not None
