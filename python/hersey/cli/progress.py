"""Progress on stderr: a spinner or a bar on a terminal, plain lines elsewhere, nothing with --quiet."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from hersey.cli.terminal import is_quiet, note

#: Time after which a line of progress is printed where there is no terminal, and between two of them, s.
PATIENCE = 10.0


@contextmanager
def steps() -> Iterator[Callable[[str], None]]:
    """Show a spinner with the current step; elsewhere a line for each step that takes long."""
    if is_quiet():
        yield lambda _what: None
    elif not sys.stderr.isatty():
        with _slow_steps() as step:
            yield step
    else:
        from rich.console import Console

        with Console(stderr=True).status("") as status:
            yield status.update


@contextmanager
def working(what: str) -> Iterator[None]:
    """Show a spinner on a terminal, elsewhere a line if the work takes long."""
    with steps() as step:
        step(what)
        yield


@contextmanager
def bar(what: str, unit: str = "") -> Iterator[Callable[[int, int], None]]:
    """Show a progress bar on a terminal, elsewhere lines if the work takes long; without unit: bytes."""
    if is_quiet():
        yield lambda _done, _total: None
        return
    if not sys.stderr.isatty():
        yield _slow_share(what)
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


@contextmanager
def _slow_steps() -> Iterator[Callable[[str], None]]:
    """Print the name of each step that is still at work after a while."""
    waiting: list[threading.Timer] = []

    def stop() -> None:
        while waiting:
            waiting.pop().cancel()

    def step(what: str) -> None:
        stop()
        timer = threading.Timer(PATIENCE, _line, [f"{what} ..."])
        timer.daemon = True
        waiting.append(timer)
        timer.start()

    try:
        yield step
    finally:
        stop()


def _slow_share(what: str) -> Callable[[int, int], None]:
    """Return what prints the share that is done, now and then."""
    last = [time.monotonic()]

    def share(done: int, total: int) -> None:
        now = time.monotonic()
        if total and done < total and now - last[0] >= PATIENCE:
            last[0] = now
            _line(f"{what}: {100 * done // total} %")

    return share


def _line(text: str) -> None:
    with suppress(OSError, ValueError):  # a stderr that is closed
        note(f"hersey: {text}")
