"""A text file as a recording, whose columns can be taken one by one; words stay words."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError, printable
from hersey.log.recording import LONGEST_CELL, Cells, Recording, Signal, Source
from hersey.log.text.blocks import blocks
from hersey.log.text.column import Column
from hersey.log.text.delimited import DelimitedFile, open_delimited


@contextmanager
def text_recording(path: Path) -> Iterator[Recording]:
    """Open a text file as a recording.

    Raises
    ------
    MissingFileError, UnreadableLogError
        If it cannot be opened, or holds no table.
    """
    with open_delimited(path) as file:
        layout, name = file.layout, printable(path.name)
        if layout.headless and not layout.named:
            raise UnreadableLogError(layout.headless)
        numeric = [column for column in layout.named if column.index not in layout.texts]

        @cache
        def numbers() -> list[FloatArray]:
            return file.numbers(numeric, complete=False, odd_as_missing=True)

        @cache
        def words() -> list[list[str]]:
            return _rows(file, name)

        def load(at: int) -> FloatArray:
            return numbers()[at]

        def texts(column: Column) -> list[str]:
            return [row[column.index][:LONGEST_CELL] if column.index < len(row) else "" for row in words()]

        rows = numbers()[0].size if numeric else 0
        signals = tuple(
            Signal(c.name, c.unit, rows, lambda at=at: load(at), line=layout.first_line)  # type: ignore[misc]
            for at, c in enumerate(numeric)
        )
        cells = tuple(
            Cells(c.name, c.unit, rows, lambda c=c: texts(c))  # type: ignore[misc]
            for c in layout.named
        )
        file.opened.file.seek(0)
        sha256 = hashlib.sha256(file.opened.file.read(file.opened.size)).hexdigest()
        yield Recording(
            "text",
            signals,
            comments=layout.comments,
            warnings=[*layout.warnings, *file.end.warnings],
            cut_off=file.end.cut_off,
            source=Source(name, sha256, file.opened.size),
            cells=cells,
        )


def _rows(file: DelimitedFile, name: str) -> list[list[str]]:
    """The cells of every row."""
    found = blocks(file.opened, file.end.byte, file.layout, name, lambda _: None)
    return [cells for block, _ in found for cells in block.cells(file.layout.between)]
