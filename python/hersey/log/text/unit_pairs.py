"""Two units given for one column: whether they are of one kind, and mean the same."""

from __future__ import annotations

from functools import lru_cache

from hersey.errors import UnitError
from hersey.units import KINDS, conversion


@lru_cache(maxsize=1024)
def _of_kind(kind: str, unit: str) -> tuple[float, float] | None:
    """Scale and offset of a unit that is one of a kind, or None."""
    if not unit:
        return None
    try:
        line = conversion(kind, unit)
    except UnitError:
        return None
    return line.scale, line.offset


def of_one_kind(one: str, other: str) -> bool:
    """Return whether both texts are units of one kind of quantity."""
    return any(_of_kind(kind, one) and _of_kind(kind, other) for kind in KINDS)


def same_unit(one: str, other: str) -> bool:
    """Return whether two units mean the same."""
    if one == other:
        return True
    lines = [(_of_kind(kind, one), _of_kind(kind, other)) for kind in KINDS]
    return any(a is not None and a == b for a, b in lines)
