"""Readings that cannot be right cost their rows, by name, and nothing else of a log whose truth is known."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from numpy.typing import NDArray

import hersey
from hersey.errors import UnreadableLogError
from hersey.log.impossible import Reason
from tests.cli.command import run
from tests.conftest import mostly_nightly

Array = NDArray[np.float64]
Columns = dict[str, Array]
TIME, TORQUE, SPEED, HOT = "Time [s]", "Torque [mN*m]", "Speed [rpm]", "Temperature [degC]"
TEMPERATURES, SPEEDS = (80.0, 120.0, 170.0), (10.0, 20.0, 40.0, 80.0, 160.0, 40.0, 20.0)
HELD, RAMP, RATE = 70, 6, 10.0  # rows of a dwell and of a ramp, Hz
#: Of damping: torque = 300 mN m (T/100 degC)^b (n/30 rpm)^(1 + c).
B, C = -1.1, -0.6
#: Rows of the third dwell of the second temperature, and of the first temperature.
START = (len(SPEEDS) + 2) * (HELD + RAMP)
DWELL = slice(START, START + HELD)


@cache
def _clean() -> tuple[Array, ...]:
    random = np.random.default_rng(5)
    hot, turning = [], []
    for level in TEMPERATURES:
        for speed, following in zip(SPEEDS, (*SPEEDS[1:], SPEEDS[0]), strict=True):
            hot.append(np.full(HELD + RAMP, level))
            turning.append(np.r_[np.full(HELD, speed), np.geomspace(speed, following, RAMP)])
    speed, temperature = np.concatenate(turning), np.concatenate(hot)
    torque = 300.0 * (temperature / 100.0) ** B * (speed / 30.0) ** (1.0 + C)
    rows = speed.size
    torque *= np.exp(0.01 * random.standard_normal(rows))
    speed *= 1.0 + 0.002 * random.standard_normal(rows)
    temperature += 0.2 * random.standard_normal(rows)
    return np.arange(rows) / RATE, torque.round(3), speed.round(3), temperature.round(2)


def clean() -> Columns:
    """A log as recorded, without a fault."""
    return dict(zip((TIME, TORQUE, SPEED, HOT), (c.copy() for c in _clean()), strict=True))


@cache
def exponents_of_the_clean_log() -> tuple[hersey.Estimate, hersey.Estimate]:
    surface = hersey.fit(hersey.read(pl.DataFrame(clean())).steady())
    assert surface.b is not None
    return surface.b, surface.c


def at(rows: object, value: object) -> Callable[[Array], int]:
    """Write a value into rows; return how many there are."""

    def write(column: Array) -> int:
        column[rows] = value  # type: ignore[call-overload, index]
        return int(np.size(column[rows]))  # type: ignore[call-overload, index]

    return write


SCATTERED = np.arange(37, 1596, 200)  # 0.5 % of the rows
FIVE = np.array([100, 401, 702, 1003, 1304])
BURST = slice(500, 512)


def flipped(column: Array) -> int:
    column[FIVE] = -column[FIVE]
    return FIVE.size


def wrapped(column: Array) -> int:
    """A slightly negative reading of a counter of 16 bits in tenths."""
    rows = DWELL
    column[rows] = 6553.6 - np.tile([0.1, 0.3], HELD)[:HELD]
    return HELD


def signed(column: Array) -> int:
    """A reading that passes the end of a signed counter in hundredths."""
    column[BURST] -= 655.36
    return 12


def alternating(column: Array) -> int:
    column[START : START + HELD : 2] = 65535.0
    return HELD // 2


def nonsense(column: Array) -> int:
    """Up from the reading to 100 000 and back within 50 rows, of which most are far beyond 170 degC."""
    start = START + 10
    column[start : start + 50] = 120.0 + np.r_[np.linspace(4e3, 1e5, 25), np.linspace(1e5, 4e3, 25)]
    return 50


def random_numbers(column: Array) -> int:
    column[BURST] = np.random.default_rng(2).uniform(-1e9, 1e9, 12)
    return 12


def stopped(column: Array) -> int:
    """The clock stands at a code for 12 rows."""
    column[BURST] = 65535.0
    return 12


#: Name: column, what is written there, and what the warning must hold beside the count; None: not one value.
PATTERNS: dict[str, tuple[str, Callable[[Array], int], str | None]] = {
    "a million degrees in five rows": (HOT, at(FIVE, 1e6), "1000000 degC (5 times)"),
    "65535 degC in five rows": (HOT, at(FIVE, 65535.0), "65535 degC (5 times)"),
    "2.1e9 degC in five rows": (HOT, at(FIVE, 2147483647.0), "2147483647 degC (5 times)"),
    "9.96921e36, the fill value of netCDF": (HOT, at(FIVE, 9.96921e36), "9.96921e+36 degC (5 times)"),
    "1e308 degC": (HOT, at(FIVE, 1e308), "1e+308 degC (5 times)"),
    "6553.5 degC, scattered": (HOT, at(SCATTERED, 6553.5), "6553.5 degC (8 times)"),
    "3276.7 degC in a single row": (HOT, at(801, 3276.7), "3276.7 degC (once)"),
    "-999 degC, scattered": (HOT, at(SCATTERED, -999.0), "-999 degC (8 times)"),
    "an open thermocouple for a whole dwell": (HOT, at(DWELL, 1372.0), "1372 degC (70 times)"),
    "an open Pt100 for 10 s": (HOT, at(slice(600, 700), 850.0), "850 degC (100 times)"),
    "a sensor off its bus": (HOT, at(BURST, -127.0), "-127 degC (12 times)"),
    "no code, 612 degC for 3 s": (HOT, at(slice(600, 630), 612.0), "612 degC (30 times)"),
    "temperature drops to zero": (HOT, at(FIVE, 0.0), "0 degC (5 times)"),
    "alternating rows of a dwell": (HOT, alternating, "65535 degC (35 times)"),
    "a ramp of nonsense": (HOT, nonsense, None),
    "a temperature that wraps": (HOT, signed, None),
    "random numbers in a burst": (HOT, random_numbers, None),
    "65535 mN m at the start of a dwell": (
        TORQUE,
        at(slice(START, START + 8), 65535.0),
        "65535 mN*m (8 times)",
    ),
    "32767 mN m in a single row": (TORQUE, at(333, 32767.0), "32767 mN*m (once)"),
    "-32768 mN m, scattered": (TORQUE, at(SCATTERED, -32768.0), "-32768 mN*m (8 times)"),
    "-9999 mN m for a whole dwell": (TORQUE, at(DWELL, -9999.0), "-9999 mN*m (70 times)"),
    "1e30 mN m": (TORQUE, at(FIVE, 1e30), "1e+30 mN*m (5 times)"),
    "torque stuck at a code for 10 s": (TORQUE, at(slice(600, 700), 32767.0), "32767 mN*m (100 times)"),
    "no code, 20 N m in five rows": (TORQUE, at(FIVE, 20_000.0), "20000 mN*m (5 times)"),
    "torque flips its sign": (TORQUE, flipped, None),
    "torque drops to zero": (TORQUE, at(FIVE, 0.0), "0 mN*m (5 times)"),
    "65535 rpm at the end of the log": (SPEED, at(slice(-4, None), 65535.0), "65535 rpm (4 times)"),
    "2147483647 rpm in five rows": (SPEED, at(FIVE, 2147483647.0), "2147483647 rpm (5 times)"),
    "-999 rpm, scattered": (SPEED, at(SCATTERED, -999.0), "-999 rpm (8 times)"),
    "a speed below zero in a counter without sign": (SPEED, wrapped, "6553.3 rpm (35 times)"),
    "speed flips its sign": (SPEED, flipped, None),
    "1e9 rpm in a burst": (SPEED, at(BURST, 1e9), "1000000000 rpm (12 times)"),
    "the clock reads 1e30 s": (TIME, at(FIVE, 1e30), "1e+30 s (5 times)"),
    "the clock stands at a code": (TIME, stopped, "65535 s (12 times)"),
    "the clock reads zero, scattered": (TIME, at(SCATTERED, 0.0), "0 s (8 times)"),
    "the clock starts at a code": (TIME, at(slice(0, 4), 4294967.295), "4294967.295 s (4 times)"),
}


#: A frame takes the path of a file behind its reader: one pattern of each column.
IN_A_FRAME = (
    "65535 degC in five rows",
    "torque flips its sign",
    "speed flips its sign",
    "the clock stands at a code",
)
CASES = [(name, as_text) for name in PATTERNS for as_text in (False, True)]


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize(
    ("name", "as_text"),
    mostly_nightly(CASES, *(case for case in CASES if case[1] or case[0] in IN_A_FRAME)),
)
def test_what_cannot_be_right_is_left_out_by_name(name: str, as_text: bool, tmp_path: Path) -> None:
    column, write, says = PATTERNS[name]
    columns = clean()
    good = columns[column].copy()
    count = write(columns[column])
    changed = np.flatnonzero(columns[column] != good)
    source: object = pl.DataFrame(columns)
    if as_text:
        source = tmp_path / "log.csv"
        source.write_text(pl.DataFrame(columns).write_csv())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        log = hersey.read(source)
        surface = hersey.fit(log.steady())
    file = log.files[0]
    assert (log.rows, file.missing_rows) == (good.size - count, count)
    role = {TIME: "time", TORQUE: "torque", SPEED: "speed", HOT: "temperature"}[column]
    assert {each.role for each in file.impossible} == {role}
    assert sum(each.rows for each in file.impossible) == count
    assert {each.kind for each in file.warnings} == {"impossible readings"}
    for warning, each in zip(file.warnings, file.impossible, strict=True):
        assert (warning.values["rows"], warning.values["role"]) == (each.rows, role)
        assert (warning.values["low"], warning.values["high"]) == (each.low, each.high)
        assert warning.values["reason"] == each.reason
        assert str(warning).startswith(f"{each.rows} row{' was' if each.rows == 1 else 's were'} excluded, ")
        assert f"'{column.partition(' ')[0]}" in str(warning)
    words = " ".join(map(str, file.warnings))
    assert f"impossible {role} " in words
    assert says is None or says in words
    if as_text:
        first = min(int(each.where.split(",")[0].removeprefix("line ")) for each in file.impossible)
        assert first == changed[0] + 2
    assert surface.b is not None
    for found, clean_one in zip((surface.b, surface.c), exponents_of_the_clean_log(), strict=True):
        assert clean_one.low <= found.value <= clean_one.high
    assert surface.b.low <= B <= surface.b.high
    assert surface.c.low <= C <= surface.c.high


def test_a_log_without_a_fault_loses_no_row() -> None:
    log = hersey.read(pl.DataFrame(clean()))
    assert (log.rows, log.files[0].impossible, log.files[0].warnings) == (_clean()[0].size, (), ())


@pytest.mark.parametrize("word", ["inf", "-inf", "1.#INF"])
def test_words_for_no_number_cost_their_rows(word: str, tmp_path: Path) -> None:
    lines = pl.DataFrame(clean()).write_csv().splitlines()
    for row in FIVE:
        cells = lines[row + 1].split(",")
        lines[row + 1] = ",".join([*cells[:3], word])
    (tmp_path / "log.csv").write_text("\n".join(lines) + "\n")
    log = hersey.read(tmp_path / "log.csv")
    assert log.files[0].missing_rows == 5
    (warning,) = log.files[0].warnings
    assert (warning.kind, warning.values["rows"], warning.values["others"]) == ("rows left out", 5, 0)
    assert f"5 rows were excluded: line 102, column 'Temperature': '{word}' instead of a number" in str(
        warning
    )


def test_too_many_are_refused_with_their_share() -> None:
    columns = clean()
    rows = columns[HOT].size
    columns[HOT][: rows // 3] = 65535.0
    says = f"33% of temperature 'Temperature' is impossible .{rows // 3} of {rows} rows..*drop_missing=True"
    with pytest.raises(UnreadableLogError, match=says):
        hersey.read(pl.DataFrame(columns))
    assert hersey.read(pl.DataFrame(columns), drop_missing=True).rows == rows - rows // 3
    columns[HOT][:] = 100.0 * clean()[HOT]  # hundredths
    with pytest.raises(UnreadableLogError, match="100% of temperature"):
        hersey.read(pl.DataFrame(columns), drop_missing=True)


def test_a_wide_range_is_no_fault() -> None:
    """A drive that creeps for 98 % of a log, and one decade faster after another, loses no row."""
    speed = np.r_[np.full(2000, 0.1), np.repeat(10.0 ** np.arange(0.0, 4.1), 40)]
    noise = 1.0 + 0.01 * np.random.default_rng(1).standard_normal(speed.size)
    frame = {TIME: np.arange(speed.size) * 0.1, TORQUE: 5.0 * speed**0.4 * noise, SPEED: speed * noise}
    log = hersey.read(pl.DataFrame(frame), isothermal=True)
    assert (log.rows, log.files[0].impossible) == (speed.size, ())


def test_a_break_away_and_a_stop_are_no_faults() -> None:
    """Torque peaks at four times the running one in one row; speed stands, runs and stands."""
    torque, speed = np.zeros(600), np.zeros(600)
    torque[200:400], speed[200:400] = 100.0, 60.0
    torque[200] = 400.0
    frame = {TIME: np.arange(600) * 0.05, TORQUE: torque, SPEED: speed}
    assert hersey.read(pl.DataFrame(frame), isothermal=True).files[0].impossible == ()


def test_an_impossible_load_costs_its_row_where_it_is_asked_for() -> None:
    columns = clean() | {"Normal load [N]": np.full(_clean()[0].size, 50.0)}
    columns["Normal load [N]"][7] = 1e30
    log = hersey.read(pl.DataFrame(columns))
    assert (log.rows, log.files[0].impossible) == (_clean()[0].size, ())  # nobody asked for it
    log = hersey.read(pl.DataFrame(columns), channels={"load": "Normal load"})
    (found,) = log.files[0].impossible
    assert (log.rows, found.reason, found.rows) == (_clean()[0].size - 1, Reason.RANGE, 1)


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("verb", ["fit", "inspect", "models"])
def test_every_verb_says_so(verb: str, tmp_path: Path) -> None:
    columns = clean()
    columns[HOT][FIVE] = 1e6
    (tmp_path / "log.csv").write_text(pl.DataFrame(columns).write_csv())
    result = run(verb, tmp_path / "log.csv", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    said = " ".join(f"{result.stdout} {result.stderr}".split())
    assert (
        "excluded, the first at line 102, column 'Temperature': impossible temperature 1000000 degC (5 times)"
        in said
    )


EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize("name", ["bench.csv", "no-load.csv"])
def test_the_examples_lose_no_row(name: str) -> None:
    file = hersey.read(EXAMPLES / name, isothermal=name == "no-load.csv").files[0]
    assert (file.missing_rows, file.impossible) == (0, ())


@pytest.mark.parametrize(("header", "offset", "unit"), [("degC", 0.0, "0.1 degC"), ("K", 2731.5, "0.1 K")])
def test_tenths_of_a_degree_are_met_with_their_unit(
    header: str, offset: float, unit: str, tmp_path: Path
) -> None:
    """Rows in another unit are not missing: to drop them is no way out."""
    rows = [f"{0.1 * i:.1f},200,60,{round(10 * (23.5 + 0.4 * i) + offset)}" for i in range(400)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join([f"Time [s],Torque [mN*m],Speed [rpm],Temperature [{header}]", *rows]))
    with pytest.raises(UnreadableLogError, match="impossible temperature") as refused:
        hersey.read(path)
    assert refused.value.remedy == (
        f"if the temperatures are in tenths of a degree, use units={{'temperature': '{unit}'}}. Otherwise "
        "name another column, or correct the file"
    )
    log = hersey.read(path, units={"temperature": unit})
    assert log.rows == 400
    assert log.runs[0].temperature is not None
    assert log.runs[0].temperature[0] == pytest.approx(273.15 + 23.5, abs=0.06)


def test_a_code_of_a_sensor_is_not_taken_for_tenths(tmp_path: Path) -> None:
    rows = [f"{0.1 * i:.1f},200,60,{1820 if i % 2 else 120.5}" for i in range(400)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join([f"{TIME},{TORQUE},{SPEED},{HOT}", *rows]))
    with pytest.raises(UnreadableLogError, match="impossible temperature") as refused:
        hersey.read(path)
    assert "0.1 degC" not in refused.value.remedy
