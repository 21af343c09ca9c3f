"""Where the table starts in a delimited text file, and how its numbers are written."""

from __future__ import annotations

import codecs
import csv
import re
from collections import Counter
from dataclasses import dataclass

from hersey.errors import UnitError, UnreadableLogError, WrongKindError
from hersey.units import KINDS, conversion

#: Bytes looked at; preambles of data loggers are far shorter.
SNIFFED = 1 << 17
#: Characters of a number at the most: longer cells are text, whatever they hold.
LONGEST_NUMBER = 60
#: Spellings of a value that was not measured.
MISSING = ("", "nan", "na", "n/a", "null", "none", "-", "--", "---", "ovl", "#n/a", "inf", "-inf", "+inf")
_COMMENTS = ("#", "~", "//")
_POINT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_COMMA = re.compile(r"[-+]?(\d+,?\d*|,\d+)([eE][-+]?\d+)?")
_NAME_WITH_UNIT = re.compile(r"(.*?)\s*(?:\[([^\]]*)\]|\(([^)]*)\))\s*")


@dataclass(frozen=True)
class Column:
    """A column of the file: position from 0, name and unit as written (unit empty if none)."""

    index: int
    name: str
    unit: str

    def __str__(self) -> str:
        """Return name and unit as a header would show them."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class Layout:
    """How to read the table: ``first_line`` is the line of the first row, counted from 1."""

    encoding: str
    separator: str
    decimal_comma: bool
    comment: str
    columns: tuple[Column, ...]
    first_line: int
    comments: tuple[str, ...]


def find_layout(start: bytes, name: str) -> Layout:
    """Return the layout of a text file from its first `SNIFFED` bytes.

    Raises
    ------
    UnreadableLogError
        If the bytes are no text, or hold no header followed by rows of numbers.
    """
    encoding = _encoding(start, name)
    text = start.decode(encoding, errors="replace")
    if "\r" in text and "\n" not in text:
        raise UnreadableLogError(f"{name}: its lines end with CR alone: save it with ordinary line ends")
    lines = [line.rstrip("\r") for line in text.split("\n")]
    if len(start) >= SNIFFED:
        lines = lines[:-1]
        if not any(line.strip() for line in lines):
            raise UnreadableLogError(f"{name} holds no table: its first line has over {SNIFFED} characters")
    comment = next((c for c in _COMMENTS if any(line.startswith(c) for line in lines)), "#")
    numbered = [
        (number, line)
        for number, line in enumerate(lines, start=1)
        if line.strip() and not line.lstrip().startswith(comment)
    ]
    if not numbered:
        raise UnreadableLogError(f"{name} is empty: a header and rows of numbers are needed")
    table = max((_table(numbered, separator) for separator in ";\t,|"), key=lambda t: t.score)
    if table.score == 0:
        raise UnreadableLogError(
            f"{name} has a header but no rows of numbers below it"
            if _looks_like_header(numbered[-1][1])
            else f"{name} holds no table of numbers with at least two columns"
        )
    if table.first == 0:
        raise UnreadableLogError(
            f"{name}, line {numbered[0][0]}: the file starts with numbers; "
            "put a header line with name and unit of each column above them, such as 'Torque [N*m]' "
            f"(and without '{comment}' before it)"
        )
    columns = _columns(table, numbered, name)
    decimal_comma = table.separator != "," and _uses_decimal_comma(table, numbered)
    first_line = numbered[table.first][0]
    above = lines[: first_line - 1]
    comments = tuple(li.strip("# ~/")[:200] for li in above if li.startswith(comment))[:5]
    return Layout(encoding, table.separator, decimal_comma, comment, columns, first_line, comments)


@dataclass(frozen=True)
class _Table:
    separator: str
    width: int
    first: int
    score: int


def split(line: str, separator: str) -> list[str]:
    """Return the cells of a line, without surrounding blanks."""
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]
    except csv.Error:  # a cell beyond the limit of the csv module
        return [cell.strip() for cell in line.split(separator)]


def is_number(cell: str, decimal_comma: bool) -> bool:
    """Return whether a cell is a finite number as the file writes them."""
    return len(cell) <= LONGEST_NUMBER and bool((_COMMA if decimal_comma else _POINT).fullmatch(cell))


def is_missing(cell: str) -> bool:
    """Return whether a cell stands for a value that was not measured."""
    return cell.lower() in MISSING


def _encoding(start: bytes, name: str) -> str:
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    if b"\0" in start:
        raise UnreadableLogError(
            f"{name} is a binary file, not text; this version reads CSV: export the channels as text"
        )
    try:
        codecs.getincrementaldecoder("utf-8")().decode(start)
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


def _table(numbered: list[tuple[int, str]], separator: str) -> _Table:
    """The longest reading of the lines as rows of numbers with this separator."""
    cells = [split(line, separator) for _, line in numbered]
    widths = Counter(len(row) for row in cells if len(row) > 1)
    best = _Table(separator, 0, 0, 0)
    for width in widths:
        rows = [len(row) == width and _mostly_numbers(row) for row in cells]
        count = sum(rows)
        if count and count * width > best.score:
            best = _Table(separator, width, _first_of_block(rows), count * width)
    return best


def _mostly_numbers(row: list[str]) -> bool:
    filled = [cell for cell in row if not is_missing(cell)]
    numbers = sum(is_number(cell, True) or is_number(cell, False) for cell in filled)
    return (numbers > 0 and 2 * numbers > len(filled)) or (not filled and any(row))


def _first_of_block(rows: list[bool]) -> int:
    """Index of the first row of the table: preambles too have a line of numbers here and there."""
    first = next(i for i, row in enumerate(rows) if row)
    while (
        gap := next((i for i in range(first, min(first + 3, len(rows))) if not rows[i]), None)
    ) is not None:
        later = next((i for i in range(gap, len(rows)) if rows[i]), None)
        if later is None or sum(rows[later:]) < sum(rows[first:gap]):
            break
        first = later
    return first


def _looks_like_header(line: str) -> bool:
    return any(len(split(line, separator)) > 1 for separator in ";\t,|")


def _columns(table: _Table, numbered: list[tuple[int, str]], file: str) -> tuple[Column, ...]:
    above = [split(line, table.separator) for _, line in numbered[: table.first]]
    line, header = numbered[table.first - 1][0], above[-1]
    units: list[str] = []
    if len(above) > 1 and len(above[-2]) == len(header) and _is_units_row(header):
        line, units, header = numbered[table.first - 2][0], header, above[-2]
    _require_width(table, numbered, header, line, file)
    columns = []
    for index in range(table.width):
        name = header[index] if index < len(header) else ""
        unit = units[index].strip("[]() ") if index < len(units) else ""
        match = _NAME_WITH_UNIT.fullmatch(name)
        if match and not unit:
            name, unit = match[1], match[2] if match[2] is not None else match[3]
        columns.append(Column(index, name, unit.strip()))
    return tuple(columns)


def _require_width(
    table: _Table, numbered: list[tuple[int, str]], header: list[str], line: int, file: str
) -> None:
    """A header with fewer or more names than the rows have cells would shift every column."""
    rows = [split(text, table.separator) for _, text in numbered[table.first :]]
    beyond = any(any(row[len(header) :]) for row in rows if len(row) == table.width)
    if beyond or any(header[table.width :]):
        raise UnreadableLogError(
            f"{file}, line {line}: the header has {len(header)} cells where the rows have {table.width}: "
            "give every column a name"
        )


def _is_units_row(row: list[str]) -> bool:
    """Units of at least half of the cells that are not blank; no number, no name with a unit of its own."""
    filled = [cell.strip("[]() ") for cell in row if cell.strip()]
    if any(is_number(cell, False) for cell in filled) or any(
        _NAME_WITH_UNIT.fullmatch(c) for c in row if c[:1] not in "[("
    ):
        return False
    return bool(filled) and 2 * sum(_is_unit(cell) for cell in filled) >= len(filled)


def _is_unit(cell: str) -> bool:
    for kind in KINDS:
        try:
            return bool(conversion(kind, cell))
        except WrongKindError:
            return True
        except UnitError:
            continue
    return False


def _uses_decimal_comma(table: _Table, numbered: list[tuple[int, str]]) -> bool:
    cells = [c for _, line in numbered[table.first :] for c in split(line, table.separator)]
    commas = sum("," in cell and is_number(cell, True) for cell in cells)
    points = sum("." in cell and is_number(cell, False) for cell in cells)
    return commas > points
