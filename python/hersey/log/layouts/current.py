"""The layout by which files are read at the moment; light, as all reading needs it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.log import formats
from hersey.log.recording import Recording

if TYPE_CHECKING:
    from hersey.log.layouts.table import LogLayout

#: What `format_of` says of a file that is read by a layout.
LAYOUT = "layout"
_now: ContextVar[LogLayout | None] = ContextVar("layout", default=None)


@contextmanager
def reading_by(layout: LogLayout | None) -> Iterator[None]:
    """Have files read by a layout, or as they are found (None), inside the context and this thread."""
    before = _now.set(layout)
    try:
        yield
    finally:
        _now.reset(before)


def stated_layout() -> LogLayout | None:
    """Return the layout by which files are read at the moment."""
    return _now.get()


def format_of(path: Path) -> str | None:
    """Return the format of a file as `formats.format_of`, or `LAYOUT` inside `reading_by`."""
    return formats.format_of(path) if _now.get() is None else LAYOUT


@contextmanager
def opened(path: Path, kind: str) -> Iterator[Recording]:
    """Open a file of any format but text, or any file by its layout."""
    layout = _now.get()
    if kind != LAYOUT or layout is None:
        with formats.opened(path, kind) as recording:
            yield recording
        return
    from hersey.log.layouts.laid_out import laid_out

    yield laid_out(path, layout)
