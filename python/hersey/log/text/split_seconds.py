"""Time stamps in whole seconds, whose milliseconds stand in a column of their own."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import Setting, UnreadableLogError
from hersey.log.text.column import Column

_MILLISECONDS = re.compile(r"ms|msec|milli(second|sekunde)s?n?|millitm", re.IGNORECASE)


def is_milliseconds(name: str) -> bool:
    """Return whether a column is called so that it may hold the milliseconds of the times beside it."""
    return _MILLISECONDS.fullmatch(name) is not None


def refuse_split_seconds(place: str, time: FloatArray, columns: Sequence[Column]) -> None:
    """Raise if times of stamps, s, are whole seconds, some shared by rows, beside a column of milliseconds.

    Raises
    ------
    UnreadableLogError
        It names that column.
    """
    beside = next((column.name for column in columns if is_milliseconds(column.name)), "")
    if (
        not beside
        or time.size < 2
        or not np.any(np.diff(time) == 0.0)
        or np.any(abs(time - np.round(time)) > 1e-6)
    ):
        return
    raise UnreadableLogError(
        f"{place} shows whole seconds; column '{beside}' seems to hold the milliseconds",
        remedy=f'write milliseconds = "{beside}" into [layout] of a mapping, or export one column',
        setting=Setting("time", "channel"),
    )
