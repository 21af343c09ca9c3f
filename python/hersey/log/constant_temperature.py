"""A temperature that is excluded: of a log of friction its column, and one that never changes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import HerseyError
from hersey.log.believed import in_si
from hersey.log.channels import ChannelChoice, find_channel, is_dead
from hersey.log.friction import Chosen, measured
from hersey.log.roles import is_called
from hersey.log.text.column import Column
from hersey.schema.warning import Warning
from hersey.units import Conversion

#: Kinds of the warnings: of one that never changes, of one beside friction, and of one that varies.
CONSTANT_TEMPERATURE, EXCLUDED, POOLED = "constant temperature", "temperature excluded", "temperatures pooled"
#: Kelvin between the tenths at both ends from which on a log has no one temperature: viscosity halves.
_APART = 20.0


def constant_temperature(
    columns: tuple[Column, ...], chosen: Chosen, file: str, numbers: Callable[[Column], FloatArray]
) -> list[Warning]:
    """Return a warning if the temperature of a log that is read without it is the same in every row.

    Or if it varies by much, so that friction at all temperatures is taken as one. And a note which column it
    is, if the log is of friction: its report proposes the column.

    ``chosen`` are the columns of the other roles, and ``numbers`` returns those of a column as written.
    """
    taken = {role: column for role, (column, _) in chosen.items()}
    if (found := _first(columns, file, taken)) is None:
        return []
    column, unit = found
    values = in_si(numbers(column), unit)
    known = values[np.isfinite(values)]
    if not known.size or not is_dead(known):
        return [*_excluded(column, unit, chosen), *_pooled(column, known)] if known.size else []
    return [
        Warning(
            CONSTANT_TEMPERATURE,
            "'{column}' reads {temperature:.4g degC} in every row, so the sensor may be dead",
            severity="watch",
            column=column.path,
            temperature=float(known[0]),
        )
    ]


def _first(
    columns: tuple[Column, ...], file: str, taken: dict[str, Column]
) -> tuple[Column, Conversion] | None:
    """The temperature, or the first of several."""
    free = tuple(each for each in columns if each not in taken.values())
    for among in (free, *((each,) for each in free if is_called("temperature", each))):
        try:
            return find_channel("temperature", among, ChannelChoice(), file, taken=taken)
        except HerseyError:  # it is not asked for
            continue
    return None


def _pooled(column: Column, kelvin: FloatArray) -> list[Warning]:
    low, high = np.percentile(kelvin, [10, 90])
    if high - low < _APART:
        return []
    return [
        Warning(
            POOLED,
            "temperature '{column}' is excluded, but ranges from {low:.3g degC} to {high:.3g degC}: friction "
            "at all of them is taken as that at one",
            severity="watch",
            column=column.path,
            low=float(low),
            high=float(high),
        )
    ]


def _excluded(column: Column, unit: Conversion, chosen: Chosen) -> list[Warning]:
    if measured(chosen).quantity == "torque":
        return []
    return [Warning(EXCLUDED, "temperature '{column}' is excluded", column=column.path, unit=unit.unit)]
