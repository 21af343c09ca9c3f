"""`hersey.toml`: which channel plays which role, proposed once, kept beside the data, reused.

A table for each role (``time``, ``torque``, ``speed``, ``temperature``) names the channel and its unit, and
holds what must be corrected: sign, tare, gears, motor constant, offsets. Every value with a dimension is
written with its unit.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from hersey.errors import ChannelError, HerseyError, ParameterError, UnitError
from hersey.files.toml import read_toml
from hersey.log import corrections
from hersey.log.channels import ROLES, ChannelChoice, find_channel
from hersey.log.corrections import Corrected
from hersey.log.reading import list_channels, read
from hersey.log.text.delimited import Progress
from hersey.log.text.layout import Column
from hersey.log.torque_log import LogFile
from hersey.units import conversion, parse, registry

#: A mapping for every log in its directory; one for a single log is called after it, ``bench.hersey.toml``.
FILE_NAME = "hersey.toml"
_SUFFIX = ".hersey.toml"
_FACTOR = r"[A-Za-zµμ]{1,20}(?:(?:\^|\*\*)[1-4])?"  # nothing that pint would compute for ever
_AMOUNT = re.compile(
    rf"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*({_FACTOR}(?:\s*[*/.·]\s*{_FACTOR}){{0,4}})\s*"
)

#: Keys of each role's table, and the kind of value: a key of `_LIMITS`, ``text`` or ``log``.
_KEYS: dict[str, dict[str, str]] = {
    "time": {"channel": "text", "unit": "text"},
    "torque": {
        "channel": "text",
        "unit": "text",
        "sign": "sign",
        "motor_constant": "motor constant",
        "tare": "torque",
        "no_load": "no-load torque",
        "gear_ratio": "gear ratio",
        "efficiency": "efficiency",
        "inertia": "moment of inertia",
    },
    "speed": {"channel": "text", "unit": "text", "sign": "sign", "gear_ratio": "gear ratio"},
    "temperature": {
        "channel": "text",
        "unit": "text",
        "offset": "temperature difference",
        "time_constant": "duration",
    },
}
#: SI unit (empty for plain numbers), an example, least and greatest value believed.
_LIMITS: dict[str, tuple[str, str, float, float]] = {
    "motor constant": ("N*m/A", "35 mN*m/A", 1e-6, 1e3),
    "torque": ("N*m", "4 mN*m", -1e6, 1e6),
    "no-load torque": ("N*m", "4 mN*m", 0.0, 1e6),
    "gear ratio": ("", "12.5", 1e-4, 1e4),
    "efficiency": ("", "0.9", 0.05, 1.0),
    "moment of inertia": ("kg*m^2", "2e-4 kg*m^2", 1e-12, 1e6),
    "temperature difference": ("K", "-1.5 K", -100.0, 100.0),
    "duration": ("s", "4 s", 1e-3, 1e4),
}


@dataclass(frozen=True)
class RoleMapping:
    """What a mapping says of one role, in SI; ``channel`` and ``unit`` are empty where the log is to tell."""

    channel: str = ""
    unit: str = ""
    sign: int = 1
    gear_ratio: float = 1.0
    efficiency: float = 1.0
    tare: float = 0.0
    no_load: float | Path = 0.0
    inertia: float = 0.0
    motor_constant: float | None = None
    offset: float = 0.0
    time_constant: float = 0.0


@dataclass(frozen=True)
class LogMapping:
    """Roles of the channels of a log, and what must be corrected.

    Attributes
    ----------
    time, torque, speed, temperature
        One `RoleMapping` each.
    source
        File that it was read from, or none.
    """

    time: RoleMapping = field(default_factory=RoleMapping)
    torque: RoleMapping = field(default_factory=RoleMapping)
    speed: RoleMapping = field(default_factory=RoleMapping)
    temperature: RoleMapping = field(default_factory=RoleMapping)
    source: Path | None = None

    @property
    def channels(self) -> dict[str, str]:
        """Column name by role, where one is stated, as `hersey.read` takes it."""
        return {role: own.channel for role in ROLES if (own := getattr(self, role)).channel}

    @property
    def units(self) -> dict[str, str]:
        """Unit by role, where one is stated, as `hersey.read` takes it; amperes stand in the place of N m."""
        stated = {role: own.unit for role in ROLES if (own := getattr(self, role)).unit}
        if self.torque.motor_constant is not None:
            stated["torque"] = f"{_ampere(self.torque.unit):.12g} N*m"
        return stated

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
    document = read_toml(path)
    unknown = sorted(set(document) - set(ROLES))
    if unknown:
        raise ParameterError(f"{path.name}: there is no table '{unknown[0]}': {', '.join(ROLES)} are known")
    roles = {role: _role(path, role, document[role]) for role in ROLES if role in document}
    mapping = LogMapping(**roles, source=path)
    if mapping.torque.motor_constant is not None:
        try:
            _ampere(mapping.torque.unit)
        except UnitError as error:
            raise UnitError(f"{path.name}: torque.unit: {error}") from None
    return mapping


def find_mapping(path: str | Path) -> Path | None:
    """Return the mapping of a log: ``bench.hersey.toml`` beside it, or `FILE_NAME` in its directory."""
    log = Path(path)
    beside = (log.parent / f"{log.stem}{_SUFFIX}", log.parent / FILE_NAME)
    return next((candidate for candidate in beside if candidate.is_file()), None)


def read_with_mapping(
    paths: str | Path | Sequence[str | Path],
    *,
    mapping: LogMapping | str | Path | None = None,
    channels: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    isothermal: bool = False,
    drop_missing: bool = False,
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
    isothermal, drop_missing, progress
        As for `hersey.read`.

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
    own = _without_temperature if isothermal else dict
    chosen = mapping if isinstance(mapping, LogMapping) else mapping_of(files, mapping)
    chosen = _outranked(chosen, channels or {}, units or {})
    try:
        log = read(
            files,
            channels={**own(chosen.channels), **(channels or {})},
            units={**own(chosen.units), **(units or {})},
            isothermal=isothermal,
            drop_missing=drop_missing,
            progress=progress,
        )
        done = chosen.correct(log)
    except (ChannelError, UnitError) as error:
        if chosen.source is None:
            raise
        raise type(error)(f"{error} (channels and units are those of {chosen.source.name})") from None
    logged = tuple(_as_written(file, chosen) for file in log.files)
    return Corrected(replace(done.log, files=logged), done.corrections)


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
    lines = [f"# Channels of {path.name}, proposed by hersey inspect: look at it and mend it."]
    for role in ("torque", "speed", "temperature", "time"):
        choice = ChannelChoice((channels or {}).get(role, ""), (units or {}).get(role, ""))
        lines += [*_proposed(role, columns, choice, path.name), ""]
    return "\n".join(lines)


_EXAMPLES = {
    "torque": (
        "# sign = -1                     # turns it",
        '# tare = "4 mN*m"               # what the sensor shows without load',
        '# no_load = "4 mN*m"            # torque of the drive without the film, or a log of it: "free.csv"',
        "# gear_ratio = 12.5             # turns of the shaft of the sensor for each turn of the roll",
        "# efficiency = 0.9              # of those gears",
        '# inertia = "2e-4 kg*m^2"       # seen at the roll, between sensor and film: matters in ramps',
        '# motor_constant = "35 mN*m/A"  # if the channel is the motor\'s current',
    ),
    "speed": (
        "# sign = -1",
        "# gear_ratio = 12.5             # turns of its shaft for each turn of the roll",
    ),
    "temperature": (
        '# offset = "-1.5 K"             # film minus reading',
        '# time_constant = "4 s"         # lag of the sensor',
    ),
    "time": (),
}


def _proposed(role: str, columns: tuple[Column, ...], choice: ChannelChoice, file: str) -> list[str]:
    try:
        found = find_channel(role, columns, choice, file)
        said = "no channel of the log is called so or has such a unit"
    except HerseyError as error:
        found, said = None, str(error).removeprefix(f"{file}: ")
    if found is None:
        return [f"# [{role}]", f"# {said}", '# channel = ""', '# unit = ""']
    column, unit = found
    stated = [f"channel = {_quoted(column.path)}", f"unit = {_quoted(unit.unit)}"]
    return [f"[{role}]", *stated, *_EXAMPLES[role]]


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)  # a JSON string is one of TOML


def mapping_of(files: Sequence[str | Path], stated: str | Path | None = None) -> LogMapping:
    """Return the stated mapping, or the one that `find_mapping` finds beside all files, or an empty one.

    Raises
    ------
    ParameterError
        If it finds several, or it is wrong.
    """
    if stated is not None:
        return read_mapping(stated)
    found = {find_mapping(file) for file in files}
    if len(found) > 1:
        names = ", ".join(sorted(f"'{path.name}'" if path else "none" for path in found))
        raise ParameterError(f"the logs have different mappings ({names}): name one with --mapping")
    only = next(iter(found), None)
    return LogMapping() if only is None else read_mapping(only)


def _without_temperature(stated: Mapping[str, str]) -> dict[str, str]:
    return {role: value for role, value in stated.items() if role != "temperature"}


def _outranked(mapping: LogMapping, channels: Mapping[str, str], units: Mapping[str, str]) -> LogMapping:
    """The mapping without what a channel or unit given by hand makes void."""
    if "torque" not in channels and "torque" not in units:
        return mapping
    return replace(mapping, torque=replace(mapping.torque, motor_constant=None))


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


def _role(path: Path, role: str, table: object) -> RoleMapping:
    if not isinstance(table, dict):
        raise ParameterError(f"{path.name}: {role} is not a table: write [{role}]")
    known = _KEYS[role]
    unknown = sorted(set(table) - set(known))
    if unknown:
        raise ParameterError(f"{path.name}: [{role}] has no key '{unknown[0]}': {', '.join(known)} are known")
    values = {key: _value(path, f"{role}.{key}", value, known[key]) for key, value in table.items()}
    if "unit" in values and "motor_constant" not in values and values["unit"]:
        try:
            conversion(role, values["unit"])
        except UnitError as error:
            hint = "; a motor's current needs motor_constant" if role == "torque" else ""
            raise UnitError(f"{path.name}: {role}.unit: {error}{hint}") from None
    return RoleMapping(**values)


def _value(path: Path, key: str, value: object, kind: str) -> Any:
    if kind == "text":
        if not isinstance(value, str) or not value.strip():
            raise ParameterError(f"{path.name}: {key} is {value!r}: write a text")
        return value
    if kind == "sign":
        if isinstance(value, bool) or value not in (1, -1):
            raise ParameterError(f"{path.name}: {key} is {value!r}: write 1 or -1")
        return value
    if kind == "no-load torque" and isinstance(value, str) and _AMOUNT.fullmatch(value) is None:
        return _other_log(path, key, value)
    si, example, low, high = _LIMITS[kind]
    number = _amount(path, key, value, kind) if si else _plain(path, key, value, example)
    if not low <= number <= high:
        raise ParameterError(
            f"{path.name}: {key} is {value}: {low:g} to {high:g} {si}".rstrip() + " is believed"
        )
    return number


def _plain(path: Path, key: str, value: object, example: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ParameterError(f"{path.name}: {key} is {value!r}: write a number such as {example}")
    return float(value)


def _amount(path: Path, key: str, value: object, kind: str) -> float:
    """SI value of a text such as ``"35 mN*m/A"``."""
    si, example, *_ = _LIMITS[kind]
    if not isinstance(value, str):
        raise UnitError(f'{path.name}: {key} is {value}: write a string with its unit, such as "{example}"')
    if kind in ("torque", "no-load torque", "duration"):
        try:
            return parse("time" if kind == "duration" else "torque", value)
        except UnitError as error:
            raise UnitError(f"{path.name}: {key}: {error}") from None
    match = _AMOUNT.fullmatch(value)
    try:
        if match is None:
            raise ValueError(value)
        unit = registry.parse_units(re.sub("[.·]", "*", match[2]))
        if kind == "temperature difference" and str(unit).startswith("degree"):
            raise ValueError(value)
        number = float(registry.Quantity(float(match[1]), unit).to(si).magnitude)
    except Exception:  # pint raises many kinds, from its tokenizer too
        raise UnitError(
            f"{path.name}: {key} is '{value}': write a number and a unit of {kind}, such as \"{example}\""
        ) from None
    return number


def _other_log(path: Path, key: str, value: str) -> Path:
    """A log named in a mapping, beside it unless its path is absolute."""
    named = path.parent / value
    if not named.is_file():
        raise ParameterError(
            f"{path.name}: {key} is '{value}': write a torque such as \"4 mN*m\", or a log that is there"
        )
    return named


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
