"""A temperature profile from a CSV file: when the machine will be how warm."""

from __future__ import annotations

import csv
import re
from contextlib import suppress
from pathlib import Path

from hersey.errors import ChannelError, ParameterError, UnreadableLogError
from hersey.files.text import read_text
from hersey.motion.schedule import Schedule
from hersey.units import Conversion, conversion

#: Points above which a temperature profile is no longer read: it is searched and simulated many times.
MOST_POINTS = 2000
#: Bytes that so many points could fill.
_MOST_BYTES = 1_000_000


def read_temperature_profile(path: str | Path) -> Schedule:
    """Read columns such as ``time [s]`` and ``temperature [degC]``, separated by commas or semicolons.

    Time is counted from the moment at which the drive could start; straight lines join the points.

    Raises
    ------
    MissingFileError, UnreadableLogError, ChannelError, UnitError, ParameterError
        Each names the file, and the line or column.
    """
    path = Path(path)
    rows = [line for line in _text(path).splitlines() if line.strip() and not line.startswith("#")]
    if len(rows) < 2:
        raise UnreadableLogError(f"{path.name}: it needs a line of names and at least one point")
    if len(rows) > MOST_POINTS + 1:
        raise ParameterError(f"{path.name}: {len(rows) - 1} points, but {MOST_POINTS} are possible: thin it")
    separator = ";" if ";" in rows[0] else ","
    table = list(csv.reader(rows, delimiter=separator))
    columns = {role: _column(path.name, table[0], role) for role in ("time", "temperature")}
    times, values = [], []
    for number, row in enumerate(table[1:], 2):
        time, value = (_number(path.name, number, row, *columns[role]) for role in columns)
        times.append(time)
        values.append(value)
    try:
        return Schedule(times, values)
    except ParameterError as error:
        raise error.within(path.name) from None


def _text(path: Path) -> str:
    with suppress(OSError):  # reading it says what is wrong
        if path.is_file() and path.stat().st_size > _MOST_BYTES:
            raise ParameterError(
                f"{path.name} is too long for a temperature profile: {MOST_POINTS} points are possible"
            )
    try:
        return read_text(path)
    except UnicodeDecodeError:
        raise UnreadableLogError(f"{path.name} is not text in UTF-8") from None


def _column(file: str, names: list[str], role: str) -> tuple[int, Conversion]:
    found = [i for i, name in enumerate(names) if name.strip().lower().startswith(role)]
    if len(found) != 1:
        what = "no column" if not found else "more than one column"
        raise ChannelError(f"{file}: {what} named {role}: write '{role} [{_UNITS[role]}]' in the first line")
    unit = re.search(r"[\[(](.+)[\])]", names[found[0]])
    if unit is None:
        raise ChannelError(f"{file}: {role} has no unit: write '{role} [{_UNITS[role]}]' in the first line")
    return found[0], conversion(role, unit[1])


_UNITS = {"time": "s", "temperature": "degC"}


def _number(file: str, line: int, row: list[str], column: int, unit: Conversion) -> float:
    text = row[column].strip() if column < len(row) else ""
    try:
        return unit.scale * float(text) + unit.offset
    except ValueError:
        raise UnreadableLogError(f"{file}: line {line}: '{text}' is no number") from None
