"""Opening a file of any format but text in a process of its own.

The libraries that read binary files were not written for untrusted files: some run code, some end the
process, some take all memory. So they run in a process that may open no other file and has bounds of memory
and time; what comes out of it are names and numbers.
"""

from __future__ import annotations

import math
import os
import re
import signal
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from hersey import errors
from hersey.arrays import FloatArray
from hersey.errors import (
    HerseyError,
    ParameterError,
    SandboxWarning,
    Setting,
    UnreadableLogError,
    printable,
    way_in,
)
from hersey.files.reading import OpenFile, unchanged
from hersey.log.formats.recognition import called
from hersey.log.long_arrays import Filling
from hersey.log.recording import LONGEST_CELL, Cells, Recording, Signal, Source
from hersey.processes.child import Child, FailedError, LostError
from hersey.processes.limits import FROM_OUTSIDE
from hersey.schema.warning import Severity, Warning

#: What a file may take while it is read, bytes, where the user does not say otherwise, and now.
_USUAL_MEMORY = 2e9
_memory = _USUAL_MEMORY
#: Whether the user was warned of a sandbox that is not whole.
_warned = False
#: Bytes for each number that is read: it is held here, and so is what is computed from it; for a cell of text
#: beside its characters.
_BYTES_PER_NUMBER, _BYTES_PER_CELL = 16, 64
#: Processor time for a file, s, and per byte of it: far more than a sound one needs.
_TIME, _TIME_PER_BYTE = 3.0, 2e-6
#: The libraries alone need some of it.
_LEAST = 3e8
#: Characters of what a file says of itself, and of a name or unit in it.
_LONGEST, _LONGEST_NAME = 1000, LONGEST_CELL
_KEPT = ("PATH", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "SYSTEMROOT", "PYTHONHOME", "LANG", "LC_ALL", "TZ")
#: By the clock, as many times the processor time: for a process that waits for ever.
_PATIENCE = 60
_SCRIPT = Path(__file__).with_name("answering.py")
#: All that the process knows of its surroundings. Each thread takes memory, and there may be many cores.
_ENVIRONMENT = {
    **{name: value for name in _KEPT if (value := os.environ.get(name))},
    "POLARS_MAX_THREADS": "4",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
}


@contextmanager
def memory_limit(limit: str) -> Iterator[None]:
    """Set the memory limit per file, e.g. ``"8 GB"``, inside the context. The default is 2 GB.

    A small compressed file can contain very many numbers. Text files have no limit. The limit applies to all
    threads.

    Raises
    ------
    ParameterError
        If it is not a valid size.

    Examples
    --------
    >>> import hersey
    >>> with hersey.memory_limit("8 GB"):
    ...     log = hersey.read("examples/bench.csv")
    """
    match = re.fullmatch(r"\s*([0-9]{1,6}(?:\.[0-9]{1,6})?)\s*([MGT])B\s*", limit)
    size = float(match[1]) * {"M": 1e6, "G": 1e9, "T": 1e12}[match[2]] if match else 0.0
    if size < _LEAST:
        raise ParameterError(f"the memory limit is {limit!r}: it must be at least 300 MB, e.g. '8 GB'")
    global _memory
    before, _memory = _memory, size
    try:
        yield
    finally:
        _memory = before


@contextmanager
def opened(path: Path, kind: str) -> Iterator[Recording]:
    """Open a file of a format, and see to it that whatever a library stumbles over ends in one clear line.

    Raises
    ------
    MissingFileError
        If it is not there, or cannot be read.
    UnreadableLogError
        If it is damaged, cut off, not of this format, changes meanwhile, or takes more memory than it may.
    """
    with unchanged(path) as file:
        digest = file.sha256()
        reader = _Reader(file, kind, _memory)
        try:
            yield reader.recording(Source(printable(path.name), digest, file.size))
        except HerseyError as error:
            if printable(path.name) not in str(error):
                raise error.within(path.name) from None
            raise
        finally:
            reader.close()
        file.refuse_other_bytes(digest)


@contextmanager
def _own_descriptor(file: OpenFile) -> Iterator[int]:
    """Yield a descriptor of an open file whose place and flags are not those of ours; Linux."""
    shared = file.file.fileno()
    try:
        descriptor = os.open(f"/proc/self/fd/{shared}", os.O_RDONLY)
    except OSError:  # another system, or a file that only who opened it may read
        yield shared
        return
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def _warn_of(missing: tuple[str, ...]) -> None:
    """Warn once that files are read without a whole sandbox."""
    global _warned
    if missing and not _warned:
        _warned = True
        warnings.warn(SandboxWarning(missing), stacklevel=2)


class _Reader:
    """A file while it is read: its own process, and how much of the memory is left."""

    #: Processes that wait for a file, each with the libraries that it has imported so far.
    _waiting: list[Child] = []  # noqa: RUF012 # shared on purpose

    def __init__(self, file: OpenFile, kind: str, limit: float) -> None:
        self.file, self.kind, self.limit, self.left = file, kind, limit, limit
        self.time = (_TIME + _TIME_PER_BYTE * file.size) * max(1.0, limit / _USUAL_MEMORY)
        try:  # not `if`: another thread may take the last one
            self.child = self._waiting.pop()
        except IndexError:
            self.child = Child(_SCRIPT, _ENVIRONMENT)

    def close(self) -> None:
        """Close the file there, and let the process wait for the next."""
        if self.child.running:
            with suppress(LostError):
                self.child.ask({"do": "close"})
        self._waiting.append(self.child)

    def recording(self, source: Source) -> Recording:
        """What the file holds."""
        self._prepare()
        with _own_descriptor(self.file) as descriptor:
            about, _ = self._asked(
                {
                    "do": "open",
                    "format": self.kind,
                    "name": self.file.path.name,
                    "path": str(self.file.path.resolve()),
                    "memory": int(self.limit),
                    "time": self.time,
                },
                file=descriptor,
            )
        signals = about.pop("signals")
        recording = Recording(
            about["format"],
            (),
            tuple(_plain(other, _LONGEST_NAME) for other in about["others"]),
            tuple(map(_plain, about["comments"])),
            list(map(_warning, about["warnings"])),
            about["cut_off"],
            _plain(about["nothing"]),
            source,
        )
        recording.signals = tuple(self._signal(recording, i, about) for i, about in enumerate(signals))
        recording.cells = tuple(self._column(i, about) for i, about in enumerate(about["cells"]))
        return recording

    def _prepare(self) -> None:
        """Have the library loaded, then limit what the process may take."""
        if FROM_OUTSIDE and self.child.running:  # what is left of the last file's time is not for this one
            self._limited(math.inf, math.inf)
        about, _ = self._asked({"do": "prepare", "format": self.kind})
        _warn_of(tuple(map(_plain, about["missing"])))
        if FROM_OUTSIDE:
            self._limited(self.limit, self.time)

    def _limited(self, memory: float, seconds: float) -> None:
        try:
            self.child.limit(memory, seconds)
        except LostError as error:
            raise self._not_started(str(error)) from None

    def _column(self, index: int, about: dict[str, Any]) -> Cells:
        rows = int(about["rows"])
        name, unit, group = (_plain(about[of], _LONGEST_NAME) for of in ("name", "unit", "group"))
        return Cells(name, unit, rows, partial(self._texts, index, rows), group)

    def _signal(self, recording: Recording, index: int, about: dict[str, Any]) -> Signal:
        rows = int(about["rows"])
        numbers = partial(self._numbers, recording, index, rows)
        return Signal(
            _plain(about["name"], _LONGEST_NAME),
            _plain(about["unit"], _LONGEST_NAME),
            rows,
            partial(numbers, "load"),
            partial(numbers, "clock") if about["clock"] else None,
            about["tick"],
            _plain(about["group"], _LONGEST_NAME),
            int(about["line"]),
            partial(numbers, "marked") if about["marked"] else None,
        )

    def _numbers(self, recording: Recording, index: int, rows: int, what: str) -> FloatArray:
        self.left -= _BYTES_PER_NUMBER * rows
        if self.left < 0:
            raise self._too_large()
        filling, begin = Filling(), True
        while True:
            left = 8 * (rows - filling.size)
            about, content = self._asked({"do": what, "index": index, "begin": begin}, most=left)
            if len(content) % 8:
                raise UnreadableLogError(
                    f"{self.file.path.name} cannot be read: only part of its numbers arrived"
                )
            if not content:
                break
            filling.add(np.frombuffer(content, dtype=float), min(1.0, len(content) / left))
            begin = False
        recording.warnings[:] = map(_warning, about["warnings"])
        recording.cut_off = about["cut_off"]
        recording.dates = {_plain(each, _LONGEST_NAME) for each in about["dates"]}
        return filling.whole()

    def _texts(self, index: int, rows: int) -> list[str]:
        self.left -= _BYTES_PER_CELL * rows
        if self.left < 0:
            raise self._too_large()
        most = (4 * LONGEST_CELL + 1) * rows  # UTF-8
        _, content = self._asked({"do": "cells", "index": index}, most=most)
        self.left -= len(content)
        cells = content.decode(errors="replace").split("\0") if rows else []
        if len(cells) != rows:
            raise UnreadableLogError(f"{self.file.path.name} cannot be read: only part of its cells arrived")
        return [_plain(cell, LONGEST_CELL) for cell in cells]

    def _asked(
        self, request: dict[str, Any], *, file: int | None = None, most: int = 0
    ) -> tuple[dict[str, Any], bytearray]:
        try:
            return self.child.ask(request, file=file, most=most, within=_PATIENCE * self.time)
        except FailedError as error:
            raise self._failure(error.kind, str(error)) from None
        except LostError as error:
            raise self._loss(error) from None

    def _failure(self, kind: str, message: str) -> HerseyError:
        """The error that a reader raised: one of ours, or one of a library on damaged bytes."""
        spent = kind == "MemoryError"
        if spent or kind in ("PanicException", "NotStarted"):
            self.child.stop()  # what it holds now may be of no use for the next file
        known = getattr(errors, kind, None)
        if isinstance(known, type) and issubclass(known, HerseyError):
            return known(_plain(message))
        if spent:
            return self._too_large()
        if kind == "NotStarted":
            return self._not_started(message)
        reason = _plain(message.partition("\n")[0])[:160] or kind
        return UnreadableLogError(
            f"{self.file.path.name} cannot be read as {called(self.kind)}. It is damaged, cut off or in "
            f"another format ({reason})"
        )

    def _loss(self, error: LostError) -> UnreadableLogError:
        name = self.file.path.name
        if error.code is None:
            return self._not_started(str(error))
        if error.code == -getattr(signal, "SIGXCPU", 0):
            return UnreadableLogError(
                f"{name} takes more processor time than a sound file of its size. It may be damaged or "
                f"malicious. If you trust it, a higher {_allowed()} also allows more time"
            )
        return UnreadableLogError(
            f"{name} is damaged, or needs more than {self.limit / 1e9:g} GB of memory ({_allowed()}): "
            "the library that reads it crashed"
        )

    def _not_started(self, reason: str) -> UnreadableLogError:
        return UnreadableLogError(
            f"{self.file.path.name} cannot be read: the process that reads such files cannot be started "
            f"({_plain(reason)[:160]})"
        )

    def _too_large(self) -> UnreadableLogError:
        return UnreadableLogError(
            f"{self.file.path.name} needs more than {self.limit / 1e9:g} GB of memory. If you trust it, "
            f"raise the limit with {_allowed('8 GB')}"
        )


def _allowed(limit: str = "") -> str:
    """How the limit of memory is set."""
    if way_in() == "python":
        return f"hersey.memory_limit({limit!r})" if limit else "hersey.memory_limit"
    return Setting("max_memory").to(limit)


def _warning(about: dict[str, Any]) -> Warning:
    """A warning of the reader: its words are shown as they are, never as a template."""
    values = {
        _plain(name): _plain(value) if isinstance(value, str) else value
        for name, value in about["values"].items()
    }
    severity: Severity = "watch" if about["severity"] == "watch" else "note"
    said = {name: _plain(about[name]) for name in ("kind", "text", "where")}
    return Warning.said(**said, title="", severity=severity, values=values)


def _plain(text: str, most: int = _LONGEST) -> str:
    """Text of a file as it may be shown, cut where no name or message is as long."""
    return printable(text if len(text) <= most else f"{text[:most]}...")
