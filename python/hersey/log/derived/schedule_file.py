"""A schedule in a table of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hersey.errors import ParameterError
from hersey.log.columns import open_columns
from hersey.log.derived.set_points import KINDS, SetPoints

_EXAMPLES = {"from": "s", "to": "s", "speed": "rpm", "temperature": "degC", "load": "N"}


def read_schedule(path: str | Path) -> SetPoints:
    """Return the schedule in a table with columns from, to and e.g. speed, each with its unit.

    Raises
    ------
    HerseyError
        It names the file and the column.
    """
    path = Path(path)
    with open_columns(path) as opened:
        columns = {column.name.lower(): column for column in opened.columns}
        known = {key: columns[key] for key in KINDS if key in columns}
        if not {"from", "to"} <= known.keys() or len(known) < 3:
            listed = ", ".join(f"'{column}'" for column in opened.columns)
            raise ParameterError(
                f"{path.name}: a schedule needs the columns 'from [s]', 'to [s]' and e.g. 'speed [rpm]'. "
                f"Columns: {listed}"
            )
        if bare := [key for key, column in known.items() if not column.unit]:
            raise ParameterError(
                f"{path.name}: column '{bare[0]}' has no unit. Write '{bare[0]} [{_EXAMPLES[bare[0]]}]'"
            )
        numbers = opened.numbers(*known.values(), complete=True)
    rows: Sequence[Mapping[str, Any]] = [
        {key: f"{value!r} {known[key].unit}" for key, value in zip(known, map(float, row), strict=True)}
        for row in zip(*numbers, strict=True)
    ]
    try:
        return SetPoints.of(rows)
    except ParameterError as error:
        raise error.within(path.name) from None
