"""Times of pulses instead of a speed: the number of pulses is a position."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hersey.errors import HerseyError
from hersey.log.columns import open_columns
from hersey.log.roles import is_called, is_named
from hersey.log.text.column import Column

#: Names of the number of a pulse of a sensor at a shaft.
_PULSES = r"(.*[^a-z])?(pulses?|impulse?|ticks?|magnets?|counter)([^a-z].*)?"
#: Columns of such a file at the most.
_FEW = 3


def pulses_in(path: str | Path) -> str:
    """Return the column of a file that numbers the pulses whose times the rows are, or nothing."""
    try:
        with open_columns(path) as opened:
            named = [column for column in opened.columns if is_named(_PULSES, column)]
            if len(named) != 1 or len(opened.columns) > _FEW or not _has_clock(opened.columns):
                return ""
            (numbers,) = opened.numbers(named[0])
    except HerseyError:
        return ""
    return named[0].path if numbers.size > 1 and np.all(np.diff(numbers) == 1.0) else ""


def _has_clock(columns: tuple[Column, ...]) -> bool:
    return any(is_called("time", column) for column in columns)
