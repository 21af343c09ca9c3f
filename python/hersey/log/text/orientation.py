"""Tables whose channels are not columns: they stand in rows, or one column names the channel of each row."""

from __future__ import annotations

import re
from collections.abc import Collection

from hersey.errors import HerseyError, UnreadableLogError
from hersey.log.channels import ChannelChoice, find_channel
from hersey.log.roles import ROLES, is_called
from hersey.log.text.column import Column, split_unit
from hersey.log.text.numbers import is_missing, looks_numeric
from hersey.log.text.separators import split
from hersey.log.text.stamps import is_stamp

#: Numbers in a row of a channel at the least, and columns that Excel can hold.
_LEAST, _WIDTH_OF_EXCEL = 20, 16384
#: Names of channels in one column at the most, names shown, and rows looked at.
_MOST, _SHOWN, _ROWS = 200, 8, 1000
_VALUE = re.compile(r".*(value|wert|valeur|valor|reading).*|val", re.IGNORECASE)


def refuse_transposed(place: str, lines: list[str], separators: str, *, whole: bool = True) -> None:
    """Raise if each line is the name of a channel and then its numbers; ``whole`` is whether all are there.

    Raises
    ------
    UnreadableLogError
        It names the first channels, and how to turn the table.
    """
    for separator in separators:
        if all(line.count(separator) < _LEAST for line in lines):
            continue
        rows = [[cell for cell in split(line, separator) if cell] for line in lines]
        rows = [row for row in rows if len(row) > 1]  # without a title
        names = [row[0] for row in rows]
        width = max(map(len, rows), default=0)
        if len(rows) < width and len(set(names)) == len(names) and all(map(_is_channel, rows)):
            way = "transpose the table (in Excel: copy it, then Paste Special with 'Transpose')"
            if not whole or width > _WIDTH_OF_EXCEL:
                way = "write it with one column per channel (it is too wide for Excel)"
            raise UnreadableLogError(
                f"{place}: the channels stand in rows, not in columns ({_listed(names)})", remedy=way
            )


def _is_channel(row: list[str]) -> bool:
    """Whether a row is a name, perhaps a unit, and numbers."""
    numbers = sum(map(_is_number, row[1:]))
    return row[0][:1].isalpha() and not _is_number(row[0]) and numbers >= _LEAST and numbers >= len(row) - 2


def _is_number(cell: str) -> bool:
    return is_missing(cell) or looks_numeric(cell) or is_stamp(cell)


def refuse_long(
    place: str,
    columns: tuple[Column, ...],
    texts: Collection[int],
    stamps: Collection[int],
    rows: list[list[str]],
    header: list[str],
) -> None:
    """Raise if a column of words, one of ``texts``, names the channel of each row; ``header`` is as written.

    Its words name roles of a log that no column plays, or all of them come once per time.

    Raises
    ------
    UnreadableLogError
        It names that column, the channels, and how to make a column of each.
    """
    numeric = tuple(column for column in columns if column.index not in texts)
    if not texts or _has_torque(numeric):
        return
    clocks = [c for c in numeric if c.index in stamps or is_called("time", c)]
    clocks.sort(key=lambda c: len({row[c.index] for row in rows[:_ROWS]}), reverse=True)  # finest first
    others = [column for column in numeric if column not in clocks]
    if not clocks or not others:
        return
    values = [column for column in others if _VALUE.fullmatch(column.name)]
    for column in columns:
        if column.index not in texts:
            continue
        words = [row[column.index] for row in rows[:_ROWS]]
        names = list(dict.fromkeys(word for word in words if not is_missing(word)))
        if not names or len(names) > _MOST:
            continue
        roles = {role for role in ROLES[1:] for name in names if _names(role, name)}
        cycles = any(_in_cycles(words, [row[c.index] for row in rows[:_ROWS]], len(names)) for c in clocks)
        if len(roles) > 1 or (roles and values) or cycles:
            listed = _listed(names) if len(names) > 1 else f"first {names[0][:60]}"
            value = f"'{values[0].name}'" if values else "the column of values"
            raise UnreadableLogError(
                f"{place} is a long table: column '{column.name}' names the channel of each row "
                f"({listed}). A log needs one column per channel and one row per time",
                remedy="export it that way, or insert a PivotTable in Excel: "
                f"'{_written(clocks[0], header)}' as rows (not grouped), '{column.name}' as columns, "
                f"the average of {value} as values",
            )


def _written(column: Column, header: list[str]) -> str:
    """The name of a column with the unit that it ends with."""
    return next((cell for cell in header if split_unit(cell)[0] == column.name), column.name)


def _has_torque(columns: tuple[Column, ...]) -> bool:
    try:
        return find_channel("torque", columns, ChannelChoice(), "") is not None
    except HerseyError:  # several, or one without a unit
        return True


def _names(role: str, name: str) -> bool:
    return len(name) > 1 and is_called(role, Column(0, name, ""))


def _in_cycles(words: list[str], times: list[str], count: int) -> bool:
    """Whether all words follow each other again and again, at one time each round."""
    rounds = len(words) // count
    if count < 2 or rounds < _LEAST or words[: rounds * count] != words[:count] * rounds:
        return False
    return len(set(times)) > 1 and all(
        len(set(times[at : at + count])) == 1 for at in range(0, rounds * count, count)
    )


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(name[:60] for name in names[:_SHOWN]) + more
