"""Reading delimited text (CSV and its relatives) in blocks, so that memory holds only the numbers used.

A block goes through polars; where that stumbles, or the count of rows does not match the lines, the block is
read again cell by cell, which either succeeds (padded cells, odd quotes) or names line and column.
"""

from __future__ import annotations

import codecs
import hashlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, UnreadableLogError
from hersey.files.reading import OpenFile, appended
from hersey.log.channels import ROLES, ChannelChoice, find_channel, no_channel
from hersey.log.text.footer import end_of_table
from hersey.log.text.layout import SNIFFED, Column, Layout, find_layout, split
from hersey.log.text.numbers import MISSING, is_missing
from hersey.log.text.stamps import Stamps
from hersey.log.torque_log import LARGEST, Channel, LogFile, Run
from hersey.spelling import printable
from hersey.units import Conversion

BLOCK = 1 << 22
#: Bytes of a line at the most.
LONGEST_LINE = 1 << 25
_WAY_OUT = "mend the file, or say --drop-missing to leave such rows out (they will be counted)"

Progress = Callable[[int, int], None]
_NULLS = sorted({s for word in MISSING for s in (word, word.upper(), word.capitalize())} | {"NaN"})


def read_delimited(
    path: Path,
    choices: dict[str, ChannelChoice],
    *,
    isothermal: bool,
    drop_missing: bool,
    progress: Progress | None = None,
) -> tuple[Run, LogFile]:
    """Read one file; ``progress`` is called with bytes done and bytes in all.

    Raises
    ------
    MissingFileError, UnreadableLogError, ChannelError, UnitError
        Each names the file, and the line and column where that applies.
    """
    name = printable(path.name)
    with open_delimited(path) as file:
        layout, end, size = file.layout, file.end, file.opened.size
        table = _Table(name, layout, _channels(layout, choices, isothermal, name), drop_missing)
        table.read(file.opened, end.byte, progress)
        growth = file.opened.growth(table.digest.hexdigest())
    arrays = table.arrays()
    run = Run(name, arrays["time"], arrays["torque"], arrays["speed"], arrays.get("temperature"))
    channels = tuple(Channel(role, column.name, si.unit) for role, (column, si) in table.channels.items())
    log = LogFile(
        name,
        table.digest.hexdigest(),
        size,
        run.time.size,
        table.missing,
        channels,
        layout.comments,
        end.cut_off,
        (*layout.notes, *table.notes(), *end.notes, *growth),
    )
    return run, log


def delimited_columns(path: Path) -> tuple[Column, ...]:
    """Return the columns of a text file that hold numbers or time stamps.

    Raises
    ------
    MissingFileError, UnreadableLogError
        If it cannot be opened, or holds no table.
    """
    with open_delimited(path) as file:
        return tuple(column for column in file.layout.columns if column.index not in file.layout.texts)


class DelimitedFile:
    """A text table while its file is open: whoever looks at it sees the same bytes."""

    def __init__(self, opened: OpenFile) -> None:
        """Find where the table starts, what its columns are, and where it ends."""
        file, size = opened.file, opened.size
        self.opened, self.layout = opened, find_layout(file.read(min(size, SNIFFED)), opened.path.name)
        self.end = end_of_table(file, size, self.layout)

    def text(self) -> tuple[bytes, list[str]]:
        """Return the file up to the end of the table, and notes if a logger appends to it.

        Raises
        ------
        UnreadableLogError
            If the file is no longer what it was, unless it has only grown.
        """
        self.opened.file.seek(0)
        text = self.opened.file.read(self.opened.size)
        return text[: self.end.byte], self.opened.growth(hashlib.sha256(text).hexdigest())

    def numbers(self, chosen: Sequence[Column], *, complete: bool) -> list[FloatArray]:
        """Return columns as written (time stamps in s), shape (rows,), NaN where a number is missing.

        Raises
        ------
        UnreadableLogError
            If a cell is no number, naming line and column; if ``complete``, also if one is missing; if the
            file is no longer what it was, unless it has only grown.
        """
        as_written = {str(i): (column, Conversion(column.unit, 1.0, 0.0)) for i, column in enumerate(chosen)}
        table = _Table(self.opened.path.name, self.layout, as_written, drop_missing=not complete)
        numbers = table.numbers(self.opened, self.end.byte)
        self.opened.growth(table.digest.hexdigest())
        return numbers


@contextmanager
def open_delimited(path: Path) -> Iterator[DelimitedFile]:
    """Open a text table once.

    Raises
    ------
    MissingFileError, UnreadableLogError
        If it cannot be opened, or holds no table.
    """
    with appended(path) as opened:
        yield DelimitedFile(opened)


def _channels(
    layout: Layout, choices: dict[str, ChannelChoice], isothermal: bool, name: str
) -> dict[str, tuple[Column, Conversion]]:
    if isothermal and choices["temperature"] != ChannelChoice():
        raise ChannelError("--isothermal leaves temperature out: give no --temperature beside it")
    used = [role for role in ROLES if not (role == "temperature" and isothermal)]
    if layout.headless and not all(choices[role].name for role in used):
        raise UnreadableLogError(layout.headless)
    chosen: dict[str, tuple[Column, Conversion]] = {}
    for role in sorted(used, key=lambda r: r != "torque"):  # without it the rest is of no use
        channel = find_channel(role, layout.named, choices[role], name)
        if channel is None:
            error = no_channel(role, layout.named, name)
            if role == "temperature":
                error.args = (*error.args, "or say --isothermal to leave temperature out")
            raise error
        other = next((r for r, (column, _) in chosen.items() if column == channel[0]), None)
        if other:
            raise ChannelError(f"{name}: column '{channel[0]}' cannot be both {other} and {role}")
        chosen[role] = channel
    return {role: chosen[role] for role in used}


@dataclass
class _Block:
    """Lines of the table as UTF-8, and the number of each in the file."""

    text: bytes
    lines: Sequence[int]

    def cells(self, row: int, separator: str) -> list[str]:
        return split(self.text.split(b"\n")[row].decode("utf-8", errors="replace").rstrip("\r"), separator)


class _Table:
    """The table of one file while it is being read."""

    def __init__(
        self, name: str, layout: Layout, channels: dict[str, tuple[Column, Conversion]], drop_missing: bool
    ) -> None:
        self.name, self.layout, self.channels, self.drop_missing = name, layout, channels, drop_missing
        self.parts: dict[str, list[FloatArray]] = {role: [] for role in channels}
        self.digest = hashlib.sha256()
        self.missing = 0
        self.stamps = {i: Stamps(style) for i, style in layout.stamps.items()}
        self.last_time = -np.inf

    @property
    def columns(self) -> list[Column]:
        return [column for column, _ in self.channels.values()]

    def read(self, opened: OpenFile, end: int, progress: Progress | None) -> None:
        """Read the table, which ends at byte ``end``."""
        for block, done in self._blocks(opened, end):
            if block.lines:
                self._add(block)
            if progress:
                progress(done, opened.size)

    def numbers(self, opened: OpenFile, end: int) -> list[FloatArray]:
        """The columns as written, NaN where a number is missing and may be."""
        parts: list[list[FloatArray]] = [[] for _ in self.columns]
        for block, _ in self._blocks(opened, end):
            if block.lines:
                self._keep(block, parts)
        return [np.concatenate(values) if values else np.empty(0) for values in parts]

    def _blocks(self, opened: OpenFile, end: int) -> Iterator[tuple[_Block, int]]:
        """Lines of the table, and bytes read so far; what follows the table is hashed with it."""
        opened.file.seek(0)
        for text, line, done in _blocks(opened.file, end, self.layout, self.name, self.digest.update):
            yield self._cleaned(text, line), done
        left = opened.size - end
        while left and (chunk := opened.file.read(min(left, BLOCK))):
            self.digest.update(chunk)
            left -= len(chunk)

    def _keep(self, block: _Block, parts: list[list[FloatArray]]) -> None:
        values = self._parsed(block)
        gone = ~np.logical_and.reduce([np.isfinite(column) for column in values])
        if gone.any() and not self.drop_missing:
            raise self._missing(block, values, int(np.argmax(gone)), "mend the file")
        for part, column in zip(parts, values, strict=True):
            part.append(np.where(np.isfinite(column), column, np.nan))

    def notes(self) -> list[str]:
        """What was done to time stamps."""
        columns = [column for column in self.columns if column.index in self.stamps]
        return [self.stamps[column.index].note(column.name) for column in columns]

    def arrays(self) -> dict[str, FloatArray]:
        arrays = {}
        for role in self.channels:  # one after another, so that only one is held twice
            parts = self.parts.pop(role)
            arrays[role] = np.concatenate(parts) if parts else np.empty(0)
        if arrays["time"].size < 2:
            count = arrays["time"].size
            raise UnreadableLogError(f"{self.name} has {count} row(s) with a number in every column needed")
        if arrays["time"][-1] == arrays["time"][0]:
            raise UnreadableLogError(f"{self.name}: all rows carry the same time")
        return arrays

    def _cleaned(self, text: bytes, line: int) -> _Block:
        """The block without blank lines and comments."""
        comment = self.layout.comment.encode()
        count = text.count(b"\n") + (not text.endswith(b"\n"))
        blank = text.startswith((b"\n", b"\r\n")) or b"\n\n" in text or b"\n\r\n" in text
        if not blank and not text.startswith(comment) and b"\n" + comment not in text:
            return _Block(text, range(line, line + count))
        kept, numbers = [], []
        for number, row in enumerate(text.split(b"\n"), start=line):
            if row.lstrip().startswith(comment):
                cells = split(row.decode("utf-8", errors="replace"), self.layout.separator)
                if len(cells) == len(self.layout.columns):
                    raise UnreadableLogError(
                        f"{self.name}, line {number} starts with '{self.layout.comment}' like a comment but "
                        "has as many cells as a row: mend or remove it"
                    )
            elif row.strip():
                kept.append(row)
                numbers.append(number)
        return _Block(b"\n".join(kept), numbers)

    def _add(self, block: _Block) -> None:
        values = self._parsed(block)
        gone = ~np.logical_and.reduce([np.isfinite(v) for v in values])
        if gone.any() and not self.drop_missing:
            raise self._missing(block, values, int(np.argmax(gone)))
        self.missing += int(gone.sum())
        kept = np.flatnonzero(~gone) if gone.any() else None
        for (role, (column, si)), numbers in zip(self.channels.items(), values, strict=True):
            chosen = numbers if kept is None else numbers[kept]
            with np.errstate(over="ignore"):
                converted = chosen * si.scale + si.offset
            if np.any(np.abs(converted) > LARGEST):
                row = int(np.argmax(np.abs(converted) > LARGEST))
                line = block.lines[row if kept is None else int(kept[row])]
                raise UnreadableLogError(
                    f"{self.name}, line {line}, column '{column.name}': "
                    f"{chosen[row]:g} {si.unit} is no {role}"
                )
            self.parts[role].append(converted)
        self._check_time(block, kept)

    def _check_time(self, block: _Block, kept: np.ndarray[tuple[int], np.dtype[np.intp]] | None) -> None:
        time = self.parts["time"][-1]
        steps = np.diff(time, prepend=self.last_time)
        if (steps < 0).any():
            row = int(np.argmax(steps < 0))
            line = block.lines[row if kept is None else int(kept[row])]
            raise UnreadableLogError(
                f"{self.name}, line {line}: time runs backwards by {-steps[row]:.6g} s; "
                "split the file there, or sort its rows"
            )
        self.last_time = float(time[-1]) if time.size else self.last_time

    def _parsed(self, block: _Block) -> list[FloatArray]:
        """The wanted columns as numbers, NaN where a cell stands for a missing value."""
        wanted = sorted(column.index for column in self.columns)
        plain = self.layout.style.is_plain and not self.stamps
        comma = self.layout.style.decimal_comma and not self.layout.style.thousands
        fast = plain or (
            comma and not self.stamps and self.layout.separator != "," and b"." not in block.text
        )  # a point beside decimal commas is a cell that could be read in two ways
        try:
            frame = pl.read_csv(
                block.text,
                has_header=False,
                columns=wanted,
                separator=self.layout.separator,
                decimal_comma=fast and comma,
                schema_overrides=[pl.Float64 if fast else pl.String] * len(self.layout.columns),
                null_values=_NULLS,
                encoding="utf8-lossy",
            )
        except pl.exceptions.PolarsError:
            return self._parsed_slowly(block)
        if frame.height != len(block.lines) or frame.width != len(wanted):
            return self._parsed_slowly(block)
        by_index = dict(zip(wanted, frame.get_columns(), strict=True))
        if fast:
            return [by_index[c.index].cast(pl.Float64).fill_null(np.nan).to_numpy() for c in self.columns]
        values = [self._values(c, by_index[c.index].fill_null("")) for c in self.columns]
        readable = [v for v in values if v is not None]
        return readable if len(readable) == len(values) else self._parsed_slowly(block)

    def _values(self, column: Column, cells: pl.Series) -> FloatArray | None:
        """Cells of text as numbers or as time stamps in s; None if one of them is neither."""
        stamps = self.stamps.get(column.index)
        return stamps.seconds(cells) if stamps else self.layout.style.values(cells)

    def _parsed_slowly(self, block: _Block) -> list[FloatArray]:
        width = len(self.layout.columns)
        table: list[list[str]] = []
        for row, text in enumerate(block.text.split(b"\n")[: len(block.lines)]):
            cells = split(text.decode("utf-8", errors="replace").rstrip("\r"), self.layout.separator)
            if any(cells[width:]):
                raise UnreadableLogError(
                    f"{self.name}, line {block.lines[row]}: {len(cells)} cells where the header has {width}"
                )
            table.append(cells + [""] * (width - len(cells)))
        out = []
        for column in self.columns:
            cells = [row[column.index] for row in table]
            values = self._values(column, pl.Series(cells, dtype=pl.String))
            if values is None:
                raise self._no_number(block, column, cells)
            out.append(values)
        return out

    def _no_number(self, block: _Block, column: Column, cells: list[str]) -> UnreadableLogError:
        """The error that names the first cell of a column which is no number."""

        def good(cell: str) -> bool:
            if column.index not in self.stamps:
                return is_missing(cell) or self.layout.style.is_number(cell)
            return self._values(column, pl.Series([cell], dtype=pl.String)) is not None

        row = next(i for i, cell in enumerate(cells) if not good(cell))
        what = "time stamp" if column.index in self.stamps else "number"
        return UnreadableLogError(
            f"{self.name}, line {block.lines[row]}, column '{column.name}': "
            f"'{cells[row][:40]}' is not a {what}"
        )

    def _missing(
        self, block: _Block, values: list[FloatArray], row: int, way_out: str = _WAY_OUT
    ) -> UnreadableLogError:
        cells = block.cells(row, self.layout.separator)
        column = next(c for c, v in zip(self.columns, values, strict=True) if not np.isfinite(v[row]))
        cell = cells[column.index] if column.index < len(cells) else ""
        what = f"'{cell[:40]}' stands" if cell else "nothing stands"
        return UnreadableLogError(
            f"{self.name}, line {block.lines[row]}, column '{column.name}': {what} where a number is "
            f"needed; {way_out}"
        )


def _blocks(
    file: BinaryIO, end: int, layout: Layout, name: str, hashed: Callable[[bytes], None]
) -> Iterator[tuple[bytes, int, int]]:
    """Yield whole lines of UTF-8 text, the line number of the first, and bytes read so far."""
    plain = layout.encoding == "utf-8-sig"
    decoder = None if plain else codecs.getincrementaldecoder(layout.encoding)(errors="replace")
    skip, line, rest, done, more = layout.first_line - 1, 1, b"", 0, True
    while more:
        chunk = file.read(min(BLOCK, end - done))
        more = bool(chunk)
        hashed(chunk)
        done += len(chunk)
        text = rest + (decoder.decode(chunk, final=not more).encode() if decoder else chunk)
        last = text.rfind(b"\n") + 1 if more else len(text)
        if more and not last and len(text) > LONGEST_LINE:
            raise UnreadableLogError(f"{name}: a line has over {LONGEST_LINE} bytes: no log has such")
        block, rest = text[:last], text[last:]
        if skip:
            above = _end_of_lines(block, skip)
            passed = block.count(b"\n", 0, above)
            skip, line, block = skip - passed, line + passed, block[above:]
        if block and not block.isspace():
            yield block, line, done
        line += block.count(b"\n")


def _end_of_lines(text: bytes, count: int) -> int:
    """Byte behind the first ``count`` lines, or behind the last one if there are fewer."""
    end = 0
    for _ in range(count):
        following = text.find(b"\n", end) + 1
        if not following:
            return len(text)
        end = following
    return end
