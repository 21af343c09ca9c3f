"""Numbers that a spreadsheet has turned into dates: they are lost, and no way out leaves only them out."""

from __future__ import annotations

from pathlib import Path

import pytest

import hersey
from hersey.errors import UnreadableLogError
from hersey.inspection import inspect
from hersey.log.text.dated_numbers import is_date
from tests.untrusted_input.other_blocks import xlsx

HEADER = ["Time [s]", "Torque [N*m]", "Speed [rpm]", "Temperature [degC]"]
LOST = (
    "A spreadsheet has made dates of numbers in column 'Torque', and this file has lost these numbers. "
    "Export it again from the original file, with the column formatted as number"
)


def table(every: int, cell: str, *, others: bool = False) -> str:
    """A log with a date in place of the torque in every so-manieth row, or in all others."""
    dated = [(i % every != 0) == others for i in range(400)]
    rows = [f"{0.1 * i:.1f},{cell if lost else 5.3},60,150" for i, lost in enumerate(dated)]
    return "\n".join([",".join(HEADER), *rows]) + "\n"


@pytest.mark.parametrize("drop_missing", [False, True])
@pytest.mark.parametrize("others", [False, True])
@pytest.mark.parametrize(
    "cell", ["05. Jan", "5-Jan", "Jan 05", "05.01.2026", "1/5/2026", "03. Mrz", "5. Mai 26"]
)
def test_dates_among_numbers_are_called_so(
    cell: str, others: bool, drop_missing: bool, tmp_path: Path
) -> None:
    path = tmp_path / "log.csv"
    path.write_text(table(7, cell, others=others))
    with pytest.raises(UnreadableLogError, match=f"column 'Torque': '{cell}' is not a number") as refused:
        hersey.read(path, drop_missing=drop_missing)
    assert refused.value.remedy == LOST
    assert inspect(path).problem.endswith(LOST)


def test_few_of_them_are_warned_of(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(table(100, "05. Jan"))
    (warning,) = hersey.read(path).files[0].warnings
    assert warning.values["rows"] == 4
    assert LOST in warning.text


def test_cells_of_a_workbook_that_are_dates_are_called_so(tmp_path: Path) -> None:
    for every, others in ((7, False), (7, True)):
        dated = [(i % every != 0) == others for i in range(400)]
        rows = [[0.1 * i, (46027.0,) if lost else 5.3, 60.0, 150.0] for i, lost in enumerate(dated)]
        path = tmp_path / "log.xlsx"
        path.write_bytes(xlsx({"Run": [HEADER, *rows]}))
        with pytest.raises(UnreadableLogError, match="channel 'Torque', row") as refused:
            hersey.read(path, drop_missing=True)
        assert refused.value.remedy == LOST


def test_dates_of_a_clock_and_other_words_are_none(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"05.01.2026,{0.1 * i:.1f},{'err' if i % 7 == 0 else 5.3},60,150" for i in range(400)]
    path.write_text("\n".join([",".join(["Date", *HEADER]), *rows]))
    assert not any(is_date(cell) for cell in ("err", "5.1", "1.234.567", "12:00:05", "2026", "5 Nm", "may"))
    with pytest.raises(UnreadableLogError, match="'err' is not a number") as refused:
        hersey.read(path)
    assert "drop_missing=True" in refused.value.remedy
    assert hersey.read(path, drop_missing=True).rows == 342
