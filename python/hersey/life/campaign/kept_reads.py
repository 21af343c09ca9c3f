"""What was read of a campaign, kept until somebody changes its file."""

from __future__ import annotations

from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any

from hersey.life.campaign.guarded import GuardedConnection
from hersey.life.campaign.store import sqlite_errors


class KeptReads:
    """What was read of all runs, by name, with the state of the file then."""

    def __init__(self, path: Path, database: GuardedConnection) -> None:
        """Take an open file, of which nothing was read yet."""
        self._path, self._database = path, database
        self._found: dict[str, tuple[tuple[int, int], Any]] = {}

    def read(self, what: str, how: Callable[[Any], Any], runs: Collection[int] | None = None) -> Any:
        """Return what was read before of all runs, or read it with ``how``; ``runs`` are read each time."""
        with sqlite_errors(self._path):
            if runs is not None:
                return how(runs)
            version = self._database.execute("PRAGMA data_version").fetchone()[0]
            state = version, self._database.total_changes
            if what not in self._found or self._found[what][0] != state:
                self._found[what] = state, how(None)
            return self._found[what][1]
