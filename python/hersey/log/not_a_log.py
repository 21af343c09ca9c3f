"""What is neither a file nor a table is refused, with how to make one of it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from hersey.arguments.numbers import described
from hersey.errors import ParameterError
from hersey.log.formats.frame import is_frame

#: How tables are made of arrays.
_BY_COLUMN = "{'Time [s]': a[:, 0], 'Torque [N*m]': a[:, 1]}"


def is_one(thing: Any) -> bool:
    """Return whether something is one thing, and no list of files or frames."""
    alone = (str, bytes, os.PathLike, np.ndarray, Mapping)
    return is_frame(thing) or isinstance(thing, alone) or hasattr(thing, "read") or _is_series(thing)


def refuse_not_a_log(thing: Any, call: str) -> None:
    """Refuse what is neither a file name nor a frame.

    Parameters
    ----------
    thing
        What a function was given.
    call
        The function as it is written, e.g. ``hersey.read``.

    Raises
    ------
    ParameterError
        With the line to write, as far as it is known.
    """
    if is_frame(thing) or isinstance(thing, str | os.PathLike):
        return
    raise ParameterError(f"{described(thing)} is not a log", remedy=_instead(thing, call))


def _instead(thing: Any, call: str) -> str:
    """What to write in place of a thing."""
    if isinstance(thing, bytes):
        return f"write {call}({os.fsdecode(thing)!r})"
    if isinstance(thing, np.ndarray | Mapping):
        columns = "a" if isinstance(thing, Mapping) else _BY_COLUMN
        return f"make a frame whose columns have names and units, e.g. {call}(polars.DataFrame({columns}))"
    if hasattr(thing, "read"):
        named = getattr(thing, "name", None)
        given = repr(named) if isinstance(named, str) else "polars.read_csv(file)"
        return f"write {call}({given}), the {'name' if isinstance(named, str) else 'table'} of the file"
    if _is_series(thing):
        return f"give the frame that this column is from, e.g. {call}(frame)"
    return "give a file name, or a polars or pandas frame"


def _is_series(thing: Any) -> bool:
    """Whether a thing is one column of a frame, and not one of file names."""
    if type(thing).__name__ != "Series":
        return False
    return not all(isinstance(each, str | os.PathLike) for each in thing)
