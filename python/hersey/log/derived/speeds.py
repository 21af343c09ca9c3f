"""The speed that a position and a direction make, and what is to be said of it."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, Setting, UnreadableLogError
from hersey.log.believed import in_si
from hersey.log.channels import called
from hersey.log.derived.direction import signs_of_numbers, signs_of_words
from hersey.log.derived.position import slope, smallest_step, unwrapped, window_for
from hersey.log.derived.set_points import SetPoints
from hersey.log.recording import Recording
from hersey.log.roles import is_called, is_named, is_of_kind, role_conversion
from hersey.log.text.column import Column
from hersey.schema.warning import Warning
from hersey.units import Conversion, conversion

#: Names of a distance slid.
_DISTANCE = r".*distance.*|.*\bpath\b.*|.*weg\b.*"
#: Unit of the speed that a position of a kind makes.
_UNITS = {"angle": "rad/s", "length": "m/s"}


def speed_column(column: Column, unit: Conversion) -> tuple[Column, Conversion]:
    """Return what stands for the column of the speed that a position makes."""
    made = _UNITS[role_conversion("position", unit.unit)[0]]
    return Column(column.index, f"slope of {column.name}", made, column.group), Conversion(made, 1.0, 0.0)


def speed_of_position(
    column: Column, unit: Conversion, time: FloatArray, written: FloatArray, window: float | None
) -> tuple[FloatArray | None, FloatArray, Warning]:
    """Return the angle that goes on, rad, if it is one; its speed, SI; and what that costs."""
    position, turns = in_si(written, unit), 0
    kind = role_conversion("position", unit.unit)[0]
    if kind == "angle":
        position, turns = unwrapped(position)
    speed, over = slope(time, position, window_for(time, position) if window is None else window)
    step = smallest_step(position) / over if over > 0 else 0.0
    words = "speed is the slope of '{channel}' over {window:.3g} s, so faster changes are smoothed"
    if step and kind == "angle":
        words += "; it counts in steps of {step:.3g rpm}"
    elif step:
        words += "; it counts in steps of {step:.3g mm/s}"
    if turns:
        words += "; {turns} times the angle started anew with a turn"
    said = Warning("speed from position", words, channel=column.path, window=over, step=step, turns=turns)
    return position if kind == "angle" else None, speed, said


def with_direction(recording: Recording, name: str, speed: FloatArray) -> tuple[FloatArray, Warning]:
    """Return a speed with the sign that a column of the direction says, and how it was read.

    Raises
    ------
    ChannelError
        If there is no such column, or it has other rows.
    UnreadableLogError
        If it holds something else than two directions.
    """
    columns = tuple(Column(i, s.name, s.unit, s.group) for i, s in enumerate(recording.signals))
    texts = tuple(Column(i, c.name, c.unit, c.group) for i, c in enumerate(recording.cells))
    file = recording.source.name
    try:
        if same := called(name, columns):
            signs = signs_of_numbers(recording.signals[same[0].index].load(), same[0].path)
        elif same := called(name, texts):
            signs = signs_of_words(recording.cells[same[0].index].load(), same[0].path)
        else:
            listed = ", ".join(f"'{column}'" for column in (texts or columns)[:40])
            raise ChannelError(
                f"{file}: there is no column '{name}' (direction). Columns: {listed}",
                setting=Setting("direction", "channel"),
            )
    except UnreadableLogError as error:
        raise error.within(file) from None
    if signs.size != speed.size:
        raise ChannelError(
            f"{file}: '{same[0].path}' (direction) has {signs.size} rows, but the speed has {speed.size}"
        )
    return np.abs(speed) * signs, Warning(
        "sign from direction",
        "the sign of speed comes from '{channel}': {forward} rows forward, {reverse} reverse",
        channel=same[0].path,
        forward=int(np.sum(signs > 0)),
        reverse=int(np.sum(signs < 0)),
    )


def clock_of_distance(
    columns: tuple[Column, ...], name: str, steps: SetPoints
) -> tuple[Column, Conversion] | None:
    """Return the column of the distance slid that stands for a clock beside steps by distance, if any."""
    lengths = [c for c in called(name, columns) or columns if is_of_kind("length", c.unit)]
    if not steps.slid or (not name and any(is_called("time", c) for c in columns)):
        return None
    found = [c for c in lengths if name or is_named(_DISTANCE, c)]
    return (found[0], conversion("length", found[0].unit)) if len(found) == 1 else None


def times_of_distance(
    column: Column, unit: Conversion, written: FloatArray, steps: SetPoints
) -> tuple[FloatArray, Warning]:
    """Return the times, s, at which distances were reached by the speeds of a schedule."""
    distance = in_si(written, unit)
    known = distance[np.isfinite(distance)]
    return steps.reached(distance - (known[0] if known.size else 0.0)), Warning(
        "time from distance",
        "time is computed from the distance in '{channel}' and the speeds of the schedule",
        channel=column.path,
    )


def unscheduled(rows: int, of: int) -> Warning:
    """Return how many rows lie outside every step of a schedule."""
    return Warning(
        "rows outside the schedule",
        "{rows} of {all} rows lie outside every step of the schedule and were dropped",
        rows=rows,
        all=of,
    )


def outside_schedule(file: str, time: FloatArray) -> UnreadableLogError:
    """Return the error of a log that a schedule does not cover."""
    return UnreadableLogError(
        f"{file}: no step of the schedule covers two rows of the log, which lasts {time[-1] - time[0]:.6g} s",
        remedy="count the times of the schedule from the first row of the log, and write their unit",
    )
