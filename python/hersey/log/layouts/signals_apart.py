"""Tables whose channels have clocks of their own: pairs of columns, or one value a row."""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha256

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.layouts.grids import Grid
from hersey.log.layouts.stacking import _called
from hersey.log.layouts.table import LogLayout
from hersey.log.recording import Recording, Signal
from hersey.log.roles import could_be, is_called, role_conversion
from hersey.log.text.column import split_unit
from hersey.log.text.stamps import Stamps, numbers_in

#: Channels of a table with one value a row at the most.
_MOST = 1000


def recording_of_pairs(grid: Grid, layout: LogLayout, place: str) -> Recording:
    """Return channels each of which has its clock in the column to its left."""
    scale = role_conversion("time", layout.paired_clocks)[1].scale
    numbers = [numbers_in(pl.Series(cells, dtype=pl.String), grid.style)[0] for cells in grid.cells]
    if len(numbers) < 2 or len(numbers) % 2:
        raise UnreadableLogError(
            f"{place} has {len(numbers)} columns of numbers, so not every channel has its clock to its left",
            remedy="delete paired_clocks of [layout]",
        )
    signals = [
        _signal(grid.columns[at + 1].name, grid.columns[at + 1].unit, scale * numbers[at], numbers[at + 1])
        for at in range(0, len(numbers), 2)
    ]
    return Recording("text", tuple(signals), warnings=list(grid.warnings))


def recording_of_values(grid: Grid, layout: LogLayout, place: str) -> Recording:
    """Return the channels of a table in which a column names the channel of each row."""
    named, valued = (
        _called(name, grid.columns, place) for name in (layout.channel_column, layout.value_column)
    )
    at = _clock(grid, layout, place)
    written = Stamps(grid.stamps[at]) if at in grid.stamps else grid.style
    time, _ = numbers_in(pl.Series(grid.cells[at], dtype=pl.String), written)
    if at not in grid.stamps:
        time = time * role_conversion("time", grid.columns[at].unit)[1].scale
    values, _ = numbers_in(pl.Series(grid.cells[valued], dtype=pl.String), grid.style)
    names = np.array(grid.cells[named])
    listed = list(dict.fromkeys(filter(None, grid.cells[named])))
    if len(listed) > _MOST:
        raise UnreadableLogError(
            f"{place}: column '{layout.channel_column}' names more than {_MOST} channels"
        )
    signals = [_signal(*split_unit(name), time[names == name], values[names == name]) for name in listed]
    recording = Recording("text", tuple(signals), warnings=list(grid.warnings))
    if isinstance(written, Stamps):
        recording.warnings.append(written.warning(grid.columns[at].name))
    return recording


def _clock(grid: Grid, layout: LogLayout, place: str) -> int:
    """The place of the column of the time that changes most often."""
    clocks = [
        at
        for at, column in enumerate(grid.columns)
        if at in grid.stamps
        or (column.unit and is_called("time", column) and could_be("time", column, surely=True))
    ]
    if not clocks:
        raise UnreadableLogError(f"{place}: no column of times was found beside '{layout.value_column}'")
    return max(clocks, key=lambda at: len(set(grid.cells[at])))


def _signal(name: str, unit: str, time: FloatArray, values: FloatArray) -> Signal:
    known = np.isfinite(time) & np.isfinite(values)
    time, values = time[known], values[known]
    tick = sha256(time.tobytes()).hexdigest()
    return Signal(name, unit, time.size, _giving(values), _giving(time), tick)


def _giving(values: FloatArray) -> Callable[[], FloatArray]:
    return lambda: values
