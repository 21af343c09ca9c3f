"""The lines above a table: names and units of its columns."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace

from hersey.errors import UnitError, UnreadableLogError, WrongKindError
from hersey.log.signals import is_signal
from hersey.log.text.column import Column, name_and_unit, refuse_long_name, split_unit
from hersey.log.text.decimal_commas import with_decimal_commas
from hersey.log.text.numbers import is_missing, looks_numeric
from hersey.log.text.separators import BLANKS, SEPARATORS, NumberRows, split
from hersey.log.text.unit_pairs import of_one_kind, same_unit
from hersey.units import KINDS, conversion

#: A line of the text with its number, counted from 1.
Numbered = tuple[int, str]
#: A data type of a panel or a logger.
_TYPE = re.compile(
    r"(L?REAL|[US]?D?INT|L?INT|D?WORD|BYTE|BOOL|STRING|(DATE_AND_)?TIME|DOUBLE|U?INT\d+|(FLOAT|REAL)\d*)",
    re.IGNORECASE,
)
#: What stands between a name and its unit, where it is no bracket (DIN 1313 has a stroke).
_BEFORE_UNITS = (" / ", " in ", ", ")
#: A name in a header between blanks, with the unit behind it.
_NAME = re.compile(r"[^\s\[(]+(?:[ \t]?(?:\[[^\[\]]*\]|\([^()]*\)))?|\S+")


def columns_of(table: NumberRows, numbered: list[Numbered], file: str) -> tuple[tuple[Column, ...], str]:
    """Return the columns of a table, and why they have no names, or nothing.

    Raises
    ------
    UnreadableLogError
        If the header does not fit the rows, or contradicts itself.
    """
    if headless := _headless(table, numbered, file):
        return tuple(Column(index, f"#{index + 1}", "") for index in range(table.width)), headless
    above = [(number, _names(line, table)) for number, line in numbered[: table.first]]
    above = [row for row in above[:-1] if not _are_types(row[1])] + above[-1:]
    if len(above) > 1 and _are_types(above[-1][1]):
        del above[-1]
    line, header = above[-1]
    units: list[str] = []
    if len(above) > 1 and len(above[-2][1]) == len(header) and is_units_row(header):
        units, (line, header) = header, above[-2]
    units = units or _of_oscilloscope([row for _, row in above[:-1]], len(header))
    _require_width(table, numbered, header, line, file)
    columns = []
    for index in range(table.width):
        name = header[index] if index < len(header) and header[index] else f"#{index + 1}"
        refuse_long_name(f"{file}, line {line}", index + 1, name)
        unit = units[index].strip("[]() ") if index < len(units) else ""
        plain, own = _own_unit(name)
        if own and unit and of_one_kind(own, unit) and not same_unit(own, unit):
            raise UnreadableLogError(
                f"{file}, line {line}, column {index + 1}: the header says '{name}', but the row of "
                f"units says {unit}. Correct one of them"
            )
        columns.append(Column(index, name if unit else plain or f"#{index + 1}", unit or own))
    return _with_endings(tuple(columns)), ""


def commented_header(above: str, table: NumberRows) -> str:
    """Return the header in a comment just above the rows, without its sign; nothing if it is another comment.

    It has a name for each column, no number, and at least two units in brackets or at the ends of names.
    """
    line = above.lstrip("#~/ \t")
    names = _names(line, table)
    units = sum(_is_unit((name_and_unit(name) or split_unit(name))[1]) for name in names)
    if len(names) != table.width or units < 2 or any(looks_numeric(name) or not name for name in names):
        return ""
    return line


def _with_endings(columns: tuple[Column, ...]) -> tuple[Column, ...]:
    """The columns with the units at the end of their names; a name that another has stays whole."""
    split = [split_unit(c.name) if not c.unit else (c.name, c.unit) for c in columns]
    split = [(name, unit) if unit else _behind_sign(name) for name, unit in split]
    counts = Counter(name for name, _ in split)
    return tuple(
        replace(c, name=name if counts[name] == 1 else c.name, unit=unit)
        for c, (name, unit) in zip(columns, split, strict=True)
    )


def _own_unit(name: str) -> tuple[str, str]:
    """Name and unit of a column; a remark in brackets, such as a serial number, is neither."""
    plain, own = name_and_unit(name) or (name, "")
    if own and not _is_unit(own) and (before := _behind_sign(plain))[1]:
        return before
    return plain, own


def _behind_sign(name: str) -> tuple[str, str]:
    """Name and unit of a column called ``M / Nm``, ``n in 1/min`` or ``Torque, mNm``; no unit otherwise."""
    for sign in _BEFORE_UNITS:
        plain, _, unit = name.partition(sign)
        if plain.strip() and unit.strip() and _is_unit(unit.strip()):
            return plain.strip(), unit.strip()
    return name, ""


def _names(line: str, table: NumberRows) -> list[str]:
    """The cells of a line above the table; between blanks a name may have a unit, or a blank, of its own.

    A header may have another separator than the rows.
    """
    if table.separator not in line and table.separator != BLANKS:
        others = (split(line, each) for each in SEPARATORS if each in line)
        return next((cells for cells in others if len(cells) == table.width), split(line, table.separator))
    if table.separator != BLANKS:
        return split(line, table.separator)
    splits = (line.split(), _NAME.findall(line), re.split(r"\s{2,}|\t", line.strip()))
    return next((cells for cells in splits if len(cells) == table.width), splits[0])


def _headless(table: NumberRows, numbered: list[Numbered], file: str) -> str:
    """Why the columns have no names, or nothing if a header stands above the rows."""
    above = numbered[table.first - 1][1] if table.first else ""
    cells = re.split(r"[;,|\s]+", above)
    if table.first and not all(looks_numeric(cell) or is_missing(cell) for cell in cells):
        return ""
    return f"{file}, line {numbered[table.first][0]}: there is no header above the numbers"


def _require_width(
    table: NumberRows, numbered: list[Numbered], header: list[str], line: int, file: str
) -> None:
    """A header with fewer or more names than the rows have cells would shift every column."""
    rows = [split(text, table.separator) for _, text in numbered[table.first :]]
    rows = [row for row in rows if len(row) == table.width]
    named = max((index + 1 for index, name in enumerate(header) if name), default=0)
    cut = with_decimal_commas(rows, named) if table.separator == "," else ""
    beyond = any(any(row[len(header) :]) for row in rows)
    if beyond or any(header[table.width :]) or cut:
        raise UnreadableLogError(
            f"{file}, line {line}: the header has {named if cut else len(header)} cells, but the rows have "
            f"{table.width}. {cut or _misfit(table, len(header))}"
        )


def _misfit(table: NumberRows, named: int) -> str:
    """What to do where the rows have more or fewer cells than the header."""
    if table.width < named:
        return "Delete the names that have no column"
    if table.separator != "," or table.width > 2 * named:
        return "Give every column a name"
    return "Give every column a name. If a comma separates thousands, export with ';' between the columns"


def _are_types(row: list[str]) -> bool:
    """Whether a row names only data types, as panels write them below the names."""
    filled = [cell for cell in row if cell]
    return len(filled) > 1 and all(_TYPE.fullmatch(cell) for cell in filled)


def _of_oscilloscope(above: list[list[str]], width: int) -> list[str]:
    """Units of the time and of each channel, as an oscilloscope writes them in rows of their own."""
    rows = {row[0].lower().rstrip(":"): row[1:] for row in above if len(row) > 1}
    time, channels = rows.get("horizontal units"), rows.get("vertical units")
    if not time or not channels or len(channels) != width - 1 or not all(map(_is_unit, channels)):
        return []
    return [time[0].lower(), *channels]


def is_units_row(row: list[str]) -> bool:
    """Return whether at least half of the cells that are not blank are units.

    None may be a number, or a name with a unit of its own.
    """
    filled = [cell.strip("[]() ") for cell in row if cell.strip()]
    filled = [cell for cell in filled if cell not in ("1", "-")]  # units of a coefficient
    named = any(name_and_unit(cell) for cell in row if cell[:1] not in "[(")
    if named or any(looks_numeric(cell) for cell in filled):
        return False
    return bool(filled) and 2 * sum(_is_unit(cell) for cell in filled) >= len(filled)


def _is_unit(cell: str) -> bool:
    if is_signal(cell):
        return True
    for kind in KINDS:
        try:
            return bool(conversion(kind, cell))
        except WrongKindError:
            return True
        except UnitError:
            continue
    return False
