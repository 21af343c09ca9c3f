"""What stands between the cells of a line, and the rows of numbers that a separator makes of a text."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass

from hersey.log.text.numbers import is_missing, looks_numeric
from hersey.log.text.stamps import is_stamp

#: What may stand between cells.
SEPARATORS = ";\t|,"
#: The separator that stands for any run of blanks and tabs.
BLANKS = " "


def tabbed(text: bytes) -> bytes:
    """Return lines in which each run of blanks and tabs between cells has become one tab."""
    return re.sub(rb"[ \t]+", b"\t", re.sub(rb"(?m)^[ \t]+|[ \t]+(?=\r?$)", b"", text))


def split(line: str, separator: str) -> list[str]:
    """Return the cells of a line, without surrounding blanks."""
    if separator == BLANKS:
        return line.split()
    if '"' not in line:  # as the csv module would, several times as fast
        return [cell.strip() for cell in line.split(separator)] if line else []
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]
    except csv.Error:  # a cell beyond the limit of the csv module
        return [cell.strip() for cell in line.split(separator)]


@dataclass(frozen=True)
class NumberRows:
    """The rows of numbers that a separator makes: cells in each, index of the first line, and how many.

    ``score`` counts the numbers in them, 0 where there are no rows.
    """

    separator: str
    width: int
    first: int
    score: int
    rows: int = 0
    pure: bool = False  # all its cells may be numbers


def number_rows(numbered: list[tuple[int, str]], separator: str) -> NumberRows:
    """Return the longest reading of the lines as rows of numbers with this separator."""
    lines: dict[int, list[int]] = {}  # of rows, by their width
    scores: dict[int, int] = {}
    for number, (_, line) in enumerate(numbered):
        if separator not in line and separator != BLANKS:
            continue
        row = split(line, separator)
        numeric = [_may_be_number(cell) for cell in row] if len(row) > 1 else []
        if numeric and _mostly_numbers(row, numeric):
            lines.setdefault(len(row), []).append(number)
            # cells that are none speak against a separator: "0,5;1,5" is no row of "0", "5;1" and "5"
            scores[len(row)] = scores.get(len(row), 0) + sum(numeric)
    width = max(scores, key=lambda w: scores[w], default=0)
    if not width or not scores[width]:
        return NumberRows(separator, 0, 0, 0)
    rows = set(lines[width])
    first = _first_of_block([number in rows for number in range(len(numbered))])
    pure = scores[width] == width * len(rows)
    return NumberRows(separator, width, first, scores[width], len(rows), pure)


def _may_be_number(cell: str) -> bool:
    return looks_numeric(cell) or is_missing(cell) or is_stamp(cell)


def _mostly_numbers(row: list[str], numeric: list[bool]) -> bool:
    missing = sum(map(is_missing, row))
    numbers, filled = sum(numeric) - missing, len(row) - missing  # what is missing may be a number
    return (numbers > 0 and 2 * numbers > filled) or (not filled and any(row))


def _first_of_block(rows: list[bool]) -> int:
    """Index of the first row of the table: preambles too have a line of numbers here and there."""
    first = next(i for i, row in enumerate(rows) if row)
    left = sum(rows)  # rows from the first on
    while (
        gap := next((i for i in range(first, min(first + 3, len(rows))) if not rows[i]), None)
    ) is not None:
        later = next((i for i in range(gap, len(rows)) if rows[i]), None)
        if later is None or left - (gap - first) < gap - first:
            break
        first, left = later, left - (gap - first)
    return first
