"""A temperature that is excluded and that never changes: its sensor may be dead."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import HerseyError
from hersey.log.believed import in_si
from hersey.log.channels import ChannelChoice, find_channel, is_dead
from hersey.log.friction import Chosen
from hersey.log.text.column import Column
from hersey.schema.warning import Warning

#: Kind of the warning.
CONSTANT_TEMPERATURE = "constant temperature"


def constant_temperature(
    columns: tuple[Column, ...], chosen: Chosen, file: str, numbers: Callable[[Column], FloatArray]
) -> list[Warning]:
    """Return a warning if the temperature of a log that is read without it is the same in every row.

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
        return []
    return [
        Warning(
            CONSTANT_TEMPERATURE,
            "'{column}' reads {temperature:.4g degC} in every row, so the sensor may be dead",
            severity="watch",
            column=column.path,
            temperature=float(known[0]),
        )
    ]
