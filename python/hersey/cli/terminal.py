"""The one way from a command to a terminal: names in a log may hold what would steer it."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

from hersey.errors import SandboxWarning, printable

#: What stands for a sign that a terminal lacks.
_PLAIN = str.maketrans(
    {
        "\N{DEGREE SIGN}": "deg",
        "\N{MINUS SIGN}": "-",
        "\N{EN DASH}": "-",
        "\N{MIDDLE DOT}": " ",
        "\N{MULTIPLICATION SIGN}": "x",
        "\N{MICRO SIGN}": "u",
        "\N{GREEK SMALL LETTER MU}": "u",
        "\N{SUPERSCRIPT TWO}": "^2",
        "\N{INFINITY}": "inf",
        "\N{PLUS-MINUS SIGN}": "+/-",
    }
)


def spelled(text: str, encoding: str) -> str:
    """Return a text as an encoding can print it: signs that it lacks in plain letters, others as ``?``."""
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        lacking = {sign for sign in set(text) if not _has(encoding, sign)}
        text = "".join(sign.translate(_PLAIN) if sign in lacking else sign for sign in text)
    return text.encode(encoding, errors="replace").decode(encoding)


def _has(encoding: str, sign: str) -> bool:
    try:
        sign.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def say(*lines: str, file: TextIO | None = None) -> None:
    """Print lines for people, on stdout unless told; what is no visible character stands as its code."""
    stream = file or sys.stdout
    encoding = getattr(stream, "encoding", None) or "utf-8"
    print(spelled(printable("\n".join(lines), lines=True), encoding), file=stream)


@contextmanager
def warnings_said() -> Iterator[None]:
    """Let warnings come in the same way."""
    usual = warnings.formatwarning

    def formatted(message: Warning | str, *about: Any, **more: Any) -> str:
        if isinstance(message, SandboxWarning):  # of the system, whatever line of the program finds it
            return f"hersey: {printable(str(message))}\n"
        return printable(usual(message, *about, **more), lines=True)

    warnings.formatwarning = formatted
    try:
        yield
    finally:
        warnings.formatwarning = usual
