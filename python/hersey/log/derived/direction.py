"""The sign of a speed that was recorded without one, from a column of the direction."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import Setting, UnreadableLogError, printable
from hersey.log.long_arrays import ends
from hersey.schema.warning import Warning

#: Words for the direction that counts as positive, and for the other.
FORWARD = (
    "1",
    "+1",
    "+",
    "cw",
    "f",
    "fw",
    "fwd",
    "forward",
    "forwards",
    "up",
    "pos",
    "positive",
    "true",
    "on",
    "vor",
)
REVERSE = (
    "-1",
    "-",
    "ccw",
    "acw",
    "r",
    "rev",
    "rw",
    "reverse",
    "backward",
    "backwards",
    "b",
    "down",
    "neg",
    "negative",
)
_REVERSE_OR_NONE = ("0", "false", "off")
#: Names of a column of the direction.
_CALLED = re.compile(
    r"dir|(rot|turn)[ _]?dir|(?!.*(flow|load|wind)).*(direction|richtung|drehsinn)", re.IGNORECASE
)
_LONGEST_NAME = 200


def called_direction(names: Iterable[str]) -> str:
    """Return the first name that a column of the direction has, or nothing."""
    return next((n for n in names if len(n) <= _LONGEST_NAME and _CALLED.fullmatch(n)), "")


def without_sign(names: Iterable[str], speed: FloatArray) -> list[Warning]:
    """Return which column may hold the direction of a speed that is never below 0."""
    name = called_direction(names)
    if not name or not speed.size or ends(speed)[0] < 0:
        return []
    words = "column '{column}' may be the direction of turning; speed is never negative"
    how = Setting("direction", "channel").to(name)
    return [
        Warning(
            "column may be the direction",
            words,
            severity="watch",
            remedy="if it is, use {how}",
            column=name,
            how=how,
        )
    ]


def signs_of_words(words: list[str], column: str) -> FloatArray:
    """Return 1 or -1 for each cell, NaN where it is empty.

    Raises
    ------
    UnreadableLogError
        If a cell is neither; it names the words that are known.
    """
    plain = [word.strip().lower() for word in words]
    known = dict.fromkeys(FORWARD, 1.0) | dict.fromkeys(REVERSE, -1.0) | {"": np.nan}
    values = [known[word] if word in known else _number(word, column) for word in plain]
    return signs_of_numbers(np.array(values), column)


def _number(word: str, column: str) -> float:
    if word in _REVERSE_OR_NONE:
        return 0.0
    try:
        return float(word)
    except ValueError:
        raise UnreadableLogError(
            f"column '{column}': '{printable(word)[:40]}' is not a direction",
            remedy="write 1 and -1, 1 and 0, CW and CCW, or F and R",
        ) from None


def signs_of_numbers(values: FloatArray, column: str) -> FloatArray:
    """Return 1 or -1 for each number: above 0 or below; 0 counts as -1 where no number is below 0.

    Raises
    ------
    UnreadableLogError
        If there are more than three numbers.
    """
    found = np.unique(values[np.isfinite(values)])
    if found.size > 3 or (found.size == 3 and not (found[0] < 0 < found[2] and found[1] == 0)):
        listed = ", ".join(f"{each:g}" for each in found[:5])
        raise UnreadableLogError(
            f"column '{column}' holds more than two directions ({listed})",
            remedy="write 1 and -1, 1 and 0, CW and CCW, or F and R",
        )
    other = 1.0 if found.size and found[0] < 0 else -1.0
    signs = np.where(values > 0, 1.0, np.where(values < 0, -1.0, other))
    return np.where(np.isfinite(values), signs, np.nan)
