"""One file before it is read as a log: clocks, channels with roles and faults, roles without a channel."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import Setting, way_in
from hersey.inspection.faults import DITHER, Fault, Traits, traits
from hersey.inspection.raw import Lacking, RawChannel, RawLog, roles_of
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.clock import Clock, clock_of
from hersey.log.roles import OTHER_ROLES, is_of_kind
from hersey.log.torque_log import NO_CLOCK
from hersey.result import Means, Record
from hersey.schema.warning import Warning
from hersey.units import conversion

#: A step of a role's channel matters if it is this share of its small readings (their lowest tenth).
COARSE = 0.05
#: Share of the steps of a time that do not go back, even of one that was put together from parts.
_RUNS_ON = 0.9
_TIME_UNIT = re.compile(r"[munµμ]?s|sec(onds?)?|min(utes?)?|h(ours?)?|d(ays?)?")
_SPEED_NAME = re.compile(r"spe?e?d|velocity|rpm|drehzahl|geschw|vitesse|velocid|速|回転数", re.IGNORECASE)
#: How a table of means is called.
MEANS = "a table of means"


@dataclass(frozen=True)
class ChannelReport(Record):
    """One channel: its name, the role it plays (empty if none), its traits, and what is wrong with it."""

    name: str
    unit: str
    role: str
    clock: str
    traits: Traits
    warnings: tuple[Warning, ...]


@dataclass(frozen=True)
class FileReport(Record):
    """One file: clocks, channels, and for each role without a channel the reason."""

    also_stated = ("without",)
    not_stated = ("lacking",)

    name: str
    format: str
    rows: int
    clocks: Annotated[tuple[Clock, ...], Means("each clock of the file once; empty if it has none")]
    channels: Annotated[tuple[ChannelReport, ...], Means("every channel, used or not")]
    lacking: Mapping[str, Lacking]
    warnings: tuple[Warning, ...]
    cut_off: bool

    @property
    def without(self) -> dict[str, str]:
        """Why there is no channel, by role."""
        return {role: why.text for role, why in self.lacking.items()}

    @property
    def temperature_unread(self) -> bool:
        """Whether there is a temperature, but no column that can be taken for it."""
        return "temperature" in self.lacking and not self.lacking["temperature"].absent


@np.errstate(all="ignore")  # numbers of a damaged file may be beyond all bounds: they are shown
def file_report(log: RawLog, choices: dict[str, ChannelChoice], stated: Stated) -> FileReport:
    """Return what one file holds: clocks, channels with their roles and faults, roles without a channel."""
    columns, without = roles_of(log, choices, stated)
    role_of = {column.index: role for role, column in columns.items()}
    clocks, clock_names = _clocks(log, role_of, choices, stated)
    channels = []
    for channel in log.channels:
        column, clock = channel.column, clock_names.get(channel.tick, "")
        role = role_of.get(column.index, "")
        shown = traits(channel.values, stands=role in ("torque", "speed") or _is_speed(channel))
        warnings = _warnings(channel, shown, role) if role != "time" else ()
        channels.append(ChannelReport(column.path, column.unit, role, clock, shown, warnings))
    rows = max((channel.values.size for channel in log.channels), default=0)
    return FileReport(log.name, log.format, rows, clocks, tuple(channels), without, log.warnings, log.cut_off)


def _clocks(
    log: RawLog, role_of: dict[int, str], choices: dict[str, ChannelChoice], stated: Stated
) -> tuple[tuple[Clock, ...], dict[str, str]]:
    """Each clock of the file once, and its name by tick."""
    clocks: dict[str, Clock] = {}
    by_tick: dict[str, list[RawChannel]] = {}
    for channel in log.channels:
        by_tick.setdefault(channel.tick, []).append(channel)
    for beside in by_tick.values():
        channel = beside[0]
        if stated.every is not None:
            seconds = np.arange(channel.values.size, dtype=float) * stated.every
            clocks[channel.tick] = clock_of(NO_CLOCK, seconds)
            continue
        if channel.clock is not None:
            clocks[channel.tick] = clock_of(f"of {channel.column.path}", channel.clock)
            continue
        of_role = [c for c in beside if role_of.get(c.column.index) == "time"]
        if time := next(iter([*of_role, *filter(_is_time, beside)]), None):
            unit = choices["time"].unit or time.column.unit
            seconds = conversion("time", unit).scale * time.values
            clocks[channel.tick] = clock_of(time.column.path, seconds)
    return tuple(clocks.values()), {tick: clock.name for tick, clock in clocks.items()}


def _is_time(channel: RawChannel) -> bool:
    """Whether a channel counts a time that runs on."""
    steps = np.diff(channel.values) if _TIME_UNIT.fullmatch(channel.column.unit) else np.empty(0)
    return steps.size > 0 and float(np.mean(steps >= 0)) > _RUNS_ON


def _is_speed(channel: RawChannel) -> bool:
    return bool(_SPEED_NAME.search(channel.column.name)) or is_of_kind("speed", channel.column.unit)


def _warnings(channel: RawChannel, channel_traits: Traits, role: str) -> tuple[Warning, ...]:
    steady = "constant" if role in OTHER_ROLES else ""  # a load, or a radius, may stay what it is
    faults = [fault for fault in channel_traits.faults if fault.kind != steady]
    found = [_of_fault(fault, channel_traits, channel.column.unit, role) for fault in faults]
    if channel.odd:
        found.append(
            Warning(
                "cells that are no numbers",
                "{cells} {cells:cell contains|cells contain} no number",
                severity="watch",
                cells=channel.odd,
            )
        )
    if (lacking := channel_traits.missing - channel.odd) > 0:
        found.append(
            Warning(
                "numbers missing",
                "a number is missing in {rows} {rows:row|rows}",
                severity="watch",
                rows=lacking,
            )
        )
    if channel_traits.refresh > 1:
        found.append(
            Warning(
                "sensor slower than the log",
                "each value repeats for {rows} rows, so the sensor is slower than the log",
                rows=channel_traits.refresh,
            )
        )
    if role in ("torque", "speed"):
        found += _coarse(channel.values, channel_traits, channel.column.unit)
    return tuple(found)


def _of_fault(fault: Fault, channel_traits: Traits, unit: str, role: str) -> Warning:
    """A fault with its rows; its value is in the unit of the channel."""
    numbers: dict[str, Any] = {
        "severity": "watch" if role else "note",
        "reading": f"{fault.value:.6g} {unit}".strip(),
        "place": f"from row {fault.first + 1}" if fault.places == 1 else f"at {fault.places} places",
        "value": fault.value,
        "unit": unit,
        "rows": fault.rows,
        "share": fault.rows / channel_traits.rows,
        "row": fault.first + 1,
        "places": fault.places,
    }
    match fault.kind:
        case "constant":
            return Warning(
                fault.kind, "reads {reading} throughout: the channel is dead, or nothing changed", **numbers
            )
        case "stuck":
            return Warning(
                fault.kind,
                ("the sensor is stuck" if role else "held")
                + (" at {reading}" if fault.places == 1 else "")
                + " for {rows} {rows:row|rows} ({share:.2g %}) {place}",
                **numbers,
            )
        case "spikes":
            return Warning(
                fault.kind,
                "spikes of up to {reading} in {rows} {rows:row|rows} ({share:.2g %}) {place}",
                **numbers,
            )
        case "drop-outs":
            return Warning(
                fault.kind, "drops to 0 in {rows} {rows:row|rows} ({share:.2g %}) {place}", **numbers
            )
    return Warning(
        fault.kind,
        "{fault} at {reading} in {rows} {rows:row|rows} ({share:.2g %}) {place}",
        remedy="record again with a wider measuring range" if role else "",
        fault=fault.kind,
        **numbers,
    )


def _coarse(values: FloatArray, channel_traits: Traits, unit: str) -> list[Warning]:
    """A step that the noise does not blur and that is large beside the small readings."""
    size = np.abs(values[np.isfinite(values) & (values != 0.0)])
    step = channel_traits.step
    if step is None or not size.size or (channel_traits.noise or 0.0) > DITHER * step:
        return []
    small = float(np.quantile(size, 0.1))
    if step < COARSE * small:
        return []
    return [
        Warning(
            "coarse",
            "its resolution, {step:.3g} {unit}, is {share:.0f %} of its small readings",
            severity="watch",
            step=step,
            unit=unit,
            share=step / small,
        )
    ]


#: Width of a name in the table, and warnings of channels shown at the most.
_WIDTH, _SHOWN = 26, 30


def file_lines(file: FileReport, *, table: bool) -> list[str]:
    """Return a file as a table of its channels, then what was found."""
    lines = [f"{file.name}: {file.format}, {file.rows} rows{', cut off' if file.cut_off else ''}"]
    for clock in file.clocks:
        lines.append(
            f"  clock '{clock.name}': every {clock.interval:.4g} s ({_rate(clock.interval)}), "
            f"{clock.duration:.5g} s in total"
        )
        lines += [f"  ! {warning}" for warning in clock.warnings]
    no_time = "time" not in file.lacking or file.lacking["time"].absent
    if not file.clocks and no_time and MEANS not in file.format:
        named = Setting("time", "channel").to()
        lines.append(f"  ! no time column found, so rates and gaps are unknown. Name it with {named}")
    lines += _table(file) if table else []
    channels = sorted(file.channels, key=lambda channel: not channel.role)
    warnings = [(c, warning.within(c.name)) for c in channels for warning in c.warnings]
    lines += [f"  {'!' if c.role else '-'} {warning}" for c, warning in warnings[:_SHOWN]]
    if len(warnings) > _SHOWN:
        has_them = "--json has them" if way_in() == "terminal" else "files has them"
        lines.append(f"  - and {len(warnings) - _SHOWN} more ({has_them})")
    lines += [f"  ! {role}: {why}" for role, why in file.without.items()]
    lines += [f"  - {warning}" for warning in file.warnings]
    return lines


def _table(file: FileReport) -> list[str]:
    lines = [f"  {'channel':{_WIDTH}} {'role':12} {'from':>10} {'to':>10} {'step':>9} {'noise':>9} unit"]
    for channel in file.channels:
        t = channel.traits
        noise = None if channel.role == "time" else t.noise
        numbers = f"{_short(t.low):>10} {_short(t.high):>10} {_short(t.step):>9} {_short(noise):>9}"
        lines.append(
            f"  {_end(channel.name):{_WIDTH}} {channel.role or '-':12} {numbers} {channel.unit or '?'}"
        )
    return lines


def _end(name: str) -> str:
    """The end of a long name, where channels of one group differ."""
    return name if len(name) <= _WIDTH else "…" + name[1 - _WIDTH :]


def _short(value: float | None) -> str:
    return "-" if value is None or not np.isfinite(value) else f"{value:.4g}"


def _rate(interval: float) -> str:
    return "no rate" if interval <= 0 else f"{1.0 / interval:.4g} Hz"
