"""A table of runs: each row names a log, its specimen and its age."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import ChannelError, HerseyError, ParameterError, UnreadableLogError
from hersey.files.headings import headings_of, separator_of
from hersey.files.reading import open_file
from hersey.files.tables import text_of
from hersey.files.text import encoding_of, read_table_text
from hersey.life.age import Age

_NEEDED = ("log", "unit", "age")
#: Bytes that hold the first line.
_START = 4096


@dataclass(frozen=True)
class RunToAdd:
    """A row of the table: the log's path (whole), its specimen and age."""

    log: Path
    unit: str
    age: Age


def read_runs(path: str | Path) -> list[RunToAdd]:
    """Read a table of runs: columns ``log``, ``unit`` and ``age``, separated by commas, semicolons or tabs.

    The unit of the age stands in each cell (``120000 pages``) or in the heading (``age [pages]``). Paths are
    from the table's folder.

    Raises
    ------
    HerseyError
        If a column or a cell is missing or says no age, naming file, line and column.
    """
    path = Path(path)
    lines = read_table_text(path).split("\n")
    separator = separator_of(lines[0])
    try:
        rows = list(csv.reader(lines, delimiter=separator))
    except csv.Error as error:
        raise UnreadableLogError(f"{path.name} is not a table: {error}") from None
    headings = headings_of(rows[0])
    names = [name for name, _ in headings]
    for name in _NEEDED:
        if names.count(name) != 1:
            what = "there is no column" if name not in names else "there is more than one column"
            listed = ", ".join(f"'{cell.strip()}'" for cell in rows[0] if cell.strip())
            example = separator.join(("log", "unit", "age [pages]")).replace("\t", "<Tab>")
            raise ChannelError(
                f"{path.name}: {what} '{name}'. {f'Columns: {listed}' if listed else 'Line 1 is empty'}",
                remedy=f"line 1 must name log, unit (the specimen) and age, e.g. '{example}'",
            )
    at = {name: names.index(name) for name in _NEEDED}
    in_head = headings[at["age"]][1]
    found = []
    for number, row in enumerate(rows[1:], 2):
        if not any(cell.strip() for cell in row):
            continue
        cells = {name: text_of(row[i].strip()) if i < len(row) else "" for name, i in at.items()}
        for name, cell in cells.items():
            if not cell:
                raise UnreadableLogError(f"{path.name}, line {number}: column '{name}' is empty. Fill it in")
        try:
            age = Age.parse(cells["age"], in_head)
        except HerseyError as error:
            raise error.within(f"{path.name}, line {number}, column 'age'") from None
        found.append(RunToAdd(path.absolute().parent / cells["log"], cells["unit"], age))
    if not found:
        raise UnreadableLogError(f"{path.name} lists no runs. Write one line per run below the header")
    return found


def lists_runs(path: str | Path) -> bool:
    """Return whether a file is a table of runs, by its first line."""
    try:
        with open_file(Path(path)) as file:
            start = file.read(_START)
    except HerseyError:  # which reading it says, too
        return False
    encoding = encoding_of(start)
    if not encoding:
        return False
    head = start.decode(encoding, errors="replace").splitlines()[:1]
    try:
        rows = list(csv.reader(head, delimiter=separator_of(head[0]))) if head else []
    except csv.Error:
        return False
    return bool(rows) and set(_NEEDED) <= {name for name, _ in headings_of(rows[0])}


def rows_of(logs: Sequence[Path], rows: Sequence[RunToAdd], table: str) -> list[RunToAdd | ParameterError]:
    """Return for each log its run, or why it has none: the row with its path, else the one with its name.

    ``rows`` are those of the table with the name ``table``; several logs of one name need rows with paths.
    """
    by_path = {os.path.realpath(row.log): row for row in rows}
    by_name: dict[str, list[RunToAdd]] = {}
    for row in rows:
        by_name.setdefault(row.log.name, []).append(row)
    names = [log.name for log in logs]

    def of(log: Path) -> RunToAdd | ParameterError:
        row = by_path.get(os.path.realpath(log))
        alike = by_name.get(log.name, [])
        if row is None and len(alike) == 1 and names.count(log.name) == 1:
            row = alike[0]
        if row is not None:
            return RunToAdd(log, row.unit, row.age)
        if not alike:
            return ParameterError(f"{table} has no row for it. Add one, or do not give this log")
        return ParameterError(
            f"{table} has several runs with this file name. Write the paths of the logs there"
        )

    return [of(log) for log in logs]
