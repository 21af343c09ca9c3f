"""A header that stands again among the rows: with other units or in another order it is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import UnreadableLogError
from hersey.identification.trace_file import read_trace
from tests.untrusted_input.other_blocks import xlsx

ROWS = 40


def rows(start: int, torque: float) -> list[str]:
    return [f"{(start + i) / 10:.1f},{torque:g},{60 + i % 3}" for i in range(ROWS)]


def table(again: list[str], head: str = "Time [s],Torque [mN*m],Speed [rpm]") -> str:
    return "\n".join([head, *rows(0, 1500.0), *again, *rows(ROWS, 1500.0), ""])


def written(folder: Path, text: str) -> Path:
    path = folder / "a.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("again", "line"),
    [
        (["Time [s],Torque [N*m],Speed [rpm]"], 42),
        (["Time [s],Torque (N*m),Speed (rpm)"], 42),
        (["Time,Torque,Speed", "s,N*m,rpm"], 43),
    ],
)
def test_another_unit_is_refused_with_line_column_and_both_units(
    again: list[str], line: int, tmp_path: Path
) -> None:
    path = written(tmp_path, table(again))
    message = rf"a\.csv, line {line}, column 'Torque': from here on the unit is N\*m; above it is mN\*m"
    with pytest.raises(UnreadableLogError, match=message):
        hersey.read(path, isothermal=True)
    with pytest.raises(UnreadableLogError, match=message):
        hersey.read(path, isothermal=True, drop_missing=True)
    with pytest.raises(UnreadableLogError, match="line 42"):
        read_trace(path, quantity="torque")


def test_a_row_of_units_above_the_table_counts_too(tmp_path: Path) -> None:
    head = "Time,Torque,Speed\ns,mN*m,rpm"
    path = written(tmp_path, table(["Time,Torque,Speed", "s,N*m,rpm"], head))
    with pytest.raises(UnreadableLogError, match=r"line 44, column 'Torque': from here on the unit is N\*m"):
        hersey.read(path, isothermal=True)


def test_columns_in_another_order_are_refused(tmp_path: Path) -> None:
    path = written(tmp_path, table(["Time [s],Speed [rpm],Torque [mN*m]"]))
    with pytest.raises(
        UnreadableLogError, match=r"line 42, column 'Torque': .* this column is now called 'Speed'"
    ):
        hersey.read(path, isothermal=True)


@pytest.mark.parametrize(
    "again", [["Time [s],Torque [mN*m],Speed [rpm]"], ["Time,Torque,Speed", "s,mNm,1/min"]]
)
def test_the_same_header_again_costs_its_rows_alone(again: list[str], tmp_path: Path) -> None:
    log = hersey.read(written(tmp_path, table(again)), isothermal=True, drop_missing=True)
    assert (log.rows, log.files[0].missing_rows) == (2 * ROWS, len(again))
    np.testing.assert_allclose(log.runs[0].torque, 1.5)


def test_a_unit_of_a_column_that_is_not_used_may_change(tmp_path: Path) -> None:
    lines = [f"{line},1" for line in rows(0, 1500.0)], [f"{line},1" for line in rows(ROWS, 1500.0)]
    head = "Time [s],Torque [mN*m],Speed [rpm],Wear"
    path = written(tmp_path, "\n".join([f"{head} [um]", *lines[0], f"{head} [mm]", *lines[1], ""]))
    assert hersey.read(path, isothermal=True).rows == 2 * ROWS


def test_a_table_of_means_too(tmp_path: Path) -> None:
    text = "Speed [rpm],Torque [mN*m]\n5,450\n10,500\n20,550\nSpeed [rpm],Torque [N*m]\n40,0.6\n80,0.65\n"
    with pytest.raises(
        UnreadableLogError, match=r"a\.csv, row 4, column 'Torque': from here on the unit is N\*m"
    ):
        hersey.SteadyPoints.from_table(written(tmp_path, text))


def test_a_sheet_too(tmp_path: Path) -> None:
    pytest.importorskip("fastexcel")
    part = [[i / 10, 1500.0, 60.0 + i % 3] for i in range(ROWS)]
    heads = [["Time [s]", f"Torque [{unit}]", "Speed [rpm]"] for unit in ("mN*m", "N*m")]
    (tmp_path / "a.xlsx").write_bytes(xlsx({"Run": [heads[0], *part, heads[1], *part]}))
    with pytest.raises(UnreadableLogError, match=r"row 42, column 'Torque': from here on the unit is N\*m"):
        hersey.read(tmp_path / "a.xlsx", isothermal=True)
