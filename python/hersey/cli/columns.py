"""Columns of a small table whose headings name quantity and unit: a profile or a drag curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.errors import ParameterError, UnitError, UnreadableLogError, followed_by

if TYPE_CHECKING:
    from hersey.log.columns import OpenColumns
    from hersey.log.text.column import Column
    from hersey.motion.drag import DragTable
    from hersey.motion.schedule import Schedule

_TIME = ("time", "time (s)")
_SPEED = ("belt speed", "speed (mm/s)")
_FORCE = ("force", "force (N)")


def read_profile(file: Path) -> Schedule:
    """Return the drive speed (m/s) over time (s) of a CSV, joined by straight lines; the last speed is held.

    Raises
    ------
    HerseyError
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
    HerseyError
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
    """Return columns of a table in SI, in the order wanted; it may be any file that a log may be.

    Parameters
    ----------
    wanted
        The first word of each heading, with its kind of unit and an example of the heading.

    Raises
    ------
    HerseyError
        If a column is missing or has no unit, or a row lacks a number; it names the file.
    """
    from hersey.log.columns import open_columns
    from hersey.units import conversion

    heads = ",".join(example for _, example in wanted.values())
    with ExitStack() as stack:
        try:
            opened = stack.enter_context(open_columns(file))
        except UnreadableLogError as error:
            error.remedy = followed_by(error.remedy, f"write '{heads}' in line 1, and a row for each point")
            raise
        if opened.headless:
            raise ParameterError(f"{file.name} has no header: write '{heads}' in line 1")
        chosen = [_column(opened, name, example) for name, (_, example) in wanted.items()]
        numbers = opened.numbers(*chosen, complete=True)
    out = []
    for column, values, (kind, _) in zip(chosen, numbers, wanted.values(), strict=True):
        try:
            line = conversion(kind, column.unit)
        except UnitError as error:
            raise UnitError(f"{file.name}, column '{column}': {error}") from None
        out.append(tuple(line.scale * value + line.offset for value in values.tolist()))
    return out


def _column(opened: OpenColumns, name: str, example: str) -> Column:
    named = [column for column in opened.columns if column.name.lower().startswith(name)]
    there = ", ".join(f"'{column}'" for column in opened.columns)
    if not named:
        raise ParameterError(
            f"{opened.file}: no column is named {name}. Columns: {there}. Call one '{example}'"
        )
    if len(named) > 1:
        raise ParameterError(f"{opened.file}: more than one column is named {name}: {there}. Delete one")
    if not named[0].unit:
        raise UnitError(f"{opened.file}: column '{named[0]}' has no unit. Write '{example}' in the header")
    return named[0]
