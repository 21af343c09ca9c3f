"""The lines of a table in blocks of UTF-8: memory holds no more text than one of them."""

from __future__ import annotations

import codecs
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from hersey.errors import UnreadableLogError
from hersey.files.reading import OpenFile
from hersey.log.text.layout import Layout
from hersey.log.text.numbers import is_missing
from hersey.log.text.separators import BLANKS, split, tabbed

BLOCK = 1 << 22
#: Bytes of a line at the most.
LONGEST_LINE = 1 << 25
_END = ord("\n")
#: Bytes looked at together, which stay in the cache.
_AT_ONCE = 1 << 17


@dataclass
class Block:
    """Lines of the table as UTF-8, and the number of each in the file."""

    text: bytes
    lines: Sequence[int]

    def cells(self, separator: str, rows: slice = slice(None)) -> Iterator[list[str]]:
        """Yield the cells of each line, or of some."""
        for text in self.text.split(b"\n")[: len(self.lines)][rows]:
            yield split(text.decode("utf-8", errors="replace").rstrip("\r"), separator)


def blocks(
    opened: OpenFile, end: int, layout: Layout, name: str, hashed: Callable[[bytes], None]
) -> Iterator[tuple[Block, int]]:
    """Yield the lines of a table that ends at byte ``end``, without comments, and bytes read so far.

    All bytes of the file are ``hashed``, also those that follow the table.

    Raises
    ------
    UnreadableLogError
        If a line is longer than any of a log, or a row looks like a comment.
    """
    opened.file.seek(0)
    line = layout.first_line
    for text, done in _whole_lines(opened.file, end, layout, name, hashed):
        if layout.separator == BLANKS:
            text = tabbed(text)
        ends, blank = _line_ends(text)
        block = _cleaned(text, ends, blank, line, layout, name)
        if block.lines:
            yield block, done
        line += ends
    left = opened.size - end
    while left and (chunk := opened.file.read(min(left, BLOCK))):
        hashed(chunk)
        left -= len(chunk)


def _cleaned(text: bytes, ends: int, blank: bool, line: int, layout: Layout, name: str) -> Block:
    """The block without blank lines and comments; it has so many line ends, ``blank`` if a line is empty."""
    comment = layout.comment.encode()
    commented = comment in text and (text.startswith(comment) or b"\n" + comment in text)
    if not commented and not blank:
        return Block(text, range(line, line + ends + (not text.endswith(b"\n"))))
    kept = [
        (number, row)
        for number, row in enumerate(text.split(b"\n"), start=line)
        if row.strip() and not _is_comment(row, number, layout, name)
    ]
    return Block(b"\n".join(row for _, row in kept), [number for number, _ in kept])


def _is_comment(row: bytes, number: int, layout: Layout, name: str) -> bool:
    """Whether a line is a comment, and no row that begins like one with an error of Excel (#N/A)."""
    if not row.lstrip().startswith(layout.comment.encode()):
        return False
    cells = split(row.decode("utf-8", errors="replace"), layout.between)
    if len(cells) != len(layout.columns):
        return True
    if is_missing(cells[0]):
        return False
    raise UnreadableLogError(
        f"{name}, line {number} starts with the comment sign '{layout.comment}' but has as many cells "
        "as a row. Correct or delete it"
    )


def _whole_lines(
    file: BinaryIO, end: int, layout: Layout, name: str, hashed: Callable[[bytes], None]
) -> Iterator[tuple[bytes, int]]:
    """Yield whole lines of UTF-8 text from the first row on, and bytes read so far."""
    plain = layout.encoding == "utf-8-sig"
    decoder = None if plain else codecs.getincrementaldecoder(layout.encoding)(errors="replace")
    skip, rest, done, more = layout.first_line - 1, b"", 0, True
    while more:
        chunk = file.read(min(BLOCK, end - done))
        more = bool(chunk)
        hashed(chunk)
        done += len(chunk)
        if decoder:
            chunk = decoder.decode(chunk, final=not more).encode()
        last = chunk.rfind(b"\n") + 1 if more else len(chunk)
        if more and not last and len(rest) + len(chunk) > LONGEST_LINE:
            raise UnreadableLogError(
                f"{name}: a line is longer than {LONGEST_LINE} bytes, so it is not a log"
            )
        whole = last or not more
        block = b"".join((rest, memoryview(chunk)[:last])) if whole else b""  # copied once
        rest = chunk[last:] if whole else rest + chunk
        if skip:
            above = _end_of_lines(block, skip)
            skip -= block.count(b"\n", 0, above)
            block = block[above:]
        if block:
            yield block, done


def _line_ends(text: bytes) -> tuple[int, bool]:
    """How many lines of a text end, and whether one is empty: faster than to count and search in the text."""
    every, count = np.frombuffer(text, np.uint8), 0
    blank, returns = text.startswith((b"\n", b"\r\n")), b"\r" in text
    close = False  # whether two line ends have one byte between them
    for start in range(0, every.size, _AT_ONCE):
        ends = every[start : start + _AT_ONCE + 2] == _END
        count += int(np.count_nonzero(ends[:_AT_ONCE]))
        blank = blank or bool((ends[1:] & ends[:-1]).any())
        close = close or (returns and bool((ends[2:] & ends[:-2]).any()))
    return count, blank or (close and b"\n\r\n" in text)


def _end_of_lines(text: bytes, count: int) -> int:
    """Byte behind the first ``count`` lines, or behind the last one if there are fewer."""
    end = 0
    for _ in range(count):
        following = text.find(b"\n", end) + 1
        if not following:
            return len(text)
        end = following
    return end
