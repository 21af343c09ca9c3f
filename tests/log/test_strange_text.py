"""Text that no logger writes: digits of other scripts, half characters, open quotes, files that change."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import HerseyError, MissingFileError, ParameterError, UnreadableLogError
from hersey.files.toml import read_toml
from hersey.inspection import inspect
from hersey.inspection.raw import raw_channels
from hersey.log.mapping import find_mapping, read_mapping
from hersey.log.text import blocks
from hersey.log.text.delimited import open_delimited
from hersey.log.text.footer import end_of_table
from hersey.log.text.layout import find_layout
from hersey.log.text.numbers import NumberStyle, looks_numeric
from hersey.log.text.stamps import is_stamp

HEADER = "Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n"
ROWS = "".join(f"{i},1.5,{30 + i},150\n" for i in range(40))
TEXT = HEADER + ROWS


@pytest.mark.parametrize("digits", ["\u0663", "\uff11\uff12", "\u0967", "²", "Ⅳ", "½", "\U0001d7d9"])
def test_digits_of_other_scripts_are_no_numbers(digits: str, tmp_path: Path) -> None:
    assert not looks_numeric(digits)
    assert not any(style.is_number(digits) for style in (NumberStyle(), NumberStyle(True, " ")))
    assert NumberStyle().values(pl.Series([digits])) is None
    assert not is_stamp(f"12:00:0{digits}")
    log = tmp_path / "log.csv"
    log.write_text(HEADER + ROWS + f"40,{digits},30,150\n41,1,1,150\n", encoding="utf-8")
    (warning,) = hersey.read(log).files[0].warnings
    assert (warning.kind, warning.values["rows"]) == ("rows left out", 1)
    assert "line 42, column 'Torque'" in str(warning)
    assert "is not a number" in str(warning)
    assert raw_channels(log).channels[1].odd == 1


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("half", [0xD83D, 0xDC00])
@pytest.mark.parametrize("around", ["{}", "1{}", "{}\n", "{}, \n\n"])
def test_half_a_character_at_the_end_of_utf_16(around: str, half: int, encoding: str, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    text = "\ufeff" + TEXT + around.format(chr(half))
    log.write_bytes(text.encode(encoding, errors="surrogatepass"))
    assert inspect(log).files[0].rows >= 40
    if around in ("{}", "1{}"):
        assert hersey.read(log).rows == 40
        return
    read = hersey.read(log)
    assert read.rows == 40
    assert any("line 42" in str(warning) for warning in read.files[0].warnings)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("below", ["max,1,2,3\n", "41,1.", "max;µ\nmin;µ\n41", ""])
def test_the_table_ends_at_the_same_line_in_every_encoding(below: str, encoding: str, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_bytes((TEXT + below).encode(encoding))
    with log.open("rb") as file:
        end = end_of_table(file, log.stat().st_size, find_layout(log.read_bytes(), log.name))
    kept = log.read_bytes()[: end.byte].decode(encoding)
    assert kept == TEXT + (below if below == "" or end.byte == log.stat().st_size else "")


@pytest.mark.parametrize("cell", ['"', '"a', '"1.5', 'x"y', '""', '"""'])
def test_a_quote_without_its_end_is_looked_at(cell: str, tmp_path: Path) -> None:
    """Polars refuses it, or takes in the lines below as far as another quote: neither loses a row."""
    log = tmp_path / "log.csv"
    notes = {9: cell, 20: 'a"'}
    rows = [f"{notes.get(i, 'a')},{row}\n" for i, row in enumerate(ROWS.splitlines())]
    log.write_text("Note," + HEADER + "".join(rows))
    (file,) = inspect(log).files
    assert file.rows == 40
    assert [c.traits.high for c in file.channels if c.role == "time"] == [39.0]


INTEGERS = ["1" * 5000, "0x" + "f" * 5000, "-" + "9" * 20]


@pytest.mark.parametrize("integer", INTEGERS)
@pytest.mark.parametrize("key", ["torque.sign", "torque.channel", "torque.gear_ratio", "torque.tare", "x.y"])
def test_integers_of_toml_have_64_bits(integer: str, key: str, tmp_path: Path) -> None:
    file = tmp_path / "hersey.toml"
    file.write_text(f"{key} = {integer}\n")
    with pytest.raises(ParameterError, match=r"hersey\.toml is not valid TOML") as raised:
        read_mapping(file)
    assert len(str(raised.value)) < 200


@pytest.mark.parametrize(
    ("document", "told"),
    [
        ("x = " + "[" * 30 + "]" * 30, "more than 20 levels of nested tables or lists"),
        (f'x = "{"a" * 1001}"', "a text of 1001 characters; at most 1000"),
        ("a" + ".a" * 21 + " = 1", "a key has more than 20 dots"),
        ("#" * 4_000_001, "larger than 4000000 bytes"),
    ],
)
def test_documents_have_limits(document: str, told: str, tmp_path: Path) -> None:
    (tmp_path / "x.toml").write_text(document)
    with pytest.raises(ParameterError, match=told):
        read_toml(tmp_path / "x.toml")


def test_numbers_with_many_dots_and_texts_of_lines_are_no_keys(tmp_path: Path) -> None:
    document = {"x": [0.1] * 40, "y": "a." * 40, "z": "\n" + "b.c." * 40, "w": '"""'}
    lines = [f"x = {[0.1] * 40}", f'y = "{document["y"]}"', f"z = '''\n{document['z']}'''  # {'d.' * 40}"]
    (tmp_path / "x.toml").write_text("\n".join([*lines, 'w = \'"""\'']) + "\n")
    assert read_toml(tmp_path / "x.toml") == document


def test_a_log_with_a_long_name_has_no_mapping(tmp_path: Path) -> None:
    assert find_mapping(tmp_path / ("é" * 125 + ".csv")) is None
    (tmp_path / "hersey.toml").write_text("")
    assert find_mapping(tmp_path / ("é" * 125 + ".csv")) == tmp_path / "hersey.toml"


def rewritten(log: Path) -> None:
    log.write_text(TEXT.replace("1.5", "2.5"))
    os.utime(log, ns=(1, 1))


def replaced(log: Path) -> None:
    other = log.with_name("other.csv")
    other.write_text(TEXT)
    other.replace(log)


def appended(log: Path) -> None:
    with log.open("a") as file:
        file.write("40,1.5,70,150\n41,1.")


def read_while(log: Path, happens: Callable[[Path], object]) -> hersey.TorqueLog:
    """Read a log that changes when the first block has been read."""
    done: list[int] = []

    def once(bytes_done: int, _size: int) -> None:
        if not done:
            happens(log)
        done.append(bytes_done)

    log.write_text(TEXT)
    return hersey.read(log, progress=once)


@pytest.mark.parametrize("block", [64, 1 << 22])
@pytest.mark.parametrize(
    "happens",
    [rewritten, replaced, Path.unlink, lambda log: os.truncate(log, 200), lambda log: os.truncate(log, 0)],
)
def test_a_log_that_changes_is_refused(
    happens: Callable[[Path], object], block: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blocks, "BLOCK", block)
    with pytest.raises(UnreadableLogError, match=r"log\.csv changed while it was read"):
        read_while(tmp_path / "log.csv", happens)


@pytest.mark.parametrize("block", [64, 1 << 22])
def test_a_log_that_grows_is_read_as_it_was(
    block: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blocks, "BLOCK", block)
    log = read_while(tmp_path / "log.csv", appended)
    (file,) = log.files
    assert log.rows == 40
    assert file.bytes == len(TEXT)
    assert file.sha256 == hashlib.sha256(TEXT.encode()).hexdigest()
    (grown,) = [each for each in file.warnings if each.kind == "file grew while it was read"]
    assert grown.values == {"before": len(TEXT), "after": len(TEXT) + 19}


def test_a_table_is_opened_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = tmp_path / "log.csv"
    log.write_text(TEXT)
    opened, usual = [], Path.open
    monkeypatch.setattr(Path, "open", lambda path, *mode: opened.append(path) or usual(path, *mode))
    with open_delimited(log) as file:
        columns = file.layout.columns
        time, torque = file.numbers(columns[:2], complete=True)
        (speed,) = file.numbers(columns[2:3], complete=False)
    np.testing.assert_array_equal(time, np.arange(40.0))
    np.testing.assert_array_equal(torque, 1.5)
    np.testing.assert_array_equal(speed, 30 + np.arange(40.0))
    assert opened == [log]


def test_a_table_that_is_written_anew_between_two_looks_is_refused(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_text(TEXT)
    with open_delimited(log) as file:
        rewritten(log)
        with pytest.raises(HerseyError, match="changed while it was read"):
            file.numbers(file.layout.columns[:2], complete=True)


def test_a_file_that_is_not_there() -> None:
    with pytest.raises(MissingFileError, match="File not found"), open_delimited(Path("none.csv")):
        pass


@pytest.mark.parametrize(
    ("separator", "number"),
    [
        (";", "{:,.2f}"),
        (";", "{:_.2f}"),  # 1.234,50
        (",", '"{:,.2f}"'),
    ],
)
def test_thousands_marks_that_begin_far_down_the_file(separator: str, number: str, tmp_path: Path) -> None:
    """Behind what is looked at for the style of a file."""

    def written(value: float, form: str) -> str:
        text = form.format(value)
        return text.replace(".", ",").replace("_", ".") if "_" in form else text

    times = np.arange(24_000) * 0.05
    rest = "0,5" if "_" in number else "0.5"
    plain = number if "_" in number else "{:.2f}"
    lines = [
        separator.join((written(t, number if t >= 1000 else plain), rest, str(60 + i % 2), rest))
        for i, t in enumerate(times)
    ]
    path = tmp_path / "log.csv"
    head = separator.join(("Time [s]", "Torque [N*m]", "Speed [rpm]", "Temp [degC]"))
    path.write_text("\n".join([head, *lines]))
    np.testing.assert_allclose(hersey.read(path).runs[0].time, times)


def test_a_mark_that_could_be_either_names_the_way_out(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(TEXT + '40,1.5,"1,000",150\n')
    with pytest.raises(UnreadableLogError, match="line 42, column 'Speed': '1,000'") as refused:
        hersey.read(path)
    assert "thousands" in refused.value.remedy


def test_rows_in_the_order_of_another_column_are_to_be_sorted(tmp_path: Path) -> None:
    rows = sorted(((i, 20 * (i // 25 % 4)) for i in range(400)), key=lambda row: row[1])
    path = tmp_path / "log.csv"
    path.write_text(HEADER + "".join(f"{i},1.5,{30 + speed},150\n" for i, speed in rows))
    with pytest.raises(UnreadableLogError) as refused:
        hersey.read(path)
    assert refused.value.remedy.startswith("sort the rows by 'Time'")


@pytest.mark.parametrize(
    "header", ["Time [ms],Speed [rpm],Torque [mN*m]", "Time [ms],Speed [rpm],Torque [mN*m],"]
)
def test_decimal_commas_between_commas_are_called_so(header: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(f"{header}\n" + "".join(f"{5 * i},60,203,{i % 10}\n" for i in range(40)))
    with pytest.raises(UnreadableLogError) as refused:
        hersey.read(path, isothermal=True)
    assert str(refused.value) == (
        "log.csv, line 1: the header has 3 cells, but the rows have 4. Commas separate the columns, and "
        "some seem to be decimal commas, as in '100,60,203,0'. Export with ';' between the columns (or "
        "tabs), or with decimal points. Only if the further cells are channels of their own, give every "
        "column a name"
    )


def test_a_decimal_comma_in_a_few_rows_is_called_so(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{5 * i},60,203" + ",5" * (i == 30) for i in range(40)]
    path.write_text("\n".join(["Time [ms],Speed [rpm],Torque [mN*m]", *rows]))
    with pytest.raises(UnreadableLogError, match="line 32: 4 cells, but the header has 3") as refused:
        hersey.read(path, isothermal=True)
    assert "decimal commas, as in '150,60,203,5'" in refused.value.remedy


@pytest.mark.parametrize("row", ["{},60,203.5,1", "{},-60,203,-1", "{},60,203,"])
def test_a_column_without_a_name_is_no_decimal_comma(row: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        "Time [ms],Speed [rpm],Torque [mN*m],\n" + "".join(f"{row.format(0.5 * i)}\n" for i in range(40))
    )
    assert hersey.read(path, isothermal=True).rows == 40
