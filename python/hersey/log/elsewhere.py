"""Where a log has a speed or a temperature that no column holds: in the names of files, or in a position."""

from __future__ import annotations

import re
from collections.abc import Sequence

from hersey.errors import Setting, UnitError
from hersey.log.derived.file_names import differing, proposed_pattern
from hersey.log.roles import could_be, is_called, is_named, is_of_kind, role_conversion
from hersey.log.text.column import Column
from hersey.log.words import MOVED

#: Names of a position along a line, in a unit of length.
_MOVED = rf".*(stroke|displacement|travel|hub|weg|{MOVED})"
#: A turn over the counts of an encoder, as an example of the unit of a position.
_COUNTS = "rev/4096"


def stated_in_names(file: str, names: Sequence[str], role: str) -> list[tuple[Setting, str]]:
    """Return the pattern of file names that state a role, and its decimal mark; temperatures must differ."""
    found = proposed_pattern(file, names, needed=(role,))
    if found is None or (role == "temperature" and "temperature" not in differing(found, names or (file,))):
        return []
    mark = [] if found[1] == "." else [(Setting("name_decimal"), found[1])]
    return [(Setting("name_pattern"), found[0]), *mark]


def typed(settings: Sequence[tuple[Setting, str]]) -> str:
    """Return what to write."""
    return " ".join(setting.to(value) for setting, value in settings)


def elsewhere(columns: tuple[Column, ...], file: str, names: Sequence[str] = ()) -> list[tuple[Setting, str]]:
    """Return what states the speed of a log without one: a pattern of its name, or a position."""
    if found := stated_in_names(file, names, "speed"):
        return found
    return [] if (position := position_in(columns)) is None else _of_position(position)


def position_in(columns: tuple[Column, ...]) -> Column | None:
    """Return the column that may be a position in the place of a speed: by its name, or an angle's unit."""
    named = [c for c in columns if is_called("position", c) and _may_be_position(c)]
    moved = [c for c in columns if is_of_kind("length", c.unit) and is_named(_MOVED, c)]
    turned = [c for c in columns if re.search("deg|rad|rev|turn|°", c.unit) and _unit_of_position(c)]
    return next(iter(named + moved + turned), None)


def _may_be_position(column: Column) -> bool:
    return could_be("position", column) or is_of_kind("length", column.unit)


def _unit_of_position(column: Column) -> bool:
    """Whether the unit of a column is one of a position."""
    try:
        return bool(column.unit and role_conversion("position", column.unit))
    except UnitError:
        return False


def _of_position(column: Column) -> list[tuple[Setting, str]]:
    """What states a position, with a unit where the column has none that is known."""
    stated = [(Setting("position", "channel"), column.path)]
    if _unit_of_position(column):
        return stated
    counts = column.unit or re.search(r"enc|count|tick|inkr|pos", column.name, re.IGNORECASE)
    return [*stated, (Setting("position", "unit"), _COUNTS if counts else "deg")]


def speed_elsewhere(columns: tuple[Column, ...], file: str, names: Sequence[str]) -> str:
    """Return what to write of the name of the file, or a position, where a log without a speed has it."""
    found = elsewhere(columns, file, names)
    if not found:
        return f", or give set points by time with {Setting('schedule').to('schedule.csv')}"
    use = typed(found)
    if found[0][0].kind == "channel":
        is_of_counts = any(of.kind == "unit" and value == _COUNTS for of, value in found)
        counts = ", with the counts of one turn of your encoder" if is_of_counts else ""
        return f". If '{found[0][1]}' is the position, use {use}{counts}"
    return f". If the name of the file states it, use {use}"
