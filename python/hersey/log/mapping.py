"""`hersey.toml`: which channel plays which role, proposed once, kept beside the data, reused.

A table for each role (``time``, ``torque``, ``speed``, ``temperature``) names the channel and its unit, and
holds what must be corrected: sign, tare, gears, motor constant, offsets. Every value with a dimension is
written with its unit.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import field, fields, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, ValidationInfo
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
from hersey.files.toml import Quantity, Table, Text, naming, quoted, read_tables, read_toml
from hersey.log import corrections
from hersey.log.channels import (
    OTHER_ROLES,
    ROLE_KINDS,
    ROLES,
    ChannelChoice,
    Stated,
    called,
    find_channel,
    is_dead,
    role_conversion,
)
from hersey.log.columns import open_columns
from hersey.log.corrections import Corrected
from hersey.log.quantities import Amount, amount
from hersey.log.reading import list_channels, read
from hersey.log.sensor_tables import SpeedErrors, TemperatureErrors, TorqueErrors, sensors_of
from hersey.log.sensors import Sensors
from hersey.log.stating import proposed
from hersey.log.text.delimited import Progress
from hersey.log.text.layout import Column
from hersey.log.torque_log import LogFile
from hersey.units import Conversion, registry, takes_si

#: A mapping for every log in its directory; one for a single log is called after it, ``bench.hersey.toml``.
FILE_NAME = "hersey.toml"
_SUFFIX = ".hersey.toml"
_ALL_ROLES = (*ROLES, *OTHER_ROLES)


class _NoLoad(Quantity):
    """A torque, or a log of it beside the mapping, unless its path is absolute."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> Any:
        """Return the torque in SI or the path."""
        if info.context is None or not isinstance(given, str) or amount(given):
            return super().checked(given, info)
        named = info.context.path.parent / given
        if not os.path.isfile(named):  # noqa: PTH113 - a name too long for the system is none
            raise ParameterError(f"is '{given}': write a torque such as \"4 mN*m\", or a log that is there")
        return named


def _sign(given: object) -> object:
    if isinstance(given, bool) or given not in (1, -1):
        raise ParameterError(f"is {given!r}: write 1 or -1")
    return given


_Sign = Annotated[int, BeforeValidator(_sign)]
_GearRatio = Annotated[float, Quantity(None, 1e-4, 1e4, "12.5")]


#: Keys of a role that state no correction.
_NO_CORRECTIONS = ("channel", "unit", "gain_error", "zero_error", "film_heating")


@dataclass(frozen=True)
class RoleMapping(Table):
    """What a mapping says of one role; ``channel`` and ``unit`` are empty where the log is to tell."""

    channel: Text = ""
    unit: Text = ""


@dataclass(frozen=True)
class TimeMapping(RoleMapping):
    """What it says of the time; ``every`` is that between rows, s, where no channel is a clock."""

    every: Annotated[float, Quantity("time", 1e-9, 1e6, "2 ms")] | None = None


@dataclass(frozen=True)
class LoadMapping(RoleMapping):
    """What it says of the normal load, N: a channel, a ``value``, or ``values``, one for each run."""

    value: Annotated[float, Quantity("force", 1e-9, 1e9, "50 N")] | None = None
    values: tuple[Annotated[float, Quantity("force", 1e-9, 1e9, "50 N")], ...] = ()


@dataclass(frozen=True)
class RadiusMapping(RoleMapping):
    """What it says of the radius of a friction force, m: as `LoadMapping`."""

    value: Annotated[float, Quantity("length", 1e-6, 1e3, "25 mm")] | None = None
    values: tuple[Annotated[float, Quantity("length", 1e-6, 1e3, "25 mm")], ...] = ()


@dataclass(frozen=True)
class TorqueMapping(TorqueErrors, RoleMapping):
    """What it says of the torque, in SI; ``no_load`` is a torque or a log."""

    sign: _Sign = 1
    motor_constant: Annotated[float, Amount("motor constant", 1e-6, 1e3, "35 mN*m/A")] | None = None
    tare: Annotated[float, Quantity("torque", -1e6, 1e6, "4 mN*m")] = 0.0
    no_load: Annotated[float | Path, _NoLoad("torque", 0.0, 1e6, "4 mN*m")] = 0.0
    gear_ratio: _GearRatio = 1.0
    efficiency: Annotated[float, Quantity(None, 0.05, 1.0, "0.9")] = 1.0
    inertia: Annotated[float, Amount("moment of inertia", 1e-12, 1e6, "2e-4 kg*m^2")] = 0.0


@dataclass(frozen=True)
class SpeedMapping(SpeedErrors, RoleMapping):
    """What it says of the speed."""

    sign: _Sign = 1
    gear_ratio: _GearRatio = 1.0


@dataclass(frozen=True)
class TemperatureMapping(TemperatureErrors, RoleMapping):
    """What it says of the temperature, in SI: film minus reading, the lag of the sensor, their bounds."""

    offset: Annotated[float, Amount("temperature difference", -100.0, 100.0, "-1.5 K")] = 0.0
    time_constant: Annotated[float, Quantity("time", 1e-3, 1e4, "4 s")] = 0.0


@dataclass(frozen=True)
class _Roles(Table):
    time: TimeMapping = field(default_factory=TimeMapping)
    torque: TorqueMapping = field(default_factory=TorqueMapping)
    speed: SpeedMapping = field(default_factory=SpeedMapping)
    temperature: TemperatureMapping = field(default_factory=TemperatureMapping)
    load: LoadMapping = field(default_factory=LoadMapping)
    radius: RadiusMapping = field(default_factory=RadiusMapping)
    run: RoleMapping = field(default_factory=RoleMapping)


@dataclass(frozen=True)
class LogMapping(_Roles):
    """Roles of the channels of a log, and what must be corrected.

    Attributes
    ----------
    time, torque, speed, temperature, load, radius, run
        One `RoleMapping` each; ``run`` is the number of a run.
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
            stated["torque"] = f"{_ampere(self.torque.unit):.12g} N*m"
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

    def turned(self, signs: Mapping[str, int]) -> LogMapping:
        """Return the mapping with the signs of torque and speed multiplied by those given by role.

        Raises
        ------
        ParameterError
            If a sign is neither 1 nor -1.
        """
        for role, value in signs.items():
            if value not in (1, -1):
                raise ParameterError(f"the sign of {role} is {value}: use {turned(role)}, or leave it out")
        torque, speed = (signs.get(role, 1) for role in ("torque", "speed"))
        return replace(
            self,
            torque=replace(self.torque, sign=self.torque.sign * torque),
            speed=replace(self.speed, sign=self.speed.sign * speed),
        )

    def correct(self, log: Any) -> Corrected:
        """Apply the corrections that are stated, in the order of `hersey.log.corrections`."""
        done = self._at_the_sensor(log)
        torque, speed, heat = self.torque, self.speed, self.temperature
        if isinstance(torque.no_load, Path):
            free = replace(self, torque=replace(torque, no_load=0.0))
            other = read(
                torque.no_load,
                channels=_without_temperature(self.channels),
                units=_without_temperature(self.units),
                isothermal=True,
                **vars(self.stated),
            )
            done = corrections.no_load(done, torque=free._at_the_sensor(other))
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
        if done.log.has_temperature and heat.time_constant:
            done = corrections.thermal_lag(done, time_constant=heat.time_constant)
        if done.log.has_temperature and heat.offset:
            done = corrections.temperature_offset(done, offset=heat.offset)
        return done

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
    """Read a mapping; every table and key is checked, every value with a dimension needs its unit.

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key.
    """
    path = Path(path)
    if "drivetrain" in read_toml(path):
        raise ParameterError(
            f"{path.name} is a machine's file, with [drivetrain], and no mapping of a log: "
            f"give it as {Setting('machine').to(printable(str(path)))}"
        )
    mapping = LogMapping(**vars(read_tables(path, _Roles)), source=path)
    for role in ROLE_KINDS:
        with naming(f"{path.name}: {role}.unit"):
            _check_unit(role, getattr(mapping, role).unit, mapping.torque.motor_constant)
    return mapping


def _check_unit(role: str, unit: str, motor_constant: float | None) -> None:
    if role == "torque" and motor_constant is not None:
        _ampere(unit)
    elif unit:
        try:
            role_conversion(role, unit)
        except UnitError as error:
            hint = "; a motor's current needs motor_constant" if role == "torque" else ""
            raise UnitError(f"{error}{hint}") from None


def find_mapping(path: str | Path) -> Path | None:
    """Return the mapping of a log: ``bench.hersey.toml`` beside it, or `FILE_NAME` in its directory."""
    log = Path(path)
    beside = (log.parent / f"{log.stem}{_SUFFIX}", log.parent / FILE_NAME)
    # a name that the system finds too long is no file
    return next((candidate for candidate in beside if os.path.isfile(candidate)), None)  # noqa: PTH113


@takes_si(every="time", radius="length", load="force")
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
    progress: Progress | None = None,
) -> Corrected:
    """Read a log, or several, as `hersey.read` does, each with its mapping, and correct it.

    Parameters
    ----------
    mapping
        A mapping or its file for all of them; if none is given, what `find_mapping` finds beside them.
    channels, units
        By role; they outrank the mapping's. A role whose channel or unit is given so is not corrected for
        a motor constant.
    signs
        -1 by role, ``torque`` or ``speed``, turns the sign once more than the mapping does.
    isothermal, drop_missing, every, radius, load, progress
        As for `hersey.read`; they outrank the mapping's.

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
    chosen = _outranked(chosen, channels or {}, units or {}).turned(signs or {})
    stated = Stated(every, as_stated(radius), as_stated(load))
    chosen = without_what_is_said(chosen, channels or {}, stated)
    try:
        log = read(
            files,
            channels={**needed(chosen.channels), **(channels or {})},
            units={**needed(chosen.units), **(units or {})},
            isothermal=isothermal,
            drop_missing=drop_missing,
            **{name: value for name, value in vars(chosen.stated).items() if value is not None}
            | {name: value for name, value in vars(stated).items() if value is not None},
            progress=progress,
        )
        done = chosen.correct(log)
    except (ChannelError, UnitError) as error:
        if chosen.source is None:
            raise
        raise type(error)(f"{error} (channels and units are those of {chosen.source.name})") from None
    logged = tuple(_as_written(file, chosen) for file in log.files)
    return Corrected(replace(done.log, files=logged, sensors=chosen.sensors), done.corrections)


def propose_mapping(
    path: str | Path,
    *,
    channels: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
) -> str:
    """Return a mapping for the channels of a log as TOML, to be looked at, mended and kept.

    What cannot be told is left out, with a line that says why; what could be corrected is a comment.
    ``channels`` and ``units`` by role are taken as for `hersey.read`.

    Raises
    ------
    HerseyError
        If the file cannot be read.

    Examples
    --------
    >>> print(propose_mapping("examples/bench.csv").splitlines()[1])
    [torque]
    """
    path = Path(path)
    columns = tuple(Column(index, name, unit) for index, (name, unit) in enumerate(list_channels(path)))
    lines = [f"# Channels of {printable(path.name)}, proposed by hersey inspect: look at it and mend it."]
    for role in ("torque", "speed", "temperature", "time"):
        choice = ChannelChoice((channels or {}).get(role, ""), (units or {}).get(role, ""))
        lines += [*_proposed(role, columns, choice, path), ""]
    return "\n".join(lines)


_EXAMPLES: dict[str, tuple[str, ...]] = {
    "torque": (
        "# sign = -1                     # turns it",
        '# tare = "4 mN*m"               # what the sensor shows without load',
        '# no_load = "4 mN*m"            # torque of the drive without the film, or a log of it: "free.csv"',
        "# gear_ratio = 12.5             # turns of the shaft of the sensor for each turn of the roll",
        "# efficiency = 0.9              # of those gears",
        '# inertia = "2e-4 kg*m^2"       # seen at the roll, between sensor and film: matters in ramps',
        '# motor_constant = "35 mN*m/A"  # if the channel is the motor\'s current',
        '# gain_error = "1 %"            # of the sensor, at 95 %',
        '# zero_error = "2 mN*m"',
    ),
    "speed": (
        "# sign = -1",
        "# gear_ratio = 12.5             # turns of its shaft for each turn of the roll",
        '# gain_error = "0.1 %"          # of the sensor, at 95 %',
    ),
    "temperature": (
        '# offset = "-1.5 K"             # film minus reading',
        '# time_constant = "4 s"         # lag of the sensor',
        '# zero_error = "2 K"            # by how much the film may differ from the reading, at 95 %',
        '# film_heating = "3 K"          # by how much friction may heat it at the greatest power',
    ),
    "time": (),
}
#: What a friction force needs beside it: meaning and an amount of each role.
_BESIDE = {
    "radius": ("at which the friction force acts", "25 mm"),
    "load": ("normal load: a friction coefficient needs it", "50 N"),
}


def _proposed(role: str, columns: tuple[Column, ...], choice: ChannelChoice, path: Path) -> list[str]:
    channel: tuple[Column, Conversion] | None = None
    try:
        channel = find_channel(role, columns, choice, path.name, lambda column: _says_nothing(path, column))
        said = "no channel of the log is called so or has such a unit"
    except HerseyError as error:
        said = str(error).removeprefix(f"{path.name}: ")
    if channel is not None and not choice.name and _says_nothing(path, channel[0], zero=True):
        said = f"'{channel[0]}' is zero throughout, or empty: it is dead"
        channel = None
    if channel is None:
        return [f"# [{role}]", f"# {printable(said)}", '# channel = ""', '# unit = ""']
    column, unit = channel
    stated = [f"channel = {quoted(column.path)}", f"unit = {quoted(unit.unit)}"]
    kind = role_conversion(role, unit.unit)[0]
    others = _beside(columns, needed=kind in ("force", "friction coefficient")) if role == "torque" else []
    return [f"[{role}]", *stated, *_EXAMPLES[role], *others]


def _beside(columns: tuple[Column, ...], *, needed: bool) -> list[str]:
    """Radius and load, commented out: where a friction force needs them, or a column is called like one."""
    lines: list[str] = []
    for role, (meaning, amount_of) in _BESIDE.items():
        named = proposed(role, columns)
        if not (needed or named):
            continue
        lines += ["", f"# [{role}]".ljust(32) + f"# {meaning}", f'# value = "{amount_of}"']
        if named:
            said = f"column {printable(str(named[0]))} may be it: in the place of a value,"
            lines += [
                f"# # {said}",
                f"# channel = {quoted(named[0].path)}",
                f"# unit = {quoted(named[0].unit)}",
            ]
    return lines


def _says_nothing(path: Path, column: Column, *, zero: bool = False) -> bool:
    """Whether a channel of a log holds one value throughout, or none; ``zero``: only whether that is zero."""
    try:
        with open_columns(path) as opened:
            (values,) = opened.numbers(called(column.name, opened.columns)[0])
    except (HerseyError, IndexError):
        return False
    return is_dead(values) and not (zero and np.any(values[np.isfinite(values)]))


def mapping_of(files: Sequence[str | Path], stated: str | Path | None = None) -> LogMapping:
    """Return the stated mapping, or the one that `find_mapping` finds beside all files, or an empty one.

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
        raise ParameterError(f"the logs have different mappings ({names}): name one with {MAPPING.to()}")
    only = next(iter(beside), None)
    return LogMapping() if only is None else read_mapping(only)


def _without_temperature(stated: Mapping[str, str]) -> dict[str, str]:
    return {role: value for role, value in stated.items() if role != "temperature"}


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
    notes = file.notes
    if mapping.source is not None:
        notes = (*notes, f"channels, units and corrections are those of {mapping.source.name}")
    if mapping.torque.motor_constant is None:
        return replace(file, notes=notes)
    unit = mapping.torque.unit or "A"
    used = tuple(replace(c, unit=unit) if c.role == "torque" else c for c in file.channels)
    return replace(file, notes=notes, channels=used)


def _ampere(unit: str) -> float:
    """Amperes in a unit of current."""
    try:
        if not re.fullmatch(r"[A-Za-zµμ]{0,20}", unit):
            raise ValueError(unit)
        return float(registry.Quantity(1.0, unit or "A").to("A").magnitude)
    except Exception:  # pint raises many kinds
        raise UnitError(
            f"'{unit}' is no unit of a current, which motor_constant needs: write A or mA"
        ) from None
