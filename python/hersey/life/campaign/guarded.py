"""A connection to a file from anywhere: limits of length and work, and nothing in the file is run.

It follows what https://www.sqlite.org/security.html advises for untrusted files.
"""

from __future__ import annotations

import sqlite3
from pathlib import Path
from typing import Any

from hersey.errors import ParameterError

#: Longest row, text or blob, bytes: the reduction of a log with many thousand dwells takes a few MB.
LONGEST = 8_000_000
#: Limits of SQLite: what this package asks needs less.
_LIMITS = {
    sqlite3.SQLITE_LIMIT_LENGTH: LONGEST,
    sqlite3.SQLITE_LIMIT_SQL_LENGTH: 100_000,
    sqlite3.SQLITE_LIMIT_COLUMN: 100,
    sqlite3.SQLITE_LIMIT_EXPR_DEPTH: 100,
    sqlite3.SQLITE_LIMIT_COMPOUND_SELECT: 10,
    sqlite3.SQLITE_LIMIT_VDBE_OP: 25_000,
    sqlite3.SQLITE_LIMIT_FUNCTION_ARG: 8,
    sqlite3.SQLITE_LIMIT_ATTACHED: 0,
    sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH: 50,
    sqlite3.SQLITE_LIMIT_VARIABLE_NUMBER: 100,
    sqlite3.SQLITE_LIMIT_TRIGGER_DEPTH: 10,
}
_SETTINGS = ("trusted_schema = OFF", "cell_size_check = ON", "mmap_size = 0", "foreign_keys = ON")
#: Instructions of SQLite after which work is counted.
_COUNTED = 10_000
#: Instructions that one statement may take: before the tables are known, afterwards, and per byte of a file.
_UNKNOWN, _LEAST, _PER_BYTE = 50_000, 5_000_000, 12
#: Last bytes of a rollback journal that names a super-journal, which SQLite would delete.
_SUPER_JOURNAL = bytes.fromhex("d9d505f920a163d7")


class GuardedConnection(sqlite3.Connection):
    """A connection of which each statement may take a bounded number of instructions of SQLite."""

    def __init__(self, *args: Any, **named: Any) -> None:
        """Open the file and set every limit before anything is read from it."""
        super().__init__(*args, **named)
        try:
            self._guard()
        except BaseException:
            self.close()  # nobody else can: an open file keeps its lock
            raise

    def _guard(self) -> None:
        self.work, self.allowed = 0, _UNKNOWN
        for limit, value in _LIMITS.items():
            self.setlimit(limit, value)
        self.set_progress_handler(self._spent, _COUNTED)
        for setting in _SETTINGS:
            self.execute(f"PRAGMA {setting}")
        if hasattr(self, "setconfig"):  # Python 3.12 and later
            self.setconfig(sqlite3.SQLITE_DBCONFIG_DEFENSIVE, True)  # type: ignore[attr-defined]
            self.setconfig(sqlite3.SQLITE_DBCONFIG_TRUSTED_SCHEMA, False)  # type: ignore[attr-defined]

    def execute(self, sql: str, parameters: Any = (), /) -> sqlite3.Cursor:
        """Run a statement; its work is counted from zero."""
        self.work = 0
        return super().execute(sql, parameters)

    def allow_what_the_size_needs(self) -> None:
        """Let each statement read the whole file some times, once its tables are known."""
        pages, size = (int(self.execute(f"PRAGMA {n}").fetchone()[0]) for n in ("page_count", "page_size"))
        self.allowed = _LEAST + _PER_BYTE * pages * size

    def _spent(self) -> int:
        """Count, and end a statement that takes more than it may."""
        self.work += _COUNTED
        return self.work > self.allowed


def connect(path: Path, *, mode: str, wait: float = 0.0) -> GuardedConnection:
    """Open a file; ``mode`` is what the URI says of it, e.g. ``mode=ro``.

    Raises
    ------
    ParameterError
        If a journal beside it names another file, which SQLite would delete.
    """
    if mode != "mode=ro":
        _refuse_super_journal(path)
    return sqlite3.connect(
        f"{path.absolute().as_uri()}?{mode}",
        uri=True,
        timeout=wait,
        isolation_level=None,
        factory=GuardedConnection,
    )


def _refuse_super_journal(path: Path) -> None:
    journal = path.with_name(f"{path.name}-journal")
    try:
        end = _last(journal, len(_SUPER_JOURNAL)) if journal.is_file() else b""
    except OSError:  # SQLite says what is wrong with it
        return
    if end == _SUPER_JOURNAL:
        raise ParameterError(
            f"{journal.name} refers to another file, which a campaign never does. Delete {journal.name}"
        )


def _last(path: Path, count: int) -> bytes:
    with path.open("rb") as file:
        file.seek(max(path.stat().st_size - count, 0))
        return file.read(count)
