"""Cells of a table of specimens: ages with units, and how many specimens a row has."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import ChannelError, HerseyError, ParameterError, UnreadableLogError
from hersey.files.headings import headings_of, separator_of
from hersey.files.tables import text_of
from hersey.files.text import read_table_text
from hersey.life.age import Age

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


@dataclass(frozen=True)
class Table:
    """A table read: its name, columns by role with their units, other columns, and rows with their lines."""

    name: str
    at: dict[str, int]
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
        return text_of(row[place].strip()) if place is not None and place < len(row) else ""

    def place(self, line: int, role: str, heading: str = "") -> str:
        """Return where a cell stands, to begin a message."""
        return f"{self.name}, line {line}, column '{heading or NAMES[role][0]}'"


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
    at: dict[str, int] = {}
    for role, names in NAMES.items():
        places = [i for i, (name, _) in enumerate(headings) if name in names]
        if len(places) > 1:
            both = " and ".join(f"'{rows[0][i].strip()}'" for i in places)
            raise ChannelError(
                f"{path.name}: columns {both} both say the {role}", remedy="delete one of them"
            )
        if places:
            at[role] = places[0]
    taken = set(at.values())
    others = {name: (i, unit) for i, (name, unit) in enumerate(headings) if name and i not in taken}
    units = {role: headings[i][1] for role, i in at.items()}
    full = [(n, row) for n, row in enumerate(rows[1:], 2) if any(cell.strip() for cell in row)]
    listed = [cell.strip() for cell in rows[0] if cell.strip()] if rows else []
    return Table(path.name, at, units, others, full, listed)


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
    if not (cell.isascii() and cell.isdigit() and 0 < int(cell) < 10**9):
        shown = f"'{cell[:40]}'" if cell else "empty"
        raise ParameterError(
            f"{table.place(line, 'count')} is {shown}: write a whole number of specimens, 1 or more"
        )
    return int(cell)
