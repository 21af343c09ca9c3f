"""`hersey.toml`: which channel has which role. It is proposed once, kept with the data and reused.

A table for each role (``time``, ``torque``, ``speed``, ``temperature``) names the channel and its unit, and
holds what must be corrected: sign, tare, gears, motor constant, offsets. Every value with a dimension is
written with its unit.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass as plain_dataclass
from dataclasses import field, fields, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic.dataclasses import dataclass

from hersey.errors import (
    MAPPING,
    ChannelError,
    HerseyError,
    ParameterError,
    Setting,
    UnitError,
    printable,
    turned,
)
from hersey.files.toml import Table, naming, read_tables, read_toml
from hersey.log import corrections
from hersey.log.channels import Stated
from hersey.log.corrections import Corrected
from hersey.log.layouts.current import reading_by
from hersey.log.layouts.presets import with_preset
from hersey.log.layouts.recognized import (
    first_of_each_file_with,
    in_words,
    layout_recognized,
    recognized,
)
from hersey.log.layouts.table import LogLayout
from hersey.log.reading import read
from hersey.log.role_tables import (
    LoadMapping,
    NamesMapping,
    PositionMapping,
    RadiusMapping,
    RoleMapping,
    SpeedMapping,
    Steps,
    TemperatureMapping,
    TimeMapping,
    TorqueMapping,
)
from hersey.log.roles import CHANNELS, OTHER_ROLES, ROLE_KINDS, ROLES, SIGNS, UNITS, role_conversion
from hersey.log.sensor_tables import sensors_of
from hersey.log.sensors import Sensors
from hersey.log.text.delimited import Progress
from hersey.log.torque_log import LogFile
from hersey.schema.warning import Warning
from hersey.units import registry, takes_si

#: A mapping for every log in its directory; one for a single log is called after it, ``bench.hersey.toml``.
FILE_NAME = "hersey.toml"
_SUFFIX = ".hersey.toml"
_ALL_ROLES = (*ROLES, *OTHER_ROLES)
#: Sources of a log whose name states nothing.
_NO_NAMES = {"name_pattern": None, "name_decimal": None}
#: Keys of a role that state no correction.
_NO_CORRECTIONS = ("channel", "unit", "gain_error", "zero_error", "film_heating")


@dataclass(frozen=True)
class _Roles(Table):
    time: TimeMapping = field(default_factory=TimeMapping)
    torque: TorqueMapping = field(default_factory=TorqueMapping)
    speed: SpeedMapping = field(default_factory=SpeedMapping)
    temperature: TemperatureMapping = field(default_factory=TemperatureMapping)
    load: LoadMapping = field(default_factory=LoadMapping)
    radius: RadiusMapping = field(default_factory=RadiusMapping)
    run: RoleMapping = field(default_factory=RoleMapping)
    position: PositionMapping = field(default_factory=PositionMapping)
    direction: RoleMapping = field(default_factory=RoleMapping)
    names: NamesMapping = field(default_factory=NamesMapping)
    #: Set points by time or distance: one ``[[schedule]]`` per step, with from, to, and e.g. speed or load.
    schedule: Annotated[Any, Steps(None)] = None
    layout: LogLayout | None = None


@dataclass(frozen=True)
class LogMapping(_Roles):
    """Roles of the channels of a log, and what must be corrected.

    Attributes
    ----------
    time, torque, speed, temperature, load, radius, run, position, direction
        One `RoleMapping` each; ``run`` is the number of a run.
    names
        What the names of the files state.
    schedule
        What was asked for by time, if no channel holds it.
    layout
        How the file is laid out, or none where it shows by itself.
    source
        File that it was read from, or none.
    """

    source: Path | None = None

    @property
    def channels(self) -> dict[str, str]:
        """Column name by role, where one is stated, as `hersey.read` takes it."""
        return {role: channel for role in _ALL_ROLES if (channel := getattr(self, role).channel)}

    @property
    def units(self) -> dict[str, str]:
        """Unit by role, where one is stated, as `hersey.read` takes it; amperes stand in the place of N m."""
        stated = {role: unit for role in _ALL_ROLES if (unit := getattr(self, role).unit)}
        if self.torque.motor_constant is not None:
            unit = self.torque.unit
            stated["torque"] = f"{_ampere(unit):.12g} N*m" if unit else "1 N*m/A"
        return stated

    @property
    def sensors(self) -> Sensors:
        """Errors of the sensors as stated, defaults for the others."""
        return sensors_of(self.torque, self.speed, self.temperature)

    @property
    def corrects(self) -> bool:
        """Whether it states a correction, beside channels and units."""
        return any(
            getattr(role, f.name) != f.default
            for role in (self.torque, self.speed, self.temperature)
            for f in fields(role)
            if f.name not in _NO_CORRECTIONS
        )

    @property
    def stated(self) -> Stated:
        """What it says that a file need not hold."""
        radius, load = (
            of.value if of.value is not None else of.values or None for of in (self.radius, self.load)
        )
        return Stated(self.time.every, radius, load)

    @property
    def sources(self) -> dict[str, Any]:
        """What it says of channels that no column holds, as `hersey.read` takes it."""
        return {
            "name_pattern": self.names.pattern or None,
            "name_decimal": self.names.decimal if self.names.pattern else None,
            "run_table": self.names.table,
            "schedule": self.schedule,
            "position_window": self.position.window,
        }

    def turned(self, signs: Mapping[str, int]) -> LogMapping:
        """Return the mapping with the signs of torque and speed multiplied by those given by role.

        Raises
        ------
        ParameterError
            If a sign is neither 1 nor -1.
        """
        for role, value in signs.items():
            if value not in (1, -1):
                raise ParameterError(
                    f"the sign of {role} is {value}: it must be 1 or -1. To flip it, use {turned(role)}"
                )
        torque, speed = (signs.get(role, 1) for role in ("torque", "speed"))
        return replace(
            self,
            torque=replace(self.torque, sign=self.torque.sign * torque),
            speed=replace(self.speed, sign=self.speed.sign * speed),
        )

    def correct(self, log: Any) -> Corrected:
        """Apply the corrections that are stated, in the order of `hersey.log.corrections`."""
        done = self._at_the_sensor(log)
        torque, speed, temperature = self.torque, self.speed, self.temperature
        if isinstance(torque.no_load, Path):
            channels, units = map(_without_temperature, (self.channels, self.units))
            given = vars(self.stated) | self._sources_without_film
            other = read(torque.no_load, channels=channels, units=units, isothermal=True, **given)
            done = corrections.no_load(done, torque=self._at_the_sensor(other))
        elif torque.no_load:
            done = corrections.no_load(done, torque=torque.no_load)
        if (torque.gear_ratio, speed.gear_ratio, torque.efficiency) != (1.0, 1.0, 1.0):
            done = corrections.at_roll(
                done,
                torque_ratio=torque.gear_ratio,
                speed_ratio=speed.gear_ratio,
                efficiency=torque.efficiency,
            )
        if torque.inertia:
            done = corrections.inertia(done, moment_of_inertia=torque.inertia)
        if done.log.has_temperature and temperature.time_constant:
            done = corrections.thermal_lag(done, time_constant=temperature.time_constant)
        if done.log.has_temperature and temperature.offset:
            done = corrections.temperature_offset(done, offset=temperature.offset)
        return done

    @property
    def _sources_without_film(self) -> dict[str, Any]:
        """`sources` of a log without the film, whose name need not state load or temperature."""
        named = {} if re.search(r"\{\s*(speed|radius)\b", self.names.pattern) else _NO_NAMES
        return self.sources | named

    def _at_the_sensor(self, log: Any) -> Corrected:
        done = Corrected(log)
        if self.torque.motor_constant is not None:
            done = corrections.torque_from_current(done, motor_constant=self.torque.motor_constant)
        if (self.torque.sign, self.speed.sign) != (1, 1):
            done = corrections.sign(done, torque=self.torque.sign, speed=self.speed.sign)
        if self.torque.tare:
            done = corrections.tare(done, torque=self.torque.tare)
        return done


def read_mapping(path: str | Path) -> LogMapping:
    """Read a mapping. Tables and keys are checked; every value with a dimension needs its unit.

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key.
    """
    path = Path(path)
    if "drivetrain" in read_toml(path):
        raise ParameterError(
            f"{path.name} is a machine file ([drivetrain]), not a mapping. Give it as "
            f"{Setting('machine').to(printable(str(path)))}"
        )
    mapping = LogMapping(**vars(read_tables(path, _Roles)), source=path)
    for role in ROLE_KINDS:
        with naming(path.name, f"{role}.unit"):
            _check_unit(role, getattr(mapping, role).unit, mapping.torque.motor_constant)
    if mapping.layout is not None:
        with naming(path.name):
            with_preset(mapping.layout)
    return mapping


def _check_unit(role: str, unit: str, motor_constant: float | None) -> None:
    if role == "torque" and motor_constant is not None:
        _ampere(unit)
    elif unit:
        try:
            role_conversion(role, unit)
        except UnitError as error:
            remedy = "if it is a motor current, set motor_constant" if role == "torque" else ""
            raise UnitError(str(error), remedy=remedy) from None


def find_mapping(path: str | Path) -> Path | None:
    """Return the mapping of a log: ``bench.hersey.toml`` next to it, or `FILE_NAME` in its folder."""
    log = Path(path)
    beside = (log.parent / f"{log.stem}{_SUFFIX}", log.parent / FILE_NAME)
    # a name that the system finds too long is no file
    return next((candidate for candidate in beside if os.path.isfile(candidate)), None)  # noqa: PTH113


@takes_si(
    every="time",
    radius="length",
    load="force",
    torque_constant="motor constant",
    inertia="moment of inertia",
    position_window="time",
    channels=CHANNELS,
    units=UNITS,
    signs=SIGNS,
)
def read_with_mapping(
    paths: str | Path | Sequence[str | Path],
    *,
    mapping: LogMapping | str | Path | None = None,
    channels: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    isothermal: bool = False,
    signs: Mapping[str, int] | None = None,
    drop_missing: bool = False,
    every: float | None = None,
    radius: float | Sequence[float] | None = None,
    load: float | Sequence[float] | None = None,
    without_torque: bool = False,
    torque_constant: float | None = None,
    gear_ratio: float | None = None,
    speed_gear_ratio: float | None = None,
    inertia: float | None = None,
    name_pattern: str | None = None,
    name_decimal: str | None = None,
    run_table: str | Path | None = None,
    schedule: Any = None,
    position_window: float | None = None,
    progress: Progress | None = None,
) -> Corrected:
    """Read one log or several with `hersey.read`, using their mapping, and apply its corrections.

    Parameters
    ----------
    mapping
        A mapping or its file, for all logs. Default: the one that `find_mapping` finds in their folder.
    channels, units
        By role; they override the mapping. A role whose channel or unit is given here is not corrected for
        the motor constant of the mapping.
    signs
        -1 by role, ``torque`` or ``speed``, flips the sign in addition to the mapping.
    isothermal, drop_missing, every, radius, load, name_pattern, name_decimal, run_table, schedule,
    position_window, without_torque, progress
        As for `hersey.read`; they override the mapping.
    torque_constant
        Torque of the motor per ampere, N m/A, if the torque column is its current.
    gear_ratio, speed_gear_ratio
        Turns of the shaft where torque, or speed, is measured per turn of the roll or joint.
    inertia
        Moment of inertia at the roll or joint, kg m^2; its torque is subtracted.

    Raises
    ------
    ParameterError
        If mappings of several logs of one call differ, or as `hersey.read` and `read_mapping` do.

    Examples
    --------
    >>> read_with_mapping("examples/bench.csv").corrections
    ()
    """
    files = [paths] if isinstance(paths, str | Path) else list(paths)
    needed = _without_temperature if isothermal else dict
    chosen = mapping if isinstance(mapping, LogMapping) else mapping_of(files, mapping)
    motor = Motor(torque_constant, gear_ratio, speed_gear_ratio, inertia)
    chosen, channels, units = motor.added(chosen, channels or {}, units or {})
    chosen = chosen.turned(signs or {})
    chosen = replace(chosen, torque=TorqueMapping()) if without_torque else chosen
    stated = Stated(every, as_stated(radius), as_stated(load))
    said = {
        "name_pattern": name_pattern,
        "name_decimal": name_decimal,
        "run_table": run_table,
        "schedule": schedule,
        "position_window": position_window,
    }
    sources = chosen.sources | {name: value for name, value in said.items() if value is not None}
    chosen = without_what_is_said(chosen, channels, stated)
    how = {
        "isothermal": isothermal,
        "drop_missing": drop_missing,
        "without_torque": without_torque,
        **{name: value for name, value in vars(chosen.stated).items() if value is not None},
        **{name: value for name, value in vars(stated).items() if value is not None},
        **sources,
        "progress": progress,
    }

    def corrected(by: LogMapping, more: Mapping[str, str]) -> Corrected:
        named = {**needed(by.channels), **more, **channels}
        with reading_by(by.layout):
            return by.correct(read(files, channels=named, units={**needed(by.units), **units}, **how))

    try:
        done = _corrected(files, chosen, corrected, channels, units)
    except HerseyError as error:
        if chosen.source is None or not isinstance(error, ChannelError | UnitError):
            raise
        raise error.saying(f"{error.reason} (channels and units come from {chosen.source.name})") from None
    if chosen.torque.zero_error is not None:
        done.log.domain.require_torque("[torque] zero_error")
    logged = tuple(_as_written(file, chosen) for file in done.log.files)
    return Corrected(replace(done.log, files=logged, sensors=chosen.sensors), done.corrections)


def _corrected(
    files: Sequence[Any],
    mapping: LogMapping,
    corrected: Callable[[LogMapping, Mapping[str, str]], Corrected],
    channels: Mapping[str, str],
    units: Mapping[str, str],
) -> Corrected:
    """Files read as they stand or by the layout of the mapping, or else by one that they show."""
    try:
        return corrected(mapping, {})
    except HerseyError as error:
        if mapping.layout is not None:
            raise
        proposal = recognized(error, files, channels, units)
    try:
        done = corrected(replace(mapping, layout=proposal.layout), proposal.channels)
    except HerseyError as error:
        raise error.saying(f"{error.reason} (layout found: {in_words(proposal.layout)})") from None
    logged = first_of_each_file_with(layout_recognized(proposal.layout), done.log.files)
    return replace(done, log=replace(done.log, files=logged))


def mapping_of(files: Sequence[str | Path], stated: str | Path | None = None) -> LogMapping:
    """Return the given mapping, or the one that `find_mapping` finds for all files, or an empty one.

    Raises
    ------
    ParameterError
        If it finds several, or it is wrong.
    """
    if stated is not None:
        return read_mapping(stated)
    beside = {find_mapping(file) for file in files}
    if len(beside) > 1:
        names = ", ".join(sorted(f"'{path.name}'" if path else "none" for path in beside))
        raise ParameterError(f"the logs have different mappings ({names}). Choose one with {MAPPING.to()}")
    only = next(iter(beside), None)
    return LogMapping() if only is None else read_mapping(only)


def _without_temperature(stated: Mapping[str, str]) -> dict[str, str]:
    return {role: value for role, value in stated.items() if role != "temperature"}


@plain_dataclass(frozen=True)
class Motor:
    """What a person says of the motor and its gears, SI, beside a mapping; None where nothing is said."""

    torque_constant: float | None = None
    gear_ratio: float | None = None
    speed_gear_ratio: float | None = None
    inertia: float | None = None

    def added(
        self, mapping: LogMapping, channels: Mapping[str, str], units: Mapping[str, str]
    ) -> tuple[LogMapping, dict[str, str], dict[str, str]]:
        """Return a mapping with it, and the channels and units that are still to be read beside it.

        Raises
        ------
        ParameterError, UnitError
            If a value is not greater than 0, or the unit of the current is none.
        """
        for name, value in vars(self).items():
            if value is not None and not 0 < value < np.inf:
                raise ParameterError(f"{Setting(name).to()} is {value:g} (SI): it must be greater than 0")
        mapping = _outranked(mapping, channels, units)
        torque, speed, left = mapping.torque, mapping.speed, (dict(channels), dict(units))
        if self.torque_constant is not None:
            name, unit = left[0].pop("torque", torque.channel), left[1].pop("torque", torque.unit)
            _ampere(unit)
            torque = replace(torque, channel=name, unit=unit, motor_constant=self.torque_constant)
        torque = replace(
            torque, gear_ratio=self.gear_ratio or torque.gear_ratio, inertia=self.inertia or torque.inertia
        )
        speed = replace(speed, gear_ratio=self.speed_gear_ratio or speed.gear_ratio)
        return replace(mapping, torque=torque, speed=speed), *left


def _outranked(mapping: LogMapping, channels: Mapping[str, str], units: Mapping[str, str]) -> LogMapping:
    """The mapping without what a channel or unit given by hand makes void."""
    if "torque" not in channels and "torque" not in units:
        return mapping
    return replace(mapping, torque=replace(mapping.torque, motor_constant=None))


def as_stated(value: float | Sequence[float] | None) -> float | tuple[float, ...] | None:
    """Return a value, or one for each run, as it stands in `Stated`."""
    return (
        value if value is None or isinstance(value, int | float) else tuple(map(float, np.atleast_1d(value)))
    )


def without_what_is_said(mapping: LogMapping, channels: Mapping[str, str], stated: Stated) -> LogMapping:
    """Return a mapping without what a channel or a value given by hand takes the place of."""
    kept = mapping
    if stated.every is not None:
        kept = replace(kept, time=TimeMapping())
    elif "time" in channels:
        kept = replace(kept, time=replace(kept.time, every=None))
    for role, given in (("load", stated.load), ("radius", stated.radius)):
        of_role = getattr(kept, role)
        if given is not None:
            kept = replace(kept, **{role: type(of_role)()})
        elif role in channels:
            kept = replace(kept, **{role: replace(of_role, value=None, values=())})
    return kept


def _as_written(file: LogFile, mapping: LogMapping) -> LogFile:
    """The record of a file, with the unit of a current as it is, and the mapping that was used."""
    warnings = file.warnings
    if mapping.source is not None:
        used = Warning(
            "mapping used",
            "channels, units and corrections come from {mapping}",
            mapping=mapping.source.name,
        )
        warnings = (*warnings, used)
    if mapping.torque.motor_constant is None:
        return replace(file, warnings=warnings)
    unit = mapping.torque.unit or "A"
    channels = tuple(replace(c, unit=unit) if c.role == "torque" else c for c in file.channels)
    return replace(file, warnings=warnings, channels=channels)


def _ampere(unit: str) -> float:
    """Amperes in a unit of current."""
    try:
        if not re.fullmatch(r"[A-Za-zµμ]{0,20}", unit):
            raise ValueError(unit)
        return float(registry.Quantity(1.0, unit or "A").to("A").magnitude)
    except Exception:  # pint raises many kinds
        raise UnitError(
            f"'{unit}' is not a unit of current, which motor_constant needs. Write A or mA"
        ) from None
