"""Options whose dashes a word processor joined into a longer one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from hersey.cli.mistyped import Commands, parameters_of, retyped

#: The dashes and the minus sign that are none of a keyboard.
_LONG = "\u2010-\u2015\u2212"
_DASHED = re.compile(rf"-?[{_LONG}][-{_LONG}]*([A-Za-z].*)")


def long_dashed(words: Sequence[str], commands: Commands) -> str:
    """Say what to type instead of an option with a long dash; nothing if there is none."""
    at = [
        i
        for i, (before, word) in enumerate(pairwise(["", *words]))
        if _is_option(before, word, words, commands)
    ]
    if not at:
        return ""
    typed = [_plain(word) if i in at else word for i, word in enumerate(words)]
    return f"'{words[at[0]]}' has a long dash, as word processors write. Type: {retyped(*typed)}"


def _is_option(before: str, word: str, words: Sequence[str], commands: Commands) -> bool:
    """Whether a word is meant as an option: neither a file nor the value of the option before it."""
    if not _DASHED.fullmatch(word) or Path(word).exists():
        return False
    return bool(getattr(parameters_of(words, commands).get(before), "is_flag", True))


def _plain(word: str) -> str:
    """An option with the dashes of a keyboard: one before a single letter, else two."""
    name = _DASHED.sub(r"\1", word)
    return f"-{name}" if len(name) == 1 else f"--{name}"
