"""Columns of a file of any format as they stand, for readers with roles of their own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.assembly import columns, nothing_to_read
from hersey.log.formats import format_of, opened
from hersey.log.recording import Recording
from hersey.log.text.delimited import delimited_layout, delimited_numbers
from hersey.log.text.layout import Column


class OpenColumns:
    """The columns of a file while it is open."""

    def __init__(self, path: Path, recording: Recording | None) -> None:
        """Look at a recording, or at a text table where there is none."""
        self.file, self._path, self._recording = path.name, path, recording
        self.headless = ""  #: why the columns of a text table have no names, or empty
        if recording is None:
            layout = delimited_layout(path)
            self.columns, self.headless = layout.named, layout.headless
        elif not recording.signals:
            raise nothing_to_read(recording)
        else:
            self.columns = columns(recording)

    def numbers(self, *chosen: Column, complete: bool = False) -> list[FloatArray]:
        """Return columns in the unit as written, shape (rows,), NaN where a number is missing.

        Raises
        ------
        UnreadableLogError
            If a cell is no number, naming line and column; if ``complete``, also if one is missing.
        """
        if self._recording is None:
            return delimited_numbers(self._path, chosen, complete=complete)
        arrays = [self._recording.signals[column.index].load() for column in chosen]
        for column, values in zip(chosen, arrays, strict=True):
            if complete and not np.isfinite(values).all():
                row = int(np.argmin(np.isfinite(values)))
                raise UnreadableLogError(
                    f"{self.file}, channel '{column.path}', sample {row + 1}: "
                    "no number stands where one is needed"
                )
        return arrays

    def clock(self, column: Column) -> FloatArray | None:
        """Return the time of each sample of a column, s, or None if a column of the file holds it."""
        clock = self._recording.signals[column.index].clock if self._recording else None
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
        yield OpenColumns(path, None)
        return
    with opened(path, kind) as recording:
        yield OpenColumns(path, recording)
