"""LabVIEW measurement files (LVM): text in segments, each with a header that says start, rate and units."""

from __future__ import annotations

import datetime
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import BinaryIO

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.recording import Recording, Signal, cell_that_is_no_number
from hersey.log.text.column import refuse_columns, refuse_long_name, refuse_ragged, split_unit
from hersey.log.text.layout import encoding_of
from hersey.log.text.numbers import LONGEST_NUMBER, NumberStyle
from hersey.log.text.stamps import numbers_in
from hersey.schema.warning import Warning

_END = "***End_of_Header***"
_X = "X_Value"
#: So few cells are read one by one, which a frame would take longer for.
_FEW = 200
_TIME = re.compile(r"([0-9]{2}:[0-9]{2}:[0-9]{2})[.,]?([0-9]*)")
#: A segment starts with one of these where no blank line stands before it.
_HEADS = ("Channels",)


@dataclass
class _Segment:
    """One block: its header by key, the names of its columns, its rows and the line of the first."""

    header: dict[str, list[str]]
    names: list[str]
    line: int
    rows: list[list[str]] = field(default_factory=list)

    def start(self, channel: int) -> datetime.datetime | None:
        """Absolute time at which a channel starts, if the header says it."""
        date, time = (self._cell(key, channel) for key in ("Date", "Time"))
        match = _TIME.fullmatch(time[:LONGEST_NUMBER])
        try:
            day = datetime.datetime.fromisoformat(f"{date.replace('/', '-')}T{match[1]}" if match else "")
        except ValueError:
            return None
        assert match is not None
        return day + datetime.timedelta(seconds=float(f"0.{match[2] or 0}"))

    def number(self, key: str, channel: int, style: NumberStyle) -> float | None:
        """A number of the header that belongs to a channel."""
        cell = self._cell(key, channel)
        return next((s.value(cell) for s in (style, NumberStyle()) if s.is_number(cell)), None)

    def unit(self, channel: int) -> str:
        return self._cell("Y_Unit_Label", channel)

    def _cell(self, key: str, channel: int) -> str:
        cells = self.header.get(key, [])
        return cells[channel] if channel < len(cells) else ""


@contextmanager
def open_lvm(file: BinaryIO, name: str) -> Iterator[Recording]:
    """Open an LVM file; segments follow one another on the clock of their start times."""
    data = file.read()
    text = data.decode(encoding_of(data, name), errors="replace")
    lines = [line.rstrip("\r") for line in text.split("\n")]
    separator = _separator(lines, name)
    recording = Recording("LVM", ())
    if lines[-1].strip():
        recording.cut_off = True
        recording.warnings.append(
            Warning("last line cut off", "line {line} is incomplete and was skipped", line=len(lines))
        )
    general, segments = _segments(lines[:-1], separator, name)
    style = _style(general, segments)
    names = [segment.names for segment in segments]
    _refuse_size(name, segments, len(data))
    if any(other != names[0] for other in names):
        raise UnreadableLogError(
            f"line {segments[-1].line}: this segment has other channels than those before it. Split the "
            "file there"
        )
    for number, segment in enumerate(segments, start=1):
        promised = segment.number("Samples", 0, style)
        if promised and len(segment.rows) < promised:
            recording.warnings.append(
                Warning(
                    "segment short",
                    "segment {segment} of {segments} has {samples} samples instead of {promised:.0f}",
                    severity="watch",
                    segment=number,
                    segments=len(segments),
                    samples=len(segment.rows),
                    promised=promised,
                )
            )
    recording.comments = tuple(f"{k}: {v[0]}"[:200] for k, v in general.items() if v and v[0])[:5]
    table = _Table(segments, style, name, recording.warnings)
    recording.signals = tuple(table.signals())
    yield recording


def _refuse_size(file: str, segments: list[_Segment], size: int) -> None:
    """Refuse more columns, longer names, and rows that lack more cells than any log has."""
    names = segments[0].names
    refuse_columns(file, len(names))
    for number, name in enumerate(names, start=1):
        refuse_long_name(f"{file}, line {segments[0].line - 1}", number, name)
    refuse_ragged(file, sum(len(segment.rows) for segment in segments), len(names), size)


def _separator(lines: list[str], file: str) -> str:
    for line in lines[:60]:
        match = re.match(r"Separator\W(Tab|Comma)", line)
        if match:
            return "\t" if match[1] == "Tab" else ","
    raise UnreadableLogError(f"{file}: the header does not state the separator (Tab or Comma)")


def _segments(lines: list[str], separator: str, file: str) -> tuple[dict[str, list[str]], list[_Segment]]:
    """The header of the file and its segments."""
    cells = [[cell.strip() for cell in line.split(separator)] for line in lines]
    ends = [i for i, row in enumerate(cells) if row[0] == _END]
    if not ends:
        raise UnreadableLogError(f"{file}: line '{_END}' is missing, so the header is incomplete")
    general = {row[0]: row[1:] for row in cells[: ends[0]] if row[0]}
    segments: list[_Segment] = []
    header: dict[str, list[str]] = {}
    open_segment: _Segment | None = None
    after_end = len(ends) == 1
    for i, row in enumerate(cells[ends[0] + 1 :], start=ends[0] + 1):
        if not any(row):
            continue
        if row[0] in _HEADS and open_segment is not None:
            open_segment, header = None, {}
        if open_segment is not None:
            open_segment.rows.append(row)
        elif row[0] == _END:
            after_end = True
        elif after_end:
            open_segment = _Segment(header, _names(row), i + 2)
            segments.append(open_segment)
            after_end = False
        else:
            header[row[0]] = row[1:]
    segments = [segment for segment in segments if segment.rows]
    if not segments:
        raise UnreadableLogError(f"{file} has a header but no rows of numbers")
    return general, segments


def _names(row: list[str]) -> list[str]:
    names = row[: row.index("Comment")] if "Comment" in row else row
    return names[: max((i + 1 for i, name in enumerate(names) if name), default=0)]


def _style(general: dict[str, list[str]], segments: list[_Segment]) -> NumberStyle:
    mark = (general.get("Decimal_Separator") or [""])[0]
    if mark not in (".", ","):
        cells = [cell for row in segments[0].rows[:50] for cell in row]
        mark = "," if sum("," in cell for cell in cells) > sum("." in cell for cell in cells) else "."
    return NumberStyle(decimal_comma=mark == ",")


class _Table:
    """The channels of all segments, one after another."""

    def __init__(
        self, segments: list[_Segment], style: NumberStyle, file: str, warnings: list[Warning]
    ) -> None:
        self.segments, self.style, self.file, self.warnings = segments, style, file, warnings
        names = segments[0].names
        self.columns = [i for i, name in enumerate(names) if name != _X]
        self.names = [names[i] for i in self.columns]
        self.times: dict[int, int | None] = {}  # column with the times of each channel, if the file has one
        time: int | None = None
        for i, name in enumerate(names):
            if name == _X:
                time = i if any(row[i : i + 1] > [""] for row in segments[0].rows) else None
            self.times[i] = time

    def signals(self) -> Iterator[Signal]:
        for channel, column in enumerate(self.columns):
            unit = self.segments[0].unit(channel)
            name, ending = (self.names[channel], unit) if unit else split_unit(self.names[channel])
            rows = [self._rows(segment, column) for segment in self.segments]
            yield Signal(
                name,
                ending,
                sum(rows),
                lambda column=column, rows=rows: self._values(column, rows),  # type: ignore[misc]
                lambda channel=channel, rows=rows: self._clock(channel, rows),  # type: ignore[misc]
                repr((rows, self.times[column], [self._step(s, channel) for s in self.segments])),
            )

    def _rows(self, segment: _Segment, column: int) -> int:
        """Rows up to the last that is not empty: channels of other rates have fewer."""
        return next(
            (
                i + 1
                for i in reversed(range(len(segment.rows)))
                if segment.rows[i][column : column + 1] > [""]
            ),
            0,
        )

    def _values(self, column: int, rows: list[int]) -> FloatArray:
        parts = [self._numbers(s, column, n) for s, n in zip(self.segments, rows, strict=True)]
        return np.concatenate(parts)

    def _numbers(self, segment: _Segment, column: int, rows: int) -> FloatArray:
        cells = [row[column] if column < len(row) else "" for row in segment.rows[:rows]]
        if len(cells) < _FEW and all(map(self.style.is_number, cells)):
            return np.array([self.style.value(cell) for cell in cells])
        values, odd = numbers_in(pl.Series(cells, dtype=pl.String), self.style)
        for row in odd.arg_true()[:1]:
            place = segment.line + row, segment.names[column], cells[row]
            self.warnings.append(cell_that_is_no_number(*place, int(odd.sum())))
        return values

    def _step(self, segment: _Segment, channel: int) -> tuple[object, ...]:
        numbers = (segment.number(key, channel, self.style) for key in ("X0", "Delta_X"))
        return (segment.start(channel), *numbers)

    def _times(self, segment: _Segment, channel: int, column: int | None, count: int) -> FloatArray:
        """Times within a segment."""
        if column is not None:
            return self._numbers(segment, column, count)
        _, zero, step = self._step(segment, channel)
        if not isinstance(step, float) or step <= 0:
            raise UnreadableLogError(
                f"{self.file}: channel '{self.names[channel]}' has neither an {_X} column nor Delta_X, "
                "so its times are unknown"
            )
        return np.asarray((zero if isinstance(zero, float) else 0.0) + step * np.arange(count), dtype=float)

    def _clock(self, channel: int, rows: list[int]) -> FloatArray:
        column = self.times[self.columns[channel]]
        starts = [segment.start(channel) for segment in self.segments]
        known = [start for start in (s.start(0) for s in self.segments) if start is not None]
        parts: list[FloatArray] = []
        last = -np.inf
        for number, (segment, count, start) in enumerate(zip(self.segments, rows, starts, strict=True), 1):
            part = self._times(segment, channel, column, count)
            if start is not None and len(known) == len(self.segments):
                part = part + (start - known[0]).total_seconds()
            if part.size and part[0] <= last:
                raise UnreadableLogError(
                    f"{self.file}, line {segment.line}: segment {number} starts at {part[0]:.6g} s, "
                    f"before the previous one ends ({last:.6g} s). Split the file there"
                )
            last = float(part[-1]) if part.size else last
            parts.append(part)
        return np.concatenate(parts)
