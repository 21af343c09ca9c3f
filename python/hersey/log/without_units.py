"""Columns of several roles without units: named at once, with every unit to state."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from hersey.errors import ChannelError, Setting, UnitError, way_in
from hersey.log.channels import ChannelChoice, find_column, taken_columns
from hersey.log.role_units import example_unit, known_unit
from hersey.log.signals import of_an_input
from hersey.log.text.column import Column
from hersey.units import Conversion


def naming_all(
    error: UnitError,
    roles: Sequence[str],
    columns: tuple[Column, ...],
    choices: Mapping[str, ChannelChoice],
    file: str,
    *,
    dead: Callable[[Column], bool] = lambda _: False,
    of_a_frame: bool = False,
) -> UnitError:
    """Return an error of a column without a unit, with all others of the roles that lack one.

    Any other error is returned as it is. A frame (``of_a_frame``) has no header and no row of units.
    """
    lacking = _without_units(roles, columns, choices, file, dead)
    setting = error.setting
    if setting is None or setting.kind != "unit" or setting.name not in lacking:
        return error
    if len(lacking) == 1 and not of_a_frame:
        return error
    named = ", ".join(f"'{column.path}'" for column in lacking.values())
    examples = {role: example_unit(role, column) for role, column in lacking.items()}
    several = len(lacking) > 1
    use = f"use {_stating(examples)}, with your unit{'s' * several}"
    if not of_a_frame:
        first = next(iter(lacking))
        example = f"'{lacking[first].name} [{examples[first]}]'"
        use = f"write units in the header, e.g. {example}, add a row of units, or {use}"
    use += "".join(of_an_input(role, column.name) for role, column in lacking.items())
    said = f"columns {named} have no units" if several else f"column {named} has no unit"
    indices = tuple(column.index for column in lacking.values())
    return UnitError(f"{file}: {said}", columns=indices, units=examples, remedy=use, setting=setting)


def _without_units(
    roles: Sequence[str],
    columns: tuple[Column, ...],
    choices: Mapping[str, ChannelChoice],
    file: str,
    dead: Callable[[Column], bool],
) -> dict[str, Column]:
    """The columns of roles for which no unit is stated, by role."""
    chosen: dict[str, tuple[Column, Conversion | None]] = {}
    lacking = {}
    for role in roles:
        taken = taken_columns(role, columns, choices, chosen)
        try:
            column = find_column(role, columns, choices[role], file, dead, taken)
        except ChannelError:  # which comes once the units are there
            continue
        if column is None:
            continue
        chosen[role] = column, None
        if not (choices[role].unit or column.unit or known_unit(role, column)):
            lacking[role] = column
    return lacking


def _stating(units: Mapping[str, str]) -> str:
    """What to write to state units by role."""
    if way_in() == "python":
        return f"units={dict(units)}"
    joint = " " if way_in() == "terminal" else ", "
    return joint.join(Setting(role, "unit").to(unit) for role, unit in units.items())
