"""The one way from a command to a terminal: no control code of a log gets through, no line is too wide."""

from __future__ import annotations

import re
import shutil
import sys
import textwrap
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

from hersey.cache.switch import spoil
from hersey.errors import ExtrapolationWarning, PlausibilityWarning, SandboxWarning, UntoldWarning, printable

#: Replacements of characters that a terminal lacks.
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
    """Return a text in the characters of an encoding: known ones replaced, others as ``?``."""
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


#: Columns of a line where there is no terminal, and the fewest that text is wrapped at.
WIDTH, _LEAST = 80, 40
#: Greatest indent of the lines that continue one.
_DEEPEST = 30
#: A list item, and a label with its text at a distance.
_ITEM = re.compile(r"\s*(?:[-!*]|\d+\.) +")
_LABEL = re.compile(r"\s*\S+(?: \S+)*? {2,}(?=\S)")
#: The space between a number and its unit, where no line ends.
_UNIT = re.compile(
    r"(?<=[\d\])]) (?=(?:%|°C|degC|K|[mkMµu]?(?:m/s|m|s|N|Pa|Hz|g|J)|rpm|rad/s|N·m|mN·m)(?:[ ,.;:)]|$))"
)
#: Whether notes are left unsaid, as --quiet asks.
_quiet = [False]


def hush(quiet: bool) -> None:
    """Print notes on stderr, or none, from here on."""
    _quiet[0] = quiet


def is_quiet() -> bool:
    """Return whether notes are left unsaid."""
    return _quiet[0]


def width(stream: TextIO) -> int:
    """Return the columns of the terminal behind a stream, 80 where there is none."""
    if not stream.isatty():
        return WIDTH
    return max(shutil.get_terminal_size((WIDTH, 24)).columns, _LEAST)


def wrapped(line: str, columns: int) -> list[str]:
    """Return a line in lines that fit; those after the first begin where its text does.

    Examples
    --------
    >>> wrapped("- the belt slides from any start above 75 mm/s", 30)
    ['- the belt slides from any', '  start above 75 mm/s']
    """
    if len(line) <= columns:
        return [line]
    lead = _ITEM.match(line) or _LABEL.match(line)
    indent = lead.end() if lead else len(line) - len(line.lstrip())
    found = textwrap.wrap(
        _UNIT.sub("\xa0", line),
        columns,
        subsequent_indent=" " * min(indent, _DEEPEST),
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [each.replace("\xa0", " ") for each in found]


def say_wrapped(*lines: str, file: TextIO | None = None) -> None:
    """Print text for people as `say` does, no line wider than the terminal."""
    columns = width(file or sys.stdout)
    say(*(each for line in lines for part in line.split("\n") for each in wrapped(part, columns)), file=file)


def note(*lines: str) -> None:
    """Print what is beside the result on stderr, unless --quiet is given."""
    if lines and not _quiet[0]:
        say_wrapped(*lines, file=sys.stderr)


def say(*lines: str, file: TextIO | None = None) -> None:
    """Print lines as they are, on stdout or another stream; invisible characters are printed as their codes.

    For paths and commands that are to be copied; other text goes through `say_wrapped`.
    """
    stream = file or sys.stdout
    encoding = getattr(stream, "encoding", None) or "utf-8"
    print(spelled(printable("\n".join(lines), lines=True), encoding), file=stream)


@contextmanager
def warnings_said() -> Iterator[None]:
    """Print Python's warnings in the same way."""
    usual = warnings.formatwarning

    def formatted(message: Warning | str, *about: Any, **more: Any) -> str:
        spoil()
        if isinstance(message, ExtrapolationWarning | PlausibilityWarning | UntoldWarning):
            return f"hersey: warning: {printable(str(message))}\n"
        if isinstance(message, SandboxWarning):  # about the system, not about a line of the program
            return f"hersey: {printable(str(message))}\n"
        return printable(usual(message, *about, **more), lines=True)

    warnings.formatwarning = formatted
    try:
        yield
    finally:
        warnings.formatwarning = usual
