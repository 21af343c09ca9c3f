"""What a log holds, shown before a fit: clocks, channels and their faults, and what it can support."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypedDict, Unpack, cast

from hersey.arguments.door import Words
from hersey.arrays import refuse_unknown
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.doubtful import doubtful_order, doubtful_tare
from hersey.damping.dwells.misleading import misleading
from hersey.damping.dwells.reasons import label_of
from hersey.errors import (
    DROP_MISSING,
    ISOTHERMAL,
    HerseyError,
    InsufficientDataError,
    Setting,
    followed_by,
    way_in,
)
from hersey.inspection.file_report import MEANS, FileReport, file_lines, file_report
from hersey.inspection.raw import raw_channels
from hersey.inspection.support import Support, support_of_points
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.corrections import Corrected
from hersey.log.derived.sources import Sources
from hersey.log.doubtful import doubtful_units
from hersey.log.layouts.current import reading_by
from hersey.log.layouts.proposing import Proposal, proposed_layout
from hersey.log.layouts.recognized import recognized
from hersey.log.mapping import (
    LogMapping,
    Motor,
    as_stated,
    mapping_of,
    read_with_mapping,
    without_what_is_said,
)
from hersey.log.mean_refusals import refuse_corrections, refuse_sources
from hersey.log.means import MeansTable, read_means
from hersey.log.roles import CHANNELS, OTHER_ROLES, ROLES, SIGNS, UNITS
from hersey.log.torque_log import ROTATIONS, TARES, Correction, LogFile, TorqueLog
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Name of a column without one.
_NUMBERED = re.compile(r"#[0-9]+")
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
    name_pattern: str | None
    name_decimal: str | None
    run_table: str | Path | None
    schedule: Any
    position_window: float | None
    torque_constant: float | None
    gear_ratio: float | None
    speed_gear_ratio: float | None
    inertia: float | None


@dataclass(frozen=True, repr=False)
class Inspection(Result):
    """Logs as they came, and together as one log of torque if they can be read so.

    Attributes
    ----------
    files
        One report each.
    problem
        Why they cannot be read as a torque log; may be empty.
    needed
        Switches needed to read them: ``isothermal``, ``drop_missing``.
    dropped
        Rows excluded because a number is missing or impossible, by file.
    corrections
        Corrections made by the mapping.
    support
        Dwells and what can be determined from them, or None if the logs cannot be read.
    warnings
        Doubtful units, tare and order of the dwells; a fit gives the same warnings.
    """

    files: tuple[FileReport, ...]
    problem: str
    needed: tuple[str, ...]
    dropped: Annotated[Mapping[str, int], Means("rows excluded, by file")]
    corrections: tuple[Correction, ...]
    support: Support | None
    warnings: Annotated[tuple[Warning, ...], Means("doubtful units, tare and order of the dwells")] = ()

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
                "warnings": "; ".join(map(str, channel.warnings)),
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
            lines += [*file_lines(file, table=len(self.files) <= _TABLES), ""]
        lines += [f"corrected: {correction}" for correction in self.corrections]
        lines += [
            f"{rows} {'row' if rows == 1 else 'rows'} of {name} {'is' if rows == 1 else 'are'} excluded, "
            "because a number is missing or impossible"
            for name, rows in self.dropped.items()
        ]
        if self.advised:
            lines.append(f"this log can be read with {_switches(self.advised)}")
        lines += [f"! {warning.sentence}" for warning in self.warnings]
        if self.support is None:
            return "\n".join([*lines, f"No fit is possible: {self._hindrance()}"])
        lines.append(f"{self.support.dwells} dwells")
        of = self.support.domain
        lines += [
            f"  excluded: {rows} rows, {label_of(kind, of)}" for kind, rows in self.support.rejected.items()
        ]
        lines += [f"  can determine     {said}" for said in self.support.can]
        lines += [f"  cannot determine  {said}" for said in self.support.cannot]
        return "\n".join(lines)

    @property
    def advised(self) -> tuple[str, ...]:
        """The switches to advise: a temperature that was recorded is mended rather than excluded."""
        unread = any(file.temperature_unread for file in self.files)
        return tuple(each for each in self.needed if not (unread and each == ISOTHERMAL.name))

    def _hindrance(self) -> str:
        """Why there can be no fit; that a log has no torque comes first."""
        bare = [
            file
            for file in self.files
            if file.channels
            and "torque" in file.without
            and file.lacking["torque"].absent
            and not _has_a_speed(file)  # else the problem says all that is open
            and not all(_NUMBERED.fullmatch(channel.name) for channel in file.channels)
        ]
        if not bare:
            return self.problem
        names = bare[0].name if len(bare) == 1 else f"{bare[0].name} and {len(bare) - 1} more"
        return followed_by(f"{names} has no torque channel", bare[0].lacking["torque"].remedy)

    @property
    def channel_warnings(self) -> tuple[Warning, ...]:
        """Every warning of a clock or of a channel with a role, with its file."""
        found: list[Warning] = []
        for file in self.files:
            found += [each.within(file.name) for clock in file.clocks for each in clock.warnings]
            found += [
                each.within(channel.name).within(file.name)
                for channel in file.channels
                for each in channel.warnings
                if channel.role
            ]
        return tuple(found)


def _has_a_speed(file: FileReport) -> bool:
    """Whether a file that lacks other roles has a column of the speed."""
    return len(file.lacking) > 1 and not ("speed" in file.lacking and file.lacking["speed"].absent)


@takes_si(
    min_dwell="time",
    every="time",
    radius="length",
    load="force",
    torque_constant="motor constant",
    inertia="moment of inertia",
    position_window="time",
    tare=TARES,
    rotation=ROTATIONS,
    temperature_scale=Words(("degC", "K")),
    channels=CHANNELS,
    units=UNITS,
    signs=SIGNS,
)
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
    """Inspect logs before a fit, even if they cannot be fitted or have no torque.

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
        How to read the logs, as for `hersey.read_with_mapping`.

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
    mapping = reading.get("mapping")
    chosen = mapping if isinstance(mapping, LogMapping) else mapping_of(files, mapping)
    said: Mapping[str, Any] = reading
    motor = Motor(*(said.get(each.name) for each in fields(Motor)))
    chosen, channels, units = motor.added(chosen, reading.get("channels") or {}, reading.get("units") or {})
    rest = {name: value for name, value in reading.items() if name not in vars(motor)}
    reading = cast("Reading", rest | {"channels": channels, "units": units})
    corrects, chosen = chosen.corrects, chosen.turned(reading.get("signs") or {})
    choices, known = _said(chosen, reading)
    made = _made(chosen, reading)

    def reported(by: LogMapping, more: Mapping[str, str]) -> tuple[FileReport, ...]:
        named = {**choices, **{role: ChannelChoice(name) for role, name in more.items()}}
        with reading_by(by.layout):
            found = (file_report(raw_channels(file), named, known) for file in files)
            return tuple(_without_lacking(each, made) for each in found)

    proposal: Proposal | None = None
    try:
        reports = reported(chosen, {})
    except HerseyError as error:
        if chosen.layout is not None:
            raise
        proposal = recognized(error, files, channels, units)
    else:
        if chosen.layout is None and not means:
            proposal = _shown_layout(files, reports, reading)
    if proposal is not None:
        chosen = replace(chosen, layout=proposal.layout)
        reading = reading | {"channels": {**proposal.channels, **channels}}
        reports = reported(chosen, proposal.channels)
    needed: tuple[str, ...] = ()
    log: TorqueLog | MeansTable
    try:
        if means:
            reports = tuple(replace(each, format=f"{each.format}, {MEANS}", lacking={}) for each in reports)
            by_hand = [Setting(name).to() for name in vars(motor) if said.get(name) is not None]
            refuse_corrections(corrects, str(chosen.source and chosen.source.name), by_hand)
            refuse_sources(chosen, said, channels)
            log = replace(_table(files, choices, known, reading), sensors=chosen.sensors)
            done = log.corrections
        else:
            read, needed = _read(files, {**reading, "mapping": chosen, "signs": None}, reports)
            log, done = read.log, read.corrections
    except HerseyError as error:
        return Inspection(reports, str(error), (), {}, (), None)

    def dwells() -> SteadyPoints:
        if isinstance(log, MeansTable):
            return SteadyPoints.from_table(log, rotation=rotation)
        return log.steady(min_dwell=min_dwell, tare=tare, rotation=rotation)

    reports = tuple(_with_warnings(report, log.files) for report in reports)
    dropped = {file.name: file.missing_rows for file in log.files if file.missing_rows}
    left_out = reading.get("isothermal", False)
    support, doubts = _supported(dwells, temperature_scale, _no_temperature(reports, excluded=left_out))
    return Inspection(reports, "", needed, dropped, done, support, (*doubtful_units(log), *doubts))


def _shown_layout(
    files: Sequence[str | Path], reports: Sequence[FileReport], reading: Reading
) -> Proposal | None:
    """The layout by which logs that lack a role are read without being asked."""
    without = {"temperature"} if reading.get("isothermal") else set()
    if not any(set(report.lacking) - without for report in reports) or not Path(files[0]).is_file():
        return None
    proposal = proposed_layout(Path(files[0]), reading.get("channels"), reading.get("units"))
    return None if proposal is None or proposal.is_doubtful else proposal


def _said(mapping: LogMapping, reading: Reading) -> tuple[dict[str, ChannelChoice], Stated]:
    """The choice for each role, and what is said beside the channels: by the user, or else the mapping."""
    channels, units = reading.get("channels") or {}, reading.get("units") or {}
    stated = Stated(reading.get("every"), as_stated(reading.get("radius")), as_stated(reading.get("load")))
    said = without_what_is_said(mapping, channels, stated)
    choices = {
        role: ChannelChoice(
            channels.get(role) or said.channels.get(role, ""), units.get(role) or said.units.get(role, "")
        )
        for role in (*ROLES, *OTHER_ROLES)
    }
    return choices, Stated(*(getattr(stated, f.name) or getattr(said.stated, f.name) for f in fields(Stated)))


def _made(mapping: LogMapping, reading: Mapping[str, Any]) -> frozenset[str]:
    """The roles that no column needs to play: a schedule, file names or a position do."""
    said = mapping.sources | {name: value for name in mapping.sources if (value := reading.get(name))}
    sources = Sources.of(**said)
    position = (reading.get("channels") or {}).get("position") or mapping.position.channel
    return sources.roles | ({"speed"} if position else set())


def _without_lacking(report: FileReport, made: frozenset[str]) -> FileReport:
    """The report of a file without what it says of roles that no column needs to play."""
    return replace(report, lacking={role: why for role, why in report.lacking.items() if role not in made})


def _supported(
    reduce: Callable[[], SteadyPoints], temperature_scale: str, no_temperature: str
) -> tuple[Support, tuple[Warning, ...]]:
    """What dwells support, and what is doubtful of them; a log without a dwell supports nothing."""
    try:
        points = reduce()
    except InsufficientDataError as error:
        return Support(0, 0, None, (), {}, (), (str(error),)), ()
    notes = () if isinstance(points.log, MeansTable) else points.warnings  # what a table lacks, support says
    found = (*doubtful_tare(points), *notes, *doubtful_order(points), *misleading(points))
    found = tuple(each.about(points.domain) for each in found)
    support = support_of_points(points, temperature_scale=temperature_scale, no_temperature=no_temperature)
    return support, found


def _no_temperature(reports: Sequence[FileReport], *, excluded: bool) -> str:
    """Why a log has no temperature; that it holds none is only one reason."""
    unread = [report.name for report in reports if report.temperature_unread]
    if excluded and (unread or any("temperature" not in report.lacking for report in reports)):
        return f"{ISOTHERMAL.to()} excludes it"
    return f"the temperature column of {unread[0]} cannot be used" if unread else "none was recorded"


def _table(
    files: Sequence[str | Path], choices: Mapping[str, ChannelChoice], known: Stated, reading: Reading
) -> MeansTable:
    """What tables of means hold, which need no clock."""
    stated = {role: choice for role, choice in choices.items() if role != "time"}
    return read_means(
        files,
        channels={role: choice.name for role, choice in stated.items() if choice.name},
        units={role: choice.unit for role, choice in stated.items() if choice.unit},
        isothermal=reading.get("isothermal", False),
        radius=known.radius,
        load=known.load,
        signs=reading.get("signs"),
    )


def _with_warnings(report: FileReport, files: Sequence[LogFile]) -> FileReport:
    """The report of a file with what was done to read it as a log: rows left out, above all."""
    own = [file for file in files if file.name.partition(", run ")[0] == report.name]
    others = [each for file in own for each in file.warnings if each not in report.warnings]
    return replace(report, warnings=(*report.warnings, *others))


def _read(
    files: Sequence[str | Path], reading: Reading, reports: Sequence[FileReport]
) -> tuple[Corrected, tuple[str, ...]]:
    """The log, and the switches that it needed beside those given."""
    hopeless = any(set(report.without) - {"temperature"} for report in reports)
    cold = any("temperature" in report.without for report in reports)
    holes = any(c.role and c.traits.missing for report in reports for c in report.channels)
    isothermal = _tries(reading.get("isothermal", False), cold and not hopeless)
    drop_missing = _tries(reading.get("drop_missing", False), holes and not hopeless)
    first: HerseyError | None = None
    for without, drop in itertools.product(isothermal, drop_missing):
        tried: Reading = {**reading, "isothermal": without, "drop_missing": drop}
        try:
            log = read_with_mapping(files, **tried)
        except HerseyError as error:
            first = first or error
            continue
        switches = {ISOTHERMAL.name: without != isothermal[0], DROP_MISSING.name: drop != drop_missing[0]}
        return log, tuple(name for name, used in switches.items() if used)
    assert first is not None
    raise first


def _switches(names: tuple[str, ...]) -> str:
    """Switches as they are set."""
    joint = " " if way_in() == "terminal" else " and "
    return joint.join(Setting(name, "switch").to() for name in names)


def _tries(given: bool, helps: bool) -> tuple[bool, ...]:
    """A flag as given, and set where that may help."""
    return (False, True) if helps and not given else (given,)
