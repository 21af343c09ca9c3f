"""Tables as spreadsheets and panels leave them: headers of two lines, channels in rows, one row per value."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError, HerseyError, UnreadableLogError
from hersey.inspection import inspect
from hersey.inspection.raw import raw_channels
from hersey.log import list_channels
from hersey.log.text.layout import SNIFFED, find_layout
from tests.conftest import ROOT
from tests.untrusted_input.other_blocks import xlsx

HEAD = ["Time [s]", "Torque [N*m]", "Speed [rpm]", "Temp [degC]"]
NUMBERS = [[f"{i / 10:.1f}", f"{1 + i / 100:g}", f"{60 + i}", "150"] for i in range(60)]
ROWS = "\n".join(map(",".join, NUMBERS))


def written(folder: Path, text: str, name: str = "a.csv") -> Path:
    path = folder / name
    path.write_bytes(text.encode())
    return path


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("above", ["", '# a rig of 5"\n', 'Bore,5"\n\n'])
def test_a_header_cell_may_hold_line_ends(above: str, end: str, tmp_path: Path) -> None:
    head = ",".join('"' + cell.replace(" ", "\n") + '"' for cell in HEAD)
    text = f"{above}{head}\n{ROWS}\n".replace("\n", end).replace(f"{end}[", "\n[")
    wrapped, plain = written(tmp_path, text), written(tmp_path, f"{','.join(HEAD)}\n{ROWS}\n", "b.csv")
    assert list_channels(wrapped) == list_channels(plain)
    (run,), (other,) = hersey.read(wrapped).runs, hersey.read(plain).runs
    for name in ("time", "torque", "speed", "temperature"):
        np.testing.assert_array_equal(getattr(run, name), getattr(other, name))
    assert raw_channels(wrapped).channels[0].values.size == len(NUMBERS)
    broken = text.replace("\n1.0,", "\n1.0,,") if end == "\n" else text.replace(f"{end}1.0,", f"{end}1.0,,")
    line = above.count("\n") + 5 + 11
    (left_out,) = hersey.read(written(tmp_path, broken, "c.csv")).files[0].warnings
    assert left_out.values["faults"] == f"line {line}: 5 cells, but the header has 4"


def test_a_quote_that_never_ends_joins_no_lines(tmp_path: Path) -> None:
    path = written(tmp_path, f'"Rig 5,a\n{",".join(HEAD)}\n{ROWS}\n')
    assert [name for name, _ in list_channels(path)] == ["Time", "Torque", "Speed", "Temp"]


def transposed(separator: str = ",", rows: list[list[str]] = NUMBERS) -> str:
    return "\n".join(
        separator.join([n, *cells]) for n, cells in zip(HEAD, zip(*rows, strict=True), strict=True)
    )


@pytest.mark.parametrize("title", ["", "Rig 3\n"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_channels_in_rows_are_refused(title: str, separator: str, tmp_path: Path) -> None:
    path = written(tmp_path, title + transposed(separator) + "\n")
    for call in (hersey.read, list_channels, raw_channels):
        with pytest.raises(UnreadableLogError, match=r"channels stand in rows.*Time \[s\], Torque") as caught:
            call(path)
        assert "Transpose" in caught.value.remedy


@pytest.mark.parametrize("rows", [2_000, 6_000, 40_000])
def test_channels_in_very_long_rows_are_refused_too(rows: int, tmp_path: Path) -> None:
    numbers = [[f"{i / 10:.1f}", f"{i}", "60", "150"] for i in range(rows)]
    text = transposed(rows=numbers)
    assert (text.index("\n") > SNIFFED) == (rows == 40_000)
    with pytest.raises(UnreadableLogError, match="channels stand in rows") as caught:
        hersey.read(written(tmp_path, text))
    assert ("Transpose" in caught.value.remedy) == (rows < 10_000)  # wider than Excel, or not known


def long_rows(names: list[str], every: int = 1) -> list[list[str]]:
    return [
        [name, f"01.03.2024 23:50:{i // every % 60:02d}", value.replace(".", ","), "1"]
        for i, row in enumerate(NUMBERS)
        for name, value in zip(names, row[1:], strict=False)
    ]


def long_table(names: list[str], head: str = "VarName;TimeString;VarValue;Validity", every: int = 1) -> str:
    return "\r\n".join([head, *map(";".join, long_rows(names, every=every)), ""])


@pytest.mark.parametrize("every", [1, 10])
@pytest.mark.parametrize(
    "names",
    [
        ["Torque_Nm", "Speed_rpm", "Temp_degC"],
        ["DB10.DBD0", "DB10.DBD4", "DB10.DBD8"],
        ["Drehmoment", "AI_2"],
    ],
)
def test_a_long_table_is_refused_with_its_channels(names: list[str], every: int, tmp_path: Path) -> None:
    path = written(tmp_path, long_table(names, every=every))
    for call in (hersey.read, list_channels, raw_channels):
        with pytest.raises(UnreadableLogError, match=r"column 'VarName' names the channel") as caught:
            call(path)
        assert all(name in caught.value.reason for name in names)
        assert all(f"'{column}'" in caught.value.remedy for column in ("TimeString", "VarName", "VarValue"))


def test_the_finest_clock_of_a_long_table_makes_its_rows(tmp_path: Path) -> None:
    rows = [
        f"{name};05.03.2024 08:00:{i // 5:02d};{i};{45356333333 + 2 * i}"
        for i in range(60)
        for name in ("Torque_Nm", "Speed_rpm", "Temp_degC")
    ]
    path = written(tmp_path, "\n".join(["VarName;TimeString;VarValue;Time_ms", *rows]))
    with pytest.raises(UnreadableLogError, match="'Time_ms' as rows"):
        hersey.read(path)


def test_names_may_end_with_their_units(tmp_path: Path) -> None:
    heads = ["t_ms", "torque_mNm", "speed_rpm", "heater_degC"]
    path = written(tmp_path, f"{','.join(heads)}\n{ROWS}\n")
    assert list_channels(path) == [("t", "ms"), ("torque", "mN*m"), ("speed", "rpm"), ("heater", "degC")]
    run = hersey.read(path).runs[0]
    assert run.torque[:2] == pytest.approx([1.00e-3, 1.01e-3])
    assert run.time[1] == pytest.approx(1e-4)
    named = hersey.read(path, channels={"torque": "torque_mNm", "time": "t_ms"}).runs[0]
    np.testing.assert_array_equal(named.torque, run.torque)


def test_a_unit_with_a_stroke_may_end_a_name(tmp_path: Path) -> None:
    path = written(tmp_path, f"t_s,torque_N*m,speed_rad/s,temp_degC\n{ROWS}\n")
    assert list_channels(path)[1:3] == [("torque", "N*m"), ("speed", "rad/s")]


def test_names_that_differ_only_in_their_units_stay_whole(tmp_path: Path) -> None:
    path = written(tmp_path, f"t_s,M_Nm,n_rpm,temp_degC,temp_K\n{ROWS.replace(',150', ',150,423')}\n")
    assert list_channels(path)[3:] == [("temp_degC", "degC"), ("temp_K", "K")]


def test_a_row_of_units_goes_before_the_end_of_a_name(tmp_path: Path) -> None:
    path = written(tmp_path, f"Time,Torque,Speed,temp_C\ns,Nm,rpm,degF\n{ROWS}\n")
    assert list_channels(path)[3] == ("temp_C", "degF")


def test_milliseconds_of_an_uptime_stay_so(tmp_path: Path) -> None:
    rows = [f"{1200000000 + 100 * i},{1 + i % 7 / 100:g},60,150" for i in range(60)]
    path = written(tmp_path, "\n".join(["Time [ms],Torque [N*m],Speed [rpm],Temp [degC]", *rows, ""]))
    assert float(np.ptp(hersey.read(path).runs[0].time)) == pytest.approx(5.9)
    wincc = [f"{45356333333 + 2 * i},{1 + i % 7 / 100:g},60,150" for i in range(60)]
    path = written(tmp_path, "\n".join(["Time_ms,Torque [N*m],Speed [rpm],Temp [degC]", *wincc, ""]), "b.csv")
    assert float(np.ptp(hersey.read(path).runs[0].time)) == pytest.approx(59 * 2 * 0.0864)


@pytest.mark.parametrize("name", ["Time_ms", "Time [ms]", "time_ms"])
def test_the_clock_of_wincc_counts_days_in_frames_and_parquet_too(name: str, tmp_path: Path) -> None:
    steps = np.arange(60)
    others = {"Torque [N*m]": 1.0 + steps % 7 / 100, "Speed [rpm]": 60.0, "Temp [degC]": 150.0}
    for first, days in ((45356333333, name == "Time_ms"), (1200000000, False)):
        frame = pl.DataFrame({name: first + 2 * steps}).with_columns(**others)
        frame.write_parquet(tmp_path / "a.parquet")
        frame.write_csv(tmp_path / "a.csv")
        for source in (frame, tmp_path / "a.parquet", tmp_path / "a.csv"):
            log = hersey.read(source)
            assert float(np.ptp(log.runs[0].time)) == pytest.approx(
                118 * (0.0864 if days else 0.001), rel=1e-4
            )
            assert [each.kind for each in log.files[0].warnings] == ["clock without unit"] * days
            assert hersey.read(source, channels={"time": name}).rows == 60
        (clock,) = inspect(tmp_path / "a.parquet").files[0].clocks
        assert clock.duration == pytest.approx(118 * (0.0864 if days else 0.001), rel=1e-4)


def test_a_line_of_settings_may_stand_above_a_table(tmp_path: Path) -> None:
    path = written(tmp_path, f'{{"bench": "3", "rate": 100}}\n{",".join(HEAD)}\n{ROWS}\n')
    assert hersey.read(path).rows == len(NUMBERS)


@pytest.mark.parametrize("order", [(0, 1, 2), (0, 2, 1)])
def test_a_row_of_data_types_is_passed_over(order: tuple[int, ...], tmp_path: Path) -> None:
    above = ["Time;Torque;Speed;Temp", "ms;Nm;rpm;degC", "DINT;REAL;REAL;LREAL"]
    text = "\n".join([*(above[i] for i in order), ROWS.replace(",", ";"), ""])
    path = written(tmp_path, text)
    assert list_channels(path) == [("Time", "ms"), ("Torque", "Nm"), ("Speed", "rpm"), ("Temp", "degC")]
    assert hersey.read(path).rows == len(NUMBERS)


def test_units_in_the_cells_are_named(tmp_path: Path) -> None:
    rows = [f"{i / 10} s;0.2 Nm;{60 + i} rpm;150 °C" for i in range(40)]
    path = written(tmp_path, "\n".join(["Time;Torque;Speed;Temp", *rows, ""]))
    with pytest.raises(UnreadableLogError, match=r"line 41: .*'3\.9 s'\. Write .* 'Time \[s\]'"):
        hersey.read(path)


def test_a_clock_of_whole_minutes_asks_for_the_time_between_rows(tmp_path: Path) -> None:
    rows = [f"08:{i // 600:02d},{1 + i % 7 / 100:g},60,150" for i in range(3000)]
    path = written(tmp_path, "\n".join([",".join(["Time", *HEAD[1:]]), *rows, ""]))
    with pytest.raises(UnreadableLogError, match=r"each pair in 600 rows.* every=0\.1 if it shows hours and"):
        hersey.read(path)
    log = hersey.read(path, every=0.1)
    assert float(log.runs[0].time[-1]) == pytest.approx(299.9)
    (warning,) = [each for each in log.files[0].warnings if each.kind == "clock passed over"]
    assert "column 'Time' is not used: every sets the time between rows" in str(warning)


def test_minutes_and_seconds_of_a_fast_log_stay_so(tmp_path: Path) -> None:
    rows = [f"{i // 6000}:{i // 100 % 60:02d},{1 + i % 7 / 100:g},60,150" for i in range(3000)]
    path = written(tmp_path, "\n".join([",".join(["Time", *HEAD[1:]]), *rows, ""]))
    assert float(hersey.read(path).runs[0].time[-1]) == pytest.approx(29.0)


@pytest.mark.parametrize("symbol", ["v_s", "n_s", "mu_s", "F_N", "Weg_s", "I_C", "Thermo_K", "Phase_C"])
def test_the_index_of_a_symbol_is_no_unit(symbol: str, tmp_path: Path) -> None:
    path = written(tmp_path, f"Time [s],Torque [N*m],{symbol},Temp [degC]\n{ROWS}\n")
    assert list_channels(path)[2] == (symbol, "")


def test_a_long_table_sorted_by_channel_in_another_order_is_refused(tmp_path: Path) -> None:
    rows = sorted(long_rows(["Torque_Nm", "Speed_rpm", "Temp_degC"]))
    path = written(tmp_path, "\n".join(["Name;Zeit;Wert;Ok", *map(";".join, rows)]))
    with pytest.raises(UnreadableLogError, match=r"column 'Name' names the channel.*Torque_Nm"):
        hersey.read(path)


def test_a_long_table_of_more_words_than_numbers_is_refused(tmp_path: Path) -> None:
    rows = [f"{stamp};{name};{value};Good" for name, stamp, value, _ in long_rows(["FT-1", "ST-2", "TT-3"])]
    path = written(tmp_path, "\n".join(["Timestamp;Tag;Val;Quality", *rows]))
    with pytest.raises(UnreadableLogError, match=r"column 'Tag' names the channel.*FT-1, ST-2, TT-3"):
        hersey.read(path)


def test_sheets_of_a_workbook_that_are_turned_say_so(tmp_path: Path) -> None:
    pytest.importorskip("fastexcel")
    long = [["VarName", "TimeString", "VarValue", "Ok"], *long_rows(["Torque", "Speed", "Temp"])]
    turned = [list(row) for row in zip(*[HEAD, *NUMBERS[:24]], strict=True)]
    for rows, words in ((long, "long table"), (turned, "stand in rows")):
        path = tmp_path / "a.xlsx"
        path.write_bytes(xlsx({"Run": rows}))
        with pytest.raises(ChannelError, match=words):
            hersey.read(path)


@pytest.mark.parametrize(
    "words",
    [["up", "down"], ["torque ramp", "speed ramp"], ["ok"], ["Speed step", "Temperature step", "hold"]],
)
def test_words_beside_the_channels_of_a_log_are_no_long_table(words: list[str], tmp_path: Path) -> None:
    rows = [",".join([*row, words[i % len(words)]]) for i, row in enumerate(NUMBERS)]
    path = written(tmp_path, "\n".join([",".join([*HEAD, "Phase"]), *rows, ""]))
    assert hersey.read(path).rows == len(NUMBERS)


def test_words_of_a_table_without_torque_are_no_long_table(tmp_path: Path) -> None:
    rows = [f"{i / 10:.1f},{i},{('up', 'down')[i % 2]}" for i in range(80)]
    assert len(list_channels(written(tmp_path, "\n".join(["Time [s],Level,Way", *rows, ""])))) == 2


def test_wide_rows_below_a_header_are_not_transposed(tmp_path: Path) -> None:
    names = ["Run", *(f"c{i}" for i in range(30))]
    rows = [",".join([f"run{k}", *(f"{i + k}" for i in range(30))]) for k in range(8)]
    assert len(list_channels(written(tmp_path, "\n".join([",".join(names), *rows, ""])))) == 30


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.csv")), ids=lambda path: path.name)
def test_no_example_is_called_turned(path: Path) -> None:
    with path.open("rb") as file:
        find_layout(file.read(SNIFFED), path.name)


PAGE = "<html><body><table><tr><th>Time [s]</th><th>Torque [N*m]</th></tr></table></body></html>"


@pytest.mark.parametrize("head", ["", "\ufeff\n", "<!-- made by a panel -->\n", "<!DOCTYPE HTML>\n"])
@pytest.mark.parametrize(
    ("name", "kind", "ending"),
    [
        ("a.xls", "workbook", ""),
        ("a.csv", "table", ".html"),
        ("a.html", "table", ""),
        ("a.xlsx", "workbook", ".html"),
    ],
)
def test_a_web_page_is_called_so(head: str, name: str, kind: str, ending: str, tmp_path: Path) -> None:
    path = written(tmp_path, head + PAGE, name)
    for call in (hersey.read, list_channels, raw_channels):
        with pytest.raises(UnreadableLogError, match=rf"web page \(HTML\), not a {kind}") as caught:
            call(path)
        assert ("rename it" in caught.value.remedy) == bool(ending)
        assert ending in caught.value.remedy


def test_a_page_without_a_table_is_to_be_downloaded_again(tmp_path: Path) -> None:
    path = written(tmp_path, "<!DOCTYPE html><html><body><form>Login</form></body></html>")
    with pytest.raises(UnreadableLogError, match="without a table") as caught:
        hersey.read(path)
    assert "Excel" not in caught.value.remedy


def test_a_spreadsheet_in_xml_and_a_page_in_utf_16_are_called_so(tmp_path: Path) -> None:
    xml = '<?xml version="1.0"?>\n<?mso-application progid="Excel.Sheet"?>\n<Workbook/>'
    with pytest.raises(UnreadableLogError, match="an XML file, not a workbook"):
        hersey.read(written(tmp_path, xml, "a.xls"))
    path = tmp_path / "b.csv"
    path.write_text(PAGE, encoding="utf-16")
    with pytest.raises(UnreadableLogError, match="web page"):
        hersey.read(path)


@pytest.mark.parametrize(("separator", "encoding"), [("\t", "utf-16"), ("\t", "cp1252"), (";", "utf-8-sig")])
def test_text_called_a_workbook_is_read_as_text(separator: str, encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "a.xls"
    head = separator.join(HEAD).replace("degC", "\u00b0C")
    lines = [head, *map(separator.join, NUMBERS), ""]
    path.write_text("\n".join(lines), encoding=encoding)
    assert hersey.read(path).rows == len(NUMBERS)


def test_what_a_library_says_of_a_broken_workbook_is_one_line_without_codes(tmp_path: Path) -> None:
    pytest.importorskip("fastexcel")
    with pytest.raises(HerseyError) as caught:
        hersey.read(written(tmp_path, "\x01\x02 no workbook", "a.xls"))
    assert "\\n" not in str(caught.value)
    assert "Context" not in str(caught.value)
