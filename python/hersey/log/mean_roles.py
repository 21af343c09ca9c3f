"""Which column of a table of means holds the torque, its error, a count, a run: found by name and unit."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import UnitError, UnreadableLogError
from hersey.log.cell_table import CellTable
from hersey.log.channels import ChannelChoice, called, find_channel, no_channel, taken_columns
from hersey.log.roles import role_conversion
from hersey.log.text.column import Column
from hersey.log.without_units import naming_all
from hersey.units import Conversion

_SHARED = re.compile(r"\bshared\b", re.IGNORECASE)
_ERROR = re.compile(r"error|uncert|\bsem\b|\bse\b|±", re.IGNORECASE)
_DEVIATION = re.compile(r"\bsd\b|\bstd|st\.? ?dev|deviation|scatter", re.IGNORECASE)
_SPEED = re.compile("speed|rpm|drehzahl|geschw|vitesse|velocid|velocit|giri|速|回転数", re.IGNORECASE)
_PLAIN = {
    "load": re.compile(r".*\bload\b.*|normal force|n force|f_?n|weight", re.IGNORECASE),
    "count": re.compile(r"counts?|samples|rows|repeats?|n samples|number.*", re.IGNORECASE),
    "run": re.compile(r"run|section|series|specimen|sample|unit|test", re.IGNORECASE),
    "approach": re.compile(r"approach|direction|branch|way", re.IGNORECASE),
}
#: A column and its conversion to SI.
Role = tuple[Column, Conversion]


def measured(columns: tuple[Column, ...]) -> tuple[Column, ...]:
    """Return the columns that are no error, deviation, count or label of others."""
    return tuple(
        c
        for c in columns
        if not (_ERROR.search(c.name) or _DEVIATION.search(c.name))
        and not any(_plays(c, name, columns) for name in _PLAIN)
    )


def _plays(column: Column, name: str, columns: tuple[Column, ...]) -> bool:
    """Whether a column plays a role without a conversion; n is a count beside a speed, or the speed."""
    if name == "count" and column.name.lower() == "n" and not column.unit:
        return any(c != column and _SPEED.search(str(c)) for c in columns)
    if name == "load" and re.search("torque|moment", column.name, re.IGNORECASE):  # a load torque is a torque
        return False
    return bool(_PLAIN[name].fullmatch(column.name))


def as_long_as_torque(cells: CellTable, choices: dict[str, ChannelChoice]) -> CellTable:
    """Return the columns that have as many rows as the torque.

    Raises
    ------
    UnreadableLogError
        If one that is named has not.
    """
    size = {column: len(each) for column, each in zip(cells.columns, cells.cells, strict=True)}
    if len(set(size.values())) < 2:
        return cells
    among = cells.columns if choices["torque"].name else measured(cells.columns)
    torque = find_channel("torque", among, choices["torque"], cells.name)
    if torque is None:
        raise no_channel("torque", among, cells.name)
    rows = size[torque[0]]
    for role, choice in choices.items():
        named = called(choice.name, cells.columns) if choice.name else []
        if named and all(size[column] != rows for column in named):
            raise UnreadableLogError(
                f"{cells.name}: column '{named[0]}' ({role}) has {size[named[0]]} rows, but column "
                f"'{torque[0]}' (torque) has {rows}. Name columns of the same table"
            )
    kept = [i for i, column in enumerate(cells.columns) if size[column] == rows]
    return replace(
        cells, columns=tuple(cells.columns[i] for i in kept), cells=tuple(cells.cells[i] for i in kept)
    )


def mean_roles(cells: CellTable, choices: dict[str, ChannelChoice], isothermal: bool) -> dict[str, Role]:
    """Return the columns of torque, speed and, if there is one, temperature, with their conversions.

    Raises
    ------
    ChannelError, UnitError
        If there is none of torque or speed, or one without a unit.
    """
    usual = measured(cells.columns)
    roles: dict[str, Role] = {}
    needed = ("torque", "speed") if isothermal else ("torque", "speed", "temperature")
    for role in needed:
        columns = cells.columns if choices[role].name else usual
        taken = taken_columns(role, columns, choices, roles)
        try:
            channel = find_channel(role, columns, choices[role], cells.name, taken=taken)
        except UnitError as error:
            raise naming_all(error, needed, usual, choices, cells.name, of_a_frame=cells.of_a_frame) from None
        if channel is not None:
            roles[role] = channel
        elif role != "temperature":
            raise no_channel(role, usual, cells.name)
    return roles


def in_si(cells: CellTable, column: Column, unit: Conversion) -> FloatArray:
    """Return a column in SI, NaN where a cell is no number."""
    return np.asarray(unit.scale * cells.numbers(column) + unit.offset)


def torque_errors(cells: CellTable, torque: Role) -> FloatArray | None:
    """Return standard errors of the column of torque, in SI, from errors, or deviations and counts."""
    about_torque = [
        c for c in cells.columns if c != torque[0] and _is_of_torque(c) and not _SHARED.search(c.name)
    ]
    count = plain_column(cells, "count")
    if error := next((c for c in about_torque if _ERROR.search(c.name)), None):
        return _scaled(cells, error, torque)
    for column in about_torque:
        if _DEVIATION.search(column.name) and count is not None:
            return _scaled(cells, column, torque) / np.sqrt(np.maximum(cells.numbers(count), 1.0))
    return None


def shared_errors(cells: CellTable, torque: Role) -> FloatArray | None:
    """Return the standard errors of torque that all rows share, in SI."""
    column = next((c for c in cells.columns if _SHARED.search(c.name) and _ERROR.search(c.name)), None)
    return None if column is None or not _is_of_torque(column) else _scaled(cells, column, torque)


def _is_of_torque(column: Column) -> bool:
    """Whether a column of errors is one of the torque: by its name, or because it names nothing else."""
    name = column.name.lower()
    if any(word in name for word in ("speed", "rpm", "temp", "load")):
        return False
    return bool(_ERROR.search(name) or _DEVIATION.search(name))


def _scaled(cells: CellTable, column: Column, torque: Role) -> FloatArray:
    if column.unit == "%":
        return np.asarray(cells.numbers(column) / 100.0 * np.abs(in_si(cells, *torque)))
    scale = role_conversion("torque", column.unit)[1].scale if column.unit else torque[1].scale
    return np.asarray(scale * cells.numbers(column))


def plain_column(cells: CellTable, name: str) -> Column | None:
    """Return the column of a role without a conversion, or None."""
    return next((c for c in cells.columns if _plays(c, name, cells.columns)), None)
