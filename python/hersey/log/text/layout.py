"""Where the table starts in a delimited text file, and how its numbers are written."""

from __future__ import annotations

import codecs
import csv
import re
from dataclasses import dataclass, replace

import numpy as np

from hersey.errors import MAPPING, Setting, UnitError, UnreadableLogError, WrongKindError, printable
from hersey.log.text.numbers import NumberStyle, is_missing, looks_numeric, style_of
from hersey.log.text.stamps import StampStyle, counted_since, is_stamp, stamp_style
from hersey.log.text.unit_pairs import of_one_kind, same_unit
from hersey.units import KINDS, conversion

#: Bytes looked at; preambles of data loggers are far shorter.
SNIFFED = 1 << 17
#: What may stand between cells.
SEPARATORS = ";\t|,"
#: The separator that stands for any run of blanks and tabs.
BLANKS = " "
#: A name in a header between blanks, with the unit behind it.
_NAME = re.compile(r"[^\s\[(]+(?:[ \t]?(?:\[[^\[\]]*\]|\([^()]*\)))?|\S+")
_COMMENTS = ("#", "~", "//")
_NOT_CP1252 = (b"\x81", b"\x8d", b"\x8f", b"\x90", b"\x9d")
#: Columns of a table, and characters of a name at the most: no log has as many.
MOST_COLUMNS = 5000
LONGEST_NAME = 1000
#: ``Torque [N*m]`` or ``Torque (N*m)``; no part can match in two ways, so that the time is linear.
NAME_WITH_UNIT = re.compile(r"(.*?)(?:\[([^\[\]]*)\]|\(([^()]*)\))\s*")


@dataclass(frozen=True)
class Column:
    """A column of the file: position from 0, name and unit as written (unit empty if none).

    ``group`` is the part of the file in which the column stands, where there are several.
    """

    index: int
    name: str
    unit: str
    group: str = ""

    def __post_init__(self) -> None:
        """Spell out what a name may hold and no name needs; it is known by that spelling from here on."""
        for name in ("name", "unit", "group"):
            object.__setattr__(self, name, printable(getattr(self, name)))

    @property
    def path(self) -> str:
        """Name behind its group."""
        return f"{self.group}/{self.name}" if self.group else self.name

    def __str__(self) -> str:
        """Return name and unit as a header would show them."""
        return f"{self.path} [{self.unit}]" if self.unit else self.path


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
    notes: tuple[str, ...] = ()
    headless: str = ""

    @property
    def between(self) -> str:
        """What stands between the cells of a block of lines once it is read: blanks have become tabs."""
        return "\t" if self.separator == BLANKS else self.separator

    @property
    def named(self) -> tuple[Column, ...]:
        """The columns without those that have neither a name nor numbers."""
        return tuple(c for c in self.columns if not (c.name.startswith("#") and c.index in self.texts))


def find_layout(start: bytes, name: str, *, separators: str = SEPARATORS) -> Layout:
    """Return the layout of a text file from its first `SNIFFED` bytes.

    Raises
    ------
    UnreadableLogError
        If the bytes are no text, or hold no header followed by rows of numbers.
    """
    encoding = encoding_of(start, name)
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
    table = max((_table(numbered, separator) for separator in separators), key=lambda t: t.score)
    if separators == SEPARATORS:
        blanks = _table(numbered, BLANKS)
        if blanks.pure and blanks.score >= table.score and not (table.pure and table.rows >= blanks.rows):
            table = blanks
    refuse_columns(name, table.width)
    if table.score == 0:
        raise UnreadableLogError(
            f"{name} has a header but no rows of numbers below it"
            if _looks_like_header(numbered[-1][1])
            else f"{name} holds no table of numbers with at least two columns{_of_another_kind(name)}"
        )
    rows = [split(line, table.separator) for _, line in numbered[table.first :]]
    rows = [row for row in rows if len(row) == table.width]
    headless = _headless(table, numbered, name)
    columns = _columns(table, numbered, name) if not headless else _numbered_columns(table.width)
    columns, stamps = _with_stamps(columns, rows)
    style = style_of([cell for row in rows for cell in row])
    columns, notes = _with_epochs(columns, rows, style)
    texts = frozenset(c.index for c in columns if c.index not in stamps and _holds_words(rows, c.index))
    first_line = numbered[table.first][0]
    above = lines[: first_line - 1]
    comments = tuple(li.strip("# ~/")[:200] for li in above if li.startswith(comment))[:5]
    return Layout(
        encoding,
        table.separator,
        style,
        comment,
        columns,
        first_line,
        comments,
        stamps,
        texts,
        notes,
        headless,
    )


def refuse_columns(place: str, count: int) -> None:
    """Raise if a table has more columns than are read.

    Raises
    ------
    UnreadableLogError
        It says how many are.
    """
    if count > MOST_COLUMNS:
        raise UnreadableLogError(
            f"{place} has {count} columns: {MOST_COLUMNS} at the most are read, export those that matter"
        )


def refuse_long_name(place: str, column: int, name: str) -> None:
    """Raise if the name of a column, counted from 1, is longer than is read.

    Raises
    ------
    UnreadableLogError
        It says how long a name may be.
    """
    if len(name) > LONGEST_NAME:
        raise UnreadableLogError(
            f"{place}: the name of column {column} has {len(name)} characters: "
            f"{LONGEST_NAME} at the most are read"
        )


def refuse_ragged(place: str, rows: int, columns: int, size: int) -> None:
    """Raise if most rows lack cells: a file of ``size`` bytes would become a table many times as large.

    Raises
    ------
    UnreadableLogError
        It says how many cells the rows should have.
    """
    if rows * columns > 8 * size + 1_000_000:
        raise UnreadableLogError(
            f"{place}: most of its {rows} rows lack cells, {columns} are named: remove columns that are empty"
        )


@dataclass(frozen=True)
class _Table:
    separator: str
    width: int
    first: int
    score: int
    rows: int = 0
    pure: bool = False  # all its cells may be numbers


def tabbed(text: bytes) -> bytes:
    """Return lines in which each run of blanks and tabs between cells has become one tab."""
    return re.sub(rb"[ \t]+", b"\t", re.sub(rb"(?m)^[ \t]+|[ \t]+(?=\r?$)", b"", text))


def split(line: str, separator: str) -> list[str]:
    """Return the cells of a line, without surrounding blanks."""
    if separator == BLANKS:
        return line.split()
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]
    except csv.Error:  # a cell beyond the limit of the csv module
        return [cell.strip() for cell in line.split(separator)]


def encoding_of(start: bytes, name: str) -> str:
    """Return the encoding of a text file from its first bytes.

    Raises
    ------
    UnreadableLogError
        If the bytes are no text.
    """
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    if b"\0" in start:
        odd, even = start[1::2].count(0), start[::2].count(0)
        if max(odd, even) > 0.4 * len(start) and not min(odd, even):  # every other byte of plain text
            return "utf-16-le" if odd else "utf-16-be"
        raise UnreadableLogError(
            f"{name} is a binary file of a kind that is not known: export the channels as text"
        )
    try:
        codecs.getincrementaldecoder("utf-8")().decode(start)
    except UnicodeDecodeError:
        return "cp1252" if not any(code in start for code in _NOT_CP1252) else "latin-1"
    return "utf-8-sig"


def _table(numbered: list[tuple[int, str]], separator: str) -> _Table:
    """The longest reading of the lines as rows of numbers with this separator."""
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
        return _Table(separator, 0, 0, 0)
    rows = set(lines[width])
    first = _first_of_block([number in rows for number in range(len(numbered))])
    pure = scores[width] == width * len(rows)
    return _Table(separator, width, first, scores[width], len(rows), pure)


def _may_be_number(cell: str) -> bool:
    return is_missing(cell) or looks_numeric(cell) or is_stamp(cell)


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


def _looks_like_header(line: str) -> bool:
    return any(len(split(line, separator)) > 1 for separator in ";\t,|")


def _headless(table: _Table, numbered: list[tuple[int, str]], file: str) -> str:
    """Why the columns have no names, or nothing if a header stands above the rows."""
    above = numbered[table.first - 1][1] if table.first else ""
    if table.first and not all(
        looks_numeric(cell) or is_missing(cell) for cell in re.split(r"[;,|\s]+", above)
    ):
        return ""
    return f"{file}, line {numbered[table.first][0]}: no header stands above the numbers"


def _numbered_columns(width: int) -> tuple[Column, ...]:
    return tuple(Column(index, f"#{index + 1}", "") for index in range(width))


def _with_stamps(
    columns: tuple[Column, ...], rows: list[list[str]]
) -> tuple[tuple[Column, ...], dict[int, StampStyle]]:
    """Columns of time stamps, which are read in s whatever unit the header gives them."""
    stamps: dict[int, StampStyle] = {}
    for column in columns:
        style = stamp_style([row[column.index] for row in rows[:1000] if not is_missing(row[column.index])])
        if style is not None:
            stamps[column.index] = style
    return tuple(replace(c, unit="s") if c.index in stamps else c for c in columns), stamps


def _holds_words(rows: list[list[str]], index: int) -> bool:
    cells = [row[index] for row in rows[:1000] if not is_missing(row[index])]
    return not cells or 2 * sum(looks_numeric(cell) for cell in cells) < len(cells)


def _with_epochs(
    columns: tuple[Column, ...], rows: list[list[str]], style: NumberStyle
) -> tuple[tuple[Column, ...], tuple[str, ...]]:
    """Clocks without unit that count since 1970 or in days of Excel."""
    out, notes = [], []
    for column in columns:
        cells = [row[column.index] for row in rows[:1000]] if not column.unit else []
        numbers = np.array([style.value(cell) for cell in cells if style.is_number(cell)])
        unit, meaning = counted_since(column.name, numbers)
        if unit:
            notes.append(f"'{column.name}' has no unit and was read as {meaning}")
        out.append(replace(column, unit=unit or column.unit))
    return tuple(out), tuple(notes)


def _columns(table: _Table, numbered: list[tuple[int, str]], file: str) -> tuple[Column, ...]:
    above = [_names(line, table) for _, line in numbered[: table.first]]
    line, header = numbered[table.first - 1][0], above[-1]
    units: list[str] = []
    if len(above) > 1 and len(above[-2]) == len(header) and _is_units_row(header):
        line, units, header = numbered[table.first - 2][0], header, above[-2]
    _require_width(table, numbered, header, line, file)
    columns = []
    for index in range(table.width):
        name = header[index] if index < len(header) and header[index] else f"#{index + 1}"
        refuse_long_name(f"{file}, line {line}", index + 1, name)
        unit = units[index].strip("[]() ") if index < len(units) else ""
        match = NAME_WITH_UNIT.fullmatch(name)
        own = (match[2] if match[2] is not None else match[3]).strip() if match else ""
        if own and unit and of_one_kind(own, unit) and not same_unit(own, unit):
            raise UnreadableLogError(
                f"{file}, line {line}, column {index + 1}: the header says '{name}' and the row of units "
                f"{unit}: mend the one that is wrong"
            )
        if match and not unit:
            name, unit = match[1].rstrip() or f"#{index + 1}", match[2] if match[2] is not None else match[3]
        columns.append(Column(index, name, unit.strip()))
    return tuple(columns)


def _names(line: str, table: _Table) -> list[str]:
    """The cells of a line above the table; between blanks a name may have a unit, or a blank, of its own."""
    if table.separator != BLANKS:
        return split(line, table.separator)
    splits = (line.split(), _NAME.findall(line), re.split(r"\s{2,}|\t", line.strip()))
    return next((cells for cells in splits if len(cells) == table.width), splits[0])


def _of_another_kind(name: str) -> str:
    """What a file is that was given in the place of a log, by the ending of its name; or nothing."""
    if name.endswith(".toml"):
        machine, mapping = Setting("machine").to(), MAPPING.to()
        return f": a machine's file is given as {machine}, a mapping of the channels as {mapping}"
    return f": a fit that was saved is given as {Setting('fit').to()}" if name.endswith(".json") else ""


def _require_width(
    table: _Table, numbered: list[tuple[int, str]], header: list[str], line: int, file: str
) -> None:
    """A header with fewer or more names than the rows have cells would shift every column."""
    rows = [split(text, table.separator) for _, text in numbered[table.first :]]
    beyond = any(any(row[len(header) :]) for row in rows if len(row) == table.width)
    if beyond or any(header[table.width :]):
        raise UnreadableLogError(
            f"{file}, line {line}: the header has {len(header)} cells where the rows have {table.width}: "
            f"{_too_many(table, rows, len(header))}"
        )


def _too_many(table: _Table, rows: list[list[str]], named: int) -> str:
    """What to do where rows have more cells than the header: a comma within the numbers parts them too."""
    cells = [row for row in rows if len(row) == table.width]
    whole = cells and all(re.fullmatch(r"[-+]?\d+", cell.strip()) for row in cells for cell in row)
    if table.width < named:
        return "leave out the names that have no column"
    if table.separator != "," or table.width > 2 * named:
        return "give every column a name"
    if table.width == 2 * named and whole:
        return (
            "its numbers have decimal commas, and commas part its columns too: export it with ';' between "
            "the columns, or with decimal points"
        )
    return "give every column a name, or export it with ';' between the columns if a comma marks thousands"


def _is_units_row(row: list[str]) -> bool:
    """Units of at least half of the cells that are not blank; no number, no name with a unit of its own."""
    filled = [cell.strip("[]() ") for cell in row if cell.strip()]
    filled = [cell for cell in filled if cell not in ("1", "-")]  # units of a coefficient
    if any(looks_numeric(cell) for cell in filled) or any(
        NAME_WITH_UNIT.fullmatch(c) for c in row if c[:1] not in "[("
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
