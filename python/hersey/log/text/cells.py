"""The cells of a block as numbers.

A block goes through polars; where that stumbles, or the count of rows does not match the lines, it is read
again cell by cell, which either succeeds (padded cells, odd quotes) or names line and column.
"""

from __future__ import annotations

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.text.blocks import Block
from hersey.log.text.column import Column
from hersey.log.text.dated_numbers import numbers_lost, was_number
from hersey.log.text.decimal_commas import with_decimal_commas
from hersey.log.text.layout import Layout
from hersey.log.text.numbers import NULLS, NumberStyle, looks_numeric
from hersey.log.text.repeated_header import refuse_another_header
from hersey.log.text.stamps import Stamps, numbers_in
from hersey.schema.warning import Warning

_ONE_STYLE = "export numbers with one decimal mark and without thousands separators"


class CellReader:
    """Reads the same columns of one block after another; time stamps remember what they read.

    With ``strict`` a cell that is no number is refused.
    """

    def __init__(self, name: str, layout: Layout, columns: list[Column], *, strict: bool) -> None:
        """Take the file's name, how it is read, and the columns."""
        self.name, self.layout, self.columns, self.strict = name, layout, columns, strict
        self.stamps = {i: Stamps(style) for i, style in layout.stamps.items()}
        self.dates = dict[int, Column]()  # columns in which numbers have become dates, by index
        self.misread = 0  # cells of a number in another style, and rows of more cells than the header
        self.remedy = ""  # for the first of them

    def warnings(self) -> list[Warning]:
        """Return how time stamps were read."""
        columns = [column for column in self.columns if column.index in self.stamps]
        return [self.stamps[column.index].warning(column.name) for column in columns]

    def what(self, column: Column) -> str:
        """Return what a cell of a column holds, in words."""
        return "time stamp" if column.index in self.stamps else "number"

    def numbers(self, block: Block) -> list[FloatArray]:
        """Return the columns as numbers, NaN where a cell stands for a missing value.

        Unless ``strict`` also where a cell is no number, and in a row of more cells than the header.

        Raises
        ------
        UnreadableLogError
            If ``strict``, or if most rows are such; it names the line.
        """
        wanted = sorted(column.index for column in self.columns)
        style = self.layout.style
        comma = style.decimal_comma and not style.thousands
        fast = not self.stamps and (
            style.is_plain or (comma and self.layout.separator != "," and b"." not in block.text)
        )  # a point beside decimal commas is a cell that could be read in two ways
        frame = self._parsed(block, wanted, fast=fast, comma=comma)
        if frame is None or frame.height != len(block.lines) or frame.width != len(wanted):
            return self._cell_by_cell(block)
        by_index = dict(zip(wanted, frame.get_columns(), strict=True))
        if fast:
            return [_with_nan(by_index[column.index]) for column in self.columns]
        values: dict[int, FloatArray] = {}
        for column in sorted(self.columns, key=lambda c: c.index in self.stamps):  # which remember, so last
            numbers = self._written(column).values(by_index[column.index].fill_null(""))
            if numbers is None:
                return self._cell_by_cell(block)
            values[column.index] = numbers
        return [values[column.index] for column in self.columns]

    def _parsed(self, block: Block, wanted: list[int], *, fast: bool, comma: bool) -> pl.DataFrame | None:
        """The columns as polars reads them, or None where it stumbles.

        Words for what is missing take most of its time, so it first tries without them.
        """
        for nulls in [None, NULLS] if fast else [NULLS]:
            try:
                return pl.read_csv(
                    block.text,
                    has_header=False,
                    columns=wanted,
                    separator=self.layout.between,
                    decimal_comma=fast and comma,
                    schema_overrides=[pl.Float64 if fast else pl.String] * len(self.layout.columns),
                    null_values=nulls,
                    encoding="utf8-lossy",
                )
            except pl.exceptions.PolarsError:
                continue
        return None

    def _written(self, column: Column) -> NumberStyle | Stamps:
        return self.stamps.get(column.index, self.layout.style)

    def _cell_by_cell(self, block: Block) -> list[FloatArray]:
        width = len(self.layout.columns)
        table = [cells + [""] * (width - len(cells)) for cells in block.cells(self.layout.between)]
        self._leave_out_longer(block, table)
        return [
            self._readable(block, column, [row[column.index] for row in table]) for column in self.columns
        ]

    def _leave_out_longer(self, block: Block, table: list[list[str]]) -> None:
        """Empty the rows that have more cells than the header: which of them is which is not known."""
        width = len(self.layout.columns)
        longer = [row for row, cells in enumerate(table) if any(cells[width:])]
        if not longer:
            return
        cells = table[longer[0]]
        remedy = with_decimal_commas([cells], width) if self.layout.separator == "," else ""
        self._misread(
            len(longer),
            len(table),
            f"{self.name}, line {block.lines[longer[0]]}: {len(cells)} cells, but the header has {width}",
            remedy,
        )
        for row in longer:
            table[row] = [""] * width

    def _misread(self, count: int, rows: int, said: str, remedy: str) -> None:
        """Count cells that are misread; refuse if ``strict``, or if most of the rows have one."""
        if self.strict or 2 * count > rows:
            raise UnreadableLogError(said, remedy=remedy)
        self.misread += count
        self.remedy = self.remedy or remedy

    def _readable(self, block: Block, column: Column, cells: list[str]) -> FloatArray:
        """The numbers of a column, NaN also where a cell is none."""
        values, odd = numbers_in(pl.Series(cells, dtype=pl.String), self._written(column))
        plain = column.index not in self.stamps
        otherwise = []
        for row in odd.arg_true():
            place = f"{self.name}, line {block.lines[row]}"
            if plain:
                refuse_another_header(place, column, cells[row], self.layout.columns)
            said = f"{place}, column '{column.name}': '{cells[row][:40]}' is not a {self.what(column)}"
            dated = plain and was_number(column.name, cells[row])
            if dated:
                self.dates[column.index] = column
            if plain and looks_numeric(cells[row]):
                otherwise.append(said)
            elif self.strict:
                raise UnreadableLogError(said, remedy=numbers_lost(column.name) if dated else "")
        if otherwise:
            self._misread(len(otherwise), len(cells), otherwise[0], _ONE_STYLE)
        return values


def _with_nan(numbers: pl.Series) -> FloatArray:
    """The numbers of a column, NaN where one is missing."""
    if numbers.dtype != pl.Float64:  # of a column without any
        numbers = numbers.cast(pl.Float64)
    return (numbers.fill_null(np.nan) if numbers.null_count() else numbers).to_numpy()
