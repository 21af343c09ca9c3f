"""A measurement that a log holds twice: its dwells would count double, and the intervals be too narrow."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from hashlib import sha256

import numpy as np
from numpy.typing import NDArray

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, Setting, TimeOrderError
from hersey.log.long_arrays import blocks, ends, rows_where
from hersey.log.torque_log import Run

#: Fewer rows than these may be equal by chance.
_FEW = 20


def refuse_given_twice(runs: Sequence[Run]) -> None:
    """Refuse two runs whose torque, speed and temperature are the same in every row.

    Two measurements never agree so: the noise of the torque differs. Times may differ.

    Raises
    ------
    ParameterError
        Naming both runs.
    """
    seen: dict[bytes, Run] = {}
    for run in runs if len(runs) > 1 else ():
        if run.time.size < _FEW or not _varies(run.torque):
            continue
        earlier = seen.setdefault(_rows(run), run)
        if earlier is not run:
            raise ParameterError(
                f"the {run.time.size} rows of {run.name} and of {earlier.name} are the same: "
                "one is a copy of the other",
                remedy="delete one of them",
            )


def refuse_rows_shared(runs: Sequence[Run]) -> None:
    """Refuse two runs of which the end of one is the beginning of the other, times included.

    Raises
    ------
    ParameterError
        Naming the rows.
    """
    starts = np.array([run.time[0] for run in runs])
    torques = np.array([run.torque[0] for run in runs])
    for run in runs if len(runs) > 1 else ():
        at = np.minimum(np.searchsorted(run.time, starts), run.time.size - 1)
        for number in map(int, np.flatnonzero((run.time[at] == starts) & (run.torque[at] == torques))):
            later, row = runs[number], int(at[number])
            rows = min(run.time.size - row, later.time.size)
            if later is run or rows < _FEW or not _varies(later.torque[:rows]):
                continue
            if _first_other(_channels(run, row, row + rows), _channels(later, 0, rows)) is None:
                raise ParameterError(
                    f"the first {rows} rows of {later.name}, {later.time[0]:.6g} to "
                    f"{later.time[rows - 1]:.6g} s, are also in {run.name}",
                    remedy=f"delete them in {later.name}",
                )


def refuse_rows_repeated(arrays: Mapping[str, FloatArray], file: str, place: Callable[[int], str]) -> None:
    """Refuse a file in which rows repeat earlier ones, times included, as if they were pasted twice.

    ``arrays`` are those of its rows by role, and ``place`` says in words where a row stands.

    Raises
    ------
    TimeOrderError
        Naming both stretches.
    """
    time, torque = arrays["time"], arrays.get("torque", arrays["speed"])
    for row, earlier, rows in _repeated(arrays):
        end = row + rows
        if not _varies(torque[row:end]) or (end < time.size and time[end] < time[row - 1]):
            continue
        pasted = f"from {place(row)} to {place(end - 1)}"
        raise TimeOrderError(
            f"{file}: the rows {pasted} repeat those from {place(earlier)} to {place(earlier + rows - 1)}",
            remedy=f"delete the rows {pasted}",
            setting=Setting("time", "channel"),
        )


def _repeated(arrays: Mapping[str, FloatArray]) -> Iterator[tuple[int, int, int]]:
    """Where time falls back to rows that are there already: the row, the earlier one, and how many agree."""
    time = arrays["time"]
    behind = rows_where(lambda rows: np.diff(time[rows.start : rows.stop + 1]) < 0, time.size - 1, time) + 1
    if not behind.size:
        return
    back, stamps = set(behind.tolist()), np.unique(time[behind])
    channels = [values for role, values in arrays.items() if role != "run"]
    seen: dict[bytes, int] = {}
    for block in blocks(time.size, *channels):
        same = np.flatnonzero(np.isin(time[block], stamps))
        if not same.size:
            continue
        bits = _as_bits([values[block.start : block.stop + _FEW] for values in channels])
        for row in (same + block.start).tolist():
            near = bits[row - block.start : row - block.start + _FEW]
            earlier = seen.setdefault(near.tobytes(), row)
            if row in back and earlier < row <= time.size - _FEW:
                most = min(row - earlier, time.size - row)
                before, here = ([v[first : first + most] for v in channels] for first in (earlier, row))
                other = _first_other(before, here)
                yield row, earlier, most if other is None else other


def _varies(values: FloatArray) -> bool:
    least, most = ends(values)
    return most - least != 0.0


def _first_other(some: Sequence[FloatArray], others: Sequence[FloatArray]) -> int | None:
    """The first row in which channels differ from others of the same length; None if in none."""
    if len(some) != len(others):
        return 0
    for rows in blocks(some[0].size, *some, *others):
        differ = np.any(_as_bits([v[rows] for v in some]) != _as_bits([v[rows] for v in others]), axis=1)
        if differ.any():
            return int(rows.start + np.argmax(differ))
    return None


def _channels(run: Run, first: int, end: int) -> list[FloatArray]:
    channels = (run.time, run.torque, run.speed, run.temperature)
    return [each[first:end] for each in channels if each is not None]


def _as_bits(channels: Sequence[FloatArray]) -> NDArray[np.int64]:
    """Channels as columns of integers that are equal where the numbers are, missing ones included."""
    return np.column_stack([np.ascontiguousarray(each, dtype=np.float64).view(np.int64) for each in channels])


def _rows(run: Run) -> bytes:
    """Hash of the rows of a run without their times."""
    hashed = sha256()
    for channel in (run.torque, run.speed, run.temperature):
        if channel is not None:
            for rows in blocks(channel.size, channel):
                hashed.update(np.ascontiguousarray(channel[rows]).data)
    return hashed.digest()
