"""What a file of any format holds before roles are given: named channels, each with its own clock.

A reader of a format is a context manager that opens a file and yields a `Recording`; the numbers of a channel
are loaded only when they are asked for, while the file is open.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, UnreadableLogError
from hersey.log.text.column import Column
from hersey.schema.warning import Warning

#: Characters of a cell of text at the most: what it says beyond is no name.
LONGEST_CELL = 300
#: What a file may say of a sample: nothing, that its value is invalid, or that its time is.
SOUND, INVALID, INVALID_TIME = 0.0, 1.0, 2.0


@dataclass(frozen=True)
class Signal:
    """One channel as recorded.

    ``load`` returns the numbers in the unit as written, shape (rows,), NaN where a value is missing;
    ``clock`` the time of each in s on a scale common to the file, or is None where a channel of the group
    holds the time. ``tick`` names the clock: two signals with the same tick need no alignment. ``line`` is
    the row of the file in which the first sample stands, 0 where a file has none. ``marked`` returns for each
    sample whether the file itself marks it as invalid: `SOUND`, `INVALID` or `INVALID_TIME`; None if it
    marks none. ``parts`` yields what ``load`` returns, part by part, where that needs less memory.
    """

    name: str
    unit: str
    rows: int
    load: Callable[[], FloatArray]
    clock: Callable[[], FloatArray] | None = None
    tick: str = ""
    group: str = ""
    line: int = 0
    marked: Callable[[], FloatArray] | None = None
    parts: Callable[[], Iterator[FloatArray]] | None = None


@dataclass(frozen=True)
class Cells:
    """One column of a table of cells: ``load`` returns all of them as text, the words beside the numbers.

    A number is written as Python reads it, whatever its decimal mark in the file; no cell is longer than
    `LONGEST_CELL`.
    """

    name: str
    unit: str
    rows: int
    load: Callable[[], list[str]]
    group: str = ""


@dataclass(frozen=True)
class Source:
    """Where a recording came from: name, SHA-256 and bytes."""

    name: str
    sha256: str
    bytes: int


@dataclass
class Recording:
    """A file as recorded; ``warnings`` grow while channels are loaded, ``cut_off``: its end is missing."""

    format: str
    signals: tuple[Signal, ...]
    others: tuple[str, ...] = ()  #: channels that hold no series of numbers, and what they hold
    comments: tuple[str, ...] = ()
    warnings: list[Warning] = field(default_factory=list)
    cut_off: bool = False
    nothing: str = ""  #: why there are no signals, if the format can tell
    source: Source = Source("", "", 0)
    cells: tuple[Cells, ...] = ()  #: every named column as text, where the file is one of cells
    dates: set[str] = field(default_factory=set)  #: paths of columns in which numbers have become dates


def columns(recording: Recording) -> tuple[Column, ...]:
    """Return the channels of a recording as columns to choose from."""
    return tuple(
        Column(index, signal.name, signal.unit, signal.group)
        for index, signal in enumerate(recording.signals)
    )


def nothing_to_read(recording: Recording) -> ChannelError:
    """Return the error for a recording without a channel of numbers."""
    file = recording.source.name
    if recording.nothing:
        return ChannelError(f"{file}: {recording.nothing}")
    others = ", ".join(recording.others[:40])[:1000] or "nothing"
    return ChannelError(f"{file} has no channel of numbers, only {others}")


def library_warning(library: str, message: str) -> Warning:
    """Return what a library says of a file."""
    return Warning(
        "library warns",
        "{library} warns: {message}",
        severity="watch",
        library=library,
        message=message[:160],
    )


def cell_that_is_no_number(
    row: int, column: str, cell: str, odd: int, *, where: str = "", expected: str = "number"
) -> Warning:
    """Return the warning of the first of several (``odd``) cells of a column that are no numbers."""
    return Warning(
        "cell that is no number",
        "row {row}, column '{column}': '{cell}' is not a {expected}"
        + (", nor are {others} more {others:cell|cells} in this column" if odd > 1 else ""),
        where=where,
        row=row,
        column=column,
        cell=cell[:40],
        expected=expected,
        others=odd - 1,
    )


def library(module: str, reads: str) -> Any:
    """Return an optional library, imported on first use.

    Raises
    ------
    UnreadableLogError
        If it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        raise UnreadableLogError(
            f"reading {reads} needs {module}. Run pip install 'hersey[formats]'"
        ) from None


@contextlib.contextmanager
def listening(name: str) -> Iterator[list[str]]:
    """Collect what a library logs, and drop what it prints; yield the list of messages."""
    heard: list[str] = []

    def keep(record: logging.LogRecord) -> bool:
        if record.levelno >= logging.WARNING:
            heard.append(record.getMessage())
        return False

    loggers = [
        logging.getLogger(key)
        for key in [name, *logging.root.manager.loggerDict]
        if key.split(".")[0] == name
    ]
    for logger in loggers:
        logger.addFilter(keep)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            yield heard
    finally:
        for logger in loggers:
            logger.removeFilter(keep)


def floats(values: Any) -> FloatArray:
    """Return numbers of any real type as float64, time stamps as seconds since the first."""
    array = np.ma.filled(values, np.nan) if np.ma.isMaskedArray(values) else np.asarray(values)
    if array.dtype.kind == "M":
        return seconds(array)
    if array.dtype.kind == "m":
        return np.asarray(array / np.timedelta64(1, "ns") * 1e-9, dtype=float)
    if array.dtype.kind == "c":
        raise UnreadableLogError("complex numbers")
    return np.ascontiguousarray(array, dtype=float)


def seconds(stamps: Any, start: Any = None) -> FloatArray:
    """Return time stamps (datetime64) as seconds since ``start`` or the first, NaN where one is missing."""
    array = np.asarray(stamps).astype("datetime64[ns]")
    known = array[~np.isnat(array)]
    if not known.size:
        return np.full(array.shape, np.nan)
    steps = array - (known[0] if start is None else np.datetime64(start, "ns"))
    return np.where(np.isnat(array), np.nan, steps.astype(np.int64) * 1e-9)
