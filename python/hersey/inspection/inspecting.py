"""What a log holds, shown before a fit: clocks, channels and their faults, and what it can support."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypedDict, Unpack

import numpy as np

from hersey.arrays import FloatArray, refuse_unknown
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.doubtful import doubtful_order, doubtful_tare
from hersey.damping.dwells.misleading import in_words, misleading
from hersey.damping.dwells.reasons import LABELS
from hersey.errors import DROP_MISSING, ISOTHERMAL, HerseyError, InsufficientDataError, Setting, way_in
from hersey.inspection.clock import Clock, clock_of
from hersey.inspection.faults import DITHER, Fault, Traits, traits
from hersey.inspection.raw import Lacking, RawChannel, RawLog, raw_channels, roles_of
from hersey.inspection.support import Support, support_of_points
from hersey.log.channels import OTHER_ROLES, ROLES, ChannelChoice, Stated
from hersey.log.corrections import Corrected
from hersey.log.doubtful import doubtful_units
from hersey.log.mapping import LogMapping, as_stated, mapping_of, read_with_mapping, without_what_is_said
from hersey.log.means import MeansTable, read_means
from hersey.log.sensors import Sensors
from hersey.log.torque_log import NO_CLOCK, Correction, LogFile
from hersey.result import Means, Record, Result
from hersey.units import conversion, takes_si

if TYPE_CHECKING:
    import polars as pl

#: A step of a role's channel matters if it is this share of its small readings (their lowest tenth).
COARSE = 0.05
#: Share of the steps of a time that do not go back, even of one that was put together from parts.
_RUNS_ON = 0.9
_TIME_UNIT = re.compile(r"[munµμ]?s|sec(onds?)?|min(utes?)?|h(ours?)?|d(ays?)?")
_SPEED_NAME = re.compile(r"spe?e?d|velocity|rpm|drehzahl", re.IGNORECASE)
#: How a table of means is called.
MEANS = "a table of means"
#: More files than this are shown without the tables of their channels.
_TABLES = 3


class Reading(TypedDict, total=False):
    """How a log is read, each by its name: as `hersey.read_with_mapping` takes it."""

    mapping: LogMapping | str | Path | None
    channels: Mapping[str, str] | None
    units: Mapping[str, str] | None
    isothermal: bool
    signs: Mapping[str, int] | None
    drop_missing: bool
    every: float | None
    radius: float | Sequence[float] | None
    load: float | Sequence[float] | None


@dataclass(frozen=True)
class ChannelReport(Record):
    """One channel: its name, the role it plays (empty if none), its traits, and findings in words."""

    name: str
    unit: str
    role: str
    clock: str
    traits: Traits
    findings: tuple[str, ...]


@dataclass(frozen=True)
class FileReport(Record):
    """One file: clocks, channels, and for each role without a channel the reason."""

    also_stated = ("without",)
    not_stated = ("lacking",)

    name: str
    format: str
    rows: int
    clocks: tuple[Clock, ...]
    channels: tuple[ChannelReport, ...]
    lacking: Mapping[str, Lacking]
    notes: tuple[str, ...]
    cut_off: bool

    @property
    def without(self) -> dict[str, str]:
        """Why there is no channel, by role."""
        return {role: why.text for role, why in self.lacking.items()}


@dataclass(frozen=True, repr=False)
class Inspection(Result):
    """Logs as they came, and together as one log of torque if they can be read so.

    Attributes
    ----------
    files
        One report each.
    problem
        Why they cannot be read as a log of torque, or empty.
    needed
        Names of switches without which they could not: ``isothermal``, ``drop_missing``.
    dropped
        Rows left out because a number is missing or cannot be right, by file.
    corrections
        What the mapping had corrected.
    support
        Dwells and what they can tell, or None if the logs cannot be read.
    cautions
        Units, tare and order of the dwells where they are doubtful, as a fit says them too.
    """

    files: tuple[FileReport, ...]
    problem: str
    needed: tuple[str, ...]
    dropped: Annotated[Mapping[str, int], Means("rows left out, by file")]
    corrections: tuple[Correction, ...]
    support: Support | None
    cautions: Annotated[tuple[str, ...], Means("units, tare and order that are doubtful")] = ()

    def to_frame(self) -> pl.DataFrame:
        """Return one row per channel; its numbers in its own ``unit``."""
        import polars as pl

        numbers = ("low", "high", "median", "step", "noise")
        rows = [
            {
                "file": file.name,
                "channel": channel.name,
                "role": channel.role,
                "unit": channel.unit,
                "rows": channel.traits.rows,
                "missing rows": channel.traits.missing,
                **{f"{name} (own unit)": getattr(channel.traits, name) for name in numbers},
                "findings": "; ".join(channel.findings),
            }
            for file in self.files
            for channel in file.channels
        ]
        return pl.DataFrame(rows, infer_schema_length=None)

    def headline(self) -> str:
        """Return files, channels and dwells."""
        channels = sum(len(file.channels) for file in self.files)
        names = self.files[0].name if len(self.files) == 1 else f"{len(self.files)} files"
        dwells = "no fit is possible" if self.support is None else f"{self.support.dwells} dwells"
        return f"{names}, {channels} channels, {dwells}"

    def summary(self) -> str:
        """Return the inspection as text."""
        lines: list[str] = []
        for file in self.files:
            lines += [*_file_lines(file, table=len(self.files) <= _TABLES), ""]
        lines += [f"corrected: {correction}" for correction in self.corrections]
        lines += [
            f"{rows} rows of {name} are left out: a number is missing or cannot be right"
            for name, rows in self.dropped.items()
        ]
        if self.needed:
            lines.append(f"readable as a log of torque with {_switches(self.needed)}")
        lines += [f"! {caution}" for caution in self.cautions]
        if self.support is None:
            return "\n".join([*lines, f"No fit is possible: {self._hindrance()}"])
        lines.append(f"{self.support.dwells} dwells")
        lines += [f"  not used: {rows} rows, {LABELS[kind]}" for kind, rows in self.support.rejected.items()]
        lines += [f"  can tell    {said}" for said in self.support.can]
        lines += [f"  cannot tell {said}" for said in self.support.cannot]
        return "\n".join(lines)

    def _hindrance(self) -> str:
        """Why there can be no fit; a log without torque is told so first."""
        bare = [
            file.name
            for file in self.files
            if file.channels and "torque" in file.without and file.lacking["torque"].absent
        ]
        if not bare:
            return self.problem
        names = bare[0] if len(bare) == 1 else f"{bare[0]} and {len(bare) - 1} more"
        return (
            f"there is no torque channel in {names}. If a channel is torque, name it with "
            f"{Setting('torque', 'channel').to()}; if one is the motor's current, give its motor_constant in "
            "a mapping"
        )

    @property
    def findings(self) -> list[str]:
        """Every finding on a clock or on a channel that plays a role, behind its file."""
        said = []
        for file in self.files:
            said += [f"{file.name}: {finding}" for clock in file.clocks for finding in clock.findings()]
            said += [
                f"{file.name}: {channel.name}: {finding}"
                for channel in file.channels
                for finding in channel.findings
                if channel.role
            ]
        return said


@takes_si(min_dwell="time", every="time", radius="length", load="force")
def inspect(
    paths: str | Path | Sequence[str | Path],
    *,
    min_dwell: float = 2.0,
    tare: str = "none",
    rotation: str = "both",
    temperature_scale: str = "degC",
    means: bool = False,
    **reading: Unpack[Reading],
) -> Inspection:
    """Look at logs before a fit: also at such that cannot be fitted, or have no torque.

    Parameters
    ----------
    paths
        As for `hersey.read`.
    min_dwell, tare, rotation
        As for `TorqueLog.steady`.
    temperature_scale
        As for `hersey.fit`.
    means
        Whether the files are tables of means: one row per dwell, no clock.
    **reading
        Any of ``mapping``, ``channels``, ``units``, ``isothermal``, ``signs``, ``drop_missing``, ``every``,
        ``radius`` and ``load``, as for `hersey.read_with_mapping`.

    Raises
    ------
    HerseyError
        If a file holds no channels at all, or the mapping is wrong.

    Examples
    --------
    >>> inspect("examples/bench.csv").support.speeds
    10
    """
    refuse_unknown("inspect", reading, tuple(Reading.__annotations__))
    files = [paths] if isinstance(paths, str | Path) else list(paths)
    mapping, channels, units = reading.get("mapping"), reading.get("channels"), reading.get("units")
    signs, isothermal = reading.get("signs"), reading.get("isothermal", False)
    chosen = mapping if isinstance(mapping, LogMapping) else mapping_of(files, mapping)
    chosen = chosen.turned(signs or {})
    stated = Stated(reading.get("every"), as_stated(reading.get("radius")), as_stated(reading.get("load")))
    said = without_what_is_said(chosen, channels or {}, stated)
    choices = {
        role: ChannelChoice(
            (channels or {}).get(role) or said.channels.get(role, ""),
            (units or {}).get(role) or said.units.get(role, ""),
        )
        for role in (*ROLES, *OTHER_ROLES)
    }
    known = Stated(*(getattr(stated, f.name) or getattr(said.stated, f.name) for f in fields(Stated)))
    reports = tuple(file_report(raw_channels(file), choices, known) for file in files)
    if means:
        of_fit = rotation, temperature_scale
        return _of_means(files, reports, choices, isothermal, signs, known, chosen.sensors, of_fit)
    hopeless = any(set(report.without) - {"temperature"} for report in reports)
    holes = any(c.role and c.traits.missing for report in reports for c in report.channels)
    cold = any("temperature" in report.without for report in reports)
    read, needed, problem = _read(
        files,
        chosen,
        channels,
        units,
        isothermal=_tries(isothermal, cold and not hopeless),
        drop_missing=_tries(reading.get("drop_missing", False), holes and not hopeless),
        stated=stated,
    )
    if read is None:
        return Inspection(reports, problem, (), {}, (), None)
    reports = tuple(_with_notes(report, read.log.files) for report in reports)
    dropped = {file.name: file.missing_rows for file in read.log.files if file.missing_rows}
    log = read.log
    support, doubts = _supported(
        lambda: log.steady(min_dwell=min_dwell, tare=tare, rotation=rotation), temperature_scale
    )
    doubts = (*doubtful_units(log), *doubts)
    return Inspection(reports, "", needed, dropped, read.corrections, support, doubts)


def _supported(reduce: Callable[[], SteadyPoints], temperature_scale: str) -> tuple[Support, tuple[str, ...]]:
    """What dwells support, and what is doubtful of them; a log without a dwell supports nothing."""
    try:
        points = reduce()
    except InsufficientDataError as error:
        return Support(0, 0, None, (), {}, (), (str(error),)), ()
    notes = () if isinstance(points.log, MeansTable) else points.notes  # what a table lacks, support says
    structures = [in_words(found, points) for found in misleading(points)]
    doubts = (*doubtful_tare(points), *notes, *(str(each) for each in doubtful_order(points)), *structures)
    return support_of_points(points, temperature_scale=temperature_scale), doubts


def _of_means(
    files: Sequence[str | Path],
    reports: tuple[FileReport, ...],
    choices: dict[str, ChannelChoice],
    isothermal: bool,
    signs: Mapping[str, int] | None,
    known: Stated,
    sensors: Sensors,
    of_fit: tuple[str, str],
) -> Inspection:
    """What a table of means holds: it needs no clock; ``of_fit`` are rotation and temperature scale."""
    rotation, temperature_scale = of_fit
    reports = tuple(
        replace(
            report,
            format=f"{report.format}, {MEANS}",
            lacking={},
        )
        for report in reports
    )
    stated = {role: choice for role, choice in choices.items() if role != "time"}
    try:
        table = read_means(
            files,
            channels={role: choice.name for role, choice in stated.items() if choice.name},
            units={role: choice.unit for role, choice in stated.items() if choice.unit},
            isothermal=isothermal,
            radius=known.radius,
            load=known.load,
            signs=signs,
        )
    except HerseyError as error:
        return Inspection(reports, str(error), (), {}, (), None)
    dropped = {file.name: file.missing_rows for file in table.files if file.missing_rows}
    reports = tuple(_with_notes(report, table.files) for report in reports)
    table = replace(table, sensors=sensors)
    support, doubts = _supported(lambda: SteadyPoints.from_table(table, rotation=rotation), temperature_scale)
    return Inspection(reports, "", (), dropped, (), support, (*doubtful_units(table), *doubts))


def _with_notes(report: FileReport, files: Sequence[LogFile]) -> FileReport:
    """The report of a file with what was done to read it as a log: rows left out, above all."""
    told = [note for file in files if file.name.partition(", run ")[0] == report.name for note in file.notes]
    return replace(report, notes=(*report.notes, *(note for note in told if note not in report.notes)))


def _read(
    files: Sequence[str | Path],
    mapping: LogMapping,
    channels: Mapping[str, str] | None,
    units: Mapping[str, str] | None,
    *,
    isothermal: Sequence[bool],
    drop_missing: Sequence[bool],
    stated: Stated,
) -> tuple[Corrected | None, tuple[str, ...], str]:
    """The log, the switches it needed beside those given (first in each list), or why it cannot be read."""
    problem = ""
    for cold, drop in itertools.product(isothermal, drop_missing):
        try:
            log = read_with_mapping(
                files,
                mapping=mapping,
                channels=channels,
                units=units,
                isothermal=cold,
                drop_missing=drop,
                **vars(stated),
            )
        except HerseyError as error:
            problem = problem or str(error)
            continue
        switches = {ISOTHERMAL.name: cold != isothermal[0], DROP_MISSING.name: drop != drop_missing[0]}
        return log, tuple(name for name, used in switches.items() if used), ""
    return None, (), problem


def _switches(names: tuple[str, ...]) -> str:
    """Switches as they are set."""
    joint = " " if way_in() == "terminal" else " and "
    return joint.join(Setting(name, "switch").to() for name in names)


def _tries(given: bool, helps: bool) -> tuple[bool, ...]:
    """A flag as given, and set where that may help."""
    return (False, True) if helps and not given else (given,)


@np.errstate(all="ignore")  # numbers of a damaged file may be beyond all bounds: they are shown
def file_report(log: RawLog, choices: dict[str, ChannelChoice], stated: Stated) -> FileReport:
    """Return what one file holds: clocks, channels with their roles and faults, roles without a channel."""
    columns, without = roles_of(log, choices, stated)
    role_of = {column.index: role for role, column in columns.items()}
    clocks, clock_names = _clocks(log, role_of, choices, stated)
    channels = []
    for channel in log.channels:
        role = role_of.get(channel.column.index, "")
        channel_traits = traits(channel.values, stands=role in ("torque", "speed") or _is_speed(channel))
        findings = _findings(channel, channel_traits, role) if role != "time" else ()
        name = clock_names.get(channel.tick, "")
        channels.append(
            ChannelReport(channel.column.path, channel.column.unit, role, name, channel_traits, findings)
        )
    rows = max((channel.values.size for channel in log.channels), default=0)
    return FileReport(log.name, log.format, rows, clocks, tuple(channels), without, log.notes, log.cut_off)


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
        time = next((c for c in beside if role_of.get(c.column.index) == "time"), None)
        time = time or next((c for c in beside if _is_time(c)), None)
        if time is not None:
            unit = choices["time"].unit or time.column.unit
            seconds = conversion("time", unit).scale * time.values
            clocks[channel.tick] = clock_of(time.column.path, seconds)
    return tuple(clocks.values()), {tick: clock.name for tick, clock in clocks.items()}


def _is_time(channel: RawChannel) -> bool:
    """Whether a channel counts a time that runs on."""
    return bool(_TIME_UNIT.fullmatch(channel.column.unit)) and _runs_on(channel.values)


def _is_speed(channel: RawChannel) -> bool:
    if _SPEED_NAME.search(channel.column.name):
        return True
    try:
        return bool(channel.column.unit and conversion("speed", channel.column.unit))
    except HerseyError:
        return False


def _runs_on(values: FloatArray) -> bool:
    return values.size > 1 and float(np.nanmean(np.diff(values) >= 0)) > _RUNS_ON


def _findings(channel: RawChannel, channel_traits: Traits, role: str) -> tuple[str, ...]:
    steady = "constant" if role in OTHER_ROLES else ""  # a load, or a radius, may stay what it is
    faults = [fault for fault in channel_traits.faults if fault.kind != steady]
    said = [_in_words(fault, channel_traits, channel.column.unit, role) for fault in faults]
    if channel.odd:
        said.append(f"{channel.odd} cells hold no number")
    if channel_traits.missing > channel.odd:
        said.append(f"{channel_traits.missing - channel.odd} rows lack a number")
    if channel_traits.refresh > 1:
        said.append(
            f"each value is held for {channel_traits.refresh} rows: the sensor is slower than the log"
        )
    if role in ("torque", "speed"):
        said += _coarse(channel.values, channel_traits, channel.column.unit)
    return tuple(said)


def _in_words(fault: Fault, channel_traits: Traits, unit: str, role: str) -> str:
    value = f"{fault.value:.6g} {unit}".strip()
    at = f"from row {fault.first + 1}" if fault.places == 1 else f"at {fault.places} places"
    rows = f"{fault.rows} row{'s' if fault.rows > 1 else ''} ({fault.rows / channel_traits.rows:.2g} of all)"
    if fault.kind == "constant":
        return f"{value} throughout: a dead channel, or nothing changed"
    if fault.kind == "stuck":
        what = "the sensor is stuck" if role else "held"
        return f"{what} at {value} for {rows} {at}" if fault.places == 1 else f"{what} for {rows} {at}"
    if fault.kind == "spikes":
        return f"spikes in {rows} {at}, as far as {value}"
    if fault.kind == "drop-outs":
        return f"drops out to 0 in {rows} {at}"
    return f"{fault.kind} at {value}: {rows} {at}"


def _coarse(values: FloatArray, channel_traits: Traits, unit: str) -> list[str]:
    """A step that the noise does not blur and that is large beside the small readings."""
    size = np.abs(values[np.isfinite(values) & (values != 0.0)])
    if (
        channel_traits.step is None
        or not size.size
        or (channel_traits.noise or 0.0) > DITHER * channel_traits.step
    ):
        return []
    small = float(np.quantile(size, 0.1))
    if channel_traits.step < COARSE * small:
        return []
    return [
        f"coarse: its step of {channel_traits.step:.3g} {unit} is {channel_traits.step / small:.0%} "
        "of its small readings"
    ]


#: Width of a name in the table, and findings of other channels shown at the most.
_WIDTH, _SHOWN = 26, 30


def _file_lines(file: FileReport, *, table: bool) -> list[str]:
    """A file as a table of its channels, then what was found."""
    lines = [f"{file.name}: {file.format}, {file.rows} rows{', cut off' if file.cut_off else ''}"]
    for clock in file.clocks:
        lines.append(
            f"  clock '{clock.name}': every {clock.interval:.4g} s ({_rate(clock.interval)}), "
            f"{clock.duration:.5g} s in all"
        )
        lines += [f"  ! {finding}" for finding in clock.findings()]
    if not file.clocks and MEANS not in file.format:
        named = Setting("time", "channel").to()
        lines.append(f"  ! no channel is a clock: rates and gaps are not known; name it with {named}")
    lines += _table(file) if table else []
    findings = [(c, finding) for c in file.channels for finding in c.findings]
    findings.sort(key=lambda pair: not pair[0].role)
    lines += [f"  {'!' if c.role else '-'} {c.name}: {finding}" for c, finding in findings[:_SHOWN]]
    if len(findings) > _SHOWN:
        has_them = "--json has them" if way_in() == "terminal" else "files has them"
        lines.append(f"  - and {len(findings) - _SHOWN} more ({has_them})")
    lines += [f"  ! {role}: {why}" for role, why in file.without.items()]
    lines += [f"  - {note}" for note in file.notes]
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
