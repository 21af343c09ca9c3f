"""Commas that separate the columns and are the decimal mark too, which makes more cells than columns."""

from __future__ import annotations

import re
from collections.abc import Sequence

_WHOLE = re.compile(r"[-+]?[0-9]+")
_DIGITS = re.compile(r"[0-9]+([eE][-+]?[0-9]+)?")
_POINT = re.compile(r"[-+]?[0-9]*\.[0-9]*([eE][-+]?[0-9]+)?")
#: How to export such a table.
_EXPORT = "Export with ';' between the columns (or tabs), or with decimal points"


def with_decimal_commas(rows: Sequence[Sequence[str]], columns: int) -> str:
    """Return what to do if decimal commas make more cells than columns, or nothing if they cannot.

    Parameters
    ----------
    rows
        Cells of some rows between commas, all with the same number of cells.
    columns
        Names in the header.
    """
    width = len(rows[0]) if rows else 0
    if not columns < width <= 2 * columns or any(_POINT.fullmatch(cell) for row in rows for cell in row):
        return ""
    if width - columns > _numbers_cut(rows):
        return ""
    if width == 2 * columns:
        return f"The numbers have decimal commas, and commas also separate the columns. {_EXPORT}"
    example = max((",".join(row) for row in rows), key=len)
    return (
        f"Commas separate the columns, and some seem to be decimal commas, as in '{example[:60]}'. "
        f"{_EXPORT}. Only if the further cells are channels of their own, give every column a name"
    )


def _numbers_cut(rows: Sequence[Sequence[str]]) -> int:
    """How many numbers at the most a comma may have cut in two, the same in all rows."""
    count, index = 0, 0
    while index + 1 < len(rows[0]):
        cut = all(_WHOLE.fullmatch(row[index]) and _DIGITS.fullmatch(row[index + 1]) for row in rows)
        count, index = count + cut, index + 1 + cut
    return count
