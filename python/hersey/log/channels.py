"""Which column plays which role: found by name and unit, or named by the user."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import (
    ISOTHERMAL,
    ChannelError,
    ParameterError,
    Setting,
    UnitError,
    WrongKindError,
    meant,
    printable,
    way_in,
)
from hersey.log.signals import (
    apart,
    is_signal,
    of_an_input,
    per,
    says_how_much,
    signal_kind,
    way_out,
    way_out_unnamed,
)
from hersey.log.text.column import Column, with_ending
from hersey.schema.warning import Warning
from hersey.units import KINDS, Conversion, conversion, nearest_unit

#: Roles of a log's columns, in the order in which they are asked for.
ROLES = ("time", "torque", "speed", "temperature")
#: Roles of columns that a log may have beside them: normal load, radius at which a friction force acts, and
#: the number of a run.
OTHER_ROLES = ("load", "radius", "run")
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
}

_NAMES = {
    "time": r"t|time.*|.*\btime|.*datetime|.*zeit|timestamp|elapsed.*|.*seconds|epoch.*|unix.*",
    "torque": r".*torque.*|tq.*|.*\btq|.*moment.*|m",
    "speed": r".*speed.*|.*velocity.*|.*rpm.*|.*omega.*|.*drehzahl.*|n|w|ω",
    "temperature": r".*temp.*|.*thermistor.*|.*heater.*|.*thermocouple.*|.*film t.*",
    "load": r".*\bload(?! ?cell).*|.*normal ?(force|kraft).*|.*normalkraft.*|f_?n|.*axial ?force",
    "radius": r".*radius.*",
}
#: Names of what stands for a torque, or a speed of rotation, where the radius is known.
_FRICTION = {
    "friction coefficient": r"(.*\b)?cof\b.*|[µμ]|mu|.*(friction|traction|reib).*(coef|koef|beiwert|zahl).*",
    "force": r".*(friction|traction|reib).*|.*tangential.*(force|kraft).*|f_?[tf]",
    "belt speed": r"v|v_?(s|rel|slid).*|.*(slid|slip|gleit|surface|peripheral).*",
}
#: What has the unit of a speed of rotation and is none.
_OSCILLATION = re.compile(r"frequen[cz]|oscillat|oszillat", re.IGNORECASE)
#: Words of a name of a frequency, and what to do with that of an inverter.
_FREQUENCY = re.compile(r"fr[eé]q", re.IGNORECASE)
_INVERTER = "If it is the frequency of an inverter, divide by the pole pairs of the motor, e.g. for 2 use"
#: As many numbers, all the same, make a dead channel.
_TELLING = 20
#: A clock of a part of a run, beside which that of the whole run counts.
_PART_OF_A_RUN = re.compile(r"step|segment|interval|cycle|lap", re.IGNORECASE)
#: Characters of a name at the most.
_LONGEST_NAME = 200
#: Columns named in a message at the most.
_SHOWN = 40
_SETPOINT = re.compile(
    r"\b(set|sp\b|cmd|command|commanded|target|demand|reference|soll|nominal)", re.IGNORECASE
)


@dataclass(frozen=True)
class ChannelChoice:
    """What the user says of a role: column name and unit, empty where the file is to tell."""

    name: str = ""
    unit: str = ""


@dataclass(frozen=True)
class Stated:
    """What the user says of a log and a file need not hold, SI; None where it is not said.

    ``every`` is the time between rows, ``radius`` that at which a friction force acts and a sliding speed is
    measured, ``load`` the normal force; a tuple of them holds one for each run.
    """

    every: float | None = None
    radius: float | tuple[float, ...] | None = None
    load: float | tuple[float, ...] | None = None


def find_channel(
    role: str,
    columns: tuple[Column, ...],
    choice: ChannelChoice,
    file: str,
    dead: Callable[[Column], bool] = lambda _: False,
    taken: Mapping[str, Column] = MappingProxyType({}),
) -> tuple[Column, Conversion] | None:
    """Return the column of a role and the conversion to SI, or None if no column comes near it.

    ``dead`` tells whether a column says nothing; it is asked where several could play the role. ``taken``
    are the columns of other roles (`taken_columns`), of which none is proposed.

    Raises
    ------
    ChannelError
        If several columns could play the role, or the named one is not there.
    UnitError
        If the column that must be it has no unit, an unknown one, or one of another kind.
    """
    if choice.name:
        column = named_channel(role, columns, choice.name, file, taken)
        return _with_unit(role, column, choice, file, columns, taken)
    free = tuple(c for c in columns if c not in taken.values())
    candidates = _candidates(role, free) or _candidates(role, columns)
    if len(candidates) > 1:
        candidates = [c for c in candidates if not dead(c)] or candidates
    if not candidates:
        return None
    if len(candidates) > 1:
        listed = _either([str(c) for c in candidates])
        if len({c.path for c in candidates}) == 1:
            raise _repeated(role, candidates, file)
        raise ChannelError(
            f"{file}: the {role} column could be {listed}",
            columns=tuple(c.index for c in candidates),
            **_choose(role, candidates[0].path),
        )
    return _with_unit(role, candidates[0], choice, file, columns, taken)


def taken_columns(
    role: str,
    columns: tuple[Column, ...],
    choices: Mapping[str, ChannelChoice],
    chosen: Mapping[str, tuple[Column, Any]],
) -> dict[str, Column]:
    """Return the columns that play another role, by that role: named for it, or found before."""
    named = {other: called(choice.name, columns) for other, choice in choices.items() if choice.name}
    taken = {other: column for other, (column, _) in chosen.items()}
    taken |= {other: same[0] for other, same in named.items() if len(same) == 1}
    return {other: column for other, column in taken.items() if other != role}


def _candidates(role: str, columns: tuple[Column, ...]) -> list[Column]:
    """The columns that could play a role, by name and unit."""
    named = [c for c in columns if _is_named(_NAMES[role], c)]
    measured = [c for c in named if not _SETPOINT.search(c.name)]
    if not measured:  # what was asked for is not what came, if another column may hold that
        others = [c for c in columns if c not in named and c.unit and _could_be(role, c, surely=True)]
        measured = named + (others if named and role != "time" else [])
    # a column of another kind of unit is out; one without a unit could still be it
    return (
        _telling(role, [c for c in measured if _could_be(role, c)])
        or _in_friction(role, columns, measured)
        or [
            c
            for c in columns
            if c.unit and _could_be(role, c, surely=True) and not _OSCILLATION.search(c.name)
        ]
        or measured
    )


def _choose(role: str, path: str) -> dict[str, Any]:
    """The remedy where several columns could play a role."""
    channel = Setting(role, "channel")
    return {"remedy": f"choose one with {channel.to(path)}", "setting": channel}


def _is_named(pattern: str, column: Column) -> bool:
    """Whether a column is called so; longer than any name it is not, for the patterns would take long."""
    return len(column.name) <= _LONGEST_NAME and bool(re.fullmatch(pattern, column.name, re.IGNORECASE))


def channels_to(columns: Mapping[str, str]) -> str:
    """Return what to write so that columns play roles, by role."""
    if way_in() == "python":
        return f"channels={dict(columns)}"
    joint = " " if way_in() == "terminal" else ", "
    return joint.join(Setting(role, "channel").to(path) for role, path in columns.items())


def is_called(role: str, column: Column) -> bool:
    """Return whether a column has a name that columns of a role have."""
    return _is_named(_NAMES[role], column)


def is_frequency(name: str) -> bool:
    """Return whether the name of a column says that it holds a frequency."""
    return len(name) <= _LONGEST_NAME and _FREQUENCY.search(name) is not None


def is_dead(values: FloatArray) -> bool:
    """Return whether a channel says nothing: no number (NaN stands for a missing one), or one throughout."""
    known = values[np.isfinite(values)]
    return not known.size or (known.size >= _TELLING and float(known.min()) == float(known.max()))


def constant_channel(column: Column) -> Warning:
    """Return the warning of a channel that was passed over because it is dead."""
    return Warning(
        "constant channel passed over",
        "'{column}' is constant and was skipped",
        column=str(column),
    )


def role_conversion(role: str, unit: str) -> tuple[str, Conversion]:
    """Return the kind of what a column of a role holds, and its conversion to SI.

    ``unit`` may be that of one of a signal, as ``0.2 N*m/A``.

    Raises
    ------
    UnitError
        If the unit is unknown, or of no kind that the role can have.
    """
    text = "1" if unit in ("-", "\u2013") else apart(unit)[0]
    for kind in ROLE_KINDS[role]:
        if kind == "friction coefficient" and text != "1":  # % of a torque is none
            continue
        try:
            return kind, replace(conversion(kind, text), unit=unit)
        except WrongKindError:
            continue
    return ROLE_KINDS[role][0], conversion(ROLE_KINDS[role][0], unit)


def no_channel(role: str, columns: tuple[Column, ...], file: str) -> ChannelError:
    """Return the error for a role that no column plays."""
    channel = Setting(role, "channel")
    way_out = f"name it with {channel.to()}"
    if role == "torque" and any(is_of_kind("force", c.unit) for c in columns):
        way_out += f" (or a friction force, with {Setting('radius').to()} for the radius at which it acts)"
    elif signals := _signals(role, columns):
        way_out = way_out_unnamed(role, [each.path for each in signals], signals[0].unit)
    elif role == "time":
        way_out += f", or give the time between rows with {EVERY.to('2 ms', python='0.002')}"
        way_out += f". If each row is the mean of one dwell, use {MEANS.to()}"
    elif role == "speed" and (of := next((c for c in columns if _may_be_of_an_inverter(c)), None)):
        between = " " if way_in() == "terminal" else " and "
        named = f"{channel.to(of.path)}{between}{Setting(role, 'unit').to('rev/s/2')}"
        way_out += (
            f". If '{of.path}' is the frequency of an inverter, divide by the pole pairs of the motor, e.g. "
            f"for 2 use {named}"
        )
    if role == "temperature":
        way_out += f", or use {ISOTHERMAL.to()} to exclude temperature"
    said = f"{file}: no {role} column found. Columns: {_listed(columns)}"
    return ChannelError(said, absent=True, remedy=way_out, setting=channel)


def _signals(role: str, columns: tuple[Column, ...]) -> list[Column]:
    """Columns of one unit, A or V, that may hold a role: a current only the torque."""
    for kind in "AV" if role == "torque" else "V" if role in ("speed", "temperature") else "":
        if found := [c for c in columns if signal_kind(c.unit) == kind]:
            return found
    return []


def _may_be_of_an_inverter(column: Column) -> bool:
    return column.unit == "Hz" or (is_frequency(column.name) and is_of_kind("speed", column.unit))


def refuse_two_roles(role: str, column: Column, chosen: Mapping[str, tuple[Column, Any]], file: str) -> None:
    """Raise if a column plays another role already.

    Raises
    ------
    ChannelError
        It names both roles.
    """
    for other, (taken, _) in chosen.items():
        if column == taken:
            raise ChannelError(
                f"{file}: column '{column}' cannot be both {other} and {role}. Name the {role} column with "
                f"{Setting(role, 'channel').to()}"
            )


def refuse_two_clocks(columns: tuple[Column, ...], stated: Stated, file: str) -> None:
    """Raise if the time between rows is stated beside a column of the time.

    Raises
    ------
    ParameterError
        It names the column.
    """
    clock = next((c for c in columns if is_called("time", c) and is_of_kind("time", c.unit)), None)
    if stated.every is not None and clock is not None:
        raise ParameterError(
            f"{file}: column '{clock}' is a clock, but {EVERY.to()} gives the time between rows as well",
            remedy=f"omit {EVERY.to()}, or rename the column if its times are wrong",
        )


def called(name: str, columns: tuple[Column, ...]) -> list[Column]:
    """Return the columns that a person may mean by a name; ``name#2`` is the second one of a name."""
    name = printable(name)  # as columns are known
    exact = [c for c in columns if name in _spellings(c)]
    same = exact or [c for c in columns if name.lower() in {s.lower() for s in _spellings(c)}]
    repeated = re.fullmatch(r"(.+)#([1-9][0-9]?)", name)
    if same or not repeated:
        return same
    same = [c for c in columns if repeated[1].lower() in {s.lower() for s in _spellings(c)}]
    return same[int(repeated[2]) - 1 : int(repeated[2])]


def _spellings(c: Column) -> set[str]:
    with_unit = (f"{c.path} ({c.unit})", f"{c.name} ({c.unit})", f"{c.name} [{c.unit}]")
    return {c.name, c.path, str(c), *with_unit, *with_ending(c.name, c.unit)}


def named_channel(
    role: str,
    columns: tuple[Column, ...],
    name: str,
    file: str,
    taken: Mapping[str, Column] = MappingProxyType({}),
) -> Column:
    """Return the column that a person names for a role, whatever its unit; ``taken`` are those with a role.

    Raises
    ------
    ChannelError
        If there is none, or several.
    """
    same = called(name, columns)
    if not same:
        free = [c for c in columns if c not in taken.values()]
        near = meant(name, [*(c.path for c in free), *(str(c) for c in free)])
        channel = Setting(role, "channel")
        raise ChannelError(
            f"{file}: there is no column '{name}' ({role}). Columns: {_listed(columns)}",
            remedy=f"did you mean {channel.to(near)}?" if near else "",
            setting=channel,
        )
    if len(same) > 1 and len({c.path for c in same}) == 1:
        raise _repeated(role, same, file)
    if len(same) > 1:
        listed = _either([str(c) for c in same])
        raise ChannelError(f"{file}: '{name}' ({role}) could be {listed}", **_choose(role, same[0].path))
    return same[0]


def _repeated(role: str, columns: list[Column], file: str) -> ChannelError:
    path = columns[0].path
    listed = _either([f"{path}#{i + 1}" for i in range(len(columns))])
    return ChannelError(
        f"{file}: {len(columns)} columns are called '{path}'. Refer to them as {listed}",
        columns=tuple(c.index for c in columns),
        **_choose(role, f"{path}#1"),
    )


def _either(names: list[str]) -> str:
    """Names to choose from, the first of them where there are very many."""
    listed = " or ".join(f"'{name}'" for name in names[:_SHOWN])
    return listed + (f" or {len(names) - _SHOWN} more" if len(names) > _SHOWN else "")


def _listed(columns: tuple[Column, ...]) -> str:
    """Columns with their units, the first of them where there are very many."""
    listed = ", ".join(f"'{c}'" for c in columns[:_SHOWN])
    return listed + (f" and {len(columns) - _SHOWN} more" if len(columns) > _SHOWN else "")


def _could_be(role: str, column: Column, surely: bool = False) -> bool:
    """Whether the unit allows the role; one that is missing or unknown does, unless asked to be sure."""
    if role == "time" and re.search("rad|rev|turn", column.unit):  # angles have no dimension
        return False
    try:
        return bool(column.unit and conversion(ROLE_KINDS[role][0], column.unit)) or not surely
    except WrongKindError:
        return False
    except UnitError:
        return not surely


def _telling(role: str, candidates: list[Column]) -> list[Column]:
    """The candidates without those that others put in the shade.

    A letter without a unit beside a name with one, and the clock of a step beside that of the run.
    """
    if any(c.unit and _could_be(role, c, surely=True) for c in candidates):
        candidates = [c for c in candidates if c.unit or len(c.name) > 1]
    if role == "time":
        candidates = [c for c in candidates if not _PART_OF_A_RUN.search(c.name)] or candidates
    return candidates


def _in_friction(role: str, columns: tuple[Column, ...], measured: list[Column]) -> list[Column]:
    """Columns of a friction force, or else a coefficient, or of a sliding speed."""
    if role == "speed":
        sliding = [c for c in columns if _is_named(_FRICTION["belt speed"], c)]
        return [c for c in measured or sliding if is_of_kind("belt speed", c.unit)]
    if role != "torque":
        return []
    coefficients = [c for c in columns if _is_named(_FRICTION["friction coefficient"], c)]
    forces = [c for c in columns if _is_named(_FRICTION["force"], c) and c not in coefficients]
    forces = [c for c in forces if not c.unit or is_of_kind("force", c.unit)]
    return (
        forces
        or [c for c in measured if is_of_kind("force", c.unit)]
        or [c for c in coefficients if not c.unit or c.unit in ("1", "-", "\u2013")]
    )


def is_of_kind(kind: str, unit: str) -> bool:
    """Return whether a unit is one of a kind of quantity."""
    try:
        return bool(unit and conversion(kind, unit))
    except UnitError:
        return False


def _with_unit(
    role: str,
    column: Column,
    choice: ChannelChoice,
    file: str,
    columns: tuple[Column, ...],
    taken: Mapping[str, Column],
) -> tuple[Column, Conversion]:
    unit = choice.unit or column.unit
    if not unit and role == "torque" and _is_named(_FRICTION["friction coefficient"], column):
        unit = "1"
    if role == "run":
        return column, Conversion(unit, 1.0, 0.0)
    if not unit:
        of_a_force = role == "torque" and _is_named(_FRICTION["force"], column)
        of_sliding = role == "speed" and _is_named(_FRICTION["belt speed"], column)
        kind = "force" if of_a_force else "belt speed" if of_sliding else ROLE_KINDS[role][0]
        example = KINDS[kind][1]
        raise UnitError(
            f"{file}: column '{column.path}' has no unit",
            columns=(column.index,),
            remedy=(
                f"write '{column.name} [{example}]' in the header, add a row of units, or use "
                f"{Setting(role, 'unit').to(example)}{of_an_input(role, column.name)}"
            ),
            setting=Setting(role, "unit"),
        )
    try:
        line = role_conversion(role, unit)[1]
    except UnitError as error:
        swapped = _swapped(role, column, unit, columns, taken)
        raise UnitError(
            f"{file}: column '{column.path}': {error.reason}{swapped[0]}",
            columns=(column.index,),
            remedy=swapped[1] or _right_unit(role, column.unit if is_signal(column.unit) else unit),
            setting=Setting(role, "unit"),
            likely="" if swapped[1] or is_signal(unit) else nearest_unit(ROLE_KINDS[role][0], unit),
        ) from None
    return column, replace(line, scale=line.scale * _signal_in(role, column, unit, file))


def _signal_in(role: str, column: Column, unit: str, file: str) -> float:
    """How many of the signal that the unit is for, if it is for any, one in the column is."""
    try:
        if is_signal(column.unit) and not says_how_much(unit):
            raise ValueError(unit)
        return per(unit, column.unit)
    except ValueError:
        raise UnitError(
            f"{file}: column '{column.path}' is in {column.unit}, but the unit given for it is '{unit}'",
            columns=(column.index,),
            remedy=(
                way_out(role, column.unit)
                if is_signal(column.unit)
                else f"omit it, or write the unit of the column as {apart(unit)[1]} in the header"
            ),
            setting=Setting(role, "unit"),
        ) from None


def _swapped(
    role: str, column: Column, unit: str, columns: tuple[Column, ...], taken: Mapping[str, Column]
) -> tuple[str, str]:
    """What else a column of a unit that the role cannot have may be, and the remedy; or nothing."""
    elsewhere = next((r for r in ROLES if r != role and _could_be(r, column, surely=True)), "")
    others = [c for c in columns if c != column and c.unit and _could_be(role, c, surely=True)]
    both = [c for c in others if elsewhere and taken.get(elsewhere) == c]
    others = [c for c in others if c not in taken.values()] or both
    if not (others and elsewhere) or unit != column.unit:
        return "", ""
    swapped = {role: others[0].path} | ({elsewhere: column.path} if others == both else {})
    said = f", but a unit of {elsewhere}. Are the columns swapped?"
    return said, f"use {channels_to(swapped)}"


def _right_unit(role: str, unit: str) -> str:
    """What to do where a column has a unit that its role cannot have."""
    setting = Setting(role, "unit")
    if is_signal(unit) and role != "time":
        return way_out(role, unit)
    if role == "speed" and unit.strip() in ("Hz", "1/s"):
        turns = f"if it means revolutions, use {setting.to('rev/s')}"
        return f"{turns}. {_INVERTER} {setting.to('rev/s/2')}" if unit.strip() == "Hz" else turns
    kind = ROLE_KINDS[role][0]
    return f"use {setting.to(nearest_unit(kind, unit) or KINDS[kind][1])}, or correct the header"
