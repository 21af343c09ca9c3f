"""Which column plays which role: found by name and unit, or named by the user."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ISOTHERMAL, ChannelError, Setting, meant, printable, way_in
from hersey.log.elsewhere import speed_elsewhere, stated_in_names, typed
from hersey.log.long_arrays import ends
from hersey.log.own_tables import not_a_log, own_table
from hersey.log.pressures import force_of_pressures
from hersey.log.role_units import with_unit
from hersey.log.roles import (
    EVERY,
    FRICTION_NAMES,
    MEANS,
    called_so,
    could_be,
    is_called,
    is_frequency,
    is_named,
    is_of_kind,
    only_left,
    without_clock_of_day,
)
from hersey.log.signals import may_be_current, signal_kind, way_out_unnamed
from hersey.log.text.column import Column, with_ending
from hersey.log.words import LUBRICANT, SET_POINT
from hersey.schema.warning import Warning
from hersey.units import Conversion

#: What has the unit of a speed of rotation and is none.
_OSCILLATION = re.compile(r"frequen[cz]|oscillat|oszillat", re.IGNORECASE)
#: As many numbers, all the same, make a dead channel.
_TELLING = 20
#: Names of the temperature of the lubricant, beside which that of a heater, a room or a motor is another.
_OF_LUBRICANT = re.compile(rf"\b(lub\w*|oil|grease|pot|bath|[oö]l|schmier\w*)|{LUBRICANT}", re.IGNORECASE)
#: A clock of a part of a run, beside which that of the whole run counts.
_PART_OF_A_RUN = re.compile(r"step|segment|interval|cycle|\blap", re.IGNORECASE)
#: Kind of the warning of a clock that is not used.
CLOCK_PASSED_OVER = "clock passed over"
#: Columns named in a message at the most.
_SHOWN = 40
_SETPOINT = re.compile(
    rf"(\b|_)(set|sp\b|cmd|command|commanded|target|goal|demand|reference|soll|nominal)|{SET_POINT}",
    re.IGNORECASE,
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
    column = find_column(role, columns, choice, file, dead, taken)
    return None if column is None else with_unit(role, column, choice.unit, file, columns, taken)


def find_column(
    role: str,
    columns: tuple[Column, ...],
    choice: ChannelChoice,
    file: str,
    dead: Callable[[Column], bool] = lambda _: False,
    taken: Mapping[str, Column] = MappingProxyType({}),
) -> Column | None:
    """Return the column of a role as `find_channel`, whatever its unit.

    Raises
    ------
    ChannelError
        If several columns could play the role, or the named one is not there.
    """
    if choice.name:
        return named_channel(role, columns, choice.name, file, taken)
    candidates = _candidates(role, columns)
    if role == "torque" and all(is_named(FRICTION_NAMES["friction coefficient"], c) for c in candidates):
        forces = _candidates(role, tuple(c for c in columns if c not in candidates))
        candidates = forces if forces and all(dead(c) for c in candidates) else candidates
    candidates = [c for c in candidates if c not in taken.values()] or candidates
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
    return candidates[0]


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
    named = called_so(role, columns)
    measured = [c for c in named if not _SETPOINT.search(c.name)]
    if not measured:  # what was asked for is not what came, if another column may hold that
        others = [c for c in columns if c not in named and c.unit and could_be(role, c, surely=True)]
        measured = named + (others if named and role != "time" else [])
    # a column of another kind of unit is out; one without a unit could still be it
    if called := _telling(role, [c for c in measured if could_be(role, c)]):
        return called
    by_unit = [
        c for c in columns if c.unit and could_be(role, c, surely=True) and not _OSCILLATION.search(c.name)
    ]
    friction = _in_friction(role, columns, measured)
    beside = by_unit if role == "torque" else []  # a torque beside its friction: which is meant is not known
    return [*friction, *beside] if friction else by_unit or measured


def _choose(role: str, path: str) -> dict[str, Any]:
    """The remedy where several columns could play a role."""
    channel = Setting(role, "channel")
    return {"remedy": f"choose one with {channel.to(path)}", "setting": channel}


def is_dead(values: FloatArray) -> bool:
    """Return whether a channel says nothing: no number (NaN stands for a missing one), or one throughout."""
    if values.size and np.isfinite(span := ends(values)).all():
        return values.size >= _TELLING and span[0] == span[1]
    known = values[np.isfinite(values)]
    return not known.size or (known.size >= _TELLING and float(known.min()) == float(known.max()))


def constant_channel(column: Column) -> Warning:
    """Return the warning of a channel that was passed over because it is dead."""
    return Warning(
        "constant channel passed over",
        "'{column}' is constant and was skipped",
        column=str(column),
    )


def no_channel(
    role: str,
    columns: tuple[Column, ...],
    file: str,
    others: tuple[str, ...] = (),
    names: Sequence[str] = (),
) -> ChannelError:
    """Return the error for a role that no column plays; ``others`` hold no numbers.

    ``names`` are those of all files that are read together.
    """
    if what := own_table(column.name for column in columns):
        return not_a_log(what, file)
    channel = Setting(role, "channel")
    way_out = f"name it with {channel.to(only_left(columns) if role == 'torque' else '')}"
    if role in ("torque", "speed") and any(not c.unit for c in columns):
        example = {"torque": "N*m", "speed": "rpm"}[role]
        way_out += f", and state its unit with {Setting(role, 'unit').to(example)}"
    if role == "torque" and any(is_of_kind("force", c.unit) for c in columns):
        way_out += f" (or a friction force, with {Setting('radius').to()} for the radius at which it acts)"
    elif signals := _signals(role, columns):
        way_out = way_out_unnamed(role, [each.path for each in signals], signals[0].unit or "A")
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
    if role == "torque":
        way_out += f"{of_a_coast_down(columns, file)}{force_of_pressures(columns)}"
    if role == "speed":
        way_out += speed_elsewhere(columns, file, names)
    if role == "temperature":
        if found := stated_in_names(file, names, role):
            way_out += f". If the names of the files state it, use {typed(found)}"
        way_out += f", or use {ISOTHERMAL.to()} to exclude temperature"
    said = f"{file}: no {role} column found. Columns: {columns_listed(columns)}{not_numbers(others)}"
    return ChannelError(said, absent=True, remedy=way_out, setting=channel)


def of_a_coast_down(columns: tuple[Column, ...], file: str) -> str:
    """Return what to call in Python if columns are those of time and speed, perhaps with a temperature."""
    roles = [next((r for r in ("time", "speed", "temperature") if is_called(r, c)), "") for c in columns]
    if way_in() != "python" or "" in roles or not {"time", "speed"} <= set(roles):
        return ""
    return (
        f". If the wheel coasts down without a drive, use hersey.coast_down({file!r}, "
        "inertia='0.012 kg*m^2 ± 2 %'), with its moment of inertia"
    )


def not_numbers(others: tuple[str, ...]) -> str:
    """Return the end of a sentence that names channels which hold no numbers."""
    return f". Not numbers: {', '.join(others[:40])[:1000]}" if others else ""


def _signals(role: str, columns: tuple[Column, ...]) -> list[Column]:
    """Columns of one unit, A or V, or called a current, that may hold a role: a current only the torque."""
    for kind in "AV" if role == "torque" else "V" if role in ("speed", "temperature") else "":
        if found := [c for c in columns if signal_kind(c.unit) == kind]:
            return found
    return [c for c in columns if role == "torque" and may_be_current(c.name, c.unit)]


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


def clocks_passed_over(columns: tuple[Column, ...], stated: Stated) -> list[Warning]:
    """Return a warning of the column of the time beside which the time between rows is stated."""
    clock = next((c for c in columns if is_called("time", c) and is_of_kind("time", c.unit)), None)
    if stated.every is None or clock is None:
        return []
    return [
        Warning(
            CLOCK_PASSED_OVER,
            "column '{column}' is not used: {setting} sets the time between rows",
            severity="watch",
            column=clock.path,
            setting=EVERY,
        )
    ]


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
            f"{file}: there is no column '{name}' ({role}). Columns: {columns_listed(columns)}",
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


def columns_listed(columns: tuple[Column, ...]) -> str:
    """Return columns with their units, the first of them where there are very many."""
    names = ", ".join(f"'{c}'" for c in columns[:_SHOWN])
    return names + (f" and {len(columns) - _SHOWN} more" if len(columns) > _SHOWN else "")


def _telling(role: str, candidates: list[Column]) -> list[Column]:
    """The candidates without those that others put in the shade.

    A letter without a unit beside a name with one, the clock of a step or of the day beside that of the
    run, and the temperature of another part beside that of the lubricant.
    """
    if any(c.unit and could_be(role, c, surely=True) for c in candidates):
        candidates = [c for c in candidates if c.unit or len(c.name) > 1]
    if role == "time":
        candidates = [c for c in candidates if not _PART_OF_A_RUN.search(c.name)] or candidates
        candidates = without_clock_of_day(candidates)
    if role == "temperature":
        candidates = [c for c in candidates if _OF_LUBRICANT.search(c.name)] or candidates
    return candidates


def _in_friction(role: str, columns: tuple[Column, ...], measured: list[Column]) -> list[Column]:
    """Columns of a friction coefficient, or else a force, or of a sliding speed."""
    if role == "speed":
        sliding = [c for c in columns if is_named(FRICTION_NAMES["belt speed"], c)]
        return [c for c in measured or sliding if is_of_kind("belt speed", c.unit)]
    if role != "torque":
        return []
    coefficients = [c for c in columns if is_named(FRICTION_NAMES["friction coefficient"], c)]
    forces = [c for c in columns if is_named(FRICTION_NAMES["force"], c) and c not in coefficients]
    forces = [c for c in forces if not c.unit or is_of_kind("force", c.unit)]
    return (
        [c for c in coefficients if not c.unit or c.unit in ("1", "-", "\u2013")]
        or forces
        or [c for c in measured if is_of_kind("force", c.unit)]
    )
