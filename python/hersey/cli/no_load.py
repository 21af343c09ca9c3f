"""The no-load log of a machine, given among the logs whose torque it is subtracted from."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.mistyped import retyped
from hersey.errors import ParameterError
from hersey.files.reading import hash_of

if TYPE_CHECKING:
    from hersey.damping.no_load_torque import NoLoadTorque


def refuse_no_load_log(paths: Sequence[Path], rest: NoLoadTorque) -> None:
    """Refuse the log of ``[rest]``, by its content, with the line to type without it."""
    own = next((path for path in paths if rest.sha256 and hash_of(path) in rest.sha256), None)
    if own is None:
        return
    said = f"{own} is the no-load log of the machine file ([rest] log), so its torque has no part of the film"
    if len(paths) == 1:
        raise ParameterError(said, remedy="give the log that was recorded with the film")
    raise ParameterError(said, remedy=f"leave it out{_line_without(own)}")


def _line_without(log: Path) -> str:
    """The line as typed without a log; empty where the log was not typed on its own."""
    words = sys.argv[1:]
    at = next((i for i, word in enumerate(words) if not word.startswith("-") and Path(word) == log), 0)
    if not at or words[at - 1].startswith("-"):
        return ""
    return f": {retyped(*words[:at], *words[at + 1 :])}"
