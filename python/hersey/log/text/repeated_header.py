"""A header that stands again among the rows, as a logger writes it that starts anew in the same file."""

from __future__ import annotations

from hersey.errors import UnreadableLogError
from hersey.log.text.column import Column, name_and_unit
from hersey.log.text.unit_pairs import of_one_kind, same_unit


def refuse_another_header(place: str, column: Column, cell: str, columns: tuple[Column, ...]) -> None:
    """Raise if a cell that is no number is a header that gives its column another unit or another name.

    ``place`` names file and row, ``columns`` are those of the table. The same header again is no fault.

    Raises
    ------
    UnreadableLogError
        It names the row, the column and both units, or both names.
    """
    name, unit = name_and_unit(cell) or (cell.strip(), "")
    if _is(name, column):
        other = unit
    elif any(_is(name, each) for each in columns):
        raise UnreadableLogError(
            f"{place}, column '{column.name}': the header is repeated here, and this column is now "
            f"called '{name}'. Split the file above this row, and give both parts"
        )
    else:
        other = cell.strip("[]() ")
        if other[:1].isdigit() or not of_one_kind(column.unit, other):  # a number with its unit is a value
            return
    if other and not same_unit(column.unit, other):
        raise UnreadableLogError(
            f"{place}, column '{column.name}': from here on the unit is {other}; above it is "
            f"{column.unit or 'not given'}. Split the file above this header, and give both parts"
        )


def _is(name: str, column: Column) -> bool:
    return bool(name) and name.lower() == column.name.lower()
