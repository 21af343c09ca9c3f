"""Columns of a small CSV whose headings name quantity and unit: a profile or a drag curve."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.errors import ParameterError, UnitError

if TYPE_CHECKING:
    from hersey.motion.drag import DragTable
    from hersey.motion.schedule import Schedule

_TIME = ("time", "time (s)")
_SPEED = ("belt speed", "speed (mm/s)")
_FORCE = ("force", "force (N)")


def read_profile(file: Path) -> Schedule:
    """Return the drive speed (m/s) over time (s) of a CSV, joined by straight lines; the last speed is held.

    Raises
    ------
    ParameterError
        If a column is missing or has no unit, a row lacks a number, or times decrease.
    """
    from hersey.motion.schedule import Schedule

    times, speeds = read_columns(file, {"time": _TIME, "speed": _SPEED})
    with _naming(file):
        profile = Schedule(times, speeds)
    if min(speeds) < 0 or speeds[-1] == 0:
        raise ParameterError(f"{file.name}: speeds must not be negative, and the last must be greater than 0")
    return profile


def read_drag_table(file: Path, **beside: Any) -> DragTable:
    """Return the drag through the points of a CSV; ``beside`` are the other arguments of `DragTable`.

    Raises
    ------
    ParameterError
        If a column is missing or has no unit, a row lacks a number, or the points are not a drag curve.
    """
    from hersey.motion.drag import DragTable

    speeds, forces = read_columns(file, {"speed": _SPEED, "force": _FORCE})
    with _naming(file):
        return DragTable(speeds, forces, **beside)


@contextmanager
def _naming(file: Path) -> Iterator[None]:
    """Begin errors about the numbers of a file with its name."""
    try:
        yield
    except ParameterError as error:
        raise ParameterError(f"{file.name}: {error}") from None


def read_columns(file: Path, wanted: Mapping[str, tuple[str, str]]) -> list[tuple[float, ...]]:
    """Return columns of a CSV in SI, in the order wanted.

    Parameters
    ----------
    wanted
        The first word of each heading, with its kind of unit and an example of the heading.

    Raises
    ------
    ParameterError
        If a column is missing or has no unit, or a row lacks a number.
    """
    from hersey.files.text import read_table_text

    try:
        rows = list(csv.reader(io.StringIO(read_table_text(file))))
    except csv.Error as error:
        raise ParameterError(f"{file.name} is not a CSV file: {error}") from None
    columns = dict(_columns(file, rows[0] if rows else [], wanted))
    missing = [example for name, (_, example) in wanted.items() if name not in columns]
    if missing:
        raise ParameterError(f"{file.name}, line 1: add a column '{missing[0]}'")
    numbers = [
        [scale * _number(file, line, row, at) + offset for at, scale, offset in (columns[n] for n in wanted)]
        for line, row in enumerate(rows[1:], start=2)
        if any(cell.strip() for cell in row)
    ]
    if not numbers:
        raise ParameterError(f"{file.name} has no rows: write {' and '.join(wanted)} in each row")
    return list(zip(*numbers, strict=True))


def _columns(
    file: Path, heads: list[str], wanted: Mapping[str, tuple[str, str]]
) -> Iterator[tuple[str, tuple[int, float, float]]]:
    """Index of each column with scale and offset to SI, by name."""
    from hersey.units import conversion

    pattern = re.compile(rf"\s*({'|'.join(wanted)})\s*[(\[](.*)[)\]]\s*", re.IGNORECASE)
    for at, head in enumerate(heads):
        match = pattern.fullmatch(head)
        if match is not None:
            name = match[1].lower()
            try:
                line = conversion(wanted[name][0], match[2])
            except UnitError as error:
                raise UnitError(f"{file.name}, column '{head}': {error}") from None
            yield name, (at, line.scale, line.offset)


def _number(file: Path, line: int, row: list[str], at: int) -> float:
    text = row[at].strip() if at < len(row) else ""
    try:
        return float(text)
    except ValueError:
        raise ParameterError(f"{file.name}, line {line}: '{text}' is not a number") from None
