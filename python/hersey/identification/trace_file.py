"""A trace read from a file of any format that a log may have: time and one quantity, in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, ParameterError, Setting, UnitError, UnreadableLogError, meant
from hersey.log.channels import called
from hersey.log.columns import OpenColumns, open_columns
from hersey.log.roles import ROLE_KINDS, is_called, is_of_kind
from hersey.log.rows import LeftOut, runs_of
from hersey.log.text.column import Column
from hersey.schema.warning import Warning
from hersey.units import KINDS, conversion

#: What a trace may hold: kind of unit, and the names by which its column is found.
QUANTITIES: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "force": ("force", ("force", "spring force", "f", "fnorm")),
    "torque": ("torque", ("torque", "tau", "m")),
    "speed": ("belt speed", ("speed", "belt speed", "v")),
}
_TIMES = ("time", "t")
#: Unit of a force given as a share of a weight.
RELATIVE = "1"


@dataclass(frozen=True)
class TraceFile:
    """Time, s, and a quantity in SI (or as a share of a weight), NaN where the file has no number."""

    time: FloatArray
    value: FloatArray
    quantity: str
    unit: str
    name: str
    warnings: tuple[Warning, ...] = ()  #: which run of the file this is, and rows that were left out


def read_trace(
    path: str | Path,
    *,
    quantity: str = "",
    time: str = "",
    value: str = "",
    time_unit: str = "",
    unit: str = "",
) -> TraceFile:
    """Read the only run in a file, as `read_trace_runs`.

    Raises
    ------
    UnreadableLogError
        If its clock starts anew: a trace is one run.
    HerseyError
        As `read_trace_runs`.
    """
    runs = read_trace_runs(path, quantity=quantity, time=time, value=value, time_unit=time_unit, unit=unit)
    if len(runs) > 1:
        raise UnreadableLogError(
            f"{Path(path).name} has {len(runs)} runs, because its time restarts. Read it with "
            "hersey.identification.trace_file.read_trace_runs"
        )
    return runs[0]


def read_trace_runs(
    path: str | Path,
    *,
    quantity: str = "",
    time: str = "",
    value: str = "",
    time_unit: str = "",
    unit: str = "",
) -> tuple[TraceFile, ...]:
    """Read the traces in a table with a heading such as ``time [s],force [N]``, or a file of another format.

    A run ends where the clock starts anew, as in a log; a stray row is left out, with a
    warning.

    Parameters
    ----------
    quantity
        ``force``, ``torque`` or ``speed``; found by name if left out.
    time, value
        Names of the columns; found by name if left out. Time may be the clock of the channel.
    time_unit, unit
        Their units, needed where the heading has none; ``1`` for a force as a share of a weight.

    Raises
    ------
    MissingFileError, UnreadableLogError, ChannelError, UnitError, ParameterError
        Each names the file, and the column or line.
    """
    if quantity and quantity not in QUANTITIES:
        raise ParameterError(f"unknown quantity '{quantity}'. Use {', '.join(QUANTITIES)}")
    with open_columns(path) as opened:
        if opened.headless and not (time and value):
            raise UnreadableLogError(
                f"{opened.headless}. Name the columns by number, e.g. {Setting('value').to('#2')}"
            )
        quantity = quantity or _quantity(opened, value)
        chosen = _chosen(opened, opened.columns, value, QUANTITIES[quantity][1], quantity)
        times, values = _with_time(opened, chosen, time, time_unit)
    used, si = unit or chosen.unit, RELATIVE
    if used != RELATIVE or quantity != "force":
        kind = _kind(quantity, used)
        values, si = _si(opened.file, kind, values, used, chosen, Setting("unit")), KINDS[kind][0]
    return _runs(TraceFile(times, values, quantity, si, str(chosen)), opened.file)


def _runs(whole: TraceFile, file: str) -> tuple[TraceFile, ...]:
    """The runs in what a file holds, split as the runs of a log are."""
    left_out = LeftOut()
    runs = runs_of(whole.time, None, file, lambda row: f"row {row + 1} of the table", left_out)
    left = tuple(left_out.warnings())
    if len(runs) == 1:
        return (replace(whole, time=runs[0].of(whole.time), value=runs[0].of(whole.value), warnings=left),)
    return tuple(
        replace(
            whole,
            time=rows.of(whole.time),
            value=rows.of(whole.value),
            warnings=(*(left if number == 1 else ()), _one_of(number, len(runs))),
        )
        for number, rows in enumerate(runs, start=1)
    )


def _one_of(number: int, runs: int) -> Warning:
    return Warning(
        "one of several runs", "run {number} of {runs}, because the time restarts", number=number, runs=runs
    )


def _with_time(opened: OpenColumns, chosen: Column, time: str, unit: str) -> tuple[FloatArray, FloatArray]:
    """Time in s, and the numbers of the column as written."""
    clock = None if time else opened.clock(chosen)
    if clock is not None:
        return clock, opened.numbers(chosen)[0]
    beside = tuple(c for c in opened.columns if time or c.group == chosen.group)
    column = _chosen(opened, beside, time, _TIMES, "time")
    times, values = opened.numbers(column, chosen)
    if times.shape != values.shape:
        raise UnreadableLogError(
            f"{opened.file}: {column} has {times.size} numbers, but {chosen} has {values.size}. They "
            "must have equal lengths"
        )
    return _si(opened.file, "time", times, unit or column.unit, column, Setting("time_unit")), values


def _kind(quantity: str, unit: str) -> str:
    """A speed may be that of a belt or of a roll."""
    kind = QUANTITIES[quantity][0]
    if quantity == "speed" and unit:
        try:
            conversion(kind, unit)
        except UnitError:
            return "speed"
    return kind


def _si(file: str, kind: str, values: FloatArray, unit: str, column: Column, named: Setting) -> FloatArray:
    if not unit:
        raise UnitError(f"{file}: {column} has no unit. Give {named.to(KINDS[kind][1])}")
    try:
        line = conversion(kind, unit)
    except UnitError as error:
        raise UnitError(f"{file}: {column}: {error}") from None
    return line.scale * values + line.offset


def _plain(name: str) -> str:
    return name.lower().replace("_", " ")


def _chosen(
    opened: OpenColumns, columns: tuple[Column, ...], wanted: str, names: tuple[str, ...], role: str
) -> Column:
    """The column that is named, or the only one with a known name."""
    known, setting = _listed(opened), Setting("time" if role == "time" else "value")
    candidates = called(wanted, columns) if wanted else [c for c in columns if _plain(c.name) in names]
    if not wanted and not candidates:
        candidates = [c for c in columns if _could_be(role, c)]
    if wanted and not candidates:
        near = meant(wanted, [c.path for c in opened.columns])
        raise ChannelError(
            f"{opened.file}: there is no column '{wanted}'. Columns: {known}",
            remedy=f"did you mean {setting.to(near)}?" if near else "",
        )
    if len(candidates) != 1:
        first = candidates[0].path if candidates else ""
        what = (
            f"the {role} column could be {' or '.join(map(str, candidates))}"
            if candidates
            else f"no {role} column found{', which a trace needs' * (role == 'time')}"
        )
        raise ChannelError(f"{opened.file}: {what}. Name it with {setting.to(first)}. Columns: {known}")
    return candidates[0]


def _could_be(role: str, column: Column) -> bool:
    """Whether a column has a name that columns of torque or speed have in a log, and a unit of their kind."""
    if role not in ROLE_KINDS:
        return False
    kinds = ("speed", "belt speed") if role == "speed" else (role,)
    return is_called(role, column) and any(is_of_kind(kind, column.unit) for kind in kinds)


def _quantity(opened: OpenColumns, value: str) -> str:
    """What the named column is, or the only one that has a known name; a force if its name is not known."""
    columns = called(value, opened.columns) if value else opened.columns
    names = {_plain(column.name) for column in columns}
    known = [quantity for quantity, (_, usual) in QUANTITIES.items() if names & set(usual)]
    if len(known) == 1:
        return known[0]
    known = known or [q for q in ("torque", "speed") if any(_could_be(q, column) for column in columns)][:1]
    if len(known) == 1:
        return known[0]
    if value and not known:
        return "force"
    what = " and ".join(known) or "no force, torque or speed"
    usual = [name for quantity in known for name in QUANTITIES[quantity][1]]
    first = next((c for name in usual for c in opened.columns if _plain(c.name) == name), None)
    named = Setting("value").to(first.path if first and not value else "")
    raise ChannelError(f"{opened.file} has {what}. Name the column with {named}. Columns: {_listed(opened)}")


def _listed(opened: OpenColumns) -> str:
    return ", ".join(map(str, opened.columns))
