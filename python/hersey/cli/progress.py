"""Progress on a terminal, nothing elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def steps() -> Iterator[Callable[[str], None]]:
    """Show a spinner with the step that is said, on a terminal."""
    if not sys.stderr.isatty():
        yield lambda _what: None
        return
    from rich.console import Console

    with Console(stderr=True).status("") as status:
        yield status.update


@contextmanager
def working(what: str) -> Iterator[None]:
    """Show a spinner on a terminal."""
    with steps() as step:
        step(what)
        yield


@contextmanager
def bar(what: str, unit: str = "") -> Iterator[Callable[[int, int], None]]:
    """Show a progress bar on a terminal; it counts bytes unless there is a unit."""
    if not sys.stderr.isatty():
        yield lambda _done, _total: None
        return
    from rich import progress as parts
    from rich.console import Console

    amount = parts.MofNCompleteColumn() if unit else parts.DownloadColumn()
    shown = (parts.TextColumn(what), parts.BarColumn(), amount, parts.TextColumn(unit))
    with parts.Progress(
        *shown, parts.TimeRemainingColumn(), console=Console(stderr=True), transient=True
    ) as progress:
        task = progress.add_task(what, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
