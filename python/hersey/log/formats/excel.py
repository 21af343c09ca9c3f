"""Workbooks of Excel, old and new, through polars and calamine: every sheet that holds a table of numbers."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import BinaryIO

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import HerseyError
from hersey.log.recording import LONGEST_CELL, Cells, Recording, Signal, cell_that_is_no_number, library
from hersey.log.text.column import Column
from hersey.log.text.dated_numbers import was_number
from hersey.log.text.footer import summary_lines
from hersey.log.text.layout import SNIFFED, Layout, find_layout
from hersey.log.text.repeated_header import refuse_another_header
from hersey.log.text.stamps import Stamps, numbers_in
from hersey.schema.warning import Warning

#: What stands between the cells of a row where the table is looked for: no cell holds one then.
_TAB = "\t"
#: Rows at the end of a sheet among which a summary is looked for.
_LAST = 21


@contextmanager
def open_excel(file: BinaryIO, _name: str) -> Iterator[Recording]:
    """Open a workbook: each sheet with a table is a group, named where there are several."""
    prepare()
    sheets = sheets_of(file)
    recording = Recording("Excel", ())
    tables: dict[str, tuple[pl.DataFrame, Layout]] = {}
    others = []
    for title, cells in sheets.items():
        try:
            tables[title] = (cells, _layout(cells, f"sheet '{title}'"))
        except HerseyError as error:
            others.append(str(error))
            if error.remedy:  # its table has to be turned
                recording.nothing = recording.nothing or str(error)
    signals: list[Signal] = []
    columns: list[Cells] = []
    for title, (cells, layout) in tables.items():
        group = title if len(tables) > 1 else ""
        table = _rows(recording, group, cells, layout)
        signals += _signals(recording, group, table, layout)
        columns += _columns(group, table, layout)
        recording.warnings += layout.warnings
        recording.comments += tuple(comment.rstrip() for comment in layout.comments)
    recording.signals, recording.others, recording.cells = tuple(signals), tuple(others), tuple(columns)
    yield recording


def sheets_of(file: BinaryIO) -> dict[str, pl.DataFrame]:
    """Return the cells of each sheet as text, by its title."""
    return pl.read_excel(
        io.BytesIO(file.read()),
        sheet_id=0,
        engine="calamine",
        has_header=False,
        # as text: a word in a column of numbers drops only its row
        read_options={"dtypes": "string", "skip_rows": 0},
        drop_empty_rows=False,
        drop_empty_cols=False,
        raise_if_empty=False,
    )


def prepare() -> None:
    """Import the library, which takes memory that is none of the file's.

    Raises
    ------
    UnreadableLogError
        If it is not installed.
    """
    library("fastexcel", "workbooks of Excel")


def _layout(cells: pl.DataFrame, place: str) -> Layout:
    """Where the table of a sheet starts, found as in a text file."""
    lines, size = [], 0
    for row in cells.iter_rows():
        lines.append(_line(row))
        size += len(lines[-1])
        if size > SNIFFED // 2:  # a sign may take more than a byte
            break
    return find_layout("\n".join(lines).encode()[: SNIFFED - 1], place, separators=_TAB)


def _line(row: tuple[str | None, ...]) -> str:
    return _TAB.join(" ".join((cell or "").replace('"', "'").split()) for cell in row)


def _rows(recording: Recording, group: str, cells: pl.DataFrame, layout: Layout) -> pl.DataFrame:
    """The rows of a table, without a summary below it."""
    table = cells.slice(layout.first_line - 1)
    filled = np.flatnonzero(~table.select(pl.all_horizontal(pl.all().is_null())).to_series().to_numpy())
    rows = int(filled[-1]) + 1 if filled.size else 0
    last = [_line(row) for row in table.slice(max(0, rows - _LAST), min(rows, _LAST)).iter_rows()]
    if summary := summary_lines(last, layout):
        recording.warnings.append(
            Warning(
                "lines below the table",
                "{lines} {lines:row|rows} below the table {lines:was|were} skipped: '{first}'",
                where=_sheet(group),
                lines=summary,
                first=last[-summary][:60],
            )
        )
        rows = int(filled[filled < rows - summary][-1]) + 1
    return table.head(rows)


def _signals(recording: Recording, group: str, table: pl.DataFrame, layout: Layout) -> Iterator[Signal]:
    for column in layout.named:
        if column.index in layout.texts:
            continue
        load = partial(_numbers, recording, group, table.to_series(column.index), layout, column)
        yield Signal(column.name, column.unit, table.height, load, group=group, line=layout.first_line)


def _sheet(group: str) -> str:
    """The sheet in words, where there are several."""
    return f"sheet '{group}'" if group else ""


def _columns(group: str, table: pl.DataFrame, layout: Layout) -> Iterator[Cells]:
    """Every named column as text, for a table whose words count: that of means."""
    for column in layout.named:
        load = partial(_texts, table.to_series(column.index), layout)
        yield Cells(column.name, column.unit, table.height, load, group)


def _texts(cells: pl.Series, layout: Layout) -> list[str]:
    style, texts = layout.style, [(cell or "")[:LONGEST_CELL] for cell in cells]
    if style.is_plain:
        return texts
    return [repr(style.value(cell)) if style.is_number(cell) else cell for cell in texts]


def _numbers(
    recording: Recording, group: str, cells: pl.Series, layout: Layout, column: Column
) -> FloatArray:
    """The numbers of a column: a cell that is none is missing, and warned of."""
    style = layout.stamps.get(column.index)
    written = layout.style if style is None else Stamps(style)
    text, sheet = cells.fill_null(""), _sheet(group)
    values, odd = numbers_in(text, written)
    for row in odd.arg_true() if style is None else ():
        where = ", ".join(filter(None, (recording.source.name, sheet, f"row {layout.first_line + row}")))
        refuse_another_header(where, column, text[row][:LONGEST_CELL], layout.columns)
    if style is None and any(was_number(column.name, cell) for cell in text.filter(odd)):
        recording.dates.add(replace(column, group=group).path)
    for row in odd.arg_true()[:1]:
        expected = "number" if style is None else "time"
        at, odd_cells = layout.first_line + row, int(odd.sum())
        recording.warnings.append(
            cell_that_is_no_number(at, column.name, text[row], odd_cells, where=sheet, expected=expected)
        )
    if isinstance(written, Stamps):
        recording.warnings.append(written.warning(column.name))
    return values
