"""The unit of a column with a role: converted to SI, or refused with what to type."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from hersey.errors import Setting, UnitError
from hersey.log.roles import (
    FRICTION_NAMES,
    ROLE_KINDS,
    ROLES,
    channels_to,
    could_be,
    is_called,
    is_named,
    role_conversion,
)
from hersey.log.signals import (
    apart,
    at_which,
    is_signal,
    of_an_input,
    per,
    says_how_much,
    signal_kind,
    way_out,
)
from hersey.log.text.column import Column
from hersey.units import COUNTS, KINDS, Conversion, nearest_unit, of_encoder

#: Clocks of microcontroller boards, and the units in which they count.
_CLOCKS_OF_BOARDS = {"micros": "us", "millis": "ms"}
_INVERTER = "If it is the frequency of an inverter, divide by the pole pairs of the motor, e.g. for 2 use"


def known_unit(role: str, column: Column) -> str:
    """Return the unit of a column that states none, where its name leaves no choice; else nothing."""
    if role == "time":
        return _CLOCKS_OF_BOARDS.get(column.name.lower(), "")
    return "1" if role == "torque" and is_named(FRICTION_NAMES["friction coefficient"], column) else ""


def example_unit(role: str, column: Column) -> str:
    """Return a unit that a column of a role could have."""
    of_a_force = role == "torque" and is_named(FRICTION_NAMES["force"], column)
    of_sliding = role == "speed" and is_named(FRICTION_NAMES["belt speed"], column)
    kind = "force" if of_a_force else "belt speed" if of_sliding else ROLE_KINDS[role][0]
    return KINDS[kind][1]


def with_unit(
    role: str,
    column: Column,
    given: str,
    file: str,
    columns: tuple[Column, ...],
    taken: Mapping[str, Column],
) -> tuple[Column, Conversion]:
    """Return a column and the conversion to SI of what it holds; ``given`` is its unit if a person says so.

    Raises
    ------
    UnitError
        If there is no unit, an unknown one, or one that the role cannot have.
    """
    unit = given or column.unit or known_unit(role, column)
    if role in ("run", "direction"):
        return column, Conversion(unit, 1.0, 0.0)
    if not unit:
        example = example_unit(role, column)
        counts = f", or for counts {Setting(role, 'unit').to('rev/4096')}" if role == "position" else ""
        raise UnitError(
            f"{file}: column '{column.path}' has no unit",
            columns=(column.index,),
            remedy=(
                f"write '{column.name} [{example}]' in the header, add a row of units, or use "
                f"{Setting(role, 'unit').to(example)}{counts}{of_an_input(role, column.name)}"
            ),
            setting=Setting(role, "unit"),
        )
    try:
        kind, line = role_conversion(role, unit)
    except UnitError as error:
        swapped = _swapped(role, column, unit, columns, taken)
        unlike = swapped[1] or is_signal(unit) or (role == "speed" and of_encoder(unit))
        raise UnitError(
            f"{file}: column '{column.path}': {error.reason}{swapped[0]}",
            columns=(column.index,),
            remedy=swapped[1] or _right_unit(role, column.unit if is_signal(column.unit) else unit),
            setting=Setting(role, "unit"),
            likely="" if unlike else nearest_unit(ROLE_KINDS[role][0], unit),
        ) from None
    if role == "torque" and kind == "force" and not given and is_called(role, column):
        raise _called_a_torque(column, unit, file)
    return column, replace(line, scale=line.scale * _signal_in(role, column, unit, file))


def _called_a_torque(column: Column, unit: str, file: str) -> UnitError:
    """The error of a column called a torque whose unit is that of a force: one of both is a slip."""
    of = Setting("torque", "unit")
    return UnitError(
        f"{file}: column '{column.path}' is called a torque, but its unit is that of a force",
        columns=(column.index,),
        remedy=f"use {of.to('N*m')}, or {of.to(unit)} if it is a friction force",
        setting=of,
    )


def _signal_in(role: str, column: Column, unit: str, file: str) -> float:
    """How many of the signal that the unit is for, if it is for any, one in the column is."""
    full, one = at_which(unit, column.unit)
    if full and says_how_much(unit):
        of = Setting(role, "unit")
        raise UnitError(
            f"{file}: column '{column.path}' is in {column.unit}, and '{unit}' may be the {role} at 1 "
            f"{signal_kind(column.unit)} or at the full value",
            columns=(column.index,),
            remedy=f"use {of.to(full)} for the full value, or {of.to(one)}",
            setting=of,
        )
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
    elsewhere = next((r for r in ROLES if r != role and could_be(r, column, surely=True)), "")
    others = [c for c in columns if c != column and c.unit and could_be(role, c, surely=True)]
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
    if role == "speed" and (counted := of_encoder(unit)):
        return f"use {setting.to(counted)}, with your value instead of {COUNTS}"
    if role == "position":
        counts = setting.to("rev/4096")
        return f"use {setting.to('deg')}, or for counts {counts} with the counts of one turn of your encoder"
    kind = ROLE_KINDS[role][0]
    return f"use {setting.to(nearest_unit(kind, unit) or KINDS[kind][1])}, or correct the header"
