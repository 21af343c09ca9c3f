"""Whether a file holds what this package writes: its own tables, and values of the right kind and range.

Tables are compared before anything is read from them, so that no view, trigger, virtual table, generated
column or expression of somebody else is run. Runs are checked when a campaign is opened, dwells before they
are read.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterator
from functools import cache
from pathlib import Path
from typing import Any

from hersey.errors import HerseyError, ParameterError, UnitError
from hersey.life.age import refuse_no_unit
from hersey.life.campaign.entry import COLUMNS
from hersey.life.campaign.events import keeps_events
from hersey.life.campaign.guarded import LONGEST
from hersey.life.maintenance import KINDS

#: The most that a campaign holds.
MOST_RUNS, MOST_DWELLS = 50_000, 2_000_000
#: No number of a campaign is greater, in SI; no age, in its unit, and no number of a row.
_LARGEST, _OLDEST, _LAST = "1e12", "1e15", "1000000000000000"
#: Runs that a statement names: SQLite's limits on its length and instructions allow some thousand.
_NAMED = 1000
#: Characters of a name that a message shows.
_SHOWN = 40


def _text(name: str, most: int, least: int = 1) -> tuple[str, str]:
    holds = f"typeof({name}) = 'text' AND length({name}) BETWEEN {least} AND {most}"
    return holds, f"text of {least} to {most} characters"


def _real(name: str, least: str = f"-{_LARGEST}", most: str = _LARGEST) -> tuple[str, str]:
    return (
        f"typeof({name}) = 'real' AND {name} BETWEEN {least} AND {most}",
        f"a number from {least} to {most}",
    )


def _whole(name: str, least: int = 0) -> tuple[str, str]:
    return (
        f"typeof({name}) = 'integer' AND {name} BETWEEN {least} AND {_LAST}",
        f"a whole number from {least}",
    )


def _or_null(name: str, rule: tuple[str, str]) -> tuple[str, str]:
    return f"{name} IS NULL OR {rule[0]}", f"{rule[1]}, or nothing"


#: What each column of a run must hold: as SQLite tests it, and in words.
_RUNS = {
    "id": _whole("id", 1),
    "unit": _text("unit", 60),
    "age": _real("age", "0", _OLDEST),
    "path": (
        "typeof(path) IN ('text', 'blob') AND length(path) BETWEEN 1 AND 4096 AND NOT instr(path, char(0))",
        "a path of 1 to 4096 characters",
    ),
    "sha256": _text("sha256", 64),
    "written": _or_null("written", _real("written")),
    "added": _text("added", 40),
    "version": _text("version", 40),
    "settings": _text("settings", 1_000_000),
    "reduction": _text("reduction", LONGEST),
    "fit": _or_null("fit", _text("fit", LONGEST)),
    "no_fit": _text("no_fit", 10_000, 0),
    "dwells": _whole("dwells"),
    "exponent": _or_null("exponent", _real("exponent")),
    "transition_speed": _or_null("transition_speed", _real("transition_speed", "0")),
}
_NOT_NEGATIVE = {"speed_error", "torque_error", "temperature", "temperature_error", "effective_rows", "load"}
_KNOWN = {"speed", "torque"}


def _of_dwell(name: str, kind: str) -> tuple[str, str]:
    quoted = f'"{name}"'
    if kind == "INTEGER":
        return _whole(quoted)
    if kind == "TEXT":
        return _text(quoted, 40, 0)
    rule = _real(quoted, "0") if name in _NOT_NEGATIVE else _real(quoted)
    return rule if name in _KNOWN else _or_null(quoted, rule)


#: The same of an event.
_EVENTS = {
    "unit": _RUNS["unit"],
    "age": _RUNS["age"],
    "kind": (f"kind IN {KINDS}", f"one of {', '.join(KINDS)}"),
    "run_id": _or_null("run_id", _whole("run_id", 1)),
}
#: The same of a dwell.
_DWELLS = {
    "run_id": _whole("run_id", 1),
    "number": _whole("number"),
    **{name: _of_dwell(name, kind) for name, kind in COLUMNS.items()},
}


def refuse_other_tables(database: sqlite3.Connection, path: Path, schema: str) -> None:
    """Refuse a file with anything but the tables and indexes of a schema.

    Raises
    ------
    ParameterError
        Naming the first that is unknown, different or not there.
    """
    known = dict(_made(schema))
    found = set()
    for kind, name, table, sql in database.execute("SELECT type, name, tbl_name, sql FROM sqlite_master"):
        shown = f"{kind} '{str(name)[:_SHOWN]}'"
        if (kind, name) not in known:
            raise _foreign(path, f"it contains {shown}, which does not belong there")
        if known[kind, name] != (table, _one_line(sql)):
            raise _foreign(path, f"its {shown} is not the one that hersey creates")
        if (kind, name) in found:
            raise _foreign(path, f"it contains {shown} twice")
        found.add((kind, name))
    for kind, name in known:
        if (kind, name) not in found:
            raise _foreign(path, f"it has no {kind} '{name}'")


@cache
def _made(schema: str) -> tuple[tuple[tuple[str, str], tuple[str, str | None]], ...]:
    """What stands in the file after a schema is made."""
    database = sqlite3.connect(":memory:")
    try:
        database.executescript(schema)
        rows = database.execute("SELECT type, name, tbl_name, sql FROM sqlite_master").fetchall()
        return tuple(((kind, name), (table, _one_line(sql))) for kind, name, table, sql in rows)
    finally:
        database.close()


def _one_line(sql: object) -> str | None:
    return None if sql is None else " ".join(str(sql).split())


def refuse_damage(database: sqlite3.Connection, path: Path) -> None:
    """Refuse a file of which pages, rows or indexes are damaged, or a run is not as one is written.

    Raises
    ------
    ParameterError
        Naming the first that is found.
    """
    pages, size = (int(database.execute(f"PRAGMA {n}").fetchone()[0]) for n in ("page_count", "page_size"))
    log = path.with_name(f"{path.name}-wal")
    if path.stat().st_size < pages * size and not (log.exists() and log.stat().st_size):
        raise damaged(path, f"it is shorter than its {pages * size} bytes")
    for check in ("quick_check(1)", "integrity_check(runs)"):
        said = database.execute(f"PRAGMA {check}").fetchone()
        if said is None or said[0] != "ok":
            raise damaged(path, "SQLite's check gave no answer" if said is None else str(said[0])[:200])
    refuse_unsound_runs(database, path)


def refuse_unsound_runs(database: sqlite3.Connection, path: Path) -> None:
    """Refuse too many runs, or a value of one that is not as it is written; errors as above."""
    runs, last, dwells = database.execute(
        "SELECT count(*), coalesce(max(id), 0), total(dwells) FROM runs"
    ).fetchone()
    if runs > MOST_RUNS:
        raise _too_many(path, runs, "runs", MOST_RUNS)
    for run, column, asked in _wrong(database, "runs", "id", _RUNS, ""):
        raise damaged(path, f"'{column}' of run {run} is not {asked}")
    if dwells > MOST_DWELLS:
        raise _too_many(path, int(dwells), "dwells", MOST_DWELLS)
    for run, no_fit in database.execute("SELECT id, no_fit FROM runs WHERE (fit IS NULL) != (no_fit != '')"):
        raise damaged(
            path,
            f"run {run} has "
            f"{'both a fit and a reason for having none' if no_fit else 'neither a fit nor a reason'}",
        )
    for name, count in database.execute("SELECT name, seq FROM sqlite_sequence"):
        if name != "runs" or not isinstance(count, int) or not last <= count <= int(_LAST):
            raise damaged(path, "'sqlite_sequence' does not contain the number of the last run")
    _refuse_unknown_age_unit(database, path, runs)
    if keeps_events(database):
        _refuse_unsound_events(database, path)


def _refuse_unsound_events(database: sqlite3.Connection, path: Path) -> None:
    """Refuse events that are not as they are written, or that name a run of another specimen or age."""
    for number, column, asked in _wrong(database, "events", "unit", _EVENTS, ""):
        raise damaged(path, f"'{column}' of an event of {str(number)[:_SHOWN]} is not {asked}")
    count = database.execute("SELECT count(*) FROM events").fetchone()[0]
    if count > MOST_RUNS:
        raise _too_many(path, count, "events", MOST_RUNS)
    for run in database.execute(
        "SELECT e.run_id FROM events e LEFT JOIN runs r ON r.id = e.run_id "
        "WHERE e.run_id IS NOT NULL AND (r.id IS NULL OR (r.unit, r.age) != (e.unit, e.age)) LIMIT 1"
    ):
        raise damaged(path, f"an event names run {run[0]}, which is of another specimen or age")


def _refuse_unknown_age_unit(database: sqlite3.Connection, path: Path, runs: int) -> None:
    rows = database.execute("SELECT name, value FROM campaign LIMIT 2").fetchall()
    if len(rows) > 1 or (rows and rows[0][0] != "age unit") or (runs and not rows):
        raise damaged(path, "table 'campaign' must contain 'age unit' and nothing else")
    try:
        for _, unit in rows:
            refuse_no_unit(unit if isinstance(unit, str) else "")
    except UnitError:
        raise damaged(path, "'age unit' in table 'campaign' is not one word") from None


def refuse_unsound_dwells(
    database: sqlite3.Connection, path: Path, runs: Collection[int] | None = None
) -> None:
    """Refuse dwells, of some runs or of all, that are not as they are written; errors as above."""
    for some in _blocks(runs):
        _refuse_unsound_dwells(database, path, some)


def _refuse_unsound_dwells(database: sqlite3.Connection, path: Path, runs: Collection[int] | None) -> None:
    of_run = _one_of("run_id", runs)
    key = "run_id || ', dwell ' || number"
    for number, column, asked in _wrong(database, "dwells", key, _DWELLS, f"{of_run} AND"):
        raise damaged(path, f"'{column}' of run {str(number)[:_SHOWN]} is not {asked}")
    counts = dict(database.execute(f"SELECT id, dwells FROM runs WHERE {_one_of('id', runs)}").fetchall())
    for number, count in database.execute(
        f"SELECT run_id, count(*) FROM dwells WHERE {of_run} GROUP BY run_id"
    ):
        if counts.pop(number, None) != count:
            raise damaged(path, f"run {number} has {count} dwells, which is not the number stated")
    for number, count in counts.items():
        if count:
            raise damaged(path, f"run {number} should have {count} dwells and has none")


def rows_of(
    database: sqlite3.Connection, select: str, column: str, runs: Collection[int] | None, order: str = ""
) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of some runs, which a column names, or of all."""
    for some in _blocks(runs):
        # Read as a whole: a cursor that an error leaves open would outlive the file.
        yield from database.execute(f"{select} WHERE {_one_of(column, some)} {order}").fetchall()


def _blocks(runs: Collection[int] | None) -> Iterator[Collection[int] | None]:
    """Yield some runs in ascending order, so many as a statement may name; for all runs None."""
    if runs is None:
        yield None
        return
    ordered = sorted({int(run) for run in runs})
    yield from (ordered[i : i + _NAMED] for i in range(0, len(ordered), _NAMED))


def _one_of(column: str, runs: Collection[int] | None) -> str:
    """Return the condition that a column names one of some runs; for all one that always holds."""
    return "1" if runs is None else f"{column} IN ({', '.join(map(str, runs))})"


def _wrong(
    database: sqlite3.Connection, table: str, key: str, rules: dict[str, tuple[str, str]], where: str
) -> list[tuple[object, str, str]]:
    """The first row with a value that is not as its rule says: its key, the column, what is asked of it."""
    cases = " ".join(f"WHEN NOT coalesce({holds}, 0) THEN '{name}'" for name, (holds, _) in rules.items())
    every = " AND ".join(f"coalesce({holds}, 0)" for holds, _ in rules.values())
    found = database.execute(
        f"SELECT {key}, CASE {cases} END FROM {table} NOT INDEXED WHERE {where} NOT ({every}) LIMIT 1"
    ).fetchall()
    return [(number, column, rules[column][1]) for number, column in found]


def damaged(path: Path, what: str) -> ParameterError:
    """Return the error of a file that is damaged."""
    return ParameterError(
        f"{path.name} is damaged ({what}). Restore it from a backup, or add the logs to a new campaign"
    )


def _foreign(path: Path, what: str) -> HerseyError:
    return ParameterError(
        f"{path.name} is not as 'hersey campaign add' made it ({what}). Restore it from a backup, or add "
        "the logs to a new campaign"
    )


def _too_many(path: Path, count: int, what: str, most: int) -> HerseyError:
    return ParameterError(
        f"{path.name} has {count} {what}; at most {most} are allowed. Split the logs over several campaigns"
    )
