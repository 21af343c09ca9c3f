"""The file of a campaign: SQLite in WAL mode, each change one transaction that is on the disk when it ends.

The application's number and the version of the schema stand in the file's header, written with the schema in
one transaction: a file that was left half-made is empty, and the next writer makes it.
"""

from __future__ import annotations

import os
import shlex
import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from hersey.errors import HerseyError, MissingFileError, OutputError, ParameterError, way_in
from hersey.files.writing import refuse_without_folder
from hersey.life.campaign.content import damaged, refuse_damage, refuse_other_tables
from hersey.life.campaign.entry import COLUMNS
from hersey.life.campaign.guarded import LONGEST, GuardedConnection, connect

#: End of the name of a campaign.
SUFFIX = ".hersey"
#: What stands in the header: "HrSy", and the version of the schema.
APPLICATION = 0x48725379
VERSION = 3
#: Time that a writer waits for another, s.
PATIENCE = 30.0
_AGAIN = 0.02
_BEFORE_EVENTS = f"""
CREATE TABLE campaign (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE runs (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    unit TEXT NOT NULL,
    age REAL NOT NULL CHECK (age >= 0),
    path NOT NULL,
    sha256 TEXT NOT NULL UNIQUE,
    written REAL,
    added TEXT NOT NULL,
    version TEXT NOT NULL,
    settings TEXT NOT NULL,
    reduction TEXT NOT NULL,
    fit TEXT,
    no_fit TEXT NOT NULL,
    dwells INTEGER NOT NULL,
    exponent REAL,
    transition_speed REAL
);
CREATE INDEX runs_of_a_unit ON runs (unit, age);
CREATE INDEX runs_of_a_file ON runs (path);
CREATE TABLE dwells (
    run_id INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
    number INTEGER NOT NULL,
    {", ".join(f'"{name}" {kind}' for name, kind in COLUMNS.items())},
    PRIMARY KEY (run_id, number)
) WITHOUT ROWID;
"""
_EVENTS = """
CREATE TABLE events (
    unit TEXT NOT NULL,
    age REAL NOT NULL CHECK (age >= 0),
    kind TEXT NOT NULL,
    run_id INTEGER REFERENCES runs (id) ON DELETE SET NULL,
    PRIMARY KEY (unit, age, kind)
) WITHOUT ROWID;
"""
_SCHEMA = _BEFORE_EVENTS + _EVENTS
#: The schema of each version that may be read or brought up to date. Version 2 keeps warnings as data, in
#: tables that are the same; what reads them also reads the sentences of version 1. Version 3 keeps events.
SCHEMAS = {1: _BEFORE_EVENTS, 2: _BEFORE_EVENTS, 3: _SCHEMA}
#: Older versions that are read as they are.
_READ_AS_THEY_ARE = {1, 2}
#: What brings a file of each older version to the next, inside one transaction.
MIGRATIONS: dict[int, Callable[[sqlite3.Connection], None]] = {
    1: lambda _database: None,
    2: lambda database: _add_tables(database, _EVENTS),
}


def open_store(
    path: Path, *, create: bool = False, write: bool = True, wait: float = PATIENCE
) -> GuardedConnection:
    """Open a campaign, or make it; bring one of an older version up to date where it may be written.

    Raises
    ------
    MissingFileError
        If there is none, or it cannot be read.
    ParameterError
        If it is no campaign, or of a newer version.
    OutputError
        If it cannot be written.
    """
    refuse_no_place(path, create)
    with sqlite_errors(path):
        database = _connected(path, create=create, write=write, wait=wait)
        try:
            if create:
                _made(database, path, wait)
            _brought_up_to_date(database, path, write)
            refuse_damage(database, path)
        except BaseException:
            database.close()
            raise
        return database


def refuse_no_place(path: Path, create: bool) -> None:
    """Refuse a path at which there is no campaign, or none can be made.

    Raises
    ------
    HerseyError
        Naming the way out.
    """
    if path.exists():
        if not path.is_file():
            raise ParameterError(f"{path} is not a file. Name a campaign file, e.g. life{SUFFIX}")
        return
    if not create:
        made = f"hersey.Campaign.create({str(path)!r})"
        if way_in() == "terminal":
            made = f"hersey campaign add {shlex.quote(path.name)} LOG"
        raise MissingFileError(f"{path} does not exist", remedy=f"create it with: {made}")
    if path.suffix != SUFFIX:
        raise ParameterError(
            f"{path} is not a campaign name. Give the campaign first, with a name that ends in "
            f"{SUFFIX}, then the logs"
        )
    refuse_without_folder(path)


def _connected(path: Path, *, create: bool, write: bool, wait: float) -> GuardedConnection:
    database = connect(path, mode=f"mode={'rwc' if create else 'rw' if write else 'ro'}", wait=wait)
    try:
        database.execute("SELECT count(*) FROM sqlite_master").fetchone()
    except sqlite3.Error as error:
        database.close()
        # In a folder that cannot be written none writes: without an unfinished log the file is all there is.
        if (
            not isinstance(error, sqlite3.OperationalError)
            or write
            or os.access(path.parent, os.W_OK)
            or path.with_name(f"{path.name}-wal").exists()
        ):
            raise
        database = connect(path, mode="immutable=1")
    try:
        database.execute("PRAGMA synchronous = FULL")
    except BaseException:
        database.close()
        raise
    return database


def _made(database: sqlite3.Connection, path: Path, wait: float) -> None:
    """Give an empty file its schema; of several who do so at once one does it."""
    if not _is_empty(database):
        return
    until = time.monotonic() + wait
    while True:  # the change of mode does not wait for others by itself
        try:
            database.execute("PRAGMA journal_mode = WAL")
            break
        except sqlite3.OperationalError:
            if time.monotonic() > until:
                raise
            time.sleep(_AGAIN)
    with transaction(database, path):
        if not _is_empty(database):
            return
        _add_tables(database, _SCHEMA)
        database.execute(f"PRAGMA application_id = {APPLICATION}")
        database.execute(f"PRAGMA user_version = {VERSION}")


def _add_tables(database: sqlite3.Connection, schema: str) -> None:
    for statement in schema.split(";"):
        database.execute(statement)


def _is_empty(database: sqlite3.Connection) -> bool:
    tables: int = database.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
    return tables == 0 and not _header(database, "application_id")


def _header(database: sqlite3.Connection, name: str) -> int:
    return int(database.execute(f"PRAGMA {name}").fetchone()[0])


def _brought_up_to_date(database: GuardedConnection, path: Path, write: bool) -> None:
    if _header(database, "application_id") != APPLICATION:
        raise _no_campaign(path)
    version = _header(database, "user_version")
    if version > VERSION:
        raise ParameterError(
            f"{path.name} was written by a newer version of hersey (file version {version}, this one "
            f"reads up to {VERSION}). Update hersey"
        )
    if version in SCHEMAS:
        refuse_other_tables(database, path, SCHEMAS[version])
        database.allow_what_the_size_needs()
    if version == VERSION or (version in _READ_AS_THEY_ARE and not write):
        return
    if not write:
        raise ParameterError(
            f"{path.name} was written by an older version of hersey (file version {version}). Run "
            f"'hersey campaign add {path.name} LOG' to update it"
        )
    with transaction(database, path):
        for old in range(_header(database, "user_version"), VERSION):
            if old not in MIGRATIONS or old not in SCHEMAS:
                raise ParameterError(
                    f"{path.name} has file version {old}, which this version of hersey cannot update. "
                    "Add the logs to a new campaign"
                )
            MIGRATIONS[old](database)
            database.execute(f"PRAGMA user_version = {old + 1}")


def _no_campaign(path: Path) -> HerseyError:
    return ParameterError(f"{path.name} is not a campaign file. Name a file made by 'hersey campaign add'")


@contextmanager
def transaction(database: sqlite3.Connection, path: Path) -> Iterator[None]:
    """Make all changes inside or none; other writers wait meanwhile."""
    with sqlite_errors(path):
        database.execute("BEGIN IMMEDIATE")
        try:
            yield
            database.execute("COMMIT")
        except BaseException:
            with suppress(sqlite3.Error):  # which may have rolled back by itself
                database.execute("ROLLBACK")
            raise


@contextmanager
def sqlite_errors(path: Path) -> Iterator[None]:
    """Say in one line what SQLite could not do, and how to mend it."""
    try:
        yield
    except sqlite3.Error as error:
        raise _said(path, error) from None


def _said(path: Path, error: sqlite3.Error) -> HerseyError:
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    if code == sqlite3.SQLITE_NOTADB:
        return _no_campaign(path)
    if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return OutputError(
            f"{path.name} is in use by another program. Wait until it has finished, then try again"
        )
    if code == sqlite3.SQLITE_FULL:
        return OutputError(
            f"{path.name}: the disk is full. Free some space and try again; earlier runs are kept"
        )
    if code == sqlite3.SQLITE_IOERR:
        return OutputError(
            f"{path.name} cannot be written or read ({error}). Check the disk and its free space, then "
            "try again; earlier runs are kept"
        )
    if code in (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM):
        return OutputError(
            f"{path.name} cannot be opened ({error}). Check the permissions of the file and its folder, "
            "or copy it"
        )
    if code == sqlite3.SQLITE_TOOBIG:
        return damaged(path, f"a run in it is longer than {LONGEST} bytes")
    if code == sqlite3.SQLITE_INTERRUPT:
        return damaged(path, "reading it takes more work than its size explains")
    return damaged(path, str(error)[:200])
