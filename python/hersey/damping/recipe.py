"""How logs become dwells: files, channels, corrections and the search for dwells in one record.

Command line, app, campaign and machine file all read logs by it. It comes before the machine, whose file may
name a log of the drive without the film.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Protocol

import pydantic.dataclasses
from pydantic import ValidationInfo

from hersey.arguments.frozen import explained
from hersey.damping.dwells import SteadyPoints
from hersey.damping.held_or_moving import held_or_moving
from hersey.damping.inertia import stated_inertia
from hersey.damping.moving.result import MovingFit
from hersey.damping.no_load import no_load_torque
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.damping.once import read_once, reduced_once
from hersey.errors import (
    MOVING,
    SIGN,
    TARE,
    ChannelError,
    HerseyError,
    InsufficientDataError,
    ParameterError,
    Setting,
    UnitError,
    turned,
)
from hersey.files.toml import Quantity, Table, quoted, read_tables
from hersey.log import TorqueLog
from hersey.log.as_torque import log_as_torque
from hersey.log.mapping import LogMapping, Motor, mapping_of, read_with_mapping
from hersey.log.mean_refusals import refuse_corrections, refuse_sources
from hersey.log.means import (
    MeansTable,
    is_means_table,
    read_means,
)
from hersey.log.reading import is_of_temperature, temperature_not_read
from hersey.log.sensors import Sensors
from hersey.log.text.delimited import Progress
from hersey.result import json_record
from hersey.units import KINDS, argument

Amount = float | tuple[float, ...] | None


class KnownDrive(Protocol):
    """What is known of the drive before its log is read: `hersey.Machine` is one."""

    @property
    def sensors(self) -> Sensors:
        """Errors of its sensors."""

    @property
    def roll_radius(self) -> float:
        """Radius at which the torque acts, m."""

    @property
    def rest(self) -> NoLoadTorque | None:
        """What it takes without the film."""


class _OneOrMore(Quantity):
    """A quantity, or one for each run."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> Any:
        """Return the value, or a tuple of them, in SI."""
        if given is None:
            return None
        if isinstance(given, list | tuple):
            return tuple(self.checked(each, info) for each in given)
        return super().checked(given, info)


class _Path(Quantity):
    """A file, beside the one that names it unless its path is absolute."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> Any:
        """Return the path."""
        if not isinstance(given, str) or not given.strip():
            raise ParameterError(f"is {given!r}: write the name of a file")
        return info.context.path.parent / given


class _Paths(_Path):
    """Files in a list, or one alone."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> Any:
        """Return the paths."""
        named = given if isinstance(given, list | tuple) else [given]
        return tuple(super(_Paths, self).checked(each, info) for each in named)


@explained
@dataclass(frozen=True)
class Recipe:
    """How logs are read and reduced to dwells: the same recipe on the same files gives the same dwells.

    Attributes
    ----------
    logs
        Files of one log.
    mapping
        File with roles, units and corrections of the channels; None for `hersey.toml` beside the logs.
    channels
        Name of the column of each role; outranks the mapping.
    units
        Unit of the column of each role; outranks the mapping.
    signs
        -1 for ``torque`` or ``speed`` reverses its sign.
    every
        Time between rows, s, if the log has no clock.
    radius
        Radius at which a friction force acts, m: one, or one for each run.
    load
        Normal load, N: one, or one for each run.
    name_pattern
        Pattern of the file names, e.g. ``"{speed} rpm {load} N.txt"``, if they state speed, load, radius or
        temperature.
    name_decimal
        Decimal mark of the numbers in the names.
    run_table
        Table with a row for each file: its speed, load, radius or temperature.
    schedule
        Table of speed, temperature or load by time, if the log has no channel of it.
    position_window
        Time over which speed is the slope of a position column, s.
    torque_constant
        Torque of the motor per ampere, N m/A, if the torque column is its current.
    gear_ratio
        Turns of the shaft where torque is measured per turn of the roll or joint.
    speed_gear_ratio
        Turns of the shaft where speed is measured per turn of the roll or joint.
    isothermal
        Whether temperature is left out of the fit.
    drop_missing
        Whether rows with a missing or impossible number are dropped also where they are many.
    means
        Whether the files are tables of means. Those that plainly are need not be called so.
    min_dwell
        Shortest dwell, s.
    tare
        ``none``, or ``standing``: subtract the torque at standstill.
    rotation
        Dwells to use: ``both``, ``forward`` or ``reverse``.
    temperature_scale
        Scale of T in the fit: ``degC`` or ``K``.
    no_load
        Log of the drive without the lubricated contact; its torque is subtracted.
    moving
        Whether friction is fitted to every sample of a log that moves all the time, instead of to dwells.
    inertia
        Moment of inertia of all that the torque of such a log accelerates, kg m^2; None if it is fitted.
    inertia_error
        Half its 95 % interval, kg m^2; None if it is exact.
    """

    logs: Annotated[tuple[Path, ...], _Paths(None)] = ()
    mapping: Annotated[Path | None, _Path(None)] = None
    channels: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    signs: dict[str, int] = field(default_factory=dict)
    every: Annotated[float | None, _OneOrMore("time", 1e-9, 1e6, "2 ms")] = None
    radius: Annotated[Amount, _OneOrMore("length", 1e-6, 1e3, "25 mm")] = None
    load: Annotated[Amount, _OneOrMore("force", 1e-9, 1e9, "50 N")] = None
    name_pattern: str = ""
    name_decimal: str = ""
    run_table: Annotated[Path | None, _Path(None)] = None
    schedule: Annotated[Path | None, _Path(None)] = None
    position_window: Annotated[float | None, _OneOrMore("time", 1e-6, 1e4, "0.2 s")] = None
    torque_constant: Annotated[float | None, _OneOrMore("motor constant", 1e-6, 1e3, "0.11 N*m/A")] = None
    gear_ratio: Annotated[float | None, _OneOrMore(None, 1e-4, 1e4, "50")] = None
    speed_gear_ratio: Annotated[float | None, _OneOrMore(None, 1e-4, 1e4, "50")] = None
    isothermal: bool = False
    drop_missing: bool = False
    means: bool = False
    min_dwell: Annotated[float, Quantity("time", 0.0, 1e9, "2 s")] = 2.0
    tare: str = "none"
    rotation: str = "both"
    temperature_scale: str = "degC"
    no_load: Annotated[Path | None, _Path(None)] = None
    moving: bool = False
    inertia: Annotated[float | None, Quantity("moment of inertia", 0.0, 1e9, "2e-4 kg*m^2")] = None
    inertia_error: Annotated[float | None, Quantity("moment of inertia", 0.0, 1e9, "1e-5 kg*m^2")] = None

    def __post_init__(self) -> None:
        """Bring amounts to SI and names of files to paths."""
        logs = (self.logs,) if isinstance(self.logs, str | Path) else self.logs
        given: dict[str, Any] = {"logs": tuple(Path(path) for path in logs)}
        for name in _FILES:
            path = getattr(self, name)
            given[name] = None if path is None else Path(path)
        for name, kind in AMOUNTS.items():
            amount = getattr(self, name)
            if isinstance(amount, tuple | list):
                given[name] = tuple(argument(name, kind, each) for each in amount)
            elif amount is not None:
                given[name] = argument(name, kind, amount)
        for name, value in given.items():
            object.__setattr__(self, name, value)

    def log(self, drive: KnownDrive | None = None, *, progress: Progress | None = None) -> Any:
        """Read the logs as one log.

        Sensor errors that the mapping does not state are those of the drive. Friction becomes a torque at the
        radius of its roll.

        Returns
        -------
        `hersey.TorqueLog`, or a table of means.

        Raises
        ------
        HerseyError
            As `hersey.read` does, and if a mapping states corrections for a table of means.
        """
        log = read_once(self, progress)
        if drive is None:
            return log
        log = replace(log, sensors=log.sensors.or_else(drive.sensors))
        return log if log.domain.is_torque else log_as_torque(log, radius=drive.roll_radius)

    def dwells(
        self,
        log: TorqueLog | MeansTable,
        drive: KnownDrive | None = None,
        found: SteadyPoints | MovingFit | None = None,
    ) -> SteadyPoints:
        """Reduce a log, or a table of means, to dwells with the torque of the film.

        The no-load torque is that of ``no_load``, or else of the drive. The dwells keep the recipe. ``found``
        is what `found` returned, if it was called before; windows of a moving log become the dwells.

        Raises
        ------
        InsufficientDataError, ParameterError
            If there is no dwell, or a setting is wrong or given twice.
        """
        rest = self.rest(None if drive is None else drive.rest, drive)
        reduced = self.found(log) if found is None else found
        if isinstance(reduced, MovingFit):
            reduced = reduced.points(rotation=self.rotation)
        points = replace(reduced, recipe=self)
        return points if rest is None else points.without(rest)

    def found(self, log: TorqueLog | MeansTable) -> SteadyPoints | MovingFit:
        """Return the dwells of a log, or the fit to every sample: if asked for, or if it moves all the time.

        Raises
        ------
        InsufficientDataError, ParameterError
            As `dwells` does.
        """
        try:
            if isinstance(log, TorqueLog) and self.moving:
                return self.moving_fit(log)
            asked = (self.tare, self.rotation) != ("none", "both")
            if asked or not isinstance(log, TorqueLog):
                return self._dwells(log)
            return held_or_moving(log.rows, lambda: self._dwells(log), lambda: self.moving_fit(log))
        except InsufficientDataError as error:
            flipped = [turned(role) for role, sign in self.signs.items() if sign == -1]
            if error.setting == SIGN and len(flipped) == 1:
                error.remedy = f"omit {flipped[0]}"
            raise

    def moving_fit(self, log: TorqueLog) -> MovingFit:
        """Fit friction, inertia and offset to every sample of a log.

        Raises
        ------
        InsufficientDataError, ParameterError
            If that cannot be, or a tare is asked for.
        """
        if self.tare != "none":
            raise ParameterError(f"the torque zero of a moving log is fitted. Omit {TARE.to()}")
        half = self.inertia_error or 0.0
        return log.moving(inertia=None if self.inertia is None else stated_inertia(self.inertia, half))

    def points(self, drive: KnownDrive | None = None, *, progress: Progress | None = None) -> SteadyPoints:
        """Read the logs and reduce them to dwells; errors begin with the name of the log.

        Raises
        ------
        HerseyError
            As `log` and `dwells` do.
        """
        with naming_logs(self.logs):
            return self.dwells(self.log(drive, progress=progress), drive)

    def rest(
        self, stated: NoLoadTorque | None = None, drive: KnownDrive | None = None
    ) -> NoLoadTorque | None:
        """Return the no-load torque from its log, or what is ``stated`` if there is no such log.

        The log is read as that of the ``drive``, as the other logs are.

        Raises
        ------
        ParameterError
            If both are given.
        """
        if self.no_load is None:
            return stated
        if stated is not None:
            how = Setting("no_load").to()
            raise ParameterError(f"{how} and {stated.source} both give the no-load torque. Omit one of them")
        channels, units = _without("load", self.channels), _without("load", self.units)
        alone = replace(self, logs=(self.no_load,), no_load=None, load=None, channels=channels, units=units)
        return no_load_torque(alone._dwells(alone.log(drive)))

    @property
    def chosen(self) -> LogMapping:
        """The mapping by which the logs are read."""
        return self._asked[0]

    @property
    def _asked(self) -> tuple[LogMapping, dict[str, str], dict[str, str]]:
        """The mapping, and the channels and units that are given beside it."""
        return self._motor.added(mapping_of(self.logs, self.mapping), self.channels, self.units)

    @property
    def _motor(self) -> Motor:
        return Motor(self.torque_constant, self.gear_ratio, self.speed_gear_ratio)

    @property
    def are_means(self) -> bool:
        """Whether the logs are tables of means, by statement or by their content."""
        rows = {"time", "run", "position", "direction"} & self.channels.keys()
        if self.means or self.every is not None or self.schedule or rows:
            return self.means
        mapping, channels, units = self._asked
        if mapping.schedule is not None or mapping.position.channel:
            return False
        if mapping.time.every is not None or mapping.layout is not None:
            return False
        channels, units = mapping.channels | channels, mapping.units | units
        return all(is_means_table(path, channels, units) for path in self.logs)

    def save(self, path: str | Path, *, overwrite: bool = False) -> None:
        """Write the recipe as TOML, with units, and with files relative to that place.

        Raises
        ------
        OutputError
            If the file exists and ``overwrite`` is false, or cannot be written.
        """
        from hersey.files.writing import write_atomically

        write_atomically(Path(path), self.toml(Path(path).parent), overwrite=overwrite)

    @classmethod
    def from_file(cls, path: str | Path) -> Recipe:
        """Read a saved recipe.

        Raises
        ------
        MissingFileError, ParameterError, UnitError
            Each names the file and the key.
        """
        return cls(**vars(read_tables(path, _RecipeFile)))

    def by_name(self) -> Recipe:
        """Return the same recipe with files by name only, for use with all files in one folder.

        Files of one name in several folders keep as much of their folders as distinguishes them.

        Examples
        --------
        >>> recipe = Recipe(logs=("/data/1/log.csv", "/data/2/log.csv"), mapping="/etc/hersey.toml")
        >>> recipe.by_name().to_dict()
        {'logs': ['1/log.csv', '2/log.csv'], 'mapping': 'hersey.toml'}
        """
        others = {name: path for name in _FILES if (path := getattr(self, name)) is not None}
        named = _distinct([*self.logs, *others.values()])
        count = len(self.logs)
        changed: dict[str, Any] = dict(zip(others, named[count:], strict=True))
        return replace(self, logs=named[:count], **changed)

    def toml(self, folder: Path = Path()) -> str:
        """Return the recipe as TOML, with files relative to ``folder``."""
        plain, tables = [], []
        for name, value in self.stated().items():
            if isinstance(value, dict):
                rows = [f"{key} = {_written(each)}" for key, each in value.items()]
                tables.append("\n".join([f"\n[{name}]", *rows]))
            else:
                plain.append(f"{name} = {_written(value, AMOUNTS.get(name, ''), folder)}")
        return "\n".join([*plain, *tables, ""])

    def stated(self) -> dict[str, Any]:
        """Return all values that differ from the default, by name."""
        usual = vars(Recipe())
        return {name: value for name, value in vars(self).items() if value != usual[name]}

    def to_dict(self) -> dict[str, Any]:
        """Return all values that differ from the default as JSON, in SI."""
        return json_record({name: _plain(value) for name, value in self.stated().items()})

    def speeds(self, *, progress: Progress | None = None) -> TorqueLog:
        """Read the logs without a torque, for `hersey.coast_down`.

        A temperature that the mapping names need not be there; one named by ``channels`` must be.

        Raises
        ------
        HerseyError
            As `hersey.read` does.
        """
        try:
            return self._trace(progress, without_torque=True)
        except (ChannelError, UnitError) as error:
            asked = self.channels if isinstance(error, ChannelError) else self.channels | self.units
            if not is_of_temperature(error) or "temperature" in asked:
                raise
            why = temperature_not_read(error)
        alone = replace(self, isothermal=True, units=_without("temperature", self.units))
        log = alone._trace(progress, without_torque=True)
        first, *others = log.files
        return replace(log, files=(replace(first, warnings=(*first.warnings, why)), *others))

    def read_files(self, progress: Progress | None = None) -> TorqueLog | MeansTable:
        """Read the logs as they are now."""
        return self._means() if self.are_means else self._trace(progress)

    def _trace(self, progress: Progress | None, *, without_torque: bool = False) -> TorqueLog:
        done = read_with_mapping(
            self.logs,
            mapping=self.mapping,
            channels=self.channels,
            units=self.units,
            signs=self.signs,
            isothermal=self.isothermal,
            drop_missing=self.drop_missing,
            without_torque=without_torque,
            **vars(self._motor),
            **{name: given for name in _STATED if (given := getattr(self, name))},
            progress=progress,
        )
        return replace(done.log, corrections=done.corrections)

    def _means(self) -> MeansTable:
        mapping = self.chosen
        by_hand = [Setting(name).to() for name, value in vars(self._motor).items() if value is not None]
        refuse_corrections(mapping.corrects, str(mapping.source and mapping.source.name), by_hand)
        refuse_sources(mapping, vars(self), self.channels)
        stated = {
            role: getattr(self, role) or (None if role in self.channels else getattr(mapping.stated, role))
            for role in ("radius", "load")
        }
        table = read_means(
            self.logs,
            channels=_without("time", mapping.channels | self.channels),
            units=_without("time", mapping.units | self.units),
            isothermal=self.isothermal,
            signs=self.signs,
            **stated,
        )
        if mapping.torque.zero_error is not None:
            table.domain.require_torque("[torque] zero_error")
        return replace(table, sensors=mapping.sensors)

    def _dwells(self, log: TorqueLog | MeansTable) -> SteadyPoints:
        if isinstance(log, MeansTable):
            if self.tare != "none":
                raise ParameterError(
                    f"a table of means has no standstill for a tare. Omit {TARE.to()}, and subtract "
                    "the zero in the table"
                )
            if self.moving:
                raise ParameterError(f"a table of means does not move. Omit {MOVING.to()}")
            return SteadyPoints.from_table(log, rotation=self.rotation)
        if self.moving:
            return self.moving_fit(log).points(rotation=self.rotation)
        return reduced_once(log, min_dwell=self.min_dwell, tare=self.tare, rotation=self.rotation)


@contextmanager
def naming_logs(paths: Sequence[Path]) -> Iterator[None]:
    """Let what is wrong with a log begin with its name, where several are read."""
    try:
        yield
    except HerseyError as error:
        if not paths or any(path.name in error.reason for path in paths):
            raise
        raise error.within(str(paths[0])) from None


@pydantic.dataclasses.dataclass(frozen=True)
class _RecipeFile(Table, Recipe):
    """A recipe as its file holds it."""


#: Fields that name one file each.
_FILES = ("mapping", "run_table", "schedule", "no_load")
#: Kind of unit of each amount.
AMOUNTS = {
    "every": "time",
    "radius": "length",
    "load": "force",
    "min_dwell": "time",
    "position_window": "time",
    "torque_constant": "motor constant",
    "inertia": "moment of inertia",
    "inertia_error": "moment of inertia",
}
#: What is said of a log and a file need not hold.
_STATED = (
    *("every", "radius", "load", "name_pattern", "name_decimal"),
    *("run_table", "schedule", "position_window"),
)


def _distinct(paths: Sequence[Path]) -> tuple[Path, ...]:
    """The shortest end of each path that no other path has; names of equal paths."""
    inside = [path.relative_to(path.anchor) for path in paths]
    depths = [1] * len(inside)
    for _ in range(max((len(path.parts) for path in inside), default=0)):
        ends = [Path(*path.parts[-depth:]) for path, depth in zip(inside, depths, strict=True)]
        for i, end in enumerate(ends):
            rivals = {inside[k] for k, other in enumerate(ends) if other == end}
            depths[i] += len(rivals) > 1
    return tuple(Path(*path.parts[-depth:]) for path, depth in zip(inside, depths, strict=True))


def _without(role: str, by_role: Mapping[str, str]) -> dict[str, str]:
    return {other: value for other, value in by_role.items() if other != role}


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return str(value) if isinstance(value, Path) else value


def _written(value: Any, kind: str = "", folder: Path = Path()) -> str:
    """A value as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Path):
        return quoted(os.path.relpath(value, folder))
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"[{', '.join(_written(each, kind, folder) for each in value)}]"
    if kind:
        return quoted(f"{value!r} {KINDS[kind][0]}")
    return quoted(value) if isinstance(value, str) else repr(value)
