"""The lines of a file that is read by a layout: those of a text, or of each sheet of a workbook."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import UnreadableLogError, printable
from hersey.files.reading import open_file
from hersey.files.text import MOST_BYTES, encoding_of
from hersey.log.formats import format_of, opened
from hersey.log.recording import Source

#: Format that gives the cells of all sheets.
SHEETS = "sheets"


@dataclass(frozen=True)
class Page:
    """A text, or a sheet with its title; the cells of a sheet have tabs between them."""

    title: str
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Pages:
    """The pages of a file."""

    source: Source
    format: str
    pages: tuple[Page, ...]

    @property
    def is_workbook(self) -> bool:
        """Whether the pages are sheets."""
        return self.format != "text"


def pages_of(path: Path, encoding: str = "") -> Pages:
    """Return the lines of a file.

    Raises
    ------
    MissingFileError, UnreadableLogError
        If it cannot be read, is no text and no workbook, or too large to be read by a layout.
    """
    kind = format_of(path)
    if kind == "excel":
        with opened(path, SHEETS) as recording:
            sheets: dict[str, list[list[str]]] = {}
            for cells in recording.cells:
                sheets.setdefault(cells.group, []).append(cells.load())
            source = recording.source
        found = [
            Page(title, tuple("\t".join(row) for row in zip(*columns, strict=True)))
            for title, columns in sheets.items()
        ]
        return Pages(source, "Excel", tuple(found))
    name = printable(path.name)
    if kind is not None:
        raise UnreadableLogError(f"{name} is neither text nor a workbook, so [layout] cannot be used")
    with open_file(path) as file:
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise UnreadableLogError(f"{name} is larger than {MOST_BYTES // 10**6} MB, the limit with [layout]")
    encoding = encoding or encoding_of(content)
    if not encoding:
        raise UnreadableLogError(f"{name} is a binary file of an unknown format")
    text = content.decode(encoding, errors="replace").removeprefix("\ufeff")
    lines = tuple(line.rstrip("\r") for line in text.replace("\0", " ").split("\n"))
    source = Source(name, hashlib.sha256(content).hexdigest(), len(content))
    return Pages(source, "text", (Page("", lines),))
