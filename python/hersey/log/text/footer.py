"""Where the table of a text file ends: summary lines below it, and a last line that was cut off."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from hersey.log.text.layout import Layout
from hersey.log.text.numbers import is_missing, looks_numeric
from hersey.log.text.separators import split
from hersey.log.text.stamps import is_stamp
from hersey.schema.warning import Warning

#: Bytes looked at from the end, and lines below a table at the most.
_TAIL = 1 << 15
_LINES = 20


@dataclass(frozen=True)
class TableEnd:
    """Byte behind the last row, whether the file stops within a row, and what was left out."""

    byte: int
    cut_off: bool = False
    warnings: tuple[Warning, ...] = ()


def end_of_table(file: BinaryIO, size: int, layout: Layout) -> TableEnd:
    """Return where the table ends; ``size`` is that of the file in bytes.

    A summary line has a word in its first cell that is not empty, where the rows have a number or a time.
    A last line without a line end that surely lacks something is left out.
    """
    if layout.encoding.startswith("utf-16"):
        size -= size % 2
    file.seek(start := max(0, size - _TAIL) // 4 * 4)
    encoding = layout.encoding
    if encoding == "utf-16":
        encoding = "utf-16-be" if _byte_order(file) == b"\xfe\xff" else "utf-16-le"
        file.seek(start)
    stored = _stored_lines(file.read(size - start), encoding)
    stored = stored[1:] if start else stored[layout.first_line - 1 :]
    if len(stored) < 2:
        return TableEnd(size)
    lines = [line.decode(encoding.removesuffix("-sig"), errors="replace").rstrip("\n") for line in stored]
    warnings: list[Warning] = []
    left_out = 0  # lines
    cut_off, short = _is_cut_off(lines, layout)
    if short:
        left_out = 1
        words = "the last line, '{line}', was cut off and was skipped"
        warnings.append(Warning("last line cut off", words, line=_shown(lines[-1])))
        lines[-1] = ""
    elif lines[-1].strip():
        words = "the last line, '{line}', has no line end, so its last number may be incomplete"
        line = _shown(lines[-1])
        warnings.append(Warning("last line has no end", words, severity="watch", line=line))
    summary = summary_lines(lines, layout)
    if summary:
        left_out = summary
        below = [line for line in lines[-summary:] if line.strip()]
        words = "{lines} {lines:line|lines} below the table {lines:was|were} skipped: '{first}'"
        warnings.append(Warning("lines below the table", words, lines=len(below), first=_shown(below[0])))
    length = sum(map(len, stored[-left_out:])) if left_out else 0
    return TableEnd(size - length, cut_off, tuple(warnings))


def _stored_lines(text: bytes, encoding: str) -> list[bytes]:
    """Lines as they are stored, each with its line end; the last, which may be empty, has none."""
    if not encoding.startswith("utf-16"):
        return [*(line + b"\n" for line in text.split(b"\n")[:-1]), text.rpartition(b"\n")[2]]
    kind = ">u2" if encoding == "utf-16-be" else "<u2"
    ends = 2 * (np.flatnonzero(np.frombuffer(text, kind, count=len(text) // 2) == ord("\n")) + 1)
    return [text[a:b] for a, b in itertools.pairwise([0, *ends.tolist(), len(text)])]


def _byte_order(file: BinaryIO) -> bytes:
    file.seek(0)
    return file.read(2)


def _is_cut_off(lines: list[str], layout: Layout) -> tuple[bool, bool]:
    """Whether the text stops within a line, and whether that line surely lacks something.

    It may lack something if the line, or its last cell, is shorter than in the lines before; surely if a cell
    is missing or the last one is no number.
    """
    last = lines[-1].rstrip("\r")
    before = [line.rstrip("\r") for line in lines[-21:-1] if line.strip()]
    if (
        not last.strip()
        or not before
        or last.lstrip().startswith(layout.comment)
        or _is_summary(last, layout)
    ):
        return False, False
    cells, rows = split(last, layout.separator), [split(line, layout.separator) for line in before]
    rows = [row for row in rows if len(row) == len(layout.columns)]
    if not rows:
        return False, False
    final, words = cells[-1], len(layout.columns) - 1 in layout.texts
    usual = any(row[-1] == final for row in rows)
    number = words or usual or looks_numeric(final) or is_stamp(final) or _is_word(final)
    short = len(cells) < len(layout.columns) or not number
    return short or len(last) < len(before[-1]) or len(final) < min(len(row[-1]) for row in rows), short


def _is_word(cell: str) -> bool:
    """Whether a cell says that a value is missing, and is not the start of a number."""
    return is_missing(cell) and cell not in ("", "-")


def summary_lines(lines: list[str], layout: Layout) -> int:
    """Return how many lines at the end are no rows; blank ones among them count."""
    count = 0
    for number, line in enumerate(reversed(lines), start=1):
        if number > _LINES:
            break
        if line.strip() and not _is_summary(line, layout):
            break
        count = number if line.strip() else count
    return count


def _is_summary(line: str, layout: Layout) -> bool:
    if line.lstrip().startswith(layout.comment):
        return False
    cells = split(line.rstrip("\r"), layout.separator)
    position = next((i for i, cell in enumerate(cells) if cell), None)
    if position is None:
        return False
    word = cells[position]
    if is_missing(word) or looks_numeric(word) or is_stamp(word) or not word[0].isalpha():
        return False
    return len(cells) == 1 or not any(index in layout.texts for index in range(position + 1))


def _shown(line: str) -> str:
    return line.strip()[:60]
