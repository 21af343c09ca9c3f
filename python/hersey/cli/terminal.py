"""The one way from a command to a terminal: names in a log may hold what would steer it."""

from __future__ import annotations

import sys
import unicodedata
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO


def say(*lines: str, file: TextIO | None = None) -> None:
    """Print lines for people, on stdout unless told; what is no visible character stands as its code."""
    stream = file or sys.stdout
    encoding = getattr(stream, "encoding", None) or "utf-8"
    text = printable("\n".join(lines))
    print(text.encode(encoding, errors="replace").decode(encoding), file=stream)


@contextmanager
def warnings_said() -> Iterator[None]:
    """Let warnings come in the same way."""
    usual = warnings.formatwarning

    def formatted(*about: Any, **more: Any) -> str:
        return printable(usual(*about, **more))

    warnings.formatwarning = formatted
    try:
        yield
    finally:
        warnings.formatwarning = usual


def printable(text: str) -> str:
    r"""Return a text that steers no terminal: what is no visible character stands as its code, as ``\x1b``.

    Line ends stay, blanks of every kind become a plain one.

    Examples
    --------
    >>> print(printable("Torque\x1b[2J"))
    Torque\x1b[2J
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(char if char.isprintable() or char == "\n" else _code(char) for char in text)


def _code(char: str) -> str:
    if char == "\t" or unicodedata.category(char) == "Zs":
        return " "
    return char.encode("unicode_escape").decode()
