"""Columns of a file of any format as they stand, for readers with roles of their own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.layouts.current import format_of, opened
from hersey.log.recording import Recording, columns, nothing_to_read
from hersey.log.text.column import Column
from hersey.log.text.delimited import DelimitedFile, open_delimited


class OpenColumns:
    """The columns of a file while it is open."""

    def __init__(self, file: str, source: Recording | DelimitedFile) -> None:
        """Look at a recording or at a text table; ``file`` is its name in messages."""
        self.file, self._source = file, source
        self.headless = ""  #: why the columns of a text table have no names, or empty
        if isinstance(source, DelimitedFile):
            self.columns, self.headless = source.layout.named, source.layout.headless
        elif not source.signals:
            raise nothing_to_read(source)
        else:
            self.columns = columns(source)

    def numbers(self, *chosen: Column, complete: bool = False) -> list[FloatArray]:
        """Return columns in the unit as written, shape (rows,), NaN where a number is missing.

        Raises
        ------
        UnreadableLogError
            If a cell is no number, naming line and column; if ``complete``, also if one is missing.
        """
        if isinstance(self._source, DelimitedFile):
            return self._source.numbers(chosen, complete=complete)
        arrays = [self._source.signals[column.index].load() for column in chosen]
        for column, values in zip(chosen, arrays, strict=True):
            if complete and not np.isfinite(values).all():
                row = int(np.argmin(np.isfinite(values)))
                raise UnreadableLogError(
                    f"{self.file}, channel '{column.path}', sample {row + 1}: the number is missing"
                )
        return arrays

    def clock(self, column: Column) -> FloatArray | None:
        """Return the time of each sample of a column, s, or None if a column of the file holds it."""
        clock = None if isinstance(self._source, DelimitedFile) else self._source.signals[column.index].clock
        return clock() if clock else None


@contextmanager
def open_columns(path: str | Path) -> Iterator[OpenColumns]:
    """Open a file of any format that a log may have.

    Raises
    ------
    MissingFileError, UnreadableLogError, ChannelError
        If it is not there, cannot be read, or holds no columns of numbers; each names the file.

    Examples
    --------
    >>> with open_columns("examples/stick-slip.csv") as opened:
    ...     [str(column) for column in opened.columns]
    ['time [s]', 'force [N]']
    """
    path = Path(path)
    kind = format_of(path)
    if kind is None:
        with open_delimited(path) as table:
            yield OpenColumns(path.name, table)
        return
    with opened(path, kind) as recording:
        yield OpenColumns(path.name, recording)
