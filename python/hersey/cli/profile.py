"""A drive's speed over time, from a CSV: times and speeds at the belt, with units in their heads."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.errors import ParameterError, UnitError

if TYPE_CHECKING:
    from hersey.motion.schedule import Schedule

#: What the columns hold, by the first word of their heads, and an example of each.
_COLUMNS = {"time": ("time", "time (s)"), "speed": ("belt speed", "speed (mm/s)")}
_HEAD = re.compile(r"\s*(time|speed)\s*[(\[](.*)[)\]]\s*", re.IGNORECASE)


def read_profile(file: Path) -> Schedule:
    """Return the drive speed (m/s) over time (s) of a CSV, joined by straight lines; the last speed stays.

    Raises
    ------
    ParameterError
        If a column is missing or has no unit, or a row no two numbers, or times run backwards.
    """
    from hersey.files.text import read_text
    from hersey.motion.schedule import Schedule

    try:
        rows = list(csv.reader(io.StringIO(read_text(file))))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ParameterError(f"{file.name} is no CSV: {error}") from None
    columns = dict(_columns(file, rows[0] if rows else []))
    missing = [example for name, (_, example) in _COLUMNS.items() if name not in columns]
    if missing:
        raise ParameterError(f"{file.name}, line 1: add a column '{missing[0]}'")
    numbers = [
        [
            scale * _number(file, line, row, at) + offset
            for at, scale, offset in (columns["time"], columns["speed"])
        ]
        for line, row in enumerate(rows[1:], start=2)
        if any(cell.strip() for cell in row)
    ]
    if not numbers:
        raise ParameterError(f"{file.name} has no rows: write a time and a speed in each")
    times, speeds = zip(*numbers, strict=True)
    try:
        profile = Schedule(times, speeds)
    except ParameterError as error:
        raise ParameterError(f"{file.name}: {error}") from None
    if min(speeds) < 0 or speeds[-1] == 0:
        raise ParameterError(f"{file.name}: no speed may be less than 0, and the last must be greater than 0")
    return profile


def _columns(file: Path, heads: list[str]) -> Iterator[tuple[str, tuple[int, float, float]]]:
    """Place of each column and what brings it to SI, by name."""
    from hersey.units import conversion

    for at, head in enumerate(heads):
        match = _HEAD.fullmatch(head)
        if match is not None:
            name = match[1].lower()
            try:
                line = conversion(_COLUMNS[name][0], match[2])
            except UnitError as error:
                raise UnitError(f"{file.name}, column '{head}': {error}") from None
            yield name, (at, line.scale, line.offset)


def _number(file: Path, line: int, row: list[str], at: int) -> float:
    text = row[at].strip() if at < len(row) else ""
    try:
        return float(text)
    except ValueError:
        raise ParameterError(f"{file.name}, line {line}: '{text}' is no number") from None
