"""Text that a command was given, with errors that a person can act on, and values as messages show them."""

from __future__ import annotations

import codecs
from pathlib import Path

from hersey.errors import ParameterError
from hersey.files.reading import open_file

#: Bytes of a text file at the most: what is read from it takes many times as much memory.
MOST_BYTES = 64_000_000
#: Characters of a value that a message shows.
_SHOWN = 60


def read_text(path: Path, *, most: int = MOST_BYTES) -> str:
    """Return the text, UTF-8 with or without its mark, or UTF-16 with it.

    Raises
    ------
    MissingFileError
        If there is no such file, it is no ordinary one, or it cannot be read.
    ParameterError
        If it has more than ``most`` bytes.
    UnicodeDecodeError
        If it is neither: what that means is for the caller to say.
    """
    with open_file(path) as file:
        text = file.read(most + 1)
    if len(text) > most:
        raise ParameterError(f"{path.name} is larger than {most} bytes, the limit for such a file")
    marked = text.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    return text.decode("utf-16" if marked else "utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")


def shown(value: object) -> str:
    """Return a value of a file as a message shows it, cut where it is long."""
    try:
        text = repr(value)
    except ValueError:  # an integer with more digits than Python writes
        return "a number with thousands of digits"
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
