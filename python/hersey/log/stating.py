"""How a person states a radius or a load: what is proposed, in the words of the way in which they came.

Such a role is never taken from the unit or the name of a column: any length could be a radius. A column that
is called so is proposed, and used once it is named.
"""

from __future__ import annotations

from typing import Final

from hersey.errors import Setting, UnstatedRoleError, way_in
from hersey.log.roles import is_called, is_of_kind
from hersey.log.text.column import Column
from hersey.schema.warning import Warning

#: What each role is called, and an amount of it.
_ROLES: Final = {"radius": ("radius", "25 mm"), "load": ("normal load", "50 N")}
_KINDS: Final = {"radius": "length", "load": "force"}


def proposed(role: str, columns: tuple[Column, ...]) -> tuple[Column, ...]:
    """Return the columns that are called like a role, with a unit that it can have or none."""
    return tuple(
        c for c in columns if is_called(role, c) and (not c.unit or is_of_kind(_KINDS[role], c.unit))
    )


def by_name(role: str, column: Column) -> str:
    """Return what to write so that a column plays a role."""
    unit = {"radius": "mm", "load": "N"}[role]
    if way_in() == "page":
        return f"choose the role {role} for '{column.path}'" + ("" if column.unit else f" and a unit, {unit}")
    joint = " " if way_in() == "terminal" else ", "
    units = "" if column.unit else joint + Setting(role, "unit").to(unit)
    return Setting(role, "channel").to(column.path) + units


def by_amount(role: str) -> str:
    """Return what to write to state an amount."""
    amount = _ROLES[role][1]
    if way_in() == "page":
        return f"write the {role}, e.g. {amount}, below the table"
    return Setting(role).to(amount)


def unstated(
    file: str, role: str, why: str, columns: tuple[Column, ...], of: Column | None = None
) -> UnstatedRoleError:
    """Return the error for a radius or a load that the column ``of`` needs and nobody stated."""
    named = proposed(role, columns)
    word = _ROLES[role][0]
    maybe = "".join(f". Column '{column}' may be the {word}: {by_name(role, column)}" for column in named[:3])
    other = maybe or f", or name its column with {by_name(role, Column(0, 'its name', '1'))}"
    return UnstatedRoleError(
        f"{file}: {why}. Give it, e.g. {by_amount(role)}{other}",
        role=role,
        proposed=tuple(column.path for column in named),
        columns=() if of is None else (of.index,),
    )


def proposals(role: str, columns: tuple[Column, ...]) -> list[Warning]:
    """Return which columns may play a role that nobody stated, and what to write to use them."""
    return [
        Warning(
            "column may play a role",
            "column '{column}' may be the {meaning}, but is not used",
            remedy="if it is, {how}" if way_in() == "page" else "if it is, use {how}",
            column=str(column),
            role=role,
            meaning=_ROLES[role][0],
            how=by_name(role, column),
        )
        for column in proposed(role, columns)
    ]
