"""A table of runs: each row names a log, its specimen and its age."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hersey.errors import ChannelError, HerseyError, ParameterError, UnreadableLogError
from hersey.files.headings import headings_of, separator_of
from hersey.files.reading import open_file
from hersey.files.tables import text_of
from hersey.files.text import encoding_of, read_table_text
from hersey.life.age import Age
from hersey.life.maintenance import kind_of

_NEEDED = ("log", "unit", "age")
#: Column that may name what was done to the specimen before the run, or without a log at this age.
_EVENT = "event"
#: Bytes that hold the first line.
_START = 4096


@dataclass(frozen=True)
class RunToAdd:
    """A row of the table: the log's path (whole), its specimen and age, and what was done before it."""

    log: Path
    unit: str
    age: Age
    event: str = ""  #: kind of the maintenance


@dataclass(frozen=True)
class RunsTable:
    """A table of runs, and of maintenance after which no run was measured at the same age."""

    runs: list[RunToAdd]
    events: list[tuple[str, Age, str]]  #: specimen, age and kind


def read_runs(path: str | Path) -> RunsTable:
    """Read a table of runs: columns ``log``, ``unit`` and ``age``, separated by commas, semicolons or tabs.

    The unit of the age stands in each cell (``120000 pages``) or in the heading (``age [pages]``). Paths are
    from the table's folder. A column ``event`` may name maintenance just before the run; a row with an event
    may have no log.

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
    if names.count(_EVENT) > 1:
        raise ChannelError(f"{path.name}: there is more than one column '{_EVENT}'")
    at = {name: names.index(name) for name in (*_NEEDED, *([_EVENT] if _EVENT in names else []))}
    in_head = headings[at["age"]][1]
    found, events = [], []
    for number, row in enumerate(rows[1:], 2):
        if not any(cell.strip() for cell in row):
            continue
        cells = {name: text_of(row[i].strip()) if i < len(row) else "" for name, i in at.items()}
        where = f"{path.name}, line {number}"
        age, event = _age_and_event(cells, in_head, where)
        if event and not cells["log"]:
            events.append((cells["unit"], age, event))
        else:
            found.append(RunToAdd(path.absolute().parent / cells["log"], cells["unit"], age, event))
    if not found:
        raise UnreadableLogError(f"{path.name} lists no runs. Write one line per run below the header")
    return RunsTable(found, events)


def _age_and_event(cells: dict[str, str], unit: str, where: str) -> tuple[Age, str]:
    """The age and the event of a row, which must have what it needs; ``unit`` is that of bare numbers."""
    event = cells.get(_EVENT, "")
    for name in _NEEDED:
        if not (cells[name] or (event and name == "log")):
            raise UnreadableLogError(f"{where}: column '{name}' is empty. Fill it in")
    column = "age"
    try:
        age = Age.parse(cells["age"], unit)
        column = _EVENT
        return age, kind_of(event) if event else ""
    except HerseyError as error:
        raise error.within(f"{where}, column '{column}'") from None


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
            return replace(row, log=log)
        if not alike:
            return ParameterError(f"{table} has no row for it. Add one, or do not give this log")
        return ParameterError(
            f"{table} has several runs with this file name. Write the paths of the logs there"
        )

    return [of(log) for log in logs]
