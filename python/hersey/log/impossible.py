"""Readings that cannot be right: beyond every drive, codes of a logger, and what neighbours rule out.

A reading is compared with what the quantity can be at all, then with the ordinary range of its channel, that
of all but 2 % of its rows at either end; rows beyond it are given up only if something else speaks against
them: a code that loggers write, the size of a jump, or steady rows around them. A drive may well reach ten
times its ordinary torque or speed for a while: such rows stay.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Annotated

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.errors import DROP_MISSING, ISOTHERMAL, Setting, TimeOrderError, UnreadableLogError
from hersey.log.believed import BELIEVED, TENTHS, Believed, as_written, in_si, is_code, is_wrapped
from hersey.log.counters import step_of_counts
from hersey.log.long_arrays import each_block, ends, every, joined, rows_where
from hersey.log.neighbours import (
    LEAST_JUMP,
    NEAREST_BURST,
    bursts,
    drop_outs,
    flips,
    on_its_way,
    pulses,
)
from hersey.log.roles import role_conversion
from hersey.log.stray_times import stray_times
from hersey.log.text.column import Column
from hersey.result import Means, Record
from hersey.schema.warning import Warning
from hersey.units import Conversion

#: Fewer rows than this show no ordinary range.
FEWEST = 50
#: Rows from which the ordinary range is taken, at the most.
_LOOKED_AT = 50_000
#: Share of rows at either end that the ordinary range leaves out.
_ENDS = 0.02
#: A channel has an ordinary range if its rows without codes are at least this share.
_LEAST_SOUND = 0.3
#: Temperatures of a channel span at least so many kelvin, for the rules below.
_LEAST_SPAN = 20.0
#: A code counts if it lies so many sizes (span, or greatest value) beyond the ordinary range, a reading that
#: may be a wrapped counter so many.
_CODE, _WRAP = 1.0, 3.0
#: A temperature is no drop-out to zero within so many kelvin of zero.
_NEAR_ZERO = 20.0
#: Rows that only neighbours speak against are few, this share at the most: more are the signal.
_FEW = 0.05
#: Share of the rows of a channel that may be impossible; with leave to drop rows.
MOST, MOST_ALLOWED = 0.2, 0.5
#: Distinct values that are named, at the most.
_NAMED = 3
#: Units in which a temperature may have been meant, and the range of those that are likely, K.
_LIKELY = (233.15, 673.15)
_OTHER_FILE = "name another column, or correct the file"
#: Larger numbers, in SI, are cut to this before they are compared: their differences would overflow.
_NO_LARGER = 1e30
#: Share by which a zero in SI may be off.
_ROUNDING = 1e-9


class Reason(StrEnum):
    """Why a reading cannot be right."""

    RANGE = "range"
    CODE = "code"
    OUTLIER = "outlier"
    SIGN = "sign"
    DROP_OUT = "drop-out"
    JUMP = "jump"
    CLOCK = "clock"
    MARKED = "marked"


_WORDS = {
    Reason.CODE: "a code of the logger or sensor, far from all other readings",
    Reason.OUTLIER: "far beyond all other readings",
    Reason.SIGN: "opposite in sign to the steady readings around it",
    Reason.DROP_OUT: "a dropout among steady readings",
    Reason.JUMP: "a jump and return too fast for a temperature",
    Reason.MARKED: "marked as invalid in the file",
    Reason.CLOCK: "out of line with the times of the rows around it",
}


@dataclass(frozen=True)
class Impossible(Record):
    """Readings of one channel that were left out for one reason.

    ``values`` are the most frequent ones with their counts, in ``unit`` as written; ``low`` and ``high`` the
    least and greatest of them all (none and None for `Reason.MARKED`); ``where`` is the first, in words;
    ``limits`` in words for `Reason.RANGE`.
    """

    role: str
    channel: str
    unit: str
    reason: Annotated[Reason, Means("range, code, outlier, sign, drop-out, jump, clock or marked")]
    rows: int
    values: Annotated[tuple[tuple[float, int], ...], Means("most frequent readings with their counts")]
    low: Annotated[float | None, Means("null if the file itself marks them as invalid")]
    high: float | None
    where: Annotated[str, Means("the first of them, in words")]
    limits: Annotated[str, Means("accepted range, in words; empty unless the reason is range")] = ""

    def __str__(self) -> str:
        """Return what was read, how often, where first, and why it is not believed."""
        why = f"outside {self.limits}" if self.reason is Reason.RANGE else _WORDS[self.reason]
        unit = f" {self.unit}" if self.unit else ""
        if self.low is None:
            return f"{self.where}: {self.role} is {why} ({_times(self.rows)})"
        if sum(count for _, count in self.values) == self.rows:
            read = ", ".join(f"{value:.10g}{unit} ({_times(count)})" for value, count in self.values)
        else:
            read = f"{self.low:.10g} to {self.high:.10g}{unit} ({_times(self.rows)})"
        return f"{self.where}: impossible {self.role} {read}, {why}"

    def warning(self) -> Warning:
        """Return it as what was done to a file."""
        return Warning(
            "impossible readings",
            "{rows} {rows:row was|rows were} excluded, {rows:at|the first at} {readings}",
            rows=self.rows,
            role=self.role,
            channel=self.channel,
            reason=self.reason.value,
            low=self.low,
            high=self.high,
            unit=self.unit,
            readings=str(self),
        )


@dataclass(frozen=True)
class Reading:
    """A channel to look at: its role, column and unit, and its numbers in SI, shape (rows,)."""

    role: str
    column: Column
    unit: Conversion
    values: FloatArray


def impossible_rows(
    readings: list[Reading], file: str, where: Callable[[int, Column], str], *, allowed: bool
) -> tuple[IntArray, tuple[Impossible, ...]]:
    """Return the rows that hold a reading that cannot be right, and what was found, by channel and reason.

    Parameters
    ----------
    readings
        Channels on one clock, that of the role ``time`` among them if there is one; NaN is passed over.
    where
        The place of a row and a column in words.
    allowed
        Whether more rows may be left out than unasked.

    Raises
    ------
    UnreadableLogError
        If too much of a channel is impossible; it says how much.
    """
    time = next((each.values for each in readings if each.role == "time"), None)
    rows = readings[0].values.size
    gone = np.empty(0, dtype=np.intp)
    found: list[Impossible] = []
    for each in readings:
        if each.role == "run" or not rows:
            continue
        kind = role_conversion(each.role, each.unit.unit)[0]
        sound, known = each, None
        if not np.isfinite(span := ends(each.values)).all():
            known = np.flatnonzero(np.isfinite(each.values))
            if not known.size:
                continue
            sound = replace(each, values=each.values[known])
            span = ends(sound.values)
        if each.role == "time":
            by_reason = _of_clock(sound.values, span)
        else:
            clock = time if time is None or known is None else time[known]
            by_reason = _of_channel(sound, kind, clock, span)
        by_reason = {
            reason: bad if known is None else known[bad] for reason, bad in by_reason.items() if bad.size
        }
        if not by_reason:
            continue
        here = [_record(each, kind, reason, bad, where) for reason, bad in by_reason.items()]
        bad = _united(*by_reason.values())
        found += here
        _refuse_many(here, each, kind, bad.size, rows, file, allowed=allowed)
        gone = _united(gone, bad)
    return gone, tuple(found)


def marked_rows(
    marks: list[tuple[str, Column, str, BoolArray]],
    file: str,
    where: Callable[[int, Column], str],
    *,
    allowed: bool,
) -> tuple[IntArray, tuple[Impossible, ...]]:
    """Return the rows that a file itself marks as invalid, and what was found, by channel.

    Parameters
    ----------
    marks
        Role, column, unit and marks of each channel on one clock, shape (rows,).
    where, allowed
        As for `impossible_rows`.

    Raises
    ------
    UnreadableLogError
        If too much of a channel is marked; it says how much.
    """
    gone = np.zeros(marks[0][3].size, dtype=bool)
    found = []
    for role, column, unit, mask in marks:
        rows = int(mask.sum())
        if not rows:
            continue
        first = where(int(np.argmax(mask)), column)
        found.append(Impossible(role, column.path, unit, Reason.MARKED, rows, (), None, None, first))
        if rows > max(1.0, (MOST_ALLOWED if allowed else MOST) * mask.size):
            share = f"{rows / mask.size:.0%} of the channel ({rows} of {mask.size} samples)"
            leave = f", or exclude temperature with {ISOTHERMAL.to()}" if role == "temperature" else ""
            raise UnreadableLogError(
                f"{file}, {found[-1]}; {share}", remedy=f"{_way_out(rows, mask.size)}{leave}"
            )
        gone |= mask
    return np.flatnonzero(gone), tuple(found)


def _way_out(bad: int, rows: int) -> str:
    """What to do about so many rows that cannot be used."""
    drop = f", or exclude such rows with {DROP_MISSING.to()}" if bad <= MOST_ALLOWED * rows else ""
    return f"{_OTHER_FILE}{drop}"


def _of_clock(time: FloatArray, span: tuple[float, float]) -> dict[Reason, IntArray]:
    believed = BELIEVED["time"]
    if span[0] >= believed.low and span[1] <= believed.high:
        return {Reason.CLOCK: stray_times(time)}
    beyond = (time < believed.low) | (time > believed.high)
    ordinary = np.flatnonzero(~beyond)
    return {Reason.RANGE: np.flatnonzero(beyond), Reason.CLOCK: ordinary[stray_times(time[ordinary])]}


def _of_channel(
    reading: Reading, kind: str, time: FloatArray | None, span: tuple[float, float]
) -> dict[Reason, IntArray]:
    """Rows that cannot be right by reason, each row under one; ``span`` is the least and greatest value."""
    values, believed = reading.values, BELIEVED[kind]
    least, most = span  # most channels need no further look
    found: dict[Reason, IntArray] = {}
    if least < believed.low or most > believed.high:
        values = each_block(lambda part: np.clip(part, -_NO_LARGER, _NO_LARGER), values)
        found[Reason.RANGE] = _beyond(values, believed.low, believed.high)
    ordinary = _ordinary(reading, kind, believed) if values.size >= FEWEST else None
    if ordinary is None:
        return found
    low, high, size = ordinary
    taken = found.get(Reason.RANGE, np.empty(0, dtype=np.intp))

    def take(reason: Reason, rows: IntArray) -> None:
        nonlocal taken
        found[reason] = _united(found.get(reason, rows[:0]), _but(rows, taken))
        taken = _united(taken, rows)

    def some_beyond(sizes: float) -> bool:
        return most > high + sizes * size or least < low - sizes * size

    if some_beyond(_CODE):
        far = _beyond(values, low - _CODE * size, high + _CODE * size)
        beyond = np.maximum(values[far] - high, low - values[far]) / size if size > 0 else np.inf
        wrapped = is_wrapped(values[far], reading.unit) & (beyond > _WRAP)
        take(Reason.CODE, far[is_code(values[far], reading.unit, kind) | wrapped])
    if size > 0 and some_beyond(NEAREST_BURST):
        take(Reason.OUTLIER, _few(_but(bursts(values, low, high, size), taken), values))
    zero = reading.unit.offset
    if least <= zero + _ROUNDING * zero and most >= zero - _ROUNDING * zero:
        nearest = _NEAR_ZERO if kind == "temperature" else 0.0
        rows = drop_outs(values, zero, nearest)
        if rows.size and kind in ("speed", "belt speed"):  # a row without a count is none
            rows = drop_outs(values, zero, 1.5 * step_of_counts(values))
        take(Reason.DROP_OUT, _few(_but(rows, taken), values))
    if kind == "temperature" and time is not None and most - least > LEAST_JUMP:
        take(Reason.JUMP, pulses(values, time, high - low, MOST))
    if size > 0 and taken.size:
        take(Reason.OUTLIER, _but(on_its_way(values, taken, low, high, size), taken))
    if least < 0.0 <= most and kind in ("torque", "force", "friction coefficient", "speed", "belt speed"):
        take(Reason.SIGN, _few(_but(flips(values), taken), values))
    return found


def _beyond(values: FloatArray, low: float, high: float) -> IntArray:
    """Rows with a value below the one or above the other."""
    return rows_where(
        lambda block: np.asarray((values[block] < low) | (values[block] > high)), values.size, values
    )


def _ordinary(reading: Reading, kind: str, believed: Believed) -> tuple[float, float, float] | None:
    """Ends of the ordinary range and its size, SI, or None if most readings are codes."""
    values = every(reading.values, max(1, reading.values.size // _LOOKED_AT))
    values = values[np.isfinite(values) & (values >= believed.low) & (values <= believed.high)]
    sound = values[~is_code(values, reading.unit, kind) & ~is_wrapped(values, reading.unit)]
    if not sound.size or sound.size < _LEAST_SOUND * values.size:
        return None
    low, high = (float(end) for end in np.quantile(sound, [_ENDS, 1.0 - _ENDS]))
    size = max(high - low, _LEAST_SPAN if kind == "temperature" else max(abs(low), abs(high)))
    return low, high, size


def _few(rows: IntArray, values: FloatArray) -> IntArray:
    """Rows if they are few, else none: what is frequent is the signal."""
    return rows if rows.size <= _FEW * values.size else rows[:0]


def _united(*parts: IntArray) -> IntArray:
    """The rows of all parts in order."""
    return np.unique(joined(parts))


def _but(rows: IntArray, taken: IntArray) -> IntArray:
    """The rows that are not taken."""
    return rows[~np.isin(rows, taken, assume_unique=True)] if taken.size else rows


def _record(
    reading: Reading, kind: str, reason: Reason, rows: IntArray, where: Callable[[int, Column], str]
) -> Impossible:
    written = as_written(reading.values[rows], reading.unit)
    distinct, counts = np.unique(np.array([float(f"{v:.10g}") for v in written[:10_000]]), return_counts=True)
    most = np.argsort(-counts, kind="stable")[:_NAMED]
    return Impossible(
        reading.role,
        reading.column.path,
        reading.unit.unit,
        reason,
        rows.size,
        tuple((float(distinct[i]), int(counts[i])) for i in most),
        float(written.min()),
        float(written.max()),
        where(int(rows[0]), reading.column),
        str(BELIEVED[kind]) if reason is Reason.RANGE else "",
    )


def _refuse_many(
    found: list[Impossible], reading: Reading, kind: str, bad: int, rows: int, file: str, *, allowed: bool
) -> None:
    if bad <= max(1.0, (MOST_ALLOWED if allowed else MOST) * rows):
        return
    share = f"{bad / rows:.0%} of {reading.role} '{reading.column.path}' is impossible ({bad} of {rows} rows)"
    if any(each.reason is Reason.CLOCK for each in found):
        raise TimeOrderError(
            f"{file}, {found[0]}; {share}",
            remedy=f"sort the rows by '{reading.column.path}' if they are in another order. Otherwise "
            f"{_way_out(bad, rows)}",
            setting=Setting("time", "channel"),
        )
    meant = _meant_unit(reading) if kind == "temperature" else ""
    tenths = "temperatures are in tenths of a degree" if meant in TENTHS else "unit is wrong"
    unit = f"if the {tenths}, use {Setting(reading.role, 'unit').to(meant)}"
    other = _OTHER_FILE if meant else _way_out(bad, rows)  # rows in another unit are not missing
    raise UnreadableLogError(f"{file}, {found[0]}; {share}", remedy=f"{unit}. Otherwise {other}")


def _meant_unit(reading: Reading) -> str:
    """The unit in which most of the temperatures written would be ordinary, or nothing."""
    written = as_written(reading.values[np.isfinite(reading.values)], reading.unit)
    for unit in ("degC", "K", "degF"):
        if _are_likely(np.array([np.median(written)]), unit):
            return unit if unit != reading.unit.unit else ""
    whole = np.round(written)
    if np.allclose(written, whole, rtol=0.0, atol=1e-6) and np.ptp(whole) > 0:  # a word of a PLC
        return next((unit for unit in TENTHS if _are_likely(np.quantile(written, [0.01, 0.99]), unit)), "")
    return ""


def _are_likely(written: FloatArray, unit: str) -> bool:
    """Whether temperatures as written would be ordinary in a unit."""
    kelvin = in_si(written, role_conversion("temperature", unit)[1])
    return bool(np.all((_LIKELY[0] < kelvin) & (kelvin < _LIKELY[1])))


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"
