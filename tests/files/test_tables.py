"""Tables as files: no text of the user is a formula for a spreadsheet, and all of it comes back as it was."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hersey.files.tables import as_cell, table, text_of
from hersey.life.campaign import read_runs
from tests.cli.command import run
from tests.conftest import ROOT
from tests.life.test_campaign import means

#: Text, and the cell that it is to be, by OWASP's page on CSV injection.
CELLS = {
    "=1+1": "'=1+1",
    "+cmd|' /C calc'!A0": "'+cmd|' /C calc'!A0",
    "-2+3": "'-2+3",
    "@SUM(1)": "'@SUM(1)",
    "\tx": "'\tx",
    "\rx": "'\rx",
    '"=1+1"': '\'"=1+1"',
    "  =1+1": "'  =1+1",
    "'=1+1": "''=1+1",
    "\uff1d1+1": "'\uff1d1+1",
    "F12;=1+1": "F12;'=1+1",
    "F12\t=1+1": "F12\t'=1+1",
    "-5 degC": "'-5 degC",
    "-1.5": "-1.5",
    "+1e-3": "+1e-3",
    "F12": "F12",
    "a=b, c - d": "a=b, c - d",
    "'quoted'": "'quoted'",
    "": "",
}


@pytest.mark.parametrize("text", CELLS)
def test_a_text_is_no_formula_and_comes_back(text: str) -> None:
    assert as_cell(text) == CELLS[text]
    assert text_of(CELLS[text]) == text


@given(st.text(alphabet="=+-@\t\r\n;'\" a1.\uff1d"))
def test_any_text_comes_back(text: str) -> None:
    assert text_of(as_cell(text)) == text


@given(st.text(alphabet="=+-@\t\r\n;'\" a1."))
def test_no_cell_begins_a_formula_wherever_a_spreadsheet_splits(text: str) -> None:
    cell = as_cell(text)
    if re.fullmatch(r"[+-]?[0-9.]*", text):
        return
    for part in re.split("[;\t\r\n]", cell):
        assert not part.strip('" ').startswith(("=", "+", "-", "@"))


def test_numbers_and_headings_of_a_table() -> None:
    frame = pl.DataFrame({"=unit": ["-F1", "F2", None], "age": [-1.5, 2.0, None], "n": [-1, 2, 3]})
    rows = list(csv.reader(io.StringIO(table(frame, ".csv").decode())))
    assert rows == [["'=unit", "age", "n"], ["'-F1", "-1.5", "-1"], ["F2", "2.0", "2"], ["", "", "3"]]
    assert pl.read_parquet(io.BytesIO(table(frame, ".parquet"))).equals(frame)


def test_categories_are_texts() -> None:
    frame = pl.DataFrame({"kind": pl.Series(["=a", "b"], dtype=pl.Categorical)})
    assert table(frame, ".csv") == b"kind\n'=a\nb\n"


def test_names_of_a_campaign_come_back(tmp_path: Path) -> None:
    """A specimen and a log with the names of formulas: out as texts, and in again as they were."""
    log, unit = "=HYPERLINK(1).csv", '=cmd|"/C calc"!A0'
    means(tmp_path / log)
    typed = ("campaign", "add", "life.hersey", log, "--unit", unit, "--age", "1000 pages")
    assert run(*typed, cwd=tmp_path).returncode == 0
    assert run("campaign", "export", "life.hersey", "--out", "d.csv", cwd=tmp_path).returncode == 0
    with (tmp_path / "d.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["unit"] for row in rows} == {f"'{unit}"}
    assert all(float(row["torque (N m)"]) > 0 for row in rows)
    assert {(run.unit, run.age.value) for run in read_runs(tmp_path / "d.csv").runs} == {(unit, 1000.0)}
    assert run("fit", log, "--each", "f.csv", cwd=tmp_path).returncode == 0
    assert pl.read_csv(tmp_path / "f.csv")["log"].to_list() == [f"'{log}"]


def test_every_table_is_written_in_one_place() -> None:
    """Logs of the test stand, whose cells are numbers, are all that is written elsewhere."""
    files = (ROOT / "python" / "hersey").rglob("*.py")
    writers = {
        path.parent.name
        for path in files
        if re.search(r"\.write_csv\(|csv\.writer|DictWriter", path.read_text())
    }
    assert writers == {"files", "testbench"}
