"""A drive's speed over time, from a CSV: times and speeds at the belt, with units in their heads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.columns import read_columns
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.motion.schedule import Schedule

_COLUMNS = {"time": ("time", "time (s)"), "speed": ("belt speed", "speed (mm/s)")}


def read_profile(file: Path) -> Schedule:
    """Return the drive speed (m/s) over time (s) of a CSV, joined by straight lines; the last speed stays.

    Raises
    ------
    ParameterError
        If a column is missing or has no unit, or a row no two numbers, or times run backwards.
    """
    from hersey.motion.schedule import Schedule

    times, speeds = read_columns(file, _COLUMNS)
    try:
        profile = Schedule(times, speeds)
    except ParameterError as error:
        raise ParameterError(f"{file.name}: {error}") from None
    if min(speeds) < 0 or speeds[-1] == 0:
        raise ParameterError(f"{file.name}: no speed may be less than 0, and the last must be greater than 0")
    return profile
