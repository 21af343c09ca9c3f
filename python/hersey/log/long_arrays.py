"""Numbers of long logs: on disk instead of in memory, and gone over a block at a time.

A channel of more than `HELD` rows lies in a file without a name, which ends with the last array of it. It is
mapped into memory, so it is an array like any other; only a pass over all of it (`blocks`) lets go of what it
has seen, and memory holds no more than a block. Where there is no room on disk, it is held in memory.
"""

from __future__ import annotations

import mmap
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray

#: Rows that a channel may have in memory.
HELD = 1 << 22
#: Rows of a block, which stays in the cache.
BLOCK = 1 << 16
#: Rows after which what was seen is let go.
_LET_GO = 1 << 20
#: Bytes that one number may bring into memory with it: the pages around it.
_PAGES = 1 << 21
#: Room for so many times the rows that are expected.
_ROOM = 1.05
#: Where temporary files may be large: the other folder is often in memory.
_LARGE_FILES = Path("/var/tmp")
_BYTES = np.dtype(float).itemsize


class Filling:
    """Numbers of one channel, shape (rows,), as they are read."""

    def __init__(self) -> None:
        """Begin without any."""
        self.size = 0
        self._room = np.empty(0)
        self._file: BinaryIO | None = None
        self._held = HELD

    def add(self, part: FloatArray, done: float = 1.0) -> None:
        """Add the numbers of a part of the file, of which the share ``done`` is read then."""
        size = self.size + part.size
        if size > self._held:
            try:
                self._write(part)
            except OSError:  # no room
                self._to_memory()
            else:
                self.size = size
                return
        if size > self._room.size:
            expected = int(_ROOM * size / max(done, 0.01))
            if self._held == HELD:
                expected = min(expected, HELD)
            room = np.empty(max(size, expected))  # memory counts once it is filled
            room[: self.size] = self._room[: self.size]
            self._room = room
        self._room[self.size : size] = part
        self.size = size

    def whole(self) -> FloatArray:
        """Return all numbers."""
        if self._file is not None:
            with self._file as file:
                self._room = np.frombuffer(mmap.mmap(file.fileno(), _BYTES * self.size), dtype=float)
            self._file = None
        return self._room[: self.size]

    def _write(self, part: FloatArray) -> None:
        if self._file is None:
            self._file = tempfile.TemporaryFile(buffering=0, dir=_folder())  # noqa: SIM115 # see `whole`
            _write(self._file, self._room[: self.size])
            self._room = np.empty(0)
        _write(self._file, part)

    def _to_memory(self) -> None:
        """Hold what the file holds, and whatever comes."""
        self._held = np.iinfo(np.intp).max
        if self._file is not None and not self._room.size:
            with self._file as file:
                file.seek(0)
                self._room = np.fromfile(file, dtype=float, count=self.size)
        self._file = None


def _folder() -> Path | None:
    """Where a temporary file may be large; None for the usual place."""
    named = any(os.environ.get(name) for name in ("TMPDIR", "TEMP", "TMP"))
    return _LARGE_FILES if not named and os.access(_LARGE_FILES, os.W_OK | os.X_OK) else None


def _write(file: BinaryIO, part: FloatArray) -> None:
    left = np.ascontiguousarray(part).data.cast("B")
    while left:
        left = left[file.write(left) :]


def blocks(rows: int, *arrays: FloatArray, size: int = 0) -> Iterator[slice]:
    """Yield the rows block by block (of ``size`` rows); of the arrays, what lies behind is let go."""
    size = size or BLOCK
    for start in range(0, rows, size):
        yield slice(start, min(start + size, rows))
        end = start + size
        if end // _LET_GO > start // _LET_GO:
            for each in arrays:
                let_go(each[start // _LET_GO * _LET_GO : end])


def passed(start: int, end: int, *arrays: FloatArray) -> None:
    """Note that these rows were seen: what lies behind is let go now and then and where rows were skipped."""
    begun = start // _LET_GO * _LET_GO
    last = end if end // _LET_GO > start // _LET_GO else begun
    if last > max(0, begun - _LET_GO):
        for each in arrays:
            let_go(each[max(0, begun - _LET_GO) : last])


def let_go(values: FloatArray) -> None:
    """Take no memory for numbers that lie on disk until they are asked for again."""
    owner: object = values
    while isinstance(owner, np.ndarray):
        whole, owner = owner, owner.base
    mapped = owner.obj if isinstance(owner, memoryview) else None
    if not isinstance(mapped, mmap.mmap) or not values.size or not hasattr(mmap, "MADV_DONTNEED"):
        return
    start = values.__array_interface__["data"][0] - whole.__array_interface__["data"][0]
    first = start // _PAGES * _PAGES
    end = min(-(-(start + values.nbytes) // _PAGES) * _PAGES, len(mapped))
    mapped.madvise(mmap.MADV_DONTNEED, first, end - first)


def rows_where(true: Callable[[slice], BoolArray], rows: int, *arrays: FloatArray) -> IntArray:
    """Return the rows for which a condition holds, which is asked of one block of them after another."""
    found = [np.flatnonzero(true(block)) + block.start for block in blocks(rows, *arrays)]
    return joined(found)


def joined(parts: Iterable[IntArray]) -> IntArray:
    """Return rows of several parts, one after another."""
    return np.concatenate([np.empty(0, dtype=np.intp), *parts])


def without(values: FloatArray, rows: IntArray) -> FloatArray:
    """Return the numbers without some rows, which are given in order."""
    if not rows.size:
        return values
    kept = Filling()
    for block in blocks(values.size, values):
        first, last = np.searchsorted(rows, (block.start, block.stop))
        part = values[block]
        part = np.delete(part, rows[first:last] - block.start) if last > first else part
        kept.add(part, block.stop / values.size)
    return kept.whole()


def each_block(function: Callable[..., FloatArray], *arrays: FloatArray) -> FloatArray:
    """Return what a function makes of every number of arrays, taken a block at a time."""
    made, rows = Filling(), arrays[0].size
    for block in blocks(rows, *arrays):
        made.add(function(*(values[block] for values in arrays)), block.stop / rows)
    return made.whole()


def ends(values: FloatArray) -> tuple[float, float]:
    """Return the least and the greatest number; NaN if one is missing."""
    parts = [(values[block].min(), values[block].max()) for block in blocks(values.size, values)]
    least, most = np.array(parts).T
    return float(least.min()), float(most.max())


def mean(values: FloatArray) -> float:
    """Return the mean, to the bit that of NumPy."""
    return _sum(lambda rows: values[rows], 0, values.size, values) / values.size


def deviation(values: FloatArray) -> float:
    """Return the standard deviation, to the bit that of NumPy."""
    return float(np.sqrt(variance(values)))


def variance(values: FloatArray) -> float:
    """Return the variance, to the bit that of NumPy."""
    middle = mean(values)

    def squares(rows: slice) -> FloatArray:
        away = values[rows] - middle
        return away * away

    return _sum(squares, 0, values.size, values) / values.size


def _sum(terms: Callable[[slice], FloatArray], start: int, end: int, values: FloatArray) -> float:
    """The sum of terms, halved as NumPy halves it, so that rounding is the same."""
    if end - start <= BLOCK:
        total = float(np.add.reduce(terms(slice(start, end))))
        passed(start, end, values)
        return total
    half = (end - start) // 2
    middle = start + half - half % 8
    return _sum(terms, start, middle, values) + _sum(terms, middle, end, values)


def means_of(values: FloatArray, rows: int) -> FloatArray:
    """Return the means of so many rows each; the last may have fewer."""
    means = []
    for block in blocks(values.size, values, size=max(1, BLOCK // rows) * rows):
        starts = np.arange(0, block.stop - block.start, rows)
        counts = np.diff(starts, append=block.stop - block.start)
        means.append(np.add.reduceat(values[block], starts) / counts)
    return np.concatenate(means)


def every(values: FloatArray, step: int) -> FloatArray:
    """Return every so manieth number, from the first on."""
    size = max(1, BLOCK // step) * step
    return np.concatenate([values[block][::step].copy() for block in blocks(values.size, values, size=size)])


def rows_before(row: int, left_out: IntArray) -> int:
    """Return where a row stood, counted from 0, before rows that are given in order were left out."""
    return row + int(np.searchsorted(left_out - np.arange(left_out.size), row, side="right"))
