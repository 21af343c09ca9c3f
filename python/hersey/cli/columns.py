"""Columns of numbers from a small CSV whose heads name quantity and unit."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from hersey.errors import ParameterError, UnitError


def read_columns(file: Path, wanted: Mapping[str, tuple[str, str]]) -> list[tuple[float, ...]]:
    """Return columns of a CSV in SI, in the order wanted.

    Parameters
    ----------
    wanted
        The first word of each head, with its kind of unit and an example of the head.

    Raises
    ------
    ParameterError
        If a column is missing or has no unit, or a row lacks a number.
    """
    from hersey.files.text import read_text

    try:
        rows = list(csv.reader(io.StringIO(read_text(file))))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ParameterError(f"{file.name} is no CSV: {error}") from None
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
        raise ParameterError(f"{file.name} has no rows: write a {' and a '.join(wanted)} in each")
    return list(zip(*numbers, strict=True))


def _columns(
    file: Path, heads: list[str], wanted: Mapping[str, tuple[str, str]]
) -> Iterator[tuple[str, tuple[int, float, float]]]:
    """Place of each column and what brings it to SI, by name."""
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
        raise ParameterError(f"{file.name}, line {line}: '{text}' is no number") from None
