"""A run as it is kept: its dwells, and all else as text."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

#: Columns of steady points, as they stand in the file, with their types there.
COLUMNS = {
    "run": "INTEGER",
    "start": "REAL",
    "end": "REAL",
    "speed": "REAL",
    "speed_error": "REAL",
    "torque": "REAL",
    "torque_error": "REAL",
    "temperature": "REAL",
    "temperature_error": "REAL",
    "rows": "INTEGER",
    "effective_rows": "REAL",
    "settling_rows": "INTEGER",
    "approach": "TEXT",
    "load": "REAL",
    "tare": "REAL",
}


@dataclass(frozen=True)
class Entry:
    """One run as it is kept, before it has a specimen and an age.

    ``dwells`` has a row per dwell with the columns of `COLUMNS`; ``reduction`` is what else `SteadyPoints`
    holds, ``fit`` the fitted surface (None where ``no_fit`` says why there is none), ``settings`` how the log
    was read: JSON each. ``written`` is when the log was last written to, s since 1970.
    """

    path: str
    sha256: str
    written: float | None
    version: str
    settings: str
    reduction: str
    fit: str | None
    no_fit: str
    dwells: list[list[Any]] = field(repr=False)
