"""A temperature that is excluded: of a log of friction its column, and one that never changes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import HerseyError
from hersey.log.believed import in_si
from hersey.log.channels import ChannelChoice, find_channel, is_dead
from hersey.log.friction import Chosen, measured
from hersey.log.text.column import Column
from hersey.schema.warning import Warning
from hersey.units import Conversion

#: Kinds of the warnings: of one that never changes, and of one beside friction.
CONSTANT_TEMPERATURE, EXCLUDED = "constant temperature", "temperature excluded"


def constant_temperature(
    columns: tuple[Column, ...], chosen: Chosen, file: str, numbers: Callable[[Column], FloatArray]
) -> list[Warning]:
    """Return a warning if the temperature of a log that is read without it is the same in every row.

    Or a note which column it is, if the log is of friction: its report proposes the column.

    ``chosen`` are the columns of the other roles, and ``numbers`` returns those of a column as written.
    """
    taken = {role: column for role, (column, _) in chosen.items()}
    try:
        found = find_channel("temperature", columns, ChannelChoice(), file, taken=taken)
    except HerseyError:  # what it is cannot be known, and it is not asked for
        return []
    if found is None or found[0] in taken.values():
        return []
    column, unit = found
    values = in_si(numbers(column), unit)
    known = values[np.isfinite(values)]
    if not known.size or not is_dead(known):
        return _excluded(column, unit, chosen) if known.size else []
    return [
        Warning(
            CONSTANT_TEMPERATURE,
            "'{column}' reads {temperature:.4g degC} in every row, so the sensor may be dead",
            severity="watch",
            column=column.path,
            temperature=float(known[0]),
        )
    ]


def _excluded(column: Column, unit: Conversion, chosen: Chosen) -> list[Warning]:
    if measured(chosen).quantity == "torque":
        return []
    return [Warning(EXCLUDED, "temperature '{column}' is excluded", column=column.path, unit=unit.unit)]
