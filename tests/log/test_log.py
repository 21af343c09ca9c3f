"""Every shape of CSV that loggers write is read to the same numbers."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hersey
from hersey.errors import ChannelError, UnitError, UnreadableLogError
from hersey.log.text import blocks

ROWS = [(0.0, 0.5, 60.0, 150.0), (0.1, 0.625, 61.5, 151.25), (0.2, 0.75, 63.0, 149.5)]


def plain(separator: str = ",", decimal: str = ".") -> str:
    return "\n".join(separator.join(f"{v}".replace(".", decimal) for v in row) for row in ROWS) + "\n"


HEADER = "Time [s],Torque [N.m],Speed [rpm],Temp [degC]\n"
SHAPES = {
    "name [unit]": HEADER + plain(),
    "name (unit)": HEADER.replace("[", "(").replace("]", ")") + plain(),
    "units row": "t,Tq,n,T1 temp\ns,N*m,rpm,degC\n" + plain(),
    "units row in brackets": "Time,Torque,Speed,Temp\n[s],[N.m],[rpm],[degC]\n" + plain(),
    "semicolon, decimal comma": HEADER.replace(",", ";") + plain(";", ","),
    "semicolon, decimal point": HEADER.replace(",", ";") + plain(";"),
    "tabs": HEADER.replace(",", "\t") + plain("\t"),
    "bars": HEADER.replace(",", "|") + plain("|"),
    "comments": "# made by hand\n# on a Friday, 2 of them\n" + HEADER + plain(),
    "preamble": "Logger X;v2\nSerial;0012;A\nSampling;10\n\n" + HEADER.replace(",", ";") + plain(";"),
    "preamble of commas": "Logger,X\nScale,0,True,2.0,49.5\nDate,2020-07-08\n" + HEADER + plain(),
    "empty last column": HEADER.replace("\n", ",\n") + plain().replace("\n", ",\n"),
    "other columns": "Note,"
    + HEADER
    + "".join(f"step {i},{line}\n" for i, line in enumerate(plain().splitlines())),
    "quoted": '"Time [s]","Torque [N.m]","Speed [rpm]","Temp [degC]"\n' + plain(),
    "trailing blank lines": HEADER + plain() + "\n\n",
    "no newline at the end": (HEADER + plain()).rstrip("\n"),
    "windows": (HEADER + plain()).replace("\n", "\r\n"),
}


def assert_same(log: hersey.TorqueLog) -> None:
    (run,) = log.runs
    expected = np.array(ROWS).T
    np.testing.assert_allclose(run.time, expected[0], rtol=1e-12)
    np.testing.assert_allclose(run.torque, expected[1], rtol=1e-12)
    np.testing.assert_allclose(run.speed, expected[2] * np.pi / 30, rtol=1e-12)
    assert run.temperature is not None
    np.testing.assert_allclose(run.temperature, expected[3] + 273.15, rtol=1e-12)


@pytest.mark.parametrize("shape", SHAPES)
def test_shape(shape: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(SHAPES[shape].encode())
    assert_same(hersey.read(path))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_encoding(encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes((HEADER.replace("degC", "°C") + plain()).encode(encoding))
    assert_same(hersey.read(path))


@pytest.mark.parametrize("size", [7, 64, 101])
@pytest.mark.parametrize("shape", ["name [unit]", "windows", "comments", "no newline at the end"])
def test_blocks_change_nothing(
    size: int, shape: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blocks, "BLOCK", size)
    path = tmp_path / "log.csv"
    path.write_bytes(SHAPES[shape].encode())
    assert_same(hersey.read(path))


@given(
    values=st.lists(
        st.tuples(
            st.floats(-1e6, 1e6, allow_subnormal=False),
            st.floats(-1e5, 1e5, allow_subnormal=False),
            st.floats(1.0, 1700.0),
        ),
        min_size=2,
        max_size=30,
    ),
    separator=st.sampled_from(",;\t"),
)
def test_any_numbers_survive(
    values: list[tuple[float, float, float]], separator: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("numbers") / "log.csv"
    rows = [(float(i), *row) for i, row in enumerate(values)]
    text = separator.join(["t [s]", "Torque [N*m]", "Speed [rad/s]", "Temp [K]"]) + "\n"
    text += "\n".join(separator.join(repr(v) for v in row) for row in rows)
    path.write_text(text)
    run = hersey.read(path).runs[0]
    assert run.temperature is not None
    found = np.column_stack([run.time, run.torque, run.speed, run.temperature])
    np.testing.assert_array_equal(found, np.array(rows))


def test_a_channel_is_named_when_two_could_be_it(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t [s],Tq (ozf.in),Torque 2 [N*m],Speed [rpm],Temp [degC]\n0,1,2,3,4\n1,1,2,3,4\n")
    with pytest.raises(ChannelError, match=r"channels=\{'torque': 'Tq'\}"):
        hersey.read(path)
    chosen = hersey.read(path, channels={"torque": "Tq (ozf.in)"})
    assert chosen.runs[0].torque[0] == pytest.approx(0.00706155, rel=1e-5)
    with pytest.raises(ChannelError, match="no column 'Moment'"):
        hersey.read(path, channels={"torque": "Moment"})


GOOD = {
    "padded cells": HEADER + plain().replace(",", " , "),
    "comments and blank lines in the middle": HEADER + plain().replace("\n", "\n\n# a note\n  # two\n"),
    "units under names with remarks": "Time (log),Torque (cell),Speed (roll),Temp (heater)\ns,N.m,rpm,degC\n"
    + plain(),
    "a wide line above the header": "Site,Operator,Rig,Date\n" + HEADER + plain(),
    "coarse clock": HEADER + plain(),
}


@pytest.mark.parametrize("case", GOOD)
def test_odd_but_good(case: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(GOOD[case])
    assert_same(hersey.read(path))


LINE = "{},0.5,60,150\n"
BODY = "".join(LINE.format(i / 10) for i in range(30))
MISREAD = {
    # name: text, what the refusal says; each was once read as something else without a word
    "a fan beside a speed in Hz": (
        "t [s],Torque [N*m],Drive speed [Hz],Temp [degC],Fan [rpm]\n" + BODY.replace("\n", ",900\n"),
        "revolutions or radians",
    ),
    "an ambient beside a film temperature without unit": (
        "t [s],Torque [N*m],Speed [rpm],Film temperature,Cabinet [degC]\n" + BODY.replace("\n", ",25\n"),
        "has no unit",
    ),
    "a set point beside a measured speed without unit": (
        "t [s],Torque [N*m],Speed actual,Temp [degC],Speed setpoint [rpm]\n" + BODY.replace("\n", ",60\n"),
        "has no unit",
    ),
    "an index column without a name": (HEADER + BODY.replace("\n", ",1\n"), "header has 4 cells"),
    "stray quotes": (
        HEADER.replace("\n", ",Note\n")
        + "".join(
            LINE.format(i / 10).replace("\n", ',5" roll\n' if i in (3, 20) else ",\n") for i in range(30)
        ),
        None,
    ),
    "thousands marks in a decimal comma file": (
        HEADER.replace(",", ";") + "0,1;0,5;60,0;150,0\n" * 5 + "0,2;28.140;60,0;150,0\n",
        "'28.140' is not a number",
    ),
    "a row behind a comment mark": (
        HEADER + BODY + "#8,0.5,60,150\n" + "9,0.5,60,150\n",
        "comment sign",
    ),
    "values beyond belief": (
        HEADER + BODY + 8 * "9,1e200,60,150\n",
        r"line 32, column 'Torque': impossible torque.*21% of torque 'Torque' is impossible \(8 of 38",
    ),
    "two readings of the same column": (HEADER + BODY, "cannot be both"),
}


@pytest.mark.parametrize("case", MISREAD)
def test_nothing_is_misread_in_silence(case: str, tmp_path: Path) -> None:
    text, says = MISREAD[case]
    path = tmp_path / "log.csv"
    path.write_text(text)
    channels = {"torque": "Speed"} if says == "cannot be both" else {}
    units = {"torque": "N*m"} if says == "cannot be both" else {}
    if says is None:
        assert hersey.read(path).rows == 30
    else:
        with pytest.raises(hersey.HerseyError, match=says.replace("'", ".")):
            hersey.read(path, channels=channels, units=units)


@pytest.mark.parametrize("mark", ["\x85", "\x0b", "\x0c", "\x1c", "\u2028", "\r"])
def test_odd_line_separators_do_not_shift_rows(mark: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes((f"# rig{mark}one\n" + HEADER + plain()).encode("utf-8"))
    assert_same(hersey.read(path))


def test_a_file_that_stops_within_a_line_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text((HEADER + plain()).rstrip()[:-3])
    assert hersey.read(path).files[0].cut_off
    path.write_text(HEADER + plain())
    assert not hersey.read(path).files[0].cut_off


def test_set_points_are_not_measurements(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t [s],Torque [N*m],Speed set [rpm],Speed [rpm],Temp [degC]\n0,1,99,3,4\n1,1,99,3,4\n")
    assert hersey.read(path).runs[0].speed[0] == pytest.approx(3 * np.pi / 30)


def test_a_unit_may_come_from_the_user(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t [s],Torque,Speed [rpm],Temp [degC]\n0,50,3,4\n1,50,3,4\n")
    with pytest.raises(UnitError, match="column 'Torque' has no unit"):
        hersey.read(path)
    log = hersey.read(path, units={"torque": "9.84 mN*m / 100"})
    assert log.runs[0].torque[0] == pytest.approx(0.00492)
    assert log.files[0].channels[1].unit == "9.84 mN*m / 100"


def test_missing_numbers_are_refused_or_counted(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(HEADER + plain() + "0.3,NaN,60,150\n0.4,---,60,150\n0.5,1.0,60,150\n")
    with pytest.raises(hersey.HerseyError, match="line 5, column 'Torque'"):
        hersey.read(path)
    log = hersey.read(path, drop_missing=True)
    assert (log.rows, log.files[0].missing_rows) == (4, 2)


def test_many_files_are_runs_of_one_machine(tmp_path: Path) -> None:
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).write_text(f"# {name}\n" + HEADER + plain())
    log = hersey.read([tmp_path / "a.csv", tmp_path / "b.csv"])
    assert [run.name for run in log.runs] == ["a.csv", "b.csv"]
    assert log.rows == 6
    assert log.files[0].comments == ("a.csv",)
    with pytest.raises(hersey.HerseyError, match="each file once"):
        hersey.read([tmp_path / "a.csv", tmp_path / "a.csv"])


def clock(style: str) -> str:
    """The rows of the table with their times written in another way."""
    return "".join(
        f"{style.format(int(10 * float(row.split(',')[0])))},{row.partition(',')[2]}\n"
        for row in plain().split()
    )


QUIRKS = {
    "quoted decimal commas": HEADER
    + "".join(
        ",".join(f'"{cell}"' for cell in row.replace(".", ",").split(";")) + "\n"
        for row in plain(";").split()
    ),
    "thousands point": HEADER.replace(",", ";").replace("Torque [N.m]", "Torque [uN.m]")
    + "0,0;500.000,0;60,0;150,0\n0,1;625.000,0;61,5;151,25\n0,2;750.000;63,0;149,5\n",
    "repeated names": "Time [s],Torque [N.m],Speed [rpm],Temp [degC],Temp [V]\n"
    + plain().replace("\n", ",7\n"),
    "summary rows": HEADER + plain() + "Mean,0.6,61,150\nTest completed at 21:02:28\n",
    "summary behind a blank line": HEADER + plain() + "\nMax,0.75,63,151\n",
    "nan spellings elsewhere": HEADER.replace("\n", ",Load [N]\n") + "0.0,0.5,60,150,1.#QNAN\n"
    "0.1,0.625,61.5,151.25,OVERLOAD\n0.2,0.75,63,149.5,-nan(ind)\n",
    "ISO time": HEADER.replace("Time [s]", "Timestamp") + clock("2024-03-01T23:59:59.{0}00"),
    "ISO time with a blank and a zone": HEADER.replace("Time [s]", "Time")
    + clock("2024/03/01 23:59:59.{0}+01:00"),
    "German time": HEADER.replace("Time [s]", "Zeit") + clock("01.03.2024 23:59:59.{0}"),
    "time of day": HEADER.replace("Time [s]", "Time [hh:mm:ss]") + clock("8:00:00.{0}"),
    "seconds since 1970": HEADER.replace("Time [s]", "t") + clock("1709330000.{0}"),
    "milliseconds since 1970": HEADER.replace("Time [s]", "timestamp") + clock("1709330000{0}00"),
    "days of Excel": HEADER.replace("Time [s]", "Date time")
    + "45352.0,0.5,60,150\n45352.000001157407,0.625,61.5,151.25\n45352.000002314815,0.75,63.0,149.5\n",
    "no-break blanks as thousands mark": HEADER.replace(",", ";").replace("rpm", "1e-3 rpm")
    + "0,0;0,5;60\u00a0000;150\n0,1;0,625;61\u00a0500;151,25\n0,2;0,75;63\u202f000;149,5\n",
    "thousands commas": HEADER.replace("rpm", "1e-3 rpm")
    + '0.0,0.5,"60,000.0",150\n0.1,0.625,"61,500.0",151.25\n0.2,0.75,"63,000.0",149.5\n',
}


@pytest.mark.parametrize(
    ("encoding", "size"), [("utf-8", 1 << 25), ("utf-8", 100), ("utf-16", 100), ("utf-16-le", 100)]
)
@pytest.mark.parametrize("quirk", QUIRKS)
def test_quirk(quirk: str, encoding: str, size: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "BLOCK", size)
    path = tmp_path / "log.csv"
    path.write_bytes(QUIRKS[quirk].encode(encoding))
    log = hersey.read(path)
    (run,), (file,) = log.runs, log.files
    assert_same(hersey.TorqueLog((replace(run, time=np.round(run.time - run.time[0], 5)),), log.files))
    kinds = {
        "summary": "lines below the table",
        "time": "time stamps read",
        "since": "clock without unit",
        "Excel": "clock without unit",
    }
    for word, kind in kinds.items():
        if word in quirk.split():
            assert kind in [warning.kind for warning in file.warnings]


def test_a_time_of_day_passes_midnight(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        HEADER.replace("Time [s]", "Time") + "23:59:59.5,1,60,150\n23:59:59.9,1,60,150\n00:00:00.3,1,60,150\n"
    )
    log = hersey.read(path)
    np.testing.assert_allclose(log.runs[0].time, [0, 0.4, 0.8], atol=1e-9)
    (warning,) = log.files[0].warnings
    assert (warning.kind, warning.values["midnights"]) == ("time stamps read", 1)
    assert str(warning).endswith("since 23:59:59, with 1 change of day")


@pytest.mark.parametrize("code", ["cp1252", "latin-1"])
def test_western_encodings(code: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(("# Prüfstand 10 µm\n" + HEADER.replace("degC", "°C") + plain()).encode(code))
    log = hersey.read(path)
    assert_same(log)
    assert log.files[0].comments == ("Prüfstand 10 µm",)


def test_a_repeated_name_is_chosen_by_its_place(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t [s],Torque [N*m],Speed [rpm],Temp [degC],Torque [N*m]\n0,1,3,4,7\n1,1,3,4,8\n")
    with pytest.raises(ChannelError, match="'Torque#1' or 'Torque#2'"):
        hersey.read(path)
    assert list(hersey.read(path, channels={"torque": "Torque#2"}).runs[0].torque) == [7, 8]
    with pytest.raises(ChannelError, match="no column 'Torque#3'"):
        hersey.read(path, channels={"torque": "Torque#3"})
    assert [name for name, _ in hersey.log.list_channels(path)] == [
        "t",
        "Torque#1",
        "Speed",
        "Temp",
        "Torque#2",
    ]


def test_a_stopwatch_is_not_taken_for_excel(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("Time,Torque [N*m],Speed [rpm],Temp [degC]\n45352,1,3,4\n45353,1,3,4\n")
    with pytest.raises(UnitError, match="'Time' has no unit"):
        hersey.read(path)


@pytest.mark.parametrize("last", ["0.3,0.5,60", "0.3,0.5,60,", "0.3,0.5,60,-", "0."])
def test_a_last_row_cut_off_is_left_out(last: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(HEADER + plain() + last)
    log = hersey.read(path)
    np.testing.assert_allclose(log.runs[0].time, [0, 0.1, 0.2])
    assert log.files[0].cut_off
    (warning,) = log.files[0].warnings
    assert (warning.kind, warning.values) == ("last line cut off", {"line": last})
    assert str(warning) == f"the last line, '{last}', was cut off and was skipped"


def test_a_number_that_reads_in_two_ways_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        HEADER.replace(",", ";") + "0,0;0,5;60,5;150,5\n0,1;0,5;1.299;150,5\n0,2;0,5;60,5;150,5\n"
    )
    with pytest.raises(hersey.HerseyError, match=r"line 3, column 'Speed': '1\.299' is not a number"):
        hersey.read(path)


def damaged(path: Path, cell: str, rows: tuple[int, ...], of: int = 1000) -> Path:
    lines = [f"{i / 10:.1f},0.5{i % 7},60.{i % 3},150\n" for i in range(of)]
    for row in rows:
        lines[row] = f"{row / 10:.1f},{cell},60.0,150\n"
    path.write_text(HEADER + "".join(lines))
    return path


@pytest.mark.parametrize(
    ("cell", "fault"),
    [
        ("err", "column 'Torque': 'err' is not a number"),
        ('"0,52"', "column 'Torque': '0,52' is not a number"),
        ("0,52", "5 cells, but the header has 4"),
    ],
)
def test_cells_that_are_no_numbers_cost_their_rows_alone(cell: str, fault: str, tmp_path: Path) -> None:
    rows = tuple(range(100, 120))
    log = hersey.read(damaged(tmp_path / "log.csv", cell, rows))
    assert log.rows == 980
    (warning,) = log.files[0].warnings
    between = ": " if fault.startswith("5") else ", "
    faults = [f"line {row + 2}{between}{fault}" for row in rows[:10]]
    assert warning.values == {"rows": 20, "faults": "; ".join(faults), "others": 10, "dates": ""}
    assert np.setdiff1d(np.arange(1000), np.round(10 * log.runs[0].time)).tolist() == list(rows)
    many = damaged(tmp_path / "many.csv", cell, tuple(range(100, 121)))
    with pytest.raises(UnreadableLogError, match=r"line 102.*the first of 21 such rows, of 1000") as refused:
        hersey.read(many)
    assert "drop_missing=True" in refused.value.remedy
    assert hersey.read(many, drop_missing=True).rows == 979


def test_damage_in_one_file_stops_none_of_many(tmp_path: Path) -> None:
    logs = [damaged(tmp_path / f"{i}.csv", "-.-" if i == 3 else f"0.{60 + i}", (500,)) for i in range(5)]
    log = hersey.read(logs)
    assert [file.rows for file in log.files] == [1000, 1000, 1000, 999, 1000]
    assert [len(file.warnings) for file in log.files] == [0, 0, 0, 1, 0]


def test_the_hash_is_of_all_bytes_also_of_what_follows_the_table(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(HEADER + BODY + "Mean,0.6,61,150\nTest completed at 21:02:28\n")
    (file,) = hersey.read(path).files
    assert file.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.mark.parametrize(
    "setpoint", ["Speed set", "Speed cmd", "Speed target", "Drehzahl Soll", "nominal speed"]
)
def test_a_set_point_is_not_taken_for_what_was_measured(setpoint: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        f"t [s],Torque [N*m],{setpoint} [rpm],Speed [rpm],Temp [degC]\n"
        + "".join(f"{i / 10},0.3,99,60,150\n" for i in range(30))
    )
    log = hersey.read(path)
    assert log.runs[0].speed == pytest.approx(60 * np.pi / 30)


def test_a_header_and_a_row_of_units_that_differ_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = "".join(f"{i / 10},0.3,60,150\n" for i in range(30))
    path.write_text("Time [s],Torque [N*m],Speed [rpm],Temp [degC]\ns,mN*m,rpm,degC\n" + rows)
    with pytest.raises(
        UnreadableLogError, match=r"line 1, column 2: the header says 'Torque \[N\*m\]', but .* mN\*m"
    ):
        hersey.read(path)
    path.write_text("Time [s],Torque [N*m],Speed [rpm],Temp [degC]\ns,Nm,1/min,degC\n" + rows)
    assert hersey.read(path).runs[0].torque == pytest.approx(0.3)


def test_a_set_point_beside_another_column_of_its_unit_is_asked_about(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        "t [s],Torque Command [N*m],Speed [rpm],Temp [degC],Trq Fbk [N*m]\n"
        + "".join(f"{i / 10},0.5,60,150,0.3\n" for i in range(30))
    )
    with pytest.raises(ChannelError, match=r"torque column could be 'Torque Command \[N\*m\]' or 'Trq Fbk"):
        hersey.read(path)
    assert hersey.read(path, channels={"torque": "Trq Fbk"}).runs[0].torque == pytest.approx(0.3)
