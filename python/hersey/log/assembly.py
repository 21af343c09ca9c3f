"""From a recording to a run: roles, SI units, and one clock, that of the torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, UnreadableLogError
from hersey.log.channels import ROLES, ChannelChoice, find_channel, no_channel
from hersey.log.recording import Recording, Signal
from hersey.log.text.layout import Column
from hersey.log.text.stamps import counted_since, is_clock_name
from hersey.log.torque_log import LARGEST, Channel, LogFile, Run
from hersey.units import Conversion


@dataclass
class _Part:
    """A channel in its role: numbers as written, NaN where one is missing, and the time of each in s."""

    role: str
    column: Column
    unit: Conversion
    values: FloatArray
    time: FloatArray
    tick: str


class Assembly:
    """The channels of one recording that play a role, loaded while its file is open.

    Raises
    ------
    ChannelError, UnitError
        If a role has no channel, several, or one without a unit; the message lists what the file holds.
    UnreadableLogError
        If the numbers of a channel cannot be read.
    """

    def __init__(self, recording: Recording, choices: dict[str, ChannelChoice], *, isothermal: bool) -> None:
        self.recording, self.source = recording, recording.source
        if isothermal and choices["temperature"] != ChannelChoice():
            raise ChannelError("--isothermal leaves temperature out: give no --temperature beside it")
        if not recording.signals:
            raise nothing_to_read(recording)
        self.columns = columns(recording)
        self._clocks: dict[str, tuple[FloatArray, str, Channel]] = {}
        self.parts = {"torque": self._part("torque", choices, None)}
        torque = self.parts["torque"].column
        for role in ("speed",) if isothermal else ("speed", "temperature"):
            self.parts[role] = self._part(role, choices, torque)

    def run(self, *, drop_missing: bool) -> tuple[Run, LogFile]:
        """Return the run on the clock of the torque, and what was done to get there.

        Raises
        ------
        UnreadableLogError
            If numbers are missing, a clock runs backwards, or the channels do not overlap.
        """
        file, notes = self.source.name, list(self.recording.notes)
        missing = self._refuse_or_drop_missing(drop_missing)
        torque = self.parts["torque"]
        kept = np.ones(torque.time.size, dtype=bool)
        for part in self.parts.values():
            if part.tick != torque.tick:
                kept &= (torque.time >= part.time[0]) & (torque.time <= part.time[-1])
        if kept.sum() < 2:
            raise UnreadableLogError(
                f"{file}: {self._spans()}: they share fewer than two samples of the torque"
            )
        time = torque.time[kept]
        if time[-1] == time[0]:
            raise UnreadableLogError(f"{file}: all rows carry the same time")
        arrays = {}
        for role, part in self.parts.items():
            values = part.values * part.unit.scale + part.unit.offset
            if part.tick == torque.tick:
                arrays[role] = values[kept]
            else:
                arrays[role] = np.interp(time, part.time, values)
                notes.append(_aligned(part, torque))
        if not kept.all():
            notes.append(
                f"{int((~kept).sum())} of {kept.size} samples of the torque lie outside the time of another "
                f"channel and were left out ({self._spans()})"
            )
        run = Run(file, time, arrays["torque"], arrays["speed"], arrays.get("temperature"))
        clock = self._clocks[self.parts["torque"].tick][2]
        used = {"time": clock} | {
            p.role: Channel(p.role, p.column.path, p.unit.unit) for p in self.parts.values()
        }
        log = LogFile(
            file,
            self.source.sha256,
            self.source.bytes,
            time.size,
            missing,
            tuple(used[role] for role in ROLES if role in used),
            self.recording.comments,
            self.recording.cut_off,
            tuple(notes),
        )
        return run, log

    def _part(self, role: str, choices: dict[str, ChannelChoice], torque: Column | None) -> _Part:
        file = self.source.name
        channel = None
        if torque is not None and not choices[role].name:  # the part of the file that holds the torque first
            beside = tuple(c for c in self.columns if c.group == torque.group and c != torque)
            channel = find_channel(role, beside, choices[role], file)
        if channel is None:
            channel = find_channel(role, self.columns, choices[role], file)
        if channel is None:
            error = no_channel(role, self.columns, file)
            if role == "temperature":
                error.args = (*error.args, "or say --isothermal to leave temperature out")
            raise error
        column, unit = channel
        for other in getattr(self, "parts", {}).values():
            if other.column == column:
                raise ChannelError(f"{file}: column '{column}' cannot be both {other.role} and {role}")
        signal = self.recording.signals[column.index]
        time, tick, _ = self._clock(signal, column, choices["time"])
        values = signal.load()
        if values.size != time.size:
            raise UnreadableLogError(
                f"{file}: channel '{column.path}' has {values.size} values and its clock {time.size}: "
                "the file is damaged or cut off"
            )
        with np.errstate(over="ignore", invalid="ignore"):
            largest = np.abs(values * unit.scale + unit.offset) > LARGEST
        if np.any(largest & np.isfinite(values)):
            row = int(np.argmax(largest & np.isfinite(values)))
            raise UnreadableLogError(
                f"{file}, channel '{column.path}', sample {row + 1}: {values[row]:g} {unit.unit} is no {role}"
            )
        return _Part(role, column, unit, np.where(np.isfinite(values), values, np.nan), time, tick)

    def _clock(
        self, signal: Signal, column: Column, choice: ChannelChoice
    ) -> tuple[FloatArray, str, Channel]:
        """Time of each sample in s, the name of the clock, and the channel it came from."""
        if signal.clock is not None and not choice.name:
            if signal.tick not in self._clocks:
                self._clocks[signal.tick] = (signal.clock(), signal.tick, Channel("time", "clock", "s"))
            return self._clocks[signal.tick]
        file = self.source.name
        beside = tuple(
            self._with_epoch(c)
            for c in self.columns
            if c != column and self._may_time(c, signal, column, bool(choice.name))
        )
        clock = find_channel("time", beside, choice, file) if beside or choice.name else None
        if clock is None:
            raise ChannelError(
                f"{file}: no time channel with {signal.rows} samples stands beside '{column}' among "
                f"{', '.join(repr(str(c)) for c in self.columns[:40])}: name it with --time"
            )
        chosen, unit = clock
        tick = f"column {chosen.index}"
        if tick not in self._clocks:
            with np.errstate(over="ignore", invalid="ignore"):
                values = self.recording.signals[chosen.index].load() * unit.scale + unit.offset
            self._clocks[tick] = (values, tick, Channel("time", chosen.path, unit.unit))
        return self._clocks[tick]

    def _may_time(self, candidate: Column, signal: Signal, column: Column, named: bool) -> bool:
        other = self.recording.signals[candidate.index]
        return other.rows == signal.rows and (named or candidate.group == column.group)

    def _with_epoch(self, column: Column) -> Column:
        if column.unit or not is_clock_name(column.name):
            return column
        signal = self.recording.signals[column.index]
        unit, meaning = counted_since(column.name, signal.load())
        if unit:
            note = f"'{column.path}' has no unit and was read as {meaning}"
            if note not in self.recording.notes:
                self.recording.notes.append(note)
        return Column(column.index, column.name, unit, column.group)

    def _refuse_or_drop_missing(self, drop_missing: bool) -> int:
        """Leave out samples without a number or a time, the same ones of every channel on one clock."""
        dropped = 0
        for tick in dict.fromkeys(part.tick for part in self.parts.values()):
            parts = [part for part in self.parts.values() if part.tick == tick]
            gone = ~np.logical_and.reduce([np.isfinite(p.values) & np.isfinite(p.time) for p in parts])
            if gone.any() and not drop_missing:
                row = int(np.argmax(gone))
                part = next((p for p in parts if not np.isfinite(p.values[row])), None)
                name = part.column.path if part else self._clocks[tick][2].name
                raise UnreadableLogError(
                    f"{self.source.name}, channel '{name}', sample {row + 1}: no number stands where one "
                    "is needed; mend the file, or say --drop-missing to leave such rows out and count them"
                )
            dropped += int(gone.sum())
            for part in parts:
                part.values, part.time = part.values[~gone], part.time[~gone]
            self._check_time(parts[0])
        return dropped

    def _check_time(self, part: _Part) -> None:
        file, name = self.source.name, part.column.path
        if part.time.size < 2:
            raise UnreadableLogError(f"{file}: channel '{name}' has {part.time.size} samples with a number")
        steps = np.diff(part.time)
        if (steps < 0).any():
            row = int(np.argmax(steps < 0))
            raise UnreadableLogError(
                f"{file}, channel '{name}', sample {row + 2}: time runs backwards by {-steps[row]:.6g} s; "
                "split the file there, or sort its rows"
            )
        if np.abs(part.time).max() > LARGEST:
            raise UnreadableLogError(f"{file}: {np.abs(part.time).max():g} s is no time of channel '{name}'")

    def _spans(self) -> str:
        return ", ".join(f"{p.role} from {p.time[0]:.6g} to {p.time[-1]:.6g} s" for p in self.parts.values())


def columns(recording: Recording) -> tuple[Column, ...]:
    """Return the channels of a recording as columns to choose from."""
    return tuple(
        Column(index, signal.name, signal.unit, signal.group)
        for index, signal in enumerate(recording.signals)
    )


def nothing_to_read(recording: Recording) -> ChannelError:
    """Return the error for a recording without a channel of numbers."""
    file = recording.source.name
    if recording.nothing:
        return ChannelError(f"{file}: {recording.nothing}")
    others = ", ".join(recording.others[:40])[:1000] or "nothing"
    return ChannelError(f"{file} holds no channel of numbers, only {others}")


def _aligned(part: _Part, torque: _Part) -> str:
    """What was done to a channel with a clock of its own."""
    step, of_torque = (float(np.median(np.diff(p.time))) for p in (part, torque))
    longest = float(np.max(np.diff(part.time)))
    faster = "; it was recorded faster, values between were passed over" if step < 0.75 * of_torque else ""
    return (
        f"{part.role} '{part.column.path}' has a clock of its own ({_rate(step)}, "
        f"torque {_rate(of_torque)}): "
        f"interpolated linearly onto the torque's, over {longest:.3g} s at the most{faster}"
    )


def _rate(step: float) -> str:
    return f"every {step:.3g} s" if step > 1 or step <= 0 else f"{1 / step:.4g} Hz"
