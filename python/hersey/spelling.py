"""Text of a stranger as it may be shown: what steers a terminal or breaks a line is spelled out."""

from __future__ import annotations

import unicodedata


def printable(text: str, *, lines: bool = False) -> str:
    r"""Return a text in which what is no visible character stands as its code, as ``\x1b``.

    Blanks of every kind become a plain one; ends of lines stay where ``lines`` is true.

    Examples
    --------
    >>> print(printable("Torque\x1b[2J"))
    Torque\x1b[2J
    """
    if text.isprintable() and text.isascii():
        return text
    return "".join(c if c.isprintable() or (lines and c == "\n") else _code(c) for c in text)


def _code(char: str) -> str:
    if char == "\t" or unicodedata.category(char) == "Zs":
        return " "
    return char.encode("unicode_escape").decode()
