"""Text of a stranger as it may be shown: what steers a terminal or breaks a line is spelled out.

Also what was probably meant by a name that is none.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable

#: How alike (`difflib`) a name must be to one that is there to be proposed, and characters of it at the most.
_ALIKE, _LONGEST = 0.6, 100


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


def meant(name: str, known: Iterable[str]) -> str:
    """Return the known name that one with a slip is nearest to, or an empty text.

    Examples
    --------
    >>> meant("torqe", ["Time", "Torque"])
    'Torque'
    """
    from difflib import get_close_matches

    by_fold = {each.lower(): each for each in known if len(each) <= _LONGEST}
    match = get_close_matches(name.lower(), by_fold, n=1, cutoff=_ALIKE) if len(name) <= _LONGEST else []
    return by_fold[match[0]] if match else ""
