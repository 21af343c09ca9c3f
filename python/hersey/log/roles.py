"""Roles of a log's columns: their names, and the kinds of units that they may have."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from hersey.arguments.door import Keys
from hersey.errors import Setting, UnitError, WrongKindError, way_in
from hersey.log.signals import apart
from hersey.log.text.column import Column
from hersey.log.words import ELAPSED, OF_THE_DAY, STAMPED, TIME_ALONE
from hersey.log.words import NAMES as IN_OTHER_LANGUAGES
from hersey.units import Conversion, conversion, of_encoder

#: Roles of a log's columns, in the order in which they are asked for.
ROLES = ("time", "torque", "speed", "temperature")
#: Roles of columns that a log may have beside them: normal load, radius at which a friction force acts, the
#: number of a run, a position in the place of a speed, and the direction of a speed without a sign.
OTHER_ROLES = ("load", "radius", "run", "position", "direction")
#: Dictionaries by role that functions take, of a log and of a table of means.
CHANNELS = Keys((*ROLES, *OTHER_ROLES), "{'torque': 'Torque 1'}")
UNITS = Keys(CHANNELS, "{'torque': 'Nm'}", "_unit")
SIGNS = Keys(("torque", "speed"), "{'torque': -1}", "_sign")
#: What a person sets beside the channels.
EVERY = Setting("every")
MEANS = Setting("means", "switch")
#: What a column of a role may hold, kinds of units: the first where there is a choice.
ROLE_KINDS: dict[str, tuple[str, ...]] = {
    "time": ("time",),
    "torque": ("torque", "force", "friction coefficient"),
    "speed": ("speed", "belt speed"),
    "temperature": ("temperature",),
    "load": ("force",),
    "radius": ("length",),
    "position": ("angle", "length"),
}
_NAMES = {
    "time": r"t|time.*|.*\btime|.*datetime|.*zeit|timestamp|micros|millis|elapsed.*|.*seconds|epoch.*|unix.*",
    "torque": r".*torque.*|tq.*|.*\btq|.*moment.*|m",
    "speed": r".*speed.*|.*velocity.*|.*velo|.*rpm.*|.*omega.*|.*drehzahl.*|n|w|ω",
    "temperature": r"(?!tempo([^a-z]|$)).*temp.*|.*thermistor.*|.*heater.*|.*thermocouple.*|.*film t.*",
    "load": r".*\bload(?! ?cell).*|.*normal ?(force|kraft).*|.*normalkraft.*|f_?[nz]|.*axial ?force",
    "radius": r".*radius.*|(?!.*wear).*\btrack",
    "position": (
        r".*(angle|position|encoder|winkel|lage).*|phi|theta|pos"
        "|(.*[^a-z])?(enc|pulses?|impulse?)([^a-z].*)?"
    ),
}
#: Names of what stands for a torque, or a speed of rotation, where the radius is known.
_FRICTION_NAMES = {
    "friction coefficient": r"(.*\b)?cof\b.*|[µμ]|mu|.*(friction|traction|reib).*(coef|koef|beiwert|zahl).*",
    "force": r".*(friction|traction|reib).*|.*tangential.*(force|kraft).*|f_?[tf]",
    "belt speed": r"v|v_?(s|rel|slid).*|.*(slid|slip|gleit|surface|peripheral).*",
}
FRICTION_NAMES = {kind: f"{names}|{IN_OTHER_LANGUAGES[kind]}" for kind, names in _FRICTION_NAMES.items()}
#: Words of a name of a frequency, and what to do with that of an inverter.
_FREQUENCY = re.compile(r"fr[eé]q", re.IGNORECASE)
#: Names of columns that number rows or runs.
_NUMBER = re.compile(r"section|run|point|nr\.?|no\.?|index|step|#", re.IGNORECASE)
#: A torque or a speed in French.
_FRENCH = r"(.*[^a-z])?(couple|vitesse|r[eé]gime|frottement)([^a-z].*)?"
#: What may have elapsed beside a time.
_NO_TIME = r".*(rev|turn|cycle|dist|lap(?!s)).*"
#: Characters of a name at the most.
_LONGEST_NAME = 200


def channels_to(columns: Mapping[str, str]) -> str:
    """Return what to write so that columns play roles, by role."""
    if way_in() == "python":
        return f"channels={dict(columns)}"
    joint = " " if way_in() == "terminal" else ", "
    return joint.join(Setting(role, "channel").to(path) for role, path in columns.items())


def is_called(role: str, column: Column) -> bool:
    """Return whether a column has a name that columns of a role have."""
    return is_named(_NAMES[role], column) or is_named(IN_OTHER_LANGUAGES[role], column)


def called_so(role: str, columns: Sequence[Column]) -> list[Column]:
    """Return the columns that have a name of a role; in another language only where none has in English.

    ``temps`` are times in French and temperatures in English: no temperature beside French names.
    """
    named = [c for c in columns if is_called(role, c)]
    if role == "temperature" and any(is_named(_FRENCH, c) for c in columns):
        named = [c for c in named if c.name.lower() != "temps" or c.unit]
    plain = [c for c in named if len(c.name) > 1 and is_named(_NAMES[role], c)]
    return plain or named


def without_clock_of_day(candidates: list[Column]) -> list[Column]:
    """Return times without a clock of the day that stands beside the time since the start."""
    elapsed = [
        c
        for c in candidates
        if re.search(ELAPSED, c.name, re.IGNORECASE)
        and is_of_kind("time", c.unit or "s")
        and (c.unit or not is_named(_NO_TIME, c))
    ]
    clocks = OF_THE_DAY if not elapsed else f"{OF_THE_DAY}|{STAMPED}"
    elapsed = elapsed or [c for c in candidates if is_named(TIME_ALONE, c)]
    return [c for c in candidates if c in elapsed or not is_named(clocks, c)] if elapsed else candidates


def is_named(pattern: str, column: Column) -> bool:
    """Return whether a column is called so; a very long name is not, as patterns take long."""
    return len(column.name) <= _LONGEST_NAME and bool(re.fullmatch(pattern, column.name, re.IGNORECASE))


def only_left(columns: Iterable[Column]) -> str:
    """Return the column that is called like no role, if there is one alone; nothing otherwise."""
    left = [c for c in columns if not _NUMBER.fullmatch(c.name) and not any(is_called(r, c) for r in _NAMES)]
    return left[0].path if len(left) == 1 else ""


def is_frequency(name: str) -> bool:
    """Return whether the name of a column says that it holds a frequency."""
    return len(name) <= _LONGEST_NAME and _FREQUENCY.search(name) is not None


def is_of_kind(kind: str, unit: str) -> bool:
    """Return whether a unit is one of a kind of quantity."""
    try:
        return bool(unit and conversion(kind, unit))
    except UnitError:
        return False


def could_be(role: str, column: Column, surely: bool = False) -> bool:
    """Return whether the unit allows the role; a missing or unknown one does, unless asked to be sure."""
    if role == "time" and re.search("rad|rev|turn", column.unit):  # angles have no dimension
        return False
    try:
        return bool(column.unit and conversion(ROLE_KINDS[role][0], column.unit)) or not surely
    except WrongKindError:
        return False
    except UnitError:
        return not surely


def role_conversion(role: str, unit: str) -> tuple[str, Conversion]:
    """Return the kind of what a column of a role holds, and its conversion to SI.

    ``unit`` may be that of one of a signal, as ``0.2 N*m/A``.

    Raises
    ------
    UnitError
        If the unit is unknown, or of no kind that the role can have.
    """
    text = "1" if unit in ("-", "\u2013") else apart(unit)[0]
    if role == "position" and (text in ("1", "%") or of_encoder(f"{text}/s")):
        raise UnitError(f"unit '{unit}' does not say how large an angle is")
    counted = role == "speed" and of_encoder(text)  # no other kind of speed knows these
    for kind in ROLE_KINDS[role][:1] if counted else ROLE_KINDS[role]:
        if kind == "friction coefficient" and text != "1":  # % of a torque is none
            continue
        try:
            return kind, replace(conversion(kind, text), unit=unit)
        except WrongKindError:
            continue
    return ROLE_KINDS[role][0], conversion(ROLE_KINDS[role][0], unit)
