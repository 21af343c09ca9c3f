"""All cells of a workbook as they stand, for a layout that says where its tables are."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import BinaryIO

import polars as pl

from hersey.log.formats.excel import prepare, sheets_of
from hersey.log.recording import LONGEST_CELL, Cells, Recording

__all__ = ["open_sheets", "prepare"]


@contextmanager
def open_sheets(file: BinaryIO, _name: str) -> Iterator[Recording]:
    """Open a workbook: each column of a sheet is one of cells, in the group of its sheet."""
    prepare()
    cells = tuple(
        Cells(f"#{index + 1}", "", table.height, partial(_texts, table.to_series(index)), title)
        for title, table in sheets_of(file).items()
        for index in range(table.width)
    )
    yield Recording("Excel", (), cells=cells)


def _texts(cells: pl.Series) -> list[str]:
    return [" ".join((cell or "")[:LONGEST_CELL].replace('"', "'").split()) for cell in cells]
