"""The process in which files are read: a reader opens one, and what it holds is sent as it is asked for.

Run by `hersey.processes.server`. Requests: ``prepare`` (a format: loads its library, and says what the
sandbox lacks on this system), ``open`` (a file, its format and name, bounds of memory and time), ``load``,
``clock`` and ``marked`` (the numbers of one signal, a part for each time it is asked), ``cells`` (the text of
one column), ``close``.
"""

from __future__ import annotations

import importlib
import math
import warnings
from collections.abc import Iterator
from contextlib import AbstractContextManager, suppress
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from hersey.errors import UnreadableLogError
from hersey.processes.confinement import only_read_libraries
from hersey.processes.limits import limit

if TYPE_CHECKING:
    from hersey.arrays import FloatArray
    from hersey.log.recording import Recording

#: Channels of a file at the most.
_MOST_SIGNALS = 100_000

#: Numbers in a reply at the most.
PART = 1 << 20

#: What this system lacks for the sandbox.
_missing: tuple[str, ...] = ()
if __name__ == "__main__":  # whoever only imports this is not confined
    _missing = only_read_libraries()  # before anything else runs, threads above all


class _Open:
    """The file that is open."""

    def __init__(self) -> None:
        self.file: BinaryIO | None = None
        self.context: AbstractContextManager[Recording] | None = None
        self.recording: Recording | None = None
        self.parts: Iterator[FloatArray] = iter(())

    def open(self, request: dict[str, Any]) -> dict[str, Any]:
        """Open a file and say what it holds."""
        reader = importlib.import_module(f"hersey.log.formats.{request['format']}")
        limit(request["memory"], request["time"])
        self.file = open(request.get("file") or request["path"], "rb")  # noqa: PTH123, SIM115 # by number; see `close`
        self.file.seek(0)  # the place in a file that was passed is shared
        self.context = getattr(reader, f"open_{request['format']}")(self.file, request["name"])
        self.recording = recording = self.context.__enter__()
        channels = max(len(recording.signals), len(recording.cells))
        if channels > _MOST_SIGNALS:
            raise UnreadableLogError(f"holds {channels} channels; at most {_MOST_SIGNALS} are read")
        return self.state() | {
            "format": recording.format,
            "others": recording.others,
            "comments": recording.comments,
            "nothing": recording.nothing,
            "signals": [
                {name: getattr(signal, name) for name in ("name", "unit", "rows", "tick", "group", "line")}
                | {"clock": signal.clock is not None, "marked": signal.marked is not None}
                for signal in recording.signals
            ],
            "cells": [
                {"name": cells.name, "unit": cells.unit, "rows": cells.rows, "group": cells.group}
                for cells in recording.cells
            ],
        }

    def state(self) -> dict[str, Any]:
        """What may change while numbers are loaded."""
        assert self.recording is not None
        warnings = [each.to_dict() for each in self.recording.warnings]
        state = {"warnings": warnings, "cut_off": self.recording.cut_off}
        return state | {"dates": sorted(self.recording.dates)}

    def numbers(self, what: str, index: int, *, begin: bool) -> bytes:
        """The next values of a signal, its clock, or what the file says of each sample, as float64.

        There are none when all were sent.
        """
        if begin:
            self.parts = self.all_parts(what, index)
        return next(self.parts, np.empty(0)).tobytes()

    def all_parts(self, what: str, index: int) -> Iterator[FloatArray]:
        """All of them, part by part."""
        assert self.recording is not None
        signal = self.recording.signals[index]
        source = {"clock": signal.clock, "marked": signal.marked}.get(what, signal.load)
        assert source is not None
        for values in signal.parts() if signal.parts and what == "load" else [source()]:
            for first in range(0, values.size, PART):
                yield values[first : first + PART]

    def cells(self, index: int) -> bytes:
        """The text of a column: its cells with a zero between them."""
        assert self.recording is not None
        cells = (cell.replace("\0", " ") for cell in self.recording.cells[index].load())
        return "\0".join(cells).encode(errors="replace")

    def close(self) -> None:
        """Close the file; one that could not be opened may fail at that, too."""
        with suppress(Exception):
            if self.context is not None:
                self.context.__exit__(None, None, None)
        if self.file is not None:
            self.file.close()
        limit(math.inf, math.inf)


_open = _Open()


def answer(request: dict[str, Any], _payload: bytes) -> tuple[dict[str, Any], bytes]:
    """Answer one request."""
    global _open
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if request["do"] == "prepare":
            reader = importlib.import_module(f"hersey.log.formats.{request['format']}")
            getattr(reader, "prepare", lambda: None)()
            return {"missing": _missing}, b""
        if request["do"] == "open":
            return _open.open(request), b""
        if request["do"] == "close":
            closing, _open = _open, _Open()
            closing.close()
            return {}, b""
        index = request["index"]
        if request["do"] == "cells":
            content = _open.cells(index)
        else:
            content = _open.numbers(request["do"], index, begin=request["begin"])
    return _open.state(), content
