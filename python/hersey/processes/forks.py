"""A process forked from one in which polars has run: it would wait for threads that are not there."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

from hersey.errors import ForkedError

_lost_threads = False


def refuse_after_fork() -> None:
    """Raise where polars would wait for ever.

    Raises
    ------
    ForkedError
        If this process was forked from one in which polars had started its threads.
    """
    if _lost_threads:
        raise ForkedError(
            "this process was forked after polars had run, and polars cannot run in it. Start "
            "processes with multiprocessing.get_context('spawn'), or fork before the first log is read"
        )


def _polars_has_threads() -> bool:
    if "polars" not in sys.modules:
        return False
    tasks = Path("/proc/self/task")
    if not tasks.is_dir():  # on other systems than Linux one cannot tell
        return True
    names = []
    for task in tasks.iterdir():
        with suppress(OSError):  # a thread that has just ended
            names.append((task / "comm").read_text().strip())
    return "polars-0" in names


def _before_fork() -> None:
    global _parent_has_threads
    _parent_has_threads = _polars_has_threads()


def _after_fork() -> None:
    global _lost_threads
    _lost_threads = _lost_threads or _parent_has_threads


_parent_has_threads = False
if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_before_fork, after_in_child=_after_fork)
