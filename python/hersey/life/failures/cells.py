"""Cells of a table of specimens: ages with units, and how many specimens a row has."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import ChannelError, HerseyError, ParameterError, UnitError, UnreadableLogError
from hersey.files.headings import headings_of, separator_of
from hersey.files.tables import text_of
from hersey.files.text import read_table_text
from hersey.life.age import COUNTS, Age

#: Names of each column, the first as it is proposed.
NAMES = {
    "age": ("age", "life", "age at failure"),
    "low": ("low", "from", "after", "last good", "last ok", "lower"),
    "high": ("high", "to", "by", "first failed", "found failed", "upper"),
    "status": ("status", "event", "state"),
    "failed": ("failed", "failure"),
    "censored": ("censored", "suspended"),
    "count": ("count", "number", "quantity", "specimens"),
    "mode": ("mode", "failure mode", "cause"),
}
#: Names of other programs' sheets, which count only where no column has one of those above.
_OF_OTHERS = {
    "low": ("start", "left", "last inspected"),
    "high": ("end", "right", "state end time"),
    "age": ("time", "lifetime", "failure time", "time to failure", "time to f or s", "ttf"),
    "status": ("cens", "censor", "censoring", "f or s", "f/s", "state f or s"),
    "count": ("freq", "frequency", "n", "number in state", "qty"),
}
#: Headings that are the unit of the ages below them.
_UNITS = {each: each for each in ("hours", "minutes", "days", "months", "km", "miles")}
_UNITS |= {"hrs": "h"} | {f"{each}s": f"{each}s" for each in COUNTS}
#: Roles of which one says when, and of which one says whether a specimen failed.
AGES, STATES = ("age", "low", "high"), ("status", "failed", "censored")
_BARE = re.compile(r"[-+]?[0-9.]+([eE][-+]?[0-9]+)?")
#: What other programs write into a cell that has no value.
_NO_VALUE = frozenset(["*", ".", "-", "na", "n/a", "nan", "none"])


@dataclass(frozen=True)
class Table:
    """A table read: its name, columns by role with their units, other columns, and rows with their lines."""

    name: str
    at: dict[str, int]
    names: dict[str, str]  #: as they are in the file, without units
    units: dict[str, str]
    others: dict[str, tuple[int, str]]
    rows: list[tuple[int, list[str]]]
    listed: list[str]

    @property
    def columns(self) -> str:
        """The headings, to be shown in a message."""
        return (
            f"Columns: {', '.join(repr(cell) for cell in self.listed)}" if self.listed else "Line 1 is empty"
        )

    def cell(self, row: Sequence[str], role: str) -> str:
        """Return the text of a cell; empty if there is none."""
        place = self.at.get(role)
        cell = text_of(row[place].strip()) if place is not None and place < len(row) else ""
        return "" if cell.casefold() in _NO_VALUE else cell

    @property
    def states(self) -> list[str]:
        """Roles of the columns that say whether a specimen failed."""
        return [role for role in STATES if role in self.at]

    def place(self, line: int, role: str, heading: str = "") -> str:
        """Return where a cell stands, to begin a message."""
        return f"{self.name}, line {line}, column '{heading or self.names.get(role, role)}'"


def read_cells(path: Path) -> Table:
    """Read a table, separated by commas, semicolons or tabs.

    Raises
    ------
    HerseyError
        If it is no table, or two columns say the same.
    """
    lines = read_table_text(path).split("\n")
    try:
        rows = list(csv.reader(lines, delimiter=separator_of(lines[0])))
    except csv.Error as error:
        raise UnreadableLogError(f"{path.name} is not a table: {error}") from None
    headings = headings_of(rows[0]) if rows else []
    at = _roles(path.name, headings, rows[0] if rows else [])
    taken = set(at.values())
    others = {name: (i, unit) for i, (name, unit) in enumerate(headings) if name and i not in taken}
    units = {role: headings[i][1] or _UNITS.get(headings[i][0], "") for role, i in at.items()}
    of_ages = next(filter(None, (units.get(role) for role in AGES)), "")
    units |= {role: units[role] or of_ages for role in AGES if role in at}
    names = {role: re.split(r"[\[(]", rows[0][i])[0].strip() for role, i in at.items()}
    full = [(n, row) for n, row in enumerate(rows[1:], 2) if any(cell.strip() for cell in row)]
    listed = [cell.strip() for cell in rows[0] if cell.strip()] if rows else []
    return Table(path.name, at, names, units, others, full, listed)


def _roles(file: str, headings: Sequence[tuple[str, str]], written: Sequence[str]) -> dict[str, int]:
    """Which column has which role; ``written`` are the headings as they are in the file."""
    at: dict[str, int] = {}

    def look_for(role: str, names: Sequence[str]) -> None:
        places = [i for i, (name, _) in enumerate(headings) if name in names]
        if len(places) > 1:
            both = " and ".join(f"'{written[i].strip()}'" for i in places)
            raise ChannelError(f"{file}: columns {both} both say the {role}", remedy="delete one of them")
        if places:
            at[role] = places[0]

    for role, names in NAMES.items():
        look_for(role, names)
    known = {name for name, _ in headings}
    both = all(known.intersection(_OF_OTHERS[role]) for role in ("low", "high"))
    if both and at.keys().isdisjoint(AGES):
        look_for("low", _OF_OTHERS["low"])
        look_for("high", _OF_OTHERS["high"])
    if at.keys().isdisjoint(AGES):
        look_for("age", _OF_OTHERS["age"])
    if at.keys().isdisjoint(AGES):
        look_for("age", tuple(_UNITS))
    if at.keys().isdisjoint(STATES):
        look_for("status", _OF_OTHERS["status"])
    if "count" not in at:
        look_for("count", _OF_OTHERS["count"])
    return at


def age_of(table: Table, line: int, row: Sequence[str], role: str, unit: str) -> Age:
    """Return the age of a cell, in the unit of the ages before it (empty if there is none).

    Raises
    ------
    HerseyError
        If it is empty or no age, naming file, line and column.
    """
    cell = table.cell(row, role)
    if not cell:
        raise UnreadableLogError(f"{table.place(line, role)} is empty. Fill it in")
    if not table.units[role] and _BARE.fullmatch(cell):
        raise UnitError(
            f"{table.place(line, role)}: age '{cell[:40]}' has no unit",
            remedy=f"write it into the heading, e.g. '{table.names[role]} [h]'",
        )
    try:
        age = Age.parse(cell, table.units[role])
        return age.as_unit(unit) if unit else age
    except HerseyError as error:
        raise error.within(table.place(line, role)) from None


def above_zero(table: Table, line: int, role: str, age: Age) -> float:
    """Return an age that must be greater than 0.

    Raises
    ------
    ParameterError
        If it is not, naming file, line and column.
    """
    if age.value <= 0:
        raise ParameterError(f"{table.place(line, role)}: age {age} must be greater than 0")
    return age.value


def count_of(table: Table, line: int, row: Sequence[str]) -> int:
    """Return how many specimens a row has, 1 without such a column.

    Raises
    ------
    ParameterError
        If it is no whole number, naming file, line and column.
    """
    cell = table.cell(row, "count")
    if "count" not in table.at:
        return 1
    whole = re.fullmatch(r"([0-9]{1,9})(?:\.0*)?", cell)
    if whole is None or int(whole[1]) == 0:
        shown = f"'{cell[:40]}'" if cell else "empty"
        raise ParameterError(
            f"{table.place(line, 'count')} is {shown}: write a whole number of specimens, 1 or more"
        )
    return int(whole[1])
