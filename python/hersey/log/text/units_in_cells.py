"""Cells that hold a number with its unit, as ``24,96 °C``, where a table has the unit in its header."""

from __future__ import annotations

import re

from hersey.log.text.column import Column
from hersey.log.text.dated_numbers import was_number

#: A number and its unit.
WITH_UNIT = re.compile(r"([-+]?[0-9][0-9.,]*(?:[eE][-+]?[0-9]+)?) ?([A-Za-zµμ°%][A-Za-z0-9µμ°%*/·^]*)")


def numbers_only(column: Column, cell: str) -> str:
    """Return what to do about a column with such a cell; empty if the cell is another text."""
    match = WITH_UNIT.fullmatch(cell.strip())
    if match is None or was_number(column.name, cell):
        return ""
    if column.unit:
        return "write only numbers in the cells"
    return f"write the unit in the header, '{column.name} [{match[2]}]', and only numbers in the cells"
