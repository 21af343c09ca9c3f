"""Reading delimited text (CSV and its relatives) in blocks, so that memory holds only the numbers used."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
import polars as pl

from hersey.errors import MissingFileError, UnreadableLogError
from hersey.log.channels import ROLES, ChannelChoice, find_channel, no_channel
from hersey.log.layout import MISSING, SNIFFED, Column, Layout, find_layout, is_missing, is_number, split
from hersey.log.torque_log import Channel, FloatArray, LogFile, Run
from hersey.units import Conversion

BLOCK = 1 << 25

Progress = Callable[[int, int], None]


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
        size = path.stat().st_size
        with path.open("rb") as file:
            layout = find_layout(file.read(SNIFFED), name)
            found = _channels(layout, choices, isothermal, name)
            file.seek(0)
            arrays, missing, digest = _read_table(file, layout, found, name, drop_missing, size, progress)
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such file") from None
    except IsADirectoryError:
        raise MissingFileError(f"{path} is a directory: name the log files in it") from None
    except PermissionError:
        raise MissingFileError(f"{path} cannot be opened: no permission to read it") from None
    run = Run(name, arrays["time"], arrays["torque"], arrays["speed"], arrays.get("temperature"))
    channels = tuple(Channel(role, column.name, line.unit) for role, (column, line) in found.items())
    return run, LogFile(name, digest, size, run.time.size, missing, channels, layout.comments)


def _channels(
    layout: Layout, choices: dict[str, ChannelChoice], isothermal: bool, name: str
) -> dict[str, tuple[Column, Conversion]]:
    found: dict[str, tuple[Column, Conversion]] = {}
    for role in ROLES:
        if role == "temperature" and isothermal and not choices[role].name:
            continue
        channel = find_channel(role, layout.columns, choices[role], name)
        if channel is None:
            error = no_channel(role, layout.columns, name)
            if role == "temperature":
                error.args = (*error.args, "or say --isothermal to leave temperature out")
            raise error
        found[role] = channel
    return found


def _read_table(
    file: BinaryIO,
    layout: Layout,
    found: dict[str, tuple[Column, Conversion]],
    name: str,
    drop_missing: bool,
    size: int,
    progress: Progress | None,
) -> tuple[dict[str, FloatArray], int, str]:
    parts: dict[str, list[FloatArray]] = {role: [] for role in found}
    digest = hashlib.sha256()
    missing = 0
    last_time = -np.inf
    for block, line, done in _blocks(file, layout, digest.update):
        columns = _parse(block, line, layout, [column for column, _ in found.values()], name)
        gone = ~np.logical_and.reduce([np.isfinite(values) for values in columns])
        if gone.any() and not drop_missing:
            raise _missing_value(block, line, layout, [c for c, _ in found.values()], name)
        missing += int(gone.sum())
        for (role, (_, si)), values in zip(found.items(), columns, strict=True):
            kept = values[~gone] if gone.any() else values
            parts[role].append(kept * si.scale + si.offset)
        time = parts["time"][-1]
        steps = np.diff(time, prepend=last_time)
        if (steps < 0).any():
            row = int(np.argmax(steps < 0))
            number, _ = list(_rows(block, line, layout))[int(np.flatnonzero(~gone)[row])]
            raise UnreadableLogError(
                f"{name}, line {number}: time runs backwards by {-steps[row]:.6g} s; "
                "split the file there, or sort its rows"
            )
        last_time = float(time[-1]) if time.size else last_time
        if progress:
            progress(done, size)
    arrays = {}
    for role in found:  # one after another, so that only one is held twice
        arrays[role] = np.concatenate(parts.pop(role)) if parts[role] else np.empty(0)
    if arrays["time"].size == 0:
        raise UnreadableLogError(f"{name}: no row has a number in every column that is needed")
    return arrays, missing, digest.hexdigest()


def _blocks(
    file: BinaryIO, layout: Layout, hashed: Callable[[bytes], None]
) -> Iterator[tuple[bytes, int, int]]:
    """Yield whole lines of UTF-8 text, the line number of the first, and bytes read so far."""
    skip, line, rest = layout.first_line - 1, 1, b""
    decoder = None if layout.encoding != "utf-16" else io.IncrementalNewlineDecoder(None, translate=False)
    utf16 = _Utf16() if decoder else None
    done = 0
    while chunk := file.read(BLOCK):
        hashed(chunk)
        done += len(chunk)
        text = rest + (utf16(chunk) if utf16 else chunk)
        end = text.rfind(b"\n") + 1
        if len(chunk) < BLOCK:
            end = len(text)
        block, rest = text[:end], text[end:]
        while skip and block:
            head, _, block = block.partition(b"\n")
            skip, line = skip - 1, line + 1
            del head
        if block and not block.isspace():
            yield block, line, done
        line += block.count(b"\n")
    if rest and not rest.isspace():
        yield rest, line, done


class _Utf16:
    """Turns chunks of UTF-16 into UTF-8."""

    def __init__(self) -> None:
        import codecs

        self._decoder = codecs.getincrementaldecoder("utf-16")()

    def __call__(self, chunk: bytes) -> bytes:
        return self._decoder.decode(chunk).encode()


def _parse(block: bytes, line: int, layout: Layout, columns: list[Column], name: str) -> list[FloatArray]:
    """The wanted columns of a block as numbers, NaN where a cell stands for a missing value."""
    if block.startswith((b"\n", b"\r\n")) or b"\n\n" in block or b"\n\r\n" in block:
        block = b"\n".join(text for text in block.splitlines() if text.strip())
    wanted = sorted(column.index for column in columns)
    nulls = [spelling for word in MISSING for spelling in {word, word.upper(), word.capitalize(), "NaN"}]
    try:
        frame = pl.read_csv(
            block,
            has_header=False,
            columns=wanted,
            separator=layout.separator,
            comment_prefix=layout.comment,
            decimal_comma=layout.decimal_comma,
            schema_overrides=[pl.Float64] * len(layout.columns),
            null_values=sorted(set(nulls)),
            encoding="utf8-lossy",
        )
    except pl.exceptions.PolarsError as error:
        raise _bad_cell(block, line, layout, columns, name) or UnreadableLogError(
            f"{name}: the rows from line {line} on cannot be read as a table: {str(error).splitlines()[0]}"
        ) from None
    by_index = dict(zip(wanted, frame.get_columns(), strict=True))
    return [by_index[c.index].cast(pl.Float64).fill_null(np.nan).to_numpy() for c in columns]


def _rows(block: bytes, line: int, layout: Layout) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of each row of the table: no comments, no blank lines."""
    for number, text in enumerate(block.decode("utf-8", errors="replace").splitlines(), start=line):
        if text.strip() and not (layout.comment and text.startswith(layout.comment)):
            yield number, split(text, layout.separator)


def _bad_cell(
    block: bytes, line: int, layout: Layout, columns: list[Column], name: str
) -> UnreadableLogError | None:
    """The first cell that is neither a number nor a known word for a missing one."""
    for number, row in _rows(block, line, layout):
        if len(row) > len(layout.columns) and any(row[len(layout.columns) :]):
            return UnreadableLogError(
                f"{name}, line {number}: {len(row)} cells where the header has {len(layout.columns)}"
            )
        for column in columns:
            cell = row[column.index] if column.index < len(row) else ""
            if not is_missing(cell) and not is_number(cell, layout.decimal_comma):
                return UnreadableLogError(
                    f"{name}, line {number}, column '{column.name}': '{cell[:40]}' is not a number"
                )
    return None


def _missing_value(
    block: bytes, line: int, layout: Layout, columns: list[Column], name: str
) -> UnreadableLogError:
    for number, row in _rows(block, line, layout):
        for column in columns:
            cell = row[column.index] if column.index < len(row) else ""
            if is_missing(cell):
                shown = f"'{cell}' stands" if cell else "nothing stands"
                return UnreadableLogError(
                    f"{name}, line {number}, column '{column.name}': {shown} where a number is needed; "
                    "mend the file, or say --drop-missing to leave such rows out (they will be counted)"
                )
    return UnreadableLogError(f"{name}: a row from line {line} on has no number; say --drop-missing")
