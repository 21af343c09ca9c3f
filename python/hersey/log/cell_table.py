"""A table as it stands in a file or in memory: cells of text or numbers by column, whatever they mean."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import HerseyError, UnreadableLogError
from hersey.log.formats.frame import is_frame
from hersey.log.layouts.current import format_of, opened
from hersey.log.recording import Cells, Signal
from hersey.log.text.column import Column, split_unit
from hersey.log.text.delimited import open_delimited
from hersey.log.text.numbers import style_of
from hersey.log.text.repeated_header import refuse_another_header
from hersey.log.text.separators import split
from hersey.schema.warning import Warning


@dataclass(frozen=True)
class CellTable:
    """Name, hash and size of what holds a table, its columns, and the cells of each."""

    name: str
    sha256: str
    size: int
    columns: tuple[Column, ...]
    cells: tuple[Sequence[object], ...]
    number: Any  #: from a cell of text to a number
    comments: tuple[str, ...] = ()
    of_a_frame: bool = False  #: without a header or a row of units
    warnings: tuple[Warning, ...] = ()

    def numbers(self, column: Column) -> FloatArray:
        """Return a column as written, NaN where a cell is no number."""
        cells = self.cells[self.columns.index(column)]
        values = np.array([self._number(cell) for cell in cells], dtype=np.float64)
        for row in np.flatnonzero(np.isnan(values)):
            cell = cells[int(row)]
            if isinstance(cell, str):
                refuse_another_header(f"{self.name}, row {row + 1}", column, cell, self.columns)
        return values

    def texts(self, column: Column) -> list[str]:
        """Return a column as text."""
        return ["" if cell is None else str(cell).strip() for cell in self.cells[self.columns.index(column)]]

    def _number(self, cell: object) -> float:
        if isinstance(cell, str):
            with suppress(ValueError, HerseyError):
                return float(self.number(cell.strip()))
            return float("nan")
        return float("nan") if cell is None else float(cell)  # type: ignore[arg-type]


def cells_of(table: Any, name: str) -> CellTable:
    """Return a table as it stands, from a file or from memory."""
    if isinstance(table, Mapping):
        table = _framed(table, name)
    if is_frame(table):
        return _of_frame(table, name)
    path = Path(table)
    if kind := format_of(path):
        with opened(path, kind) as recording:
            held: Sequence[Cells | Signal] = recording.cells or recording.signals
            columns = tuple(Column(i, s.name, s.unit, s.group) for i, s in enumerate(held))
            loaded: tuple[Sequence[object], ...] = tuple(list(each.load()) for each in held)
            source, comments, warnings = recording.source, recording.comments, tuple(recording.warnings)
        return CellTable(
            path.name, source.sha256, source.bytes, columns, loaded, float, comments, warnings=warnings
        )
    with open_delimited(path) as file:
        layout = file.layout
        text, _ = file.text()
    lines = text.decode(layout.encoding, errors="replace").splitlines()[layout.first_line - 1 :]
    kept = [line for line in lines if line.strip() and not line.startswith(layout.comment)]
    rows = [split(line, layout.separator) for line in kept]
    named = tuple(column for column in layout.columns if column.name)
    cells = tuple([row[c.index] if c.index < len(row) else "" for row in rows] for c in named)
    return CellTable(path.name, _sha(text), len(text), named, cells, layout.style.value, layout.comments)


def _framed(columns: Mapping[str, Any], name: str) -> pl.DataFrame:
    """Columns by name as a frame."""
    try:
        return pl.DataFrame(dict(columns), strict=False)
    except pl.exceptions.ShapeError:
        rows = ", ".join(f"'{title}' has {np.size(cells)}" for title, cells in columns.items())
        raise UnreadableLogError(f"{name}: the columns differ in length: {rows}") from None


def _sha(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _of_frame(frame: Any, name: str) -> CellTable:
    if isinstance(frame, pl.LazyFrame):
        frame = frame.collect()
    by_name = {str(c): list(frame[c]) for c in frame.columns}
    columns = tuple(Column(i, *split_unit(title)) for i, title in enumerate(by_name))
    content = repr(by_name).encode()
    style = style_of([cell.strip() for cells in by_name.values() for cell in cells if isinstance(cell, str)])
    cells = tuple(by_name.values())
    return CellTable(name, _sha(content), len(content), columns, cells, style.value, of_a_frame=True)
