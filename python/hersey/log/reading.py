"""Reading files, and frames in memory, into a `TorqueLog`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from hersey.errors import ChannelError, HerseyError, ParameterError, UnitError
from hersey.log.assembly import Assembly
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.derived.sources import Sources
from hersey.log.derived.text import text_recording
from hersey.log.exchanged import refuse_exchanged
from hersey.log.formats.frame import frame_recording, is_frame
from hersey.log.given_twice import refuse_given_twice, refuse_rows_shared
from hersey.log.layouts.current import format_of, opened
from hersey.log.not_a_log import is_one, refuse_not_a_log
from hersey.log.pooling import of_each_run
from hersey.log.recording import columns, nothing_to_read
from hersey.log.roles import CHANNELS, OTHER_ROLES, ROLES, UNITS
from hersey.log.text.column import distinct_names
from hersey.log.text.delimited import Progress, delimited_columns, read_delimited
from hersey.log.torque_log import LARGEST, LogFile, Run, TorqueLog
from hersey.log.wanted import Wanted
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Kind of the warning of a temperature that cannot be read.
NOT_READ = "temperature not read"


@takes_si(every="time", radius="length", load="force", position_window="time", channels=CHANNELS, units=UNITS)
def read(
    paths: Any,
    *,
    channels: dict[str, str] | None = None,
    units: dict[str, str] | None = None,
    isothermal: bool = False,
    drop_missing: bool = False,
    every: float | None = None,
    radius: float | Sequence[float] | None = None,
    load: float | Sequence[float] | None = None,
    without_torque: bool = False,
    name_pattern: str | None = None,
    name_decimal: str | None = None,
    run_table: str | Path | None = None,
    schedule: Any = None,
    position_window: float | None = None,
    progress: Progress | None = None,
) -> TorqueLog:
    """Read one log, or several of the same machine, each as a separate run.

    Parameters
    ----------
    paths
        File or files (text, Excel, LVM, TDMS, MDF, MATLAB, HDF5, NumPy, Parquet), or polars or pandas frames.
    channels
        Column name by role (``time``, ``torque``, ``speed``, ``temperature``; ``load``, ``radius``, and
        ``run``, the run number; ``position``, an angle or a distance instead of a speed; ``direction`` of a
        speed without a sign), if names and units in the file are not sufficient. ``name#2`` is the second
        column with that name, ``group/name`` a column in a part of the file, ``#2`` the second column of a
        table without header. Torque may be a friction force or coefficient; speed may be a sliding speed.
    units
        Unit by role, if it is missing or wrong in the file; it may include a factor or sign.
    isothermal
        Whether to ignore temperature.
    drop_missing
        Whether to exclude and count rows with a missing number even if there are many. A few such rows are
        always excluded, with a warning. So are impossible readings: up to a fifth of a channel, or up to a
        half with this option.
    every
        Time between rows, s, if the file has no time column.
    radius
        Radius at which a friction force acts and a sliding speed is measured, m, if there is no column for
        it; one value, or one per run.
    load
        Normal load, N, if there is no column for it; one value, or one per run.
    without_torque
        Whether to read time and speed alone, for `hersey.coast_down`: no torque is looked for, and all its
        values are NaN.
    name_pattern
        Pattern of the file names, e.g. ``"{speed} rpm {load} N.txt"``, if they state speed, load, radius or
        temperature. ``*`` stands for any text.
    name_decimal
        Decimal mark of the numbers in the names, e.g. ``"-"`` for ``0-1rps.txt``.
    run_table
        File with a row for each log: a column ``file``, and speed, load, radius or temperature with their
        units (``load [N]``).
    schedule
        Speed, temperature or load by time, if the log has no channel of it: a file (``from [s]``,
        ``to [s]``, ``speed [rpm]``), or a list of ``{"from": "0 s", "to": "60 s", "speed": "10 rpm"}``.
        Times are counted from the first row. With sliding speeds, distances may stand in their place.
    position_window
        Time over which speed is the slope of a ``position`` column, s (0.2 s, or less if motion is faster).
    progress
        Called with bytes done and total bytes.

    Raises
    ------
    HerseyError
        With file, line and column in the message.

    Examples
    --------
    >>> import hersey
    >>> log = hersey.read("examples/bench.csv")
    >>> log.rows > 10_000
    True
    """
    files = _listed(paths)
    if not files:
        raise ParameterError("no log file is given")
    known = (*ROLES, *OTHER_ROLES)
    for name, by_role in (("channels", channels or {}), ("units", units or {})):
        unknown = [role for role in by_role if role not in known]
        if unknown:
            wrong_way = {role for role in unknown if by_role[role] in known}
            turned = {
                by_role[r] if r in wrong_way else r: r if r in wrong_way else by_role[r] for r in by_role
            }
            raise ParameterError(
                f"unknown role '{unknown[0]}' of a channel. The roles are {', '.join(known)}",
                remedy=f"write {name}={turned}" if wrong_way else "",
            )
    choices = {r: ChannelChoice((channels or {}).get(r, ""), (units or {}).get(r, "")) for r in known}
    stated = _stated(every=every, radius=radius, load=load)
    sources = Sources.of(name_pattern, name_decimal, run_table, schedule, position_window)
    sources.refuse_twice(choices, stated)
    stated = sources.stated(stated, files)
    names = tuple(Path(file).name for file in files if isinstance(file, str | Path))
    wanted = Wanted(choices, stated, isothermal, drop_missing, without_torque, names=names)
    done: list[tuple[Run, LogFile]] = []
    for number, file in enumerate(files, start=1):
        of_file = replace(wanted, derived=sources.of_file(file))
        name = "frame" if len(files) == 1 else f"frame {number}"
        read_here = (_speeds if without_torque else _runs)(file, of_file, name, progress)
        if any(read_here[0][1].sha256 == other.sha256 for _, other in done):
            name = read_here[0][1].name
            raise ParameterError(f"{name} has the same content as an earlier file. Give each file once")
        done += read_here
    done = of_each_run(done, stated)
    if unused := sources.unused(names, choices, stated):
        run, first = done[0]
        done[0] = run, replace(first, warnings=(*first.warnings, *unused))
    log = TorqueLog(tuple(run for run, _ in done), tuple(log for _, log in done))
    refuse_given_twice(log.runs)
    refuse_rows_shared(log.runs)
    if not without_torque:
        refuse_exchanged(log, choices)
    return log


def _runs(file: Any, wanted: Wanted, frame: str, progress: Progress | None) -> list[tuple[Run, LogFile]]:
    """The runs in a file, or in a frame of that name."""
    if is_frame(file):
        return Assembly(frame_recording(file, frame), wanted).runs()
    if kind := format_of(path := Path(file)):
        with opened(path, kind) as recording:
            assembly = Assembly(recording, wanted)
        return assembly.runs()
    if wanted.needs_parts:
        with text_recording(path) as recording:
            return Assembly(recording, wanted).runs()
    return read_delimited(path, wanted, progress)


def _speeds(file: Any, wanted: Wanted, frame: str, progress: Progress | None) -> list[tuple[Run, LogFile]]:
    """The runs in a log without torque, with a temperature if one is found."""
    try:
        return _runs(file, wanted, frame, progress)
    except (ChannelError, UnitError) as error:
        if wanted.choices["temperature"] != ChannelChoice():
            raise
        absent = isinstance(error, ChannelError) and error.absent
        why = (temperature_not_read(error),) if is_of_temperature(error) and not absent else ()
    found = _runs(file, replace(wanted, isothermal=True), frame, progress)
    return [(run, replace(log, warnings=(*log.warnings, *why))) for run, log in found]


def is_of_temperature(error: HerseyError) -> bool:
    """Return whether an error is one of the channel of temperature."""
    return error.setting is not None and error.setting.name == "temperature"


def temperature_not_read(error: HerseyError) -> Warning:
    """Return the warning of a log without torque that is read without a temperature, for this error."""
    return Warning(NOT_READ, "{why}, so no temperature is used", severity="watch", why=error.reason)


def _stated(*, every: Any, radius: Any, load: Any) -> Stated:
    """What the user says of the log, if it can be."""
    given = {"every": every, "radius": radius, "load": load}
    for name, value in given.items():
        for one in np.atleast_1d(value) if value is not None else ():
            if not 0 < one < LARGEST:
                raise ParameterError(f"{name} is {one:g} (SI): it must be greater than 0")
        if np.ndim(value):
            given[name] = tuple(map(float, value))
    return Stated(**given)


def list_channels(path: Any) -> list[tuple[str, str]]:
    """Return name and unit, as written, of every channel of numbers in a file or frame.

    The unit is empty where the file has none. Names are those that `read` understands in ``channels=``.

    Raises
    ------
    HerseyError
        If the file cannot be read.

    Examples
    --------
    >>> from hersey.log import list_channels
    >>> list_channels("examples/bench.csv")[1]
    ('Drive torque', 'N*m')
    """
    if is_frame(path):
        listed = columns(frame_recording(path))
    elif kind := format_of(path := Path(path)):
        with opened(path, kind) as recording:
            listed = columns(recording)
            if not listed and recording.nothing:
                raise nothing_to_read(recording)
    else:
        listed = delimited_columns(path)
    return list(zip(distinct_names(listed), (column.unit for column in listed), strict=True))


def _listed(paths: Any) -> list[Any]:
    """The files and frames, each of which is one.

    Raises
    ------
    ParameterError
        If something else is among them.
    """
    listed = [paths] if is_one(paths) or not isinstance(paths, Iterable) else list(paths)
    for each in listed:
        refuse_not_a_log(each, "hersey.read")
    return listed
