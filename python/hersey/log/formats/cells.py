"""Cell arrays of MATLAB that are tables, or lists of channels each with its name and unit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.formats.matrices import array_signals
from hersey.log.recording import Signal


def cell_signals(name: str, cells: Any, group: str, signals: list[Signal]) -> bool:
    """Add the channels of a cell array, and return whether it is one of those that are known.

    Known are a table, ``{'t','Torque'; 's','N*m'; 0,1.5; ...}``, and a list of channels, one in each row or
    column, ``{'Torque','N*m',[1.5;...]; ...}``, both with or without units.
    """
    if cells.ndim != 2 or not cells.size:
        return False
    path = f"{group}/{name}" if group else name
    for rows in (cells, cells.T):
        vectors = _list_of(rows)
        if vectors is not None:
            break
    else:
        vectors = _table(cells)
    for channel, unit, numbers in vectors:
        signals.extend(array_signals(channel, numbers.shape, numbers.view, unit, path))
    return bool(vectors)


def _list_of(rows: Any) -> list[tuple[str, str, Any]] | None:
    """Name, unit and numbers of each row, or None if one row is something else."""
    channels = []
    for row in rows:
        words = [_word(cell) for cell in row]
        numbers = [cell for cell in row if _is_numbers(cell) and cell.size > 1]
        named = [word for word in words if word is not None]
        if len(numbers) != 1 or not 1 <= len(named) <= 2 or len(numbers) + len(named) != len(row):
            return None
        channels.append((named[0], named[1] if len(named) == 2 else "", numbers[0]))
    return channels


def _table(cells: Any) -> list[tuple[str, str, FloatArray]]:
    """Name, unit and numbers of each column below a row of names; none if it is no table."""
    words = [[_word(cell) for cell in row] for row in cells[:2]]
    if len(cells) < 3 or None in words[0]:
        return []
    units = words[1] if None not in words[1] else [""] * cells.shape[1]
    rows = cells[2:] if None not in words[1] else cells[1:]
    return [
        (str(words[0][i]), str(units[i]), _column(rows[:, i]))
        for i in range(cells.shape[1])
        if any(_is_numbers(cell) and cell.size == 1 for cell in rows[:, i])
    ]


def _column(cells: Sequence[Any]) -> FloatArray:
    """The numbers of a column of cells, NaN where one holds something else."""
    return np.array(
        [float(cell.reshape(-1)[0]) if _is_numbers(cell) and cell.size == 1 else np.nan for cell in cells]
    )


def _is_numbers(cell: Any) -> bool:
    return isinstance(cell, np.ndarray) and cell.dtype.kind in "iufb"


def _word(cell: Any) -> str | None:
    """The text of a cell, or None if it holds none."""
    if isinstance(cell, np.ndarray) and cell.dtype.kind == "U" and cell.size <= 1:
        return str(cell.reshape(-1)[0]) if cell.size else ""
    return None
