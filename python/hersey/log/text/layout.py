"""Where the table starts in a delimited text file, and how its numbers are written."""

from __future__ import annotations

import itertools
import json
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import MAPPING, Setting, UnreadableLogError, way_in
from hersey.files import text as text_files
from hersey.log.text.column import Column, refuse_columns, split_unit
from hersey.log.text.dated_numbers import was_number
from hersey.log.text.header import Numbered, columns_of, commented_header
from hersey.log.text.numbers import NumberStyle, is_missing, looks_numeric, style_of
from hersey.log.text.orientation import refuse_long, refuse_transposed
from hersey.log.text.separators import BLANKS, SEPARATORS, NumberRows, number_rows, split
from hersey.log.text.stamps import OF_WINCC, StampStyle, clock_without_unit, counted_unit, stamp_style
from hersey.log.text.units_in_cells import WITH_UNIT, numbers_only
from hersey.schema.warning import Warning

#: Bytes looked at; preambles of data loggers are far shorter.
SNIFFED = 1 << 17
#: Lines that a quoted cell of a header has at the most.
_LINES_OF_A_CELL = 10
#: Layouts kept, each with the bytes that were looked at.
_KEPT = 8
_COMMENTS = ("#", "~", "//")


#: How JSON of objects begins, and what a result of this package in JSON states.
_JSON = re.compile(r'\s*\[?\s*\{\s*"')
_RESULT = '"hersey_version"'


@dataclass(frozen=True)
class Layout:
    """How to read the table: ``first_line`` is the line of the first row, counted from 1.

    ``stamps`` tells how time stamps are written, by index of the column that holds them; ``texts`` are the
    columns that hold words; ``headless`` is why the columns have no names, or empty.
    """

    encoding: str
    separator: str
    style: NumberStyle
    comment: str
    columns: tuple[Column, ...]
    first_line: int
    comments: tuple[str, ...]
    stamps: dict[int, StampStyle]
    texts: frozenset[int] = frozenset()
    warnings: tuple[Warning, ...] = ()
    headless: str = ""

    @property
    def between(self) -> str:
        """What stands between the cells of a block of lines once it is read: blanks have become tabs."""
        return "\t" if self.separator == BLANKS else self.separator

    @property
    def named(self) -> tuple[Column, ...]:
        """The columns without those that have neither a name nor numbers."""
        return tuple(c for c in self.columns if not (c.name.startswith("#") and c.index in self.texts))


def find_layout(start: bytes, name: str, *, separators: str = SEPARATORS, long: bool = False) -> Layout:
    """Return the layout of a text file from its first `SNIFFED` bytes; ``long``: rows name their channels.

    Raises
    ------
    UnreadableLogError
        If the bytes are no text, or hold no header followed by rows of numbers.
    """
    return _layout(start, name, separators, long, way_in())


@lru_cache(maxsize=_KEPT)
def _layout(start: bytes, name: str, separators: str, long: bool, _way_in: str) -> Layout:
    """The layout, kept because each who opens a file looks for it; its words suit the way in."""
    encoding = encoding_of(start, name)
    lines = _lines(start, encoding, name, separators)
    _refuse_json("\n".join(lines), name)
    comment = next((c for c in _COMMENTS if any(line.startswith(c) for line in lines)), "#")
    numbered = [
        (number, line)
        for number, line in _joined(lines, comment, separators)
        if line.strip() and not line.lstrip().startswith(comment)
    ]
    refuse_transposed(name, [line for _, line in numbered], separators)
    table = _table(numbered, separators, name)
    if not table.first and (commented := _in_comment(lines, numbered[0][0], comment, table)):
        numbered, table = [commented, *numbered], replace(table, first=1)
    rows = [split(line, table.separator) for _, line in numbered[table.first :]]
    rows = [row for row in rows if len(row) == table.width]
    columns, headless = columns_of(table, numbered, name)
    header = split(numbered[table.first - 1][1], table.separator) if table.first else []
    columns, stamps = _with_stamps(columns, rows)
    style = style_of([cell for row in rows for cell in row])
    columns, warnings = _with_epochs(columns, rows, style, [] if headless else header)
    texts = frozenset(c.index for c in columns if c.index not in stamps and _holds_words(rows, c))
    if not headless and not long:
        refuse_long(name, columns, texts, stamps, rows, header)
    first_line = numbered[table.first][0]
    comments = tuple(li.strip("# ~/")[:200] for li in lines[: first_line - 1] if li.startswith(comment))
    return Layout(
        encoding=encoding,
        separator=table.separator,
        style=style,
        comment=comment,
        columns=columns,
        first_line=first_line,
        comments=comments[:5],
        stamps=stamps,
        texts=texts,
        warnings=warnings,
        headless=headless,
    )


def _lines(start: bytes, encoding: str, name: str, separators: str) -> list[str]:
    """The lines of the text that are whole."""
    text = start.decode(encoding, errors="replace")
    if "\r" in text and "\n" not in text:
        raise UnreadableLogError(
            f"{name}: lines end with CR only. Save the file with ordinary line ends (LF or CR LF)"
        )
    lines = [line.rstrip("\r") for line in text.split("\n")]
    if len(start) >= SNIFFED:
        cut, lines = lines[-1], lines[:-1]
        if not any(line.strip() for line in lines):
            for separator in separators:  # the last cell may be cut off
                refuse_transposed(name, [cut.rpartition(separator)[0]], separator, whole=False)
            raise UnreadableLogError(
                f"{name} is not a table: its first line has more than {SNIFFED} characters"
            )
    return lines


def _joined(lines: list[str], comment: str, separators: str) -> Iterator[tuple[int, str]]:
    """Lines with the number of each; line ends within a quoted cell become blanks.

    A quote that opens no cell, or none that ends soon, is one of text.
    """
    opening = re.compile(rf'(^|[{re.escape(separators)}])\s*"')
    number = 0
    while number < len(lines):
        cell, count = [lines[number]], 1
        if cell[0].count('"') % 2 and opening.search(cell[0]) and not cell[0].lstrip().startswith(comment):
            ahead = lines[number + 1 : number + _LINES_OF_A_CELL]
            parities = itertools.accumulate((line.count('"') for line in ahead), initial=1)
            whole = next((n for n, quotes in enumerate(parities) if quotes % 2 == 0), 0)
            cell += ahead[:whole]
            count += whole
        yield number + 1, " ".join(cell)
        number += count


def _in_comment(lines: list[str], first: int, comment: str, table: NumberRows) -> Numbered | None:
    """The header in a comment above the first row, as NumPy and gnuplot write it."""
    above = next((i for i in range(first - 2, -1, -1) if lines[i].strip()), None)
    if above is None or not lines[above].lstrip().startswith(comment):
        return None
    header = commented_header(lines[above], table)
    return (above + 1, header) if header else None


def _table(numbered: list[Numbered], separators: str, name: str) -> NumberRows:
    """The longest rows of numbers that a separator makes."""
    if not numbered:
        raise UnreadableLogError(f"{name} is empty. A log needs a header and rows of numbers")
    table = max((number_rows(numbered, each) for each in separators), key=lambda t: t.score)
    if separators == SEPARATORS:
        blanks = number_rows(numbered, BLANKS)
        if blanks.pure and blanks.score >= table.score and not (table.pure and table.rows >= blanks.rows):
            table = blanks
    refuse_columns(name, table.width)
    if table.score == 0:
        for each in separators:
            _refuse_runs(numbered, each, name)
            _refuse_long_words(numbered, each, name)
            _refuse_units_in_cells(numbered, each, name)
        raise UnreadableLogError(
            f"{name} has a header but no rows of numbers"
            if any(len(split(numbered[-1][1], each)) > 1 for each in SEPARATORS)
            else f"{name} has no table of numbers with at least two columns{_of_another_kind(name)}"
        )
    return table


def _refuse_json(text: str, name: str) -> None:
    """Raise if a text is JSON and not a table."""
    if not _JSON.match(text):
        return
    first, _, rest = text.lstrip().partition("\n")
    if rest.strip() and not rest.lstrip().startswith("{") and _is_json(first):
        return  # a line of settings above a table
    if _RESULT not in text:
        raise UnreadableLogError(f"{name} is JSON, not a table. Export the channels as text (CSV)")
    fit = f"; where a command takes a saved fit, use {Setting('fit').to()}" * (way_in() == "terminal")
    raise UnreadableLogError(f"{name} is a result of hersey, not a log. Give the log itself{fit}")


def _is_json(line: str) -> bool:
    try:
        return isinstance(json.loads(line), dict)
    except ValueError:
        return False


def _refuse_runs(numbered: list[Numbered], separator: str, name: str) -> None:
    """Raise if a table lists the runs of a life test."""
    if {"log", "unit", "age"} <= {split_unit(cell)[0].lower() for cell in split(numbered[0][1], separator)}:
        raise UnreadableLogError(
            f"{name} is a table of the runs of a life test, not a log. Give one of its logs"
        )


def _refuse_long_words(numbered: list[Numbered], separator: str, name: str) -> None:
    """Raise if rows of words and few numbers are those of a long table."""
    rows = [split(line, separator) for _, line in numbered]
    width = Counter(map(len, rows)).most_common(1)[0][0]
    header, *rows = [row for row in rows if len(row) == width]
    columns, stamps = _with_stamps(tuple(Column(i, cell, "") for i, cell in enumerate(header)), rows)
    texts = {c.index for c in columns if c.index not in stamps and _holds_words(rows, c)}
    refuse_long(name, columns, texts, stamps, rows, header)


def _refuse_units_in_cells(numbered: list[Numbered], separator: str, name: str) -> None:
    """Raise if the cells of the rows are numbers with their units."""
    number, last = numbered[-1]
    cells = split(last, separator)
    found = [(i, match) for i, cell in enumerate(cells) if (match := WITH_UNIT.fullmatch(cell))]
    if len(cells) < 2 or 2 * len(found) < len(cells):
        return
    rows = [row for _, line in numbered if len(row := split(line, separator)) == len(cells)]
    names = next((row for row in rows if not any(map(WITH_UNIT.fullmatch, row))), cells)
    index, _ = found[0]
    named = Column(index, split_unit(names[index])[0], "")
    raise UnreadableLogError(
        f"{name}, line {number}: the cells hold units, e.g. '{cells[index]}'",
        remedy=numbers_only(named, cells[index]),
    )


def encoding_of(start: bytes, name: str) -> str:
    """Return the encoding of a text file from its first bytes.

    Raises
    ------
    UnreadableLogError
        If the bytes are no text.
    """
    encoding = text_files.encoding_of(start)
    if not encoding:
        raise UnreadableLogError(
            f"{name} is a binary file of an unknown format. Export the channels as text (CSV)"
        )
    return encoding


def _with_stamps(
    columns: tuple[Column, ...], rows: list[list[str]]
) -> tuple[tuple[Column, ...], dict[int, StampStyle]]:
    """Columns of time stamps, which are read in s whatever unit the header gives them."""
    stamps: dict[int, StampStyle] = {}
    for column in columns:
        cells = [row[column.index] for row in rows[:1000] if not is_missing(row[column.index])]
        style = stamp_style([cell for cell in cells if not was_number(column.name, cell)])
        if style is not None:
            stamps[column.index] = style
    return tuple(replace(c, unit="s") if c.index in stamps else c for c in columns), stamps


def _holds_words(rows: list[list[str]], column: Column) -> bool:
    cells = [row[column.index] for row in rows[:1000] if not is_missing(row[column.index])]
    numbers = sum(looks_numeric(cell) or was_number(column.name, cell) for cell in cells)
    return not cells or 2 * numbers < len(cells)


def _with_epochs(
    columns: tuple[Column, ...], rows: list[list[str]], style: NumberStyle, header: list[str]
) -> tuple[tuple[Column, ...], tuple[Warning, ...]]:
    """Clocks without unit that count since 1970 or in days of Excel, and ``Time_ms`` of WinCC."""
    out, warnings = [], []
    for column in columns:
        name = OF_WINCC if header[column.index : column.index + 1] == [OF_WINCC] else column.name
        unit, meaning = counted_unit(name, column.unit, partial(_numbers, rows, column, style))
        if unit:
            warnings.append(clock_without_unit(name, meaning))
            column = replace(column, name=name, unit=unit)  # whose ending is not its unit
        out.append(column)
    return tuple(out), tuple(warnings)


def _numbers(rows: list[list[str]], column: Column, style: NumberStyle) -> FloatArray:
    """The numbers of a column in the first rows."""
    cells = [row[column.index] for row in rows[:1000]]
    return np.array([style.value(cell) for cell in cells if style.is_number(cell)])


def _of_another_kind(name: str) -> str:
    """What a file is that was given in the place of a log, by the ending of its name; or nothing."""
    if name.endswith(".toml"):
        machine, mapping = Setting("machine").to(), MAPPING.to()
        return f". Give a machine file with {machine}, or a mapping of channels with {mapping}"
    return ""
