"""A table of runs: a row for each file, with its speed, load, radius or temperature."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hersey.errors import ParameterError, UnitError, meant
from hersey.files.text import read_table_text
from hersey.log import formats
from hersey.log.cell_table import CellTable, cells_of
from hersey.log.derived.file_names import ROLES
from hersey.log.layouts.current import reading_by
from hersey.log.roles import is_called, role_conversion
from hersey.log.text.column import Column, split_unit
from hersey.log.text.numbers import style_of
from hersey.log.text.separators import split

#: Names of the column of the files.
_FILE = re.compile(r"file|file ?name|log|name|datei", re.IGNORECASE)


@dataclass(frozen=True)
class RunTable:
    """What a table says of each file: number and unit by role."""

    name: str
    units: Mapping[str, str]
    rows: Mapping[str, Mapping[str, str]]  #: by the name of the file

    def values(self, name: str) -> Mapping[str, str]:
        """Return number and unit of each role of a file.

        Raises
        ------
        ParameterError
            If the table does not list it.
        """
        if name in self.rows:
            return self.rows[name]
        near = meant(name, list(self.rows))
        listed = f". Did you mean '{near}' there?" if near else ""
        raise ParameterError(f"{self.name} does not list {name}{listed}", remedy="add a row for it")


def read_run_table(path: str | Path) -> RunTable:
    """Return what a table with a column ``file``, and others such as ``load [N]``, says of each file.

    Raises
    ------
    HerseyError
        It names the table, and the column or the row.
    """
    path = Path(path)
    cells = _cells(path)
    listed = ", ".join(f"'{column}'" for column in cells.columns)
    called = [c for c in cells.columns if _FILE.fullmatch(c.name.strip())]
    files = next((c for c in called if c.name.strip().lower() != "name"), next(iter(called), None))
    columns = {role: _column(cells, role) for role in ROLES}
    known = {role: column for role, column in columns.items() if column is not None}
    if files is None or not known:
        raise ParameterError(
            f"{path.name}: a table of runs needs a column 'file', and others with units, e.g. 'load [N]' or "
            f"'radius [mm]'. Columns: {listed}"
        )
    units = {role: column.unit for role, column in known.items()}
    numbers = {role: cells.numbers(column) for role, column in known.items()}
    rows = dict[str, Mapping[str, str]]()
    for row, text in enumerate(cells.texts(files)):
        name = Path(text).name
        if name in rows:
            raise ParameterError(f"{path.name}, row {row + 1}: {name} has a row already. Delete one")
        if name:
            bad = next((role for role in known if not np.isfinite(numbers[role][row])), None)
            if bad is not None:
                raise ParameterError(f"{path.name}, row {row + 1}: {name} has no number in '{known[bad]}'")
            rows[name] = {role: f"{float(numbers[role][row])!r} {units[role]}" for role in known}
    return RunTable(path.name, units, rows)


def _cells(path: Path) -> CellTable:
    """The cells of the table: line 1 of a text names its columns, however few rows it has."""
    if formats.format_of(path):
        with reading_by(None):  # the layout is that of the logs
            return cells_of(path, path.name)
    lines = [line for line in read_table_text(path).split("\n") if line.strip()] or [""]
    rows = [split(line, max(",;\t", key=lines[0].count)) for line in lines]
    columns = tuple(Column(i, *split_unit(cell)) for i, cell in enumerate(rows[0]))
    cells = tuple([row[c.index] if c.index < len(row) else "" for row in rows[1:]] for c in columns)
    style = style_of([cell for column in cells for cell in column])
    return CellTable(path.name, "", 0, columns, cells, style.value)


def _column(cells: CellTable, role: str) -> Column | None:
    """The column of a role, by its name."""
    found = [c for c in cells.columns if c.name.strip().lower() == role] or [
        c for c in cells.columns if is_called(role, c)
    ]
    if len(found) > 1:
        listed = " and ".join(f"'{column}'" for column in found)
        raise ParameterError(f"{cells.name}: {listed} may both be the {role}. Call one of them '{role}'")
    if not found:
        return None
    if not found[0].unit:
        example = f"{found[0].name} [{ROLES[role]}]"
        raise UnitError(f"{cells.name}: column '{found[0].name}' has no unit. Write '{example}'")
    try:
        role_conversion(role, found[0].unit)
    except UnitError as error:
        raise error.within(f"{cells.name}, column '{found[0]}'") from None
    return found[0]
