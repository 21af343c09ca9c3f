"""Several roles that a file leaves open, by column or by unit: asked for in one message."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from hersey.errors import ISOTHERMAL, ChannelError, HerseyError, Setting, UnitError, way_in
from hersey.log.channels import (
    ChannelChoice,
    columns_listed,
    find_column,
    of_a_coast_down,
    taken_columns,
)
from hersey.log.elsewhere import elsewhere, stated_in_names
from hersey.log.role_units import example_unit, known_unit
from hersey.log.roles import EVERY, only_left
from hersey.log.signals import CURRENT_EXAMPLE, answered, is_signal, may_be_current, question
from hersey.log.text.column import Column
from hersey.log.without_units import naming_all
from hersey.units import Conversion

#: What stands for the name of a column of which nothing is known.
_COLUMN = "COLUMN"
#: Names of columns of registers, which hold counts.
_REGISTER = re.compile(
    r"present_.*|(.*[^a-z])?(raw|counts?|cnt|ticks?|lsb|reg(ister)?)([^a-z].*)?", re.IGNORECASE
)
#: Columns of which it is asked whether they say nothing, at the most.
_LOOKED_AT = 40
#: Columns of a log that holds a time, a speed and perhaps a temperature.
_NO_TORQUE = 2
#: A setting and its value, as an example.
Example = tuple[Setting, str]


@dataclass
class _Open:
    """What is open: a sentence for each role without one column, columns without a unit, what to state."""

    roles: list[str] = field(default_factory=list)
    without_unit: list[Column] = field(default_factory=list)
    examples: list[Example] = field(default_factory=list)


def asking_all(
    error: HerseyError,
    roles: Sequence[str],
    columns: tuple[Column, ...],
    choices: Mapping[str, ChannelChoice],
    file: str,
    *,
    dead: Callable[[Column], bool] = lambda _: False,
    of_a_frame: bool = False,
    names: Sequence[str] = (),
) -> HerseyError:
    """Return an error of a role without column or unit, or with several columns, with all else that is open.

    Any other error is returned as it is, and so is that of a file in which nothing else is open, or in which
    neither torque nor speed is found.
    """
    setting = error.setting
    if setting is None or setting.name not in roles or setting.kind not in ("channel", "unit"):
        return error
    if setting.kind == "channel" and choices[setting.name].name:  # of which the name is wrong
        return error
    few = {column.index for column in columns[:_LOOKED_AT]}  # each is read from the file
    is_open, found = _all_open(
        roles, columns, choices, file, lambda column: column.index in few and dead(column), names
    )
    if isinstance(error, UnitError) and (not is_open.roles or setting not in dict(is_open.examples)):
        return naming_all(error, roles, columns, choices, file, dead=dead, of_a_frame=of_a_frame)
    if "current" in found and (Setting("speed", "channel"), _COLUMN) not in is_open.examples:
        found.add("torque")  # in its place
    bare = "torque" not in found and len(columns) <= _NO_TORQUE  # which may be of a coast-down
    if len(is_open.roles) + len(is_open.without_unit) < 2 or not {"torque", "speed"} & found or bare:
        return error
    said = list(is_open.roles)
    if is_open.without_unit:
        names = ", ".join(f"'{column.path}'" for column in is_open.without_unit)
        said.append(f"no unit for {names}")
    coasts = "" if "torque" in found else of_a_coast_down(columns, file)
    return ChannelError(
        f"{file}: {'; '.join(said)}. Columns: {columns_listed(columns)}",
        columns=error.columns if isinstance(error, ChannelError | UnitError) else (),
        examples=tuple(is_open.examples),
        remedy=(
            f"use {stated(is_open.examples)}{_own(is_open.examples)}{_instead(is_open.examples)}"
            f"{_of_registers(is_open)}{coasts}"
        ),
        setting=setting,
    )


def _all_open(
    roles: Sequence[str],
    columns: tuple[Column, ...],
    choices: Mapping[str, ChannelChoice],
    file: str,
    dead: Callable[[Column], bool],
    names: Sequence[str],
) -> tuple[_Open, set[str]]:
    """What is open, and the roles of which a column, or one of several, is there."""
    is_open, found = _Open(), set[str]()
    chosen: dict[str, tuple[Column, Conversion | None]] = {}
    for role in sorted(roles, key=lambda each: each == "temperature"):
        taken = taken_columns(role, columns, choices, chosen)
        try:
            column = find_column(role, columns, choices[role], file, dead, taken)
        except ChannelError as several:
            column = next((c for c in columns if c.index in several.columns), None)
            if column is None:  # a name that a person gave, which is another mistake
                continue
            is_open.roles.append(several.reason.removeprefix(f"{file}: "))
            alike = sum(c.path == column.path for c in columns)
            name = f"{column.path}#1" if alike > 1 else column.path
            is_open.examples.append((Setting(role, "channel"), name))
        if column is None:
            is_open.roles.append(f"no {role} column found")
            free = tuple(c for c in columns if c not in taken.values())
            examples = _of_absent(role, free, file, names, choices[role].unit)
            if role == "torque" and (current := dict(examples)[Setting(role, "channel")]) != _COLUMN:
                found.add("current")
                is_open.roles[-1] += f" ('{current}' may be the motor current)"
            is_open.examples += examples
            continue
        found.add(role)
        chosen[role] = column, None
        if role != "time" and is_signal(column.unit) and not choices[role].unit:
            of, example = question(role, column.unit)
            is_open.roles.append(f"'{column.path}' is in {column.unit}, which needs the {of}")
            is_open.examples.append((Setting(role, "unit"), answered(example, column.unit)))
        if not (choices[role].unit or column.unit or known_unit(role, column)):
            is_open.without_unit.append(column)
            is_open.examples.append((Setting(role, "unit"), example_unit(role, column)))
    is_open.examples = list(dict.fromkeys(is_open.examples))  # a pattern may state two roles
    return is_open, found


def _of_absent(
    role: str, columns: tuple[Column, ...], file: str, names: Sequence[str], unit: str
) -> list[Example]:
    """What to state for a role that none of the free columns plays by name or unit."""
    if role == "temperature":
        return stated_in_names(file, names, role) or [(ISOTHERMAL, "")]
    if role == "speed" and (other := elsewhere(columns, file, names)):
        return other
    if role == "speed" and not columns:
        return [(Setting("schedule"), "schedule.csv")]
    if role == "time" and not columns:
        return [(EVERY, "2 ms")]
    channel = Setting(role, "channel")
    current = next((c for c in columns if role == "torque" and may_be_current(c.name, c.unit)), None)
    if current is not None:
        return [(channel, current.path), (Setting(role, "unit"), CURRENT_EXAMPLE)]
    named = (only_left(columns) if role == "torque" else "") or _COLUMN
    if unit or all(c.unit for c in columns):
        return [(channel, named)]
    return [(channel, named), (Setting(role, "unit"), example_unit(role, columns[0]))]


def _own(examples: Sequence[Example]) -> str:
    """What is to be put in the place of examples; an encoder of a line counts lengths."""
    if any(of == Setting("position", "unit") and value.startswith("rev/") for of, value in examples):
        line = Setting("position", "unit").to("0.5 um")
        return f", with your units: the counts of one turn of your encoder, or {line} for one of a line"
    columns = f"columns for {_COLUMN}" if any(value == _COLUMN for _, value in examples) else ""
    units = "units" if any(of.kind == "unit" for of, _ in examples) else ""
    return f", with your {' and '.join(filter(None, [columns, units]))}" if columns or units else ""


def _instead(examples: Sequence[Example]) -> str:
    """What to state instead of a column of the time, or of the speed, of which nothing is known."""
    every, schedule = EVERY.to("2 ms", python="0.002"), Setting("schedule").to("schedule.csv")
    ways = {"time": f"set the time between rows with {every}", "speed": f"give set points with {schedule}"}
    columns = {role: Setting(role, "channel") for role in ways}
    return "".join(
        f", or omit {column.to()} and {ways[role]}"
        for role, column in columns.items()
        if (column, _COLUMN) in examples
    )


def _of_registers(is_open: _Open) -> str:
    """What to state instead for columns of torque and speed that may hold counts of a register."""
    named = {value for of, value in is_open.examples if of.kind == "channel"}
    named |= {column.name for column in is_open.without_unit}
    if not any(_REGISTER.fullmatch(name) for name in named):
        return ""
    counts = {"torque": "4.79 mN*m", "speed": "0.229 rpm"}
    units = [Setting(role, "unit") for role in counts]
    asked = [(unit, counts[unit.name]) for unit in units if unit in dict(is_open.examples)]
    return f". For counts of a register give what one count is, e.g. {stated(asked)}" if asked else ""


def stated(examples: Sequence[Example]) -> str:
    """Return what to write; in Python columns and units stand in one argument each."""
    if way_in() != "python":
        return (" " if way_in() == "terminal" else ", ").join(of.to(value) for of, value in examples)
    by_kind = {"channels": "channel", "units": "unit"}
    written = [
        f"{name}={values}"
        for name, kind in by_kind.items()
        if (values := {of.name: value for of, value in examples if of.kind == kind})
    ]
    others = [of.to(value) for of, value in examples if of.kind not in by_kind.values()]
    return ", ".join([*written, *others])
