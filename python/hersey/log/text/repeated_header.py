"""A header that stands again among the rows, as a logger writes it that starts anew in the same file."""

from __future__ import annotations

from functools import lru_cache

from hersey.errors import UnitError, UnreadableLogError
from hersey.log.text.layout import NAME_WITH_UNIT, Column
from hersey.units import KINDS, conversion


def refuse_another_header(place: str, column: Column, cell: str, columns: tuple[Column, ...]) -> None:
    """Raise if a cell that is no number is a header that gives its column another unit or another name.

    ``place`` names file and row, ``columns`` are those of the table. The same header again is no fault.

    Raises
    ------
    UnreadableLogError
        It names the row, the column and both units, or both names.
    """
    name, unit = _header(cell)
    if _is(name, column):
        other = unit
    elif any(_is(name, each) for each in columns):
        raise UnreadableLogError(
            f"{place}, column '{column.name}': the header stands here again, and this column is '{name}': "
            "cut the file above this row into two files, and give both"
        )
    else:
        other = cell.strip("[]() ")
        if not _same_kind(column.unit, other):
            return
    if other and not _same(column.unit, other):
        raise UnreadableLogError(
            f"{place}, column '{column.name}': the unit is {other} from here on, and above it is "
            f"{column.unit or 'not given'}: cut the file above this header into two files, and give both"
        )


def _header(cell: str) -> tuple[str, str]:
    """Name and unit of a cell as one of a header."""
    match = NAME_WITH_UNIT.fullmatch(cell)
    if match is None:
        return cell.strip(), ""
    return match[1].strip(), (match[2] if match[2] is not None else match[3]).strip()


def _is(name: str, column: Column) -> bool:
    return bool(name) and name.lower() == column.name.lower()


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


def _same_kind(one: str, other: str) -> bool:
    """Whether both texts are units of one kind of quantity."""
    return any(_of_kind(kind, one) and _of_kind(kind, other) for kind in KINDS)


def _same(one: str, other: str) -> bool:
    """Whether two units mean the same."""
    if one == other:
        return True
    lines = [(_of_kind(kind, one), _of_kind(kind, other)) for kind in KINDS]
    return any(a is not None and a == b for a, b in lines)
