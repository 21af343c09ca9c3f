"""What to type for a log of one speed, which no fit can use: its friction can be followed over time."""

from __future__ import annotations

import sys
from pathlib import Path

from hersey.cli.mistyped import Commands, options_of, parameters_of, retyped
from hersey.errors import HerseyError, OneSpeedError, followed_by
from hersey.files.endings import LOGS

#: The command that follows friction, and its options that mean something else elsewhere or make dwells.
_TREND = "trend"
_OWN = frozenset(["by", "at", "share", "seed", "out", "figure", "json", "force", "quiet", "verbose"])
_OTHERS = _OWN | {"recipe", "no-cache", "min-dwell", "tare", "rotation", "temperature-scale", "no-load"}


def with_trend(error: HerseyError, commands: Commands) -> str:
    """Return an error in words, with the line that follows friction over time if the log has one speed."""
    if not isinstance(error, OneSpeedError):
        return str(error)
    logs, options = _typed(commands)
    logs = [each for each in logs if Path(each).name in error.files] or logs or ["LOG"]
    line = retyped(_TREND, *logs, *options)
    return followed_by(str(error), f"To follow friction over time, type: {line}")


def _typed(commands: Commands) -> tuple[list[str], list[str]]:
    """The logs that were typed, and the options that say how they are read, with their values."""
    known = parameters_of(sys.argv[1:], commands)
    of_trend = options_of(commands.load(_TREND))
    logs: list[str] = []
    options: list[str] = []
    words = iter(sys.argv[2:])
    for word in words:
        name, joined, _ = word.partition("=")
        if name not in known:
            logs += [word] if Path(word).suffix.lower() in LOGS else []
            continue
        one = getattr(known[name], "is_flag", False) or joined
        typed = [word] if one else [word, next(words, "")]
        name = name.removeprefix("--")
        options += typed if name in of_trend and name not in _OTHERS else []
    return logs, options
