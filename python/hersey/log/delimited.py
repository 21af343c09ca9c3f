"""Reading delimited text (CSV and its relatives) in blocks, so that memory holds only the numbers used.

A block goes through polars; where that stumbles, or the count of rows does not match the lines, the block is
read again cell by cell, which either succeeds (padded cells, odd quotes) or names line and column.
"""

from __future__ import annotations

import codecs
import hashlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
import polars as pl

from hersey.errors import ChannelError, MissingFileError, UnreadableLogError
from hersey.log.channels import ROLES, ChannelChoice, find_channel, no_channel
from hersey.log.layout import MISSING, SNIFFED, Column, Layout, find_layout, is_missing, is_number, split
from hersey.log.torque_log import Channel, FloatArray, LogFile, Run
from hersey.units import Conversion

BLOCK = 1 << 25
#: No quantity of a drive comes near this, in SI.
LARGEST = 1e12

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
    name = path.name
    try:
        if path.exists() and not path.is_file():
            what = "a directory: name the log files in it" if path.is_dir() else "no ordinary file"
            raise MissingFileError(f"{path} is {what}")
        size = path.stat().st_size
        with path.open("rb") as file:
            layout = find_layout(file.read(SNIFFED), name)
            table = _Table(name, layout, _channels(layout, choices, isothermal, name), drop_missing)
            file.seek(0)
            table.read(file, size, progress)
    except MissingFileError:
        raise
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such file") from None
    except OSError as error:
        raise MissingFileError(f"{path} cannot be read: {error.strerror}") from None
    arrays = table.arrays()
    run = Run(name, arrays["time"], arrays["torque"], arrays["speed"], arrays.get("temperature"))
    channels = tuple(Channel(role, column.name, si.unit) for role, (column, si) in table.found.items())
    digest, missing = table.digest.hexdigest(), table.missing
    return run, LogFile(name, digest, size, run.time.size, missing, channels, layout.comments, table.cut_off)


def _channels(
    layout: Layout, choices: dict[str, ChannelChoice], isothermal: bool, name: str
) -> dict[str, tuple[Column, Conversion]]:
    if isothermal and choices["temperature"] != ChannelChoice():
        raise ChannelError("--isothermal leaves temperature out: give no --temperature beside it")
    found: dict[str, tuple[Column, Conversion]] = {}
    for role in ROLES:
        if role == "temperature" and isothermal:
            continue
        channel = find_channel(role, layout.columns, choices[role], name)
        if channel is None:
            error = no_channel(role, layout.columns, name)
            if role == "temperature":
                error.args = (*error.args, "or say --isothermal to leave temperature out")
            raise error
        other = next((r for r, (column, _) in found.items() if column == channel[0]), None)
        if other:
            raise ChannelError(f"{name}: column '{channel[0]}' cannot be both {other} and {role}")
        found[role] = channel
    return found


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
        self, name: str, layout: Layout, found: dict[str, tuple[Column, Conversion]], drop_missing: bool
    ) -> None:
        self.name, self.layout, self.found, self.drop_missing = name, layout, found, drop_missing
        self.parts: dict[str, list[FloatArray]] = {role: [] for role in found}
        self.digest = hashlib.sha256()
        self.missing = 0
        self.cut_off = False
        self.last_time = -np.inf

    @property
    def columns(self) -> list[Column]:
        return [column for column, _ in self.found.values()]

    def read(self, file: BinaryIO, size: int, progress: Progress | None) -> None:
        tail = b""
        for text, line, done in _blocks(file, self.layout, self.digest.update):
            block = self._cleaned(text, line)
            if block.lines:
                self._add(block)
            if progress:
                progress(done, size)
            tail = (tail + text[-4096:])[-4096:]
        self.cut_off = _looks_cut_off(tail)

    def arrays(self) -> dict[str, FloatArray]:
        arrays = {}
        for role in self.found:  # one after another, so that only one is held twice
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
        for (role, (column, si)), numbers in zip(self.found.items(), values, strict=True):
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
        if self.layout.decimal_comma and b"." in block.text:  # where one cell would be read in two ways
            return self._parsed_slowly(block)
        wanted = sorted(column.index for column in self.columns)
        try:
            frame = pl.read_csv(
                block.text,
                has_header=False,
                columns=wanted,
                separator=self.layout.separator,
                decimal_comma=self.layout.decimal_comma,
                schema_overrides=[pl.Float64] * len(self.layout.columns),
                null_values=_NULLS,
                encoding="utf8-lossy",
            )
        except pl.exceptions.PolarsError:
            return self._parsed_slowly(block)
        if frame.height != len(block.lines) or frame.width != len(wanted):
            return self._parsed_slowly(block)
        by_index = dict(zip(wanted, frame.get_columns(), strict=True))
        return [by_index[c.index].cast(pl.Float64).fill_null(np.nan).to_numpy() for c in self.columns]

    def _parsed_slowly(self, block: _Block) -> list[FloatArray]:
        columns, width, comma = self.columns, len(self.layout.columns), self.layout.decimal_comma
        out = np.full((len(columns), len(block.lines)), np.nan)
        for row, text in enumerate(block.text.split(b"\n")[: len(block.lines)]):
            cells = split(text.decode("utf-8", errors="replace").rstrip("\r"), self.layout.separator)
            line = block.lines[row]
            if any(cells[width:]):
                raise UnreadableLogError(
                    f"{self.name}, line {line}: {len(cells)} cells where the header has {width}"
                )
            for i, column in enumerate(columns):
                cell = cells[column.index] if column.index < len(cells) else ""
                if is_number(cell, comma):
                    out[i, row] = float(cell.replace(",", ".") if comma else cell)
                elif not is_missing(cell):
                    raise UnreadableLogError(
                        f"{self.name}, line {line}, column '{column.name}': '{cell[:40]}' is not a number"
                    )
        return list(out)

    def _missing(self, block: _Block, values: list[FloatArray], row: int) -> UnreadableLogError:
        cells = block.cells(row, self.layout.separator)
        column = next(c for c, v in zip(self.columns, values, strict=True) if not np.isfinite(v[row]))
        cell = cells[column.index] if column.index < len(cells) else ""
        shown = f"'{cell[:40]}' stands" if cell else "nothing stands"
        return UnreadableLogError(
            f"{self.name}, line {block.lines[row]}, column '{column.name}': {shown} where a number is "
            "needed; mend the file, or say --drop-missing to leave such rows out (they will be counted)"
        )


def _blocks(
    file: BinaryIO, layout: Layout, hashed: Callable[[bytes], None]
) -> Iterator[tuple[bytes, int, int]]:
    """Yield whole lines of UTF-8 text, the line number of the first, and bytes read so far."""
    decoder = (
        codecs.getincrementaldecoder("utf-16")(errors="replace") if layout.encoding == "utf-16" else None
    )
    skip, line, rest, done, more = layout.first_line - 1, 1, b"", 0, True
    while more:
        chunk = file.read(BLOCK)
        more = bool(chunk)
        hashed(chunk)
        done += len(chunk)
        text = rest + (decoder.decode(chunk, final=not more).encode() if decoder else chunk)
        end = text.rfind(b"\n") + 1 if more else len(text)
        block, rest = text[:end], text[end:]
        while skip and block:
            _, _, block = block.partition(b"\n")
            skip, line = skip - 1, line + 1
        if block and not block.isspace():
            yield block, line, done
        line += block.count(b"\n")


def _looks_cut_off(text: bytes) -> bool:
    """Whether the text stops within a line: no line end, and fewer characters than the line before."""
    if text.endswith(b"\n"):
        return False
    *_, before, last = (b"", *text.split(b"\n"))
    return 0 < len(last) < len(before.rstrip(b"\r"))
