"""How a person states a radius or a load: what is proposed, in the words of the way in which they came.

Such a role is never taken from the unit or the name of a column: any length could be a radius. A column that
is called so is proposed, and used once it is named.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import Setting, UnstatedRoleError, way_in
from hersey.log.roles import is_called, is_of_kind
from hersey.log.text.column import Column
from hersey.schema.warning import Warning

#: Kind of the warning of a column that may play a role and is not used.
MAY_PLAY = "column may play a role"
#: Parts of a column whose medians are compared, so that noise is no change, and the ratio of two that is one:
#: an unused load costs the headline, so that it takes more than `hersey.log.pooling.SAME_LOAD`.
_PARTS, CHANGED = 50, 1.1
#: Share of the usual (95th percentile) load below which surfaces are not in contact.
LIFTED = 0.1
#: What each role is called, and an amount of it.
_ROLES: Final = {"radius": ("radius", "25 mm"), "load": ("normal load", "50 N")}
_KINDS: Final = {"radius": "length", "load": "force"}


def proposed(role: str, columns: tuple[Column, ...]) -> tuple[Column, ...]:
    """Return the columns that are called like a role, with a unit that it can have or none."""
    return tuple(
        c for c in columns if is_called(role, c) and (not c.unit or is_of_kind(_KINDS[role], c.unit))
    )


def by_name(role: str, column: Column, *, pulls: bool = False) -> str:
    """Return what to write so that a column plays a role; ``pulls`` says that its numbers are negative."""
    unit = column.unit or {"radius": "mm", "load": "N"}[role]
    needed = "" if column.unit and not pulls else f"-1 {unit}" if pulls else unit
    if way_in() == "page":
        return f"choose the role {role} for '{column.path}'" + (f" and a unit, {needed}" if needed else "")
    joint = " " if way_in() == "terminal" else ", "
    units = joint + Setting(role, "unit").to(needed) if needed else ""
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


def proposals(
    role: str, columns: tuple[Column, ...], numbers: Callable[[Column], FloatArray], *, counts: bool
) -> list[Warning]:
    """Return which columns may play a role that nobody stated, and what to write to use them.

    ``numbers`` returns those of a column as written; ``counts`` says that what is measured depends on the
    role, so that a column that changes must be spoken of.
    """
    return [_proposal(role, column, numbers, counts=counts) for column in proposed(role, columns)]


def _proposal(role: str, column: Column, numbers: Callable[[Column], FloatArray], *, counts: bool) -> Warning:
    values = numbers(column)
    low, high = levels(values) if counts else (0.0, 0.0)
    changes = counts and high > CHANGED * low
    return Warning(
        MAY_PLAY,
        "column '{column}' may be the {meaning}, but is not used"
        + (". It changes from {low:.3g} to {high:.3g}{unit}" if changes else ""),
        severity="watch" if changes else "note",
        remedy="if it is, {how}" if way_in() == "page" else "if it is, use {how}",
        column=str(column),
        role=role,
        meaning=_ROLES[role][0],
        how=by_name(role, column, pulls=bool(np.sum(values < 0.0) > np.sum(values > 0.0))),
        low=low,
        high=high,
        unit=f" {column.unit}" if column.unit else "",
    )


def levels(values: FloatArray) -> tuple[float, float]:
    """Return the lowest and highest level of a column, whatever its sign, but of rows out of contact."""
    known = np.abs(values[np.isfinite(values)])
    known = known[known > LIFTED * np.quantile(known, 0.95)] if known.size else known
    if not known.size:
        return 0.0, 0.0
    medians = [float(np.median(part)) for part in np.array_split(known, min(_PARTS, known.size))]
    return min(medians), max(medians)
