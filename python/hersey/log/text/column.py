"""A column of a table: its name and unit as written, and what no column of a log has."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from hersey.errors import UnreadableLogError, printable
from hersey.log.words import NAMES

#: Columns of a table, and characters of a name at the most: no log has as many.
MOST_COLUMNS = 5000
LONGEST_NAME = 1000
#: ``Torque [N*m]`` or ``Torque (N*m)``; no part can match in two ways, so that the time is linear.
NAME_WITH_UNIT = re.compile(r"(.*?)(?:\[([^\[\]]*)\]|\(([^()]*)\))\s*")
#: Units that a name may end with: ``torque_Nm``, ``t_s``.
_ENDINGS = {
    "s": "s",
    "ms": "ms",
    "us": "us",
    "Nm": "N*m",
    "N_m": "N*m",
    "mNm": "mN*m",
    "Ncm": "N*cm",
    "kNm": "kN*m",
    "N": "N",
    "rpm": "rpm",
    "m_s": "m/s",
    "mm_s": "mm/s",
    "rad_s": "rad/s",
    "m/s": "m/s",
    "mm/s": "mm/s",
    "rad/s": "rad/s",
    "deg/s": "deg/s",
    "N*m": "N*m",
    "degC": "degC",
    "degF": "degF",
    "C": "degC",
    "K": "K",
    "A": "A",
    "mA": "mA",
    "mm": "mm",
    "um": "um",
    "deg": "deg",
    "rad": "rad",
}
_LONGEST_FIRST = sorted(_ENDINGS, key=len, reverse=True)
_CLOCK = re.compile(rf"t|.*time.*|.*zeit.*|.*(elapsed|clock|stamp).*|{NAMES['time']}", re.IGNORECASE)
#: Names beside which a short ending is a unit: a phase A, a type K, a static or sliding quantity is none.
_MEANT = {
    **dict.fromkeys(("s", "ms", "us"), _CLOCK),
    **dict.fromkeys(("C", "K"), re.compile(rf"T|.*temp.*|{NAMES['temperature']}", re.IGNORECASE)),
    "N": re.compile(r".{2,}"),
    "A": re.compile(r"i_?[qd](_.*)?|i_?rms|.*motor_?(current|strom)", re.IGNORECASE),
    "deg": re.compile(r"(?!.*temp).*", re.IGNORECASE),
}


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


def name_and_unit(text: str) -> tuple[str, str] | None:
    """Return name and unit of a column called ``Torque [N*m]`` or ``Torque (N*m)``, None of any other."""
    match = NAME_WITH_UNIT.fullmatch(text)
    return match and (match[1].strip(), (match[2] if match[2] is not None else match[3]).strip())


def split_unit(name: str) -> tuple[str, str]:
    """Return name and unit of a column called ``Torque [N*m]``, ``Torque (N*m)`` or ``torque_Nm``.

    Examples
    --------
    >>> split_unit("torque_mNm"), split_unit("Drehmoment (Ncm)"), split_unit("v_s")
    (('torque', 'mN*m'), ('Drehmoment', 'Ncm'), ('v_s', ''))
    """
    if named := name_and_unit(name):
        return named
    for ending in _LONGEST_FIRST:
        plain = name.removesuffix(f"_{ending}")
        if plain and plain != name and (ending not in _MEANT or _MEANT[ending].fullmatch(plain)):
            return plain, _ENDINGS[ending]
    return name, ""


def with_ending(name: str, unit: str) -> set[str]:
    """Return how a name may have been written with its unit at the end."""
    return {f"{name}_{ending}" for ending, meant in _ENDINGS.items() if meant == unit} | {f"{name}_{unit}"}


def distinct_names(columns: Sequence[Column]) -> list[str]:
    """Return the path of each column; where several have one, with its number among them, ``name#2``."""
    counts, seen = Counter(column.path for column in columns), Counter[str]()
    names = []
    for path in (column.path for column in columns):
        seen[path] += 1
        names.append(f"{path}#{seen[path]}" if counts[path] > 1 else path)
    return names


def refuse_columns(place: str, count: int) -> None:
    """Raise if a table has more columns than are read.

    Raises
    ------
    UnreadableLogError
        It says how many are.
    """
    if count > MOST_COLUMNS:
        raise UnreadableLogError(
            f"{place} has {count} columns; at most {MOST_COLUMNS} are read. Export only those you need"
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
            f"{place}: the name of column {column} has {len(name)} characters; at most {LONGEST_NAME} "
            "are read"
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
            f"{place}: most of the {rows} rows have fewer cells than the {columns} columns. Delete "
            "empty columns"
        )
