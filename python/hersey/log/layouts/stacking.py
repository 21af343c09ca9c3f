"""Runs below each other as one recording: a channel for each name, and for each stated number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, UnitError, UnreadableLogError, WrongKindError
from hersey.log.layouts.grids import Grid
from hersey.log.layouts.pattern import Value
from hersey.log.layouts.table import LogLayout
from hersey.log.recording import Recording, Signal
from hersey.log.roles import role_conversion
from hersey.log.text.column import Column
from hersey.log.text.numbers import NumberStyle
from hersey.log.text.split_seconds import refuse_split_seconds
from hersey.log.text.stamps import Stamps, numbers_in
from hersey.schema.warning import Warning
from hersey.units import KINDS, conversion

#: Names of the channels that a layout adds: the number of the section, the clock of stated steps, set points.
SECTION, CLOCK, SET = "section", "time", "set {}"


@dataclass
class _Channel:
    """A channel while runs are added to it: numbers of each run in its unit, None where a run has none."""

    name: str
    unit: str
    parts: list[FloatArray | None] = field(default_factory=list)

    def add(self, run: int, values: FloatArray) -> None:
        """Set the numbers of a run."""
        self.parts += [None] * (run + 1 - len(self.parts))
        self.parts[run] = values


class Stack:
    """The runs of a file, one below the other."""

    def __init__(self, layout: LogLayout, file: str) -> None:
        """Take the layout, and the name of the file."""
        self.layout, self.file = layout, file
        self.warnings: list[Warning] = []
        self._channels: dict[tuple[str, int], _Channel] = {}  # by name, and its number among those of a name
        self._stamps: dict[str, Stamps] = {}
        self._rows: list[int] = []
        self._lines: list[int] = []

    def add(self, grid: Grid, place: str) -> None:
        """Add a run."""
        run, rows = len(self._rows), len(grid.lines)
        if not rows:
            return
        self._rows.append(rows)
        self._lines += grid.lines[:1]
        self.warnings += [each for each in grid.warnings if each not in self.warnings]
        numbers = {at: self._numbers(grid, at, place) for at in range(len(grid.columns))}
        if self.layout.milliseconds:
            self._with_milliseconds(grid, numbers, place)
        else:
            for at in grid.stamps:
                where = f"{place}: column '{grid.columns[at].name}'"
                refuse_split_seconds(where, numbers[at], grid.columns)
        seen = Counter[str]()
        for at, values in numbers.items():
            column = grid.columns[at]
            seen[column.name.lower()] += 1
            unit = "s" if at in grid.stamps else column.unit
            self._put(
                run, column.name, unit, values, f"{place}, line {grid.lines[0]}", seen[column.name.lower()]
            )
        for name, value in grid.values.items():
            self._state(run, rows, name, value)

    def _state(self, run: int, rows: int, name: str, value: Value) -> None:
        """Add a number that holds for a run as a channel."""
        if name == "every":
            step = role_conversion("time", value.unit)[1].scale * value.number
            if not 0 < step < 1e6:
                raise UnreadableLogError(f"{self.file}: the time between rows is {step:g} s")
            self._put(run, CLOCK, "s", np.arange(rows, dtype=np.float64) * step, self.file)
        else:
            self._put(run, SET.format(name), value.unit, np.full(rows, value.number), self.file)

    def _put(self, run: int, name: str, unit: str, values: FloatArray, place: str, count: int = 1) -> None:
        channel = self._channels.setdefault((name.lower(), count), _Channel(name, unit))
        if not channel.unit:
            channel.unit = unit
        elif unit and unit != channel.unit:
            values = _converted(values, unit, channel, place)
        channel.add(run, values)

    def _numbers(self, grid: Grid, at: int, place: str) -> FloatArray:
        """The numbers of a column; a cell that is none is missing, and warned of."""
        column = grid.columns[at]
        written: NumberStyle | Stamps = grid.style
        if style := grid.stamps.get(at):
            known = self._stamps.get(column.name.lower())
            written = known if known and known.style == style else Stamps(style)
            self._stamps[column.name.lower()] = written
        values, odd = numbers_in(pl.Series(grid.cells[at], dtype=pl.String), written)
        if at not in grid.stamps and odd.all():  # words throughout
            return np.full(len(grid.lines), np.nan)
        for row in odd.arg_true()[:1]:
            words = "line {row}, column '{column}': '{cell}' is not a {expected}"
            words += ", nor are {others} more {others:cell|cells} in this column" if odd.sum() > 1 else ""
            self.warnings.append(
                Warning(
                    "cell that is no number",
                    words,
                    where=place if place != self.file else "",
                    row=grid.lines[row],
                    column=column.name,
                    cell=grid.cells[at][row][:40],
                    expected="time" if at in grid.stamps else "number",
                    others=int(odd.sum()) - 1,
                )
            )
        return values

    def _with_milliseconds(self, grid: Grid, numbers: dict[int, FloatArray], place: str) -> None:
        """Add the column of milliseconds to the time stamps."""
        of = _called(self.layout.milliseconds, grid.columns, place)
        if not grid.stamps:
            raise UnreadableLogError(
                f"{place}: no column of time stamps to which '{self.layout.milliseconds}' could belong",
                remedy="delete milliseconds of [layout]",
            )
        for at in grid.stamps:
            numbers[at] = numbers[at] + 1e-3 * numbers[of]
        del numbers[of]

    def recording(self, kind: str) -> Recording:
        """Return all runs as a recording on one clock, with the number of the section."""
        if not self._rows:
            raise UnreadableLogError(f"{self.file}: [layout] leaves no rows of numbers")
        total, runs = sum(self._rows), len(self._rows)
        channels = [
            Signal(
                channel.name,
                channel.unit,
                total,
                _loading(channel.parts, self._rows),
                tick="rows",
                line=self._lines[0] if runs == 1 else 0,
            )
            for channel in self._channels.values()
            if any(part is not None and np.isfinite(part).any() for part in channel.parts)
        ]
        if runs > 1:
            section = np.repeat(np.arange(1.0, runs + 1), self._rows)
            channels.append(Signal(SECTION, "", total, lambda: section, tick="rows"))
        recording = Recording(kind, tuple(channels), warnings=self.warnings)
        for stamps, name in ((each, key) for key, each in self._stamps.items()):
            recording.warnings.append(stamps.warning(self._channels[name, 1].name))
        return recording


def _loading(parts: Sequence[FloatArray | None], rows: Sequence[int]) -> Callable[[], FloatArray]:
    """What gives the numbers of a channel: none in a run that does not have it."""
    known = [*parts, *[None] * (len(rows) - len(parts))]
    filled = [
        np.full(count, np.nan) if part is None else part for part, count in zip(known, rows, strict=True)
    ]
    return lambda: np.concatenate(filled)


def _called(name: str, columns: Sequence[Column], place: str) -> int:
    """The place of a column among others."""
    found = [at for at, column in enumerate(columns) if column.name.lower() == name.lower()]
    if len(found) != 1:
        listed = ", ".join(f"'{each}'" for each in columns[:40])
        raise ChannelError(f"{place}: [layout] names the column '{name}'. Columns: {listed}")
    return found[0]


def _converted(values: FloatArray, unit: str, channel: _Channel, place: str) -> FloatArray:
    """Numbers in the unit that the channel has in the runs before."""
    for kind in KINDS:
        try:
            here, there = conversion(kind, unit), conversion(kind, channel.unit)
        except (UnitError, WrongKindError):
            continue
        return (values * here.scale + here.offset - there.offset) / there.scale
    raise UnitError(
        f"{place}: column '{channel.name}' is in '{unit}' here and in '{channel.unit}' above it. "
        "Correct one of them"
    )
