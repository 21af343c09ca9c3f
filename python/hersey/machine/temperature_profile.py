"""A temperature profile from a file: when the machine will be how warm."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, ParameterError, UnitError, UnreadableLogError
from hersey.log.columns import OpenColumns, open_columns
from hersey.log.formats import format_of
from hersey.log.text.column import Column
from hersey.motion.schedule import Schedule
from hersey.units import conversion, takes_si

#: Points above which a temperature profile is no longer read: it is searched and simulated many times.
MOST_POINTS = 2000
#: Bytes of text that so many points could fill.
_MOST_BYTES = 1_000_000
_UNITS = {"time": "s", "temperature": "degC"}


@takes_si()
def read_temperature_profile(path: str | Path) -> Schedule:
    """Read columns such as ``time [s]`` and ``temperature [degC]`` of a file of any format of a log.

    Time is counted from the moment at which the drive could start; straight lines join the points.

    Raises
    ------
    MissingFileError, UnreadableLogError, ChannelError, UnitError, ParameterError
        Each names the file, and the line or column.
    """
    path = Path(path)
    _refuse_long_text(path)
    with open_columns(path) as opened:
        if opened.headless:
            raise UnreadableLogError(
                f"{path.name}: a temperature profile needs a header line and at least one point"
            )
        temperature = _column(opened, "temperature")
        times = opened.clock(temperature)
        if times is None:
            time = _column(opened, "time")
            times, values = opened.numbers(time, temperature, complete=True)
            times = _in_si(path.name, "time", time, times)
        else:
            values = opened.numbers(temperature, complete=True)[0]
    if values.size > MOST_POINTS:
        raise ParameterError(f"{path.name}: {values.size} points are too many. Keep at most {MOST_POINTS}")
    try:
        return Schedule(times, _in_si(path.name, "temperature", temperature, values))
    except ParameterError as error:
        raise error.within(path.name) from None


def _refuse_long_text(path: Path) -> None:
    with suppress(OSError):  # reading it says what is wrong
        if path.is_file() and path.stat().st_size > _MOST_BYTES and format_of(path) is None:
            raise ParameterError(
                f"{path.name} is too long for a temperature profile. Keep at most {MOST_POINTS} points"
            )


def _column(opened: OpenColumns, role: str) -> Column:
    named = [column for column in opened.columns if column.name.lower().startswith(role)]
    example = f"Write '{role} [{_UNITS[role]}]' in the first line"
    if len(named) != 1:
        what = "more than one column" if named else "no column"
        raise ChannelError(f"{opened.file}: {what} is named {role}. {example}")
    if not named[0].unit:
        raise ChannelError(f"{opened.file}: {role} has no unit. {example}")
    return named[0]


def _in_si(file: str, role: str, column: Column, values: FloatArray) -> FloatArray:
    try:
        unit = conversion(role, column.unit)
    except UnitError as error:
        raise UnitError(f"{file}: column '{column.path}': {error}") from None
    return unit.scale * values + unit.offset
