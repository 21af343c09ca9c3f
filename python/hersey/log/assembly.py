"""From a recording to a run: roles, SI units, and one clock, that of the torque."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.errors import (
    ChannelError,
    HerseyError,
    Setting,
    TimeOrderError,
    UnitError,
    UnreadableLogError,
)
from hersey.log.believed import in_si
from hersey.log.channels import (
    clocks_passed_over,
    constant_channel,
    find_channel,
    is_dead,
    no_channel,
    not_numbers,
    refuse_two_roles,
    taken_columns,
)
from hersey.log.constant_temperature import constant_temperature
from hersey.log.derived.direction import without_sign
from hersey.log.derived.speeds import (
    clock_of_distance,
    outside_schedule,
    speed_column,
    speed_of_position,
    times_of_distance,
    unscheduled,
    with_direction,
)
from hersey.log.formats.frame import FRAME
from hersey.log.friction import Chosen, beside, computed, in_domain, slow_roles, unused
from hersey.log.impossible import Impossible, Reading, impossible_rows, marked_rows
from hersey.log.lacking_roles import asking_all
from hersey.log.long_arrays import HELD, each_block, ends, rows_before, rows_where, without
from hersey.log.recording import INVALID, INVALID_TIME, Recording, Signal, columns, nothing_to_read
from hersey.log.replaced import replaced_units
from hersey.log.roles import EVERY, OTHER_ROLES, ROLES, role_conversion
from hersey.log.rows import LeftOut, runs_with_records
from hersey.log.text.column import Column
from hersey.log.text.stamps import clock_without_unit, counted_unit, is_clock_name
from hersey.log.torque_log import NO_CLOCK, Channel, LogFile, Run
from hersey.log.wanted import Wanted
from hersey.log.wrapped import COUNTED, with_signs
from hersey.schema.warning import Warning
from hersey.units import Conversion


@dataclass
class _Part:
    """A channel in its role: numbers in SI, NaN where one is missing, the time of each in s, and its row."""

    role: str
    column: Column
    unit: Conversion
    values: FloatArray
    time: FloatArray
    tick: str
    marked: FloatArray | None  #: what the file itself says of each sample: see `Signal.marked`
    lost: tuple[IntArray, ...] = ()  #: samples that were left out, step by step

    def recorded(self, row: int) -> int:
        """Where a sample that is left stood among all, counted from 0."""
        for rows in reversed(self.lost):
            row = rows_before(row, rows)
        return row


def _leave_out(parts: list[_Part], rows: IntArray) -> None:
    """Leave out samples, which are in order, of the channels on one clock."""
    time = without(parts[0].time, rows)
    for part in parts if rows.size else ():
        part.values, part.time = without(part.values, rows), time
        part.marked = None if part.marked is None else without(part.marked, rows)
        part.lost = (*part.lost, rows)


class Assembly:
    """The channels of one recording that play a role, loaded while its file is open.

    Raises
    ------
    ChannelError, UnitError
        If a role has no channel, several, or one without a unit; the message lists what the file holds.
    UnreadableLogError
        If the numbers of a channel cannot be read.
    """

    def __init__(self, recording: Recording, wanted: Wanted) -> None:
        self.recording, self.source = recording, recording.source
        self.choices, self.stated, self.drop_missing = wanted.choices, wanted.stated, wanted.drop_missing
        self._first = "speed" if wanted.without_torque else "torque"  # the role that gives the clock
        if not recording.signals:
            raise nothing_to_read(recording)
        self.columns = columns(recording)
        self._lacking: dict[str, LeftOut] = {}  # rows of the torque that lack a role that may be slow
        self._clocks: dict[str, tuple[FloatArray, str, Channel]] = {}
        self._dead: dict[int, Warning | None] = {}
        self._counted: dict[int, Warning] = {}  # clocks that count from a known day
        self.chosen: Chosen = {}
        self._timed: Chosen = {}
        self.parts: dict[str, _Part] = {}
        self.derived, self._said, self._names = wanted.derived, list[Warning](), wanted.names
        try:
            self._choose(wanted.roles, isothermal=wanted.isothermal)
        except (ChannelError, UnitError) as error:
            raise self._asking_all(error, wanted.roles) from None

    def _choose(self, roles: tuple[str, ...], *, isothermal: bool) -> None:
        """Find the channel of each role, and load it."""
        for role in roles:
            if role != "time":  # which is that of the channel
                self.chosen[role] = self._channel(role)
        first = self.chosen[self._first][0]
        others = {r: g.column(first.group) for r, g in self.derived.channels.items() if r in OTHER_ROLES}
        self.chosen |= others
        near = tuple(c for c in self.columns if c.group == first.group)
        self.chosen |= beside(near, self.choices, self.stated, self.chosen, self.source.name)
        self._unused = [
            *clocks_passed_over(near, self.stated),
            *unused(near, self.chosen, self.stated, self._numbers),
        ]
        if isothermal:
            self._unused += constant_temperature(near, self.chosen, self.source.name, self._numbers)
        for role in self.chosen:
            self.parts[role] = self._part(role)

    def _asking_all(self, error: HerseyError, roles: tuple[str, ...]) -> HerseyError:
        """The error of a role that is open, with all others that are; of parts apart only those of units."""
        if isinstance(error, ChannelError) and len({column.group for column in self.columns}) > 1:
            return error
        elsewhere = set(self.derived.channels) | ({"speed"} if self.choices["position"].name else set())
        roles = tuple(role for role in roles if role not in elsewhere)
        if not self.choices["time"].name and any(each.clock is not None for each in self.recording.signals):
            roles = tuple(role for role in roles if role != "time")
        columns = tuple(map(self._with_epoch, self.columns)) if "time" in roles else self.columns
        of_a_frame = self.recording.format == FRAME
        return asking_all(
            error,
            roles,
            columns,
            self.choices,
            self.source.name,
            dead=self._says_nothing,
            of_a_frame=of_a_frame,
            names=self._names,
        )

    def runs(self) -> list[tuple[Run, LogFile]]:
        """Return the runs on the clock of the torque, and what was done to get there.

        Raises
        ------
        UnreadableLogError
            If too many numbers are missing, a clock runs backwards, or the channels do not overlap.
        """
        left_out, torque = LeftOut(), self.parts[self._first]
        warnings = [*self.recording.warnings, *self._counted.values()]
        marked, rows_marked = self._judged(self._marked)
        self._leave_out_unscheduled()
        self._leave_out_missing(left_out)
        impossible, rows_impossible = self._judged(self._impossible)
        impossible = (*marked, *impossible)
        warnings += [each.warning() for each in impossible]
        arrays, first = self._on_one_clock(warnings)
        arrays = in_domain(arrays, self.chosen, self.stated)
        bad = _unknown([values for role, values in arrays.items() if role not in self._lacking])
        places = (self._place(torque, first + row) for row in bad.tolist())
        left_out.add(bad.size, (f"{each}: the radius is not greater than zero" for each in places))
        arrays = {role: without(values, bad) for role, values in arrays.items()}
        warnings += computed(self.chosen, self.stated)
        warnings += replaced_units(self._timed | self.chosen)
        if not self.choices["direction"].name:
            names = [*(each.name for each in self.recording.cells)]
            names += [each.name for each in self.recording.signals]
            warnings += without_sign(names, arrays["speed"])
        warnings += [*filter(None, self._dead.values()), *self._unused, *self._said]
        log = self._record(tuple(warnings))
        log = replace(log, missing_rows=rows_marked + rows_impossible, impossible=impossible)

        def place(row: int) -> str:
            return self._place(torque, first + rows_before(row, bad))

        return runs_with_records(log, arrays, place, left_out, self._lacking, drop_missing=self.drop_missing)

    def _on_one_clock(self, warnings: list[Warning]) -> tuple[dict[str, FloatArray], int]:
        """Every channel at the times of the torque that all clocks span, and the first of these samples."""
        torque = self.parts[self._first]
        first, end = 0, torque.time.size
        others = [part for part in self.parts.values() if part.tick != torque.tick]
        for part in others:
            self._check_time(torque)
            self._check_time(part)
            first = max(first, int(np.searchsorted(torque.time, part.time[0])))
            end = min(end, int(np.searchsorted(torque.time, part.time[-1], side="right")))
        kept, dropped = slice(first, max(first, end)), torque.time.size - max(0, end - first)
        if dropped and end - first < 2:
            raise UnreadableLogError(
                f"{self.source.name}: the channels share fewer than two torque samples in time "
                f"({self._spans()})"
            )
        arrays = {"time": torque.time[kept]}
        for role, part in self.parts.items():
            same = part.tick == torque.tick
            arrays[role] = part.values[kept] if same else np.interp(arrays["time"], part.time, part.values)
        warnings += [_aligned(part, torque) for part in others if part.role != "position"]
        if dropped:
            warnings.append(
                Warning(
                    "samples outside another channel",
                    "{samples} of {all} torque samples were dropped because another channel has no "
                    "values at their times ({spans})",
                    samples=dropped,
                    all=torque.time.size,
                    spans=self._spans(),
                )
            )
        return arrays, first

    def _record(self, warnings: tuple[Warning, ...]) -> LogFile:
        used = {"time": self._clocks[self.parts[self._first].tick][2]} | {
            p.role: Channel(p.role, p.column.path, p.unit.unit)
            for p in self.parts.values()
            if p.role != "position"  # the speed is its slope
        }
        return LogFile(
            self.source.name,
            self.source.sha256,
            self.source.bytes,
            0,
            0,
            tuple(used[role] for role in (*ROLES, *OTHER_ROLES) if role in used),
            self.recording.comments,
            self.recording.cut_off,
            warnings,
        )

    def _place(self, part: _Part, row: int) -> str:
        """One of the samples that are left, counted from 0, in words: by its row where the file has rows."""
        line, row = self.recording.signals[part.column.index].line, part.recorded(row)
        return f"row {line + row}" if line else f"sample {row + 1}"

    def _channel(self, role: str) -> tuple[Column, Conversion]:
        """The channel of a role; the part of the file that holds the torque is looked at first."""
        file, choice, channel = self.source.name, self.choices[role], None
        if given := self.derived.channels.get(role):
            return given.column(self.chosen[self._first][0].group)
        if role == "speed" and self.choices["position"].name:
            return speed_column(*self._position())
        taken = taken_columns(role, self.columns, self.choices, self.chosen)
        if role != self._first and not choice.name:
            torque = self.chosen[self._first][0]
            near = tuple(c for c in self.columns if c.group == torque.group and c != torque)
            channel = find_channel(role, near, choice, file, self._says_nothing, taken)
        if channel is None:
            among = self._beside_a_speed(role)
            channel = find_channel(role, among, choice, file, self._says_nothing, taken)
        if channel is None:
            raise no_channel(role, self.columns, file, self.recording.others, self._names)
        refuse_two_roles(role, channel[0], self.chosen, file)
        return channel

    def _part(self, role: str) -> _Part:
        """A channel with its numbers and its clock."""
        column, unit = self.chosen[role]
        if given := self.derived.channels.get(role):
            torque = self.parts[self._first]
            self._said.append(given.warning())
            return _Part(role, column, unit, given.at(torque.time), torque.time, torque.tick, None)
        signal = self.recording.signals[column.index]
        time, tick, _ = self._clock(signal, column)
        values = signal.load()
        if values.size != time.size:
            raise UnreadableLogError(
                f"{self.source.name}: channel '{column.path}' has {values.size} values, but its clock "
                f"has {time.size}. The file is damaged or cut off"
            )
        marked = None if signal.marked is None else signal.marked()
        if role in COUNTED:
            values, read = with_signs(values, 1.0, self.columns[column.index].path)
            self._said += read
        if role == "speed":
            values = self._speed(time, values, tick)
        return _Part(role, column, unit, _in_si(values, unit), time, tick, marked)

    def _position(self) -> tuple[Column, Conversion]:
        """The column of the position, and its unit."""
        choice, file = self.choices["position"], self.source.name
        channel = find_channel("position", self.columns, choice, file)
        assert channel is not None  # it is named
        return channel

    def _speed(self, time: FloatArray, values: FloatArray, tick: str) -> FloatArray:
        """The speed from the numbers of its column, or of a position; with the sign of a direction."""
        if self.choices["position"].name:
            column, unit = self._position()
            position, values, warning = speed_of_position(column, unit, time, values, self.derived.window)
            self._said.append(warning)
            if position is not None and not self.choices["direction"].name:
                self.parts["position"] = _Part("position", column, unit, position, time, tick, None)
        if name := self.choices["direction"].name:
            values, warning = with_direction(self.recording, name, values)
            self._said.append(warning)
        return values

    def _leave_out_unscheduled(self) -> None:
        """Leave out samples of the torque at which nothing is scheduled."""
        torque = self.parts[self._first]
        given = self.derived.channels.items()
        scheduled = [self.parts[role].values for role, of in given if of.schedule and role in self.parts]
        if not scheduled:
            return
        rows, count = _unknown(scheduled), torque.time.size
        if rows.size > count - 2:
            raise outside_schedule(self.source.name, torque.time)
        _leave_out([part for part in self.parts.values() if part.tick == torque.tick], rows)
        if rows.size:
            self._said.append(unscheduled(int(rows.size), count))

    def _numbers(self, column: Column) -> FloatArray:
        """The numbers of a channel as written."""
        return self.recording.signals[column.index].load()

    def _says_nothing(self, column: Column) -> bool:
        """Whether a channel holds one value throughout, or none; there is a warning then."""
        if column.index not in self._dead:
            dead = is_dead(self._numbers(column))
            self._dead[column.index] = constant_channel(column) if dead else None
        return self._dead[column.index] is not None

    def _beside_a_speed(self, role: str) -> tuple[Column, ...]:
        """Channels among which to look for a role: for a torque those of the only part with a speed."""
        groups = dict.fromkeys(column.group for column in self.columns)
        if role != "torque" or self.choices[role].name or len(groups) < 2:
            return self.columns
        parts = [tuple(c for c in self.columns if c.group == group) for group in groups]
        both = [p for p in parts if all(self._has(role, p) for role in ("torque", "speed"))]
        return both[0] if len(both) == 1 else self.columns

    def _has(self, role: str, part: tuple[Column, ...]) -> bool:
        """Whether a part of the file has a channel of a role, or several."""
        try:
            return find_channel(role, part, self.choices[role], self.source.name) is not None
        except HerseyError:
            return True

    def _clock(self, signal: Signal, column: Column) -> tuple[FloatArray, str, Channel]:
        """Time of each sample in s, the name of the clock, and the channel it came from."""
        choice = self.choices["time"]
        if (every := self.stated.every) is not None:
            tick = f"every {signal.rows}"
            if tick not in self._clocks:
                channel = Channel("time", NO_CLOCK, f"{every:g} s")
                self._clocks[tick] = (np.arange(signal.rows, dtype=float) * every, tick, channel)
            return self._clocks[tick]
        if signal.clock is not None and not choice.name:
            if signal.tick not in self._clocks:
                self._clocks[signal.tick] = (signal.clock(), signal.tick, Channel("time", "clock", "s"))
            return self._clocks[signal.tick]
        file = self.source.name
        near = tuple(
            self._with_epoch(c)
            for c in self.columns
            if c != column and self._may_time(c, signal, column, bool(choice.name))
        )
        if (of_distance := self._clock_of_distance(near)) is not None:
            return of_distance
        taken = taken_columns("time", near, self.choices, self.chosen)
        clock = (
            find_channel("time", near, choice, file, self._says_nothing, taken)
            if near or choice.name
            else None
        )
        if clock is None:
            raise ChannelError(
                f"{file}: '{column}' has no time channel with {signal.rows} samples. Channels: "
                f"{', '.join(repr(str(c)) for c in self.columns[:40])}{not_numbers(self.recording.others)}",
                remedy=(
                    f"name it with {Setting('time', 'channel').to()}, or give the time between rows with "
                    f"{EVERY.to('2 ms', python='0.002')}"
                ),
                setting=Setting("time", "channel"),
            )
        chosen, unit = clock
        self._timed["time"] = clock
        tick = f"column {chosen.index}"
        if tick not in self._clocks:
            values = _in_si(self.recording.signals[chosen.index].load(), unit)
            self._clocks[tick] = (values, tick, Channel("time", chosen.path, unit.unit))
        return self._clocks[tick]

    def _clock_of_distance(self, near: tuple[Column, ...]) -> tuple[FloatArray, str, Channel] | None:
        """The time from a distance slid, beside a schedule of distances."""
        steps = next((of.schedule for of in self.derived.channels.values() if of.schedule), None)
        found = clock_of_distance(near, self.choices["time"].name, steps) if steps else None
        if steps is None or found is None:
            return None
        column, unit = found
        if (tick := f"distance {column.index}") not in self._clocks:
            written = self.recording.signals[column.index].load()
            values, warning = times_of_distance(column, unit, written, steps)
            self._said.append(warning)
            self._clocks[tick] = (values, tick, Channel("time", f"by {column.path}", "s"))
        return self._clocks[tick]

    def _may_time(self, candidate: Column, signal: Signal, column: Column, named: bool) -> bool:
        other = self.recording.signals[candidate.index]
        return other.rows == signal.rows and (named or candidate.group == column.group)

    def _with_epoch(self, column: Column) -> Column:
        if not is_clock_name(column.name):
            return column
        load = self.recording.signals[column.index].load
        unit, meaning = counted_unit(column.name, column.unit, load)
        if unit:
            self._counted[column.index] = clock_without_unit(column.path, meaning)
        return Column(column.index, column.name, unit or column.unit, column.group)

    def _by_clock(self) -> Iterator[list[_Part]]:
        """The channels on each clock, which lose the same samples."""
        for tick in dict.fromkeys(part.tick for part in self.parts.values()):
            yield [part for part in self.parts.values() if part.tick == tick]

    def _leave_out_missing(self, left_out: LeftOut) -> None:
        """Leave out samples without a number or a time."""
        torque = self.parts[self._first]
        for parts in self._by_clock():
            own = parts[0].tick == torque.tick
            slow = [p for p in parts if own and p.role in slow_roles(self.chosen, self.stated)]
            needed = [p for p in parts if p not in slow]
            gone = _unknown([parts[0].time, *(p.values for p in needed)])
            for part in slow:
                self._set_apart(part, gone)
            here = left_out if own else LeftOut()
            here.add(gone.size, (self._fault(needed, row) for row in gone.tolist()))
            here.dates = next((p.column.name for p in parts if p.column.path in self.recording.dates), "")
            here.refuse_many(self.source.name, parts[0].time.size, allowed=self.drop_missing)
            if not own:
                left_out.add(here.rows, here.words)
            _leave_out(parts, gone)
            if parts[0].time.size < 2:
                name, count = parts[0].column.path, parts[0].time.size
                raise UnreadableLogError(
                    f"{self.source.name}: channel '{name}' has only {count} samples with a number"
                )

    def _set_apart(self, part: _Part, gone: IntArray) -> None:
        """Count the samples that lack only what may be slow, and keep the first of them in words."""
        rows = np.setdiff1d(_unknown([part.values]), gone, assume_unique=True)
        lacking = LeftOut()
        lacking.add(rows.size, (self._fault([part], row) for row in rows.tolist()))
        self._lacking[part.role] = lacking

    def _judged(
        self, judged: Callable[[list[_Part]], tuple[IntArray, tuple[Impossible, ...]]]
    ) -> tuple[tuple[Impossible, ...], int]:
        """Leave out samples that are judged to be no readings; what they were, and how many."""
        found: tuple[Impossible, ...] = ()
        rows = 0
        for parts in self._by_clock():
            gone, here = judged(parts)
            _leave_out(parts, gone)
            found, rows = (*found, *here), rows + gone.size
        return found, rows

    def _marked(self, parts: list[_Part]) -> tuple[IntArray, tuple[Impossible, ...]]:
        """Samples that the file itself marks as invalid."""
        judged = [(part, part.marked) for part in parts if part.marked is not None]
        if not judged:
            return np.empty(0, dtype=np.intp), ()
        clock = self._clocks[parts[0].tick][2]
        marks = [("time", Column(-1, clock.name, clock.unit), clock.unit, judged[0][1] == INVALID_TIME)]
        marks += [(part.role, part.column, part.unit.unit, marked == INVALID) for part, marked in judged]
        return marked_rows(marks, self.source.name, partial(self._where, parts[0]), allowed=self.drop_missing)

    def _impossible(self, parts: list[_Part]) -> tuple[IntArray, tuple[Impossible, ...]]:
        """Samples that cannot be right."""
        readings = [Reading(p.role, p.column, p.unit, p.values) for p in parts if p.role != "position"]
        if (clock := self._clocks[parts[0].tick][2]).name != NO_CLOCK:
            unit = role_conversion("time", clock.unit)[1]
            readings.insert(0, Reading("time", Column(-1, clock.name, clock.unit), unit, parts[0].time))
        return impossible_rows(
            readings, self.source.name, partial(self._where, parts[0]), allowed=self.drop_missing
        )

    def _where(self, part: _Part, row: int, column: Column) -> str:
        """A channel and one of its samples that are left, in words."""
        return f"channel '{column.path}', {self._place(part, row)}"

    def _fault(self, parts: list[_Part], row: int) -> str:
        """The channel of the first number of a sample that is missing, in words."""
        place = self._place(parts[0], row)
        bad = next((part for part in parts if not np.isfinite(part.values[row])), None)
        name = bad.column.path if bad else self._clocks[parts[0].tick][2].name
        return f"channel '{name}', {place}: the number is missing"

    def _check_time(self, part: _Part) -> None:
        file, name = self.source.name, part.column.path
        time = part.time
        back = rows_where(lambda rows: np.diff(time[rows.start : rows.stop + 1]) < 0, time.size - 1, time)
        if back.size:
            row = int(back[0])
            by = time[row] - time[row + 1]
            raise TimeOrderError(
                f"{file}, channel '{name}', sample {row + 2}: time runs backwards by {by:.6g} s",
                remedy="split the file there, or sort its rows",
                setting=Setting("time", "channel"),
            )

    def _spans(self) -> str:
        return ", ".join(f"{p.role} from {p.time[0]:.6g} to {p.time[-1]:.6g} s" for p in self.parts.values())


def _in_si(values: FloatArray, unit: Conversion) -> FloatArray:
    """Numbers as written in SI, a block at a time where they are many; the same array if nothing changes."""
    if values.size <= HELD:
        return in_si(values, unit)
    if unit.scale == 1.0 and unit.offset == 0.0 and np.isfinite(ends(values)).all():
        return values
    return each_block(lambda part: in_si(part, unit), values)


def _unknown(channels: list[FloatArray]) -> IntArray:
    """Samples in which a number is missing."""
    return rows_where(
        lambda rows: ~np.logical_and.reduce([np.isfinite(values[rows]) for values in channels]),
        channels[0].size,
        *channels,
    )


def _aligned(part: _Part, torque: _Part) -> Warning:
    """What was done to a channel with a clock of its own."""
    step, of_torque = (float(np.median(np.diff(p.time))) for p in (part, torque))
    longest = float(np.max(np.diff(part.time)))
    return Warning(
        "clocks aligned",
        (
            "{role} '{channel}' has its own clock ({rate}, torque {torque_rate}) and was interpolated "
            "linearly to the times of the torque (longest step {longest:.3g} s)"
        )
        + (
            "; it was recorded faster than the torque, so values in between were not used"
            if step < 0.75 * of_torque
            else ""
        ),
        role=part.role,
        channel=part.column.path,
        interval=step,
        torque_interval=of_torque,
        rate=_rate(step),
        torque_rate=_rate(of_torque),
        longest=longest,
    )


def _rate(step: float) -> str:
    return f"every {step:.3g} s" if step > 1 or step <= 0 else f"{1 / step:.4g} Hz"
