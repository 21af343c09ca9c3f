"""A table of failures and suspensions: one row for each specimen, or for several of one age."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.errors import ChannelError, HerseyError, ParameterError, Setting, UnreadableLogError
from hersey.files.tables import text_of
from hersey.life.failures.cells import Table, above_zero, age_of, count_of, read_cells
from hersey.life.failures.sample import Failures
from hersey.units import takes_si

_FAILED = frozenset(["failed", "failure", "fail", "f", "broken", "event", "dead"])
_RUNNING = frozenset(
    ["running", "suspended", "suspension", "s", "censored", "survived", "alive", "right", "ok", "good", "c"]
)
_LEFT = frozenset(["left", "before", "found failed"])
_YES, _NO = frozenset(["1", "1.0", "yes", "true", "y"]), frozenset(["0", "0.0", "no", "false", "n"])
#: An end that a specimen has not reached, as other programs write it.
_ENDLESS = frozenset(["inf", "infinity", "\u221e"])
_AMOUNT = re.compile(r"\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(\S.*?)\s*")
#: The stress of use.
_USE = Setting("use")
_EXAMPLE = "age [pages],status"
_ROWS = "write failed or running in each row"


@takes_si()
def read_failures(path: str | Path, *, arrhenius: str = "", power: str = "", use: str = "") -> Failures:
    """Read a table of failures and suspensions, separated by commas, semicolons or tabs.

    Either ``age`` with ``status`` (failed, running, or left for one found failed at that age), or ``low``
    and ``high`` (the last age at which it was good, the first at which it had failed; no ``high`` if it
    still runs). ``failed`` or ``censored`` with yes or no may stand for ``status``. The unit stands in each
    cell (``120000 pages``) or in the heading (``age [pages]``). Also read are ``count`` (specimens of a
    row) and ``mode``. Columns named as in sheets of Minitab, Weibull++ and R do too.

    Parameters
    ----------
    path
        The table.
    arrhenius
        Column of temperature with its unit in the heading; life depends on it by Arrhenius.
    power
        Column of a load with its unit in the heading; life depends on it by an inverse power.
    use
        Temperature or load for which ages are wanted, e.g. "40 degC".

    Raises
    ------
    HerseyError
        If a column or a cell is missing or unclear, naming file, line and column.
    """
    stress = arrhenius or power
    _refuse_half(arrhenius, power, use)
    table = read_cells(Path(path))
    _refuse_unclear(table, stress)
    reader = _between if "low" in table.at else _at_ages
    unit = ""
    lows, highs, counts, modes, stresses = [], [], [], [], []
    for line, row in table.rows:
        low, high, unit = reader(table, line, row, unit)
        lows.append(low)
        highs.append(high)
        counts.append(count_of(table, line, row))
        modes.append(_mode(table, line, row, failed=math.isfinite(high)))
        if stress:
            stresses.append(_stress(table, line, row, stress))
    stress_unit = table.others[stress.casefold()][1] if stress else ""
    return Failures(
        np.array(lows),
        np.array(highs),
        np.array(counts, dtype=np.intp),
        unit,
        tuple(modes) if any(modes) else (),
        np.array(stresses) if stress else None,
        stress_unit,
        "arrhenius" if arrhenius else "power" if power else None,
        _of_use(use, stress_unit) if stress else None,
    )


def _refuse_unclear(table: Table, stress: str) -> None:
    """Refuse a table whose columns do not say which specimens failed when, or that has unknown ones."""
    at = table.at
    columns = table.columns
    remedy = f"line 1 must name age and status, e.g. '{_EXAMPLE}', or low and high, e.g. 'low [h],high [h]'"
    if len(table.listed) == 1 and len(table.listed[0].split()) > 1:
        remedy = f"separate columns by commas, e.g. '{','.join(table.listed[0].split())}'"
    if "age" in at and ("low" in at or "high" in at):
        raise ChannelError(f"{table.name}: columns of 'age' and of 'low' or 'high'. {columns}", remedy=remedy)
    if "age" not in at and not {"low", "high"} <= at.keys():
        missing = "age" if "low" not in at and "high" not in at else "low" if "low" not in at else "high"
        raise ChannelError(f"{table.name}: there is no column '{missing}'. {columns}", remedy=remedy)
    states = table.states
    if "age" in at and not states and "mode" not in at:
        raise ChannelError(
            f"{table.name}: no column says which specimens failed. {columns}",
            remedy=f"add a column 'status' and {_ROWS}",
        )
    if len(states) > 1:
        again = table.names[states[-1]]
        raise ChannelError(
            f"{table.name}: column '{again}' says again which specimens failed. {columns}",
            remedy=f"delete column '{again}'",
        )
    _refuse_others(table, columns, stress)
    _refuse_row_numbers(table, columns)
    if not table.rows:
        raise UnreadableLogError(
            f"{table.name} lists no specimens. Write one line per specimen below the header"
        )


def _refuse_row_numbers(table: Table, columns: str) -> None:
    """Refuse a column 'n' that may count specimens or rows."""
    if table.names.get("count", "").casefold() != "n" or len(table.rows) < 2:
        return
    if [table.cell(row, "count") for _, row in table.rows] == [str(i + 1) for i in range(len(table.rows))]:
        raise ChannelError(
            f"{table.name}: column 'n' numbers the rows or counts specimens. {columns}",
            remedy="name it 'id' or 'count'",
        )


def _refuse_others(table: Table, columns: str, stress: str) -> None:
    """Refuse a column of stress that is not there or has no unit."""
    if not stress:
        return
    if stress.casefold() not in table.others:
        raise ChannelError(f"{table.name}: there is no column '{stress}'. {columns}")
    if not table.others[stress.casefold()][1]:
        raise ChannelError(
            f"{table.name}: column '{stress}' has no unit",
            remedy=f"write it in the heading, e.g. '{stress} [degC]'",
        )


def _at_ages(table: Table, line: int, row: Sequence[str], unit: str) -> tuple[float, float, str]:
    """The ends of a row with an age and its status."""
    age = age_of(table, line, row, "age", unit)
    value = above_zero(table, line, "age", age)
    status = _status(table, line, row)
    low, high = {"failed": (value, value), "running": (value, math.inf), "left": (0.0, value)}[status]
    return low, high, age.unit


def _status(table: Table, line: int, row: Sequence[str]) -> str:
    """Whether specimens of a row failed at its age, run, or were found failed."""
    if not table.states:
        return "failed" if _named_mode(table, row) else "running"
    role = table.states[0]
    typed = table.cell(row, role)
    cell = typed.casefold()
    if role != "failed":  # where F may be false
        for name, words in (("failed", _FAILED), ("running", _RUNNING), ("left", _LEFT)):
            if cell in words:
                return name
    if role != "status" or table.names[role].casefold() == "event":
        for words, failed in ((_YES, True), (_NO, False)):
            if cell in words:
                return "failed" if failed != (role == "censored") else "running"
    shown = f"'{typed[:40]}'" if typed else "empty"
    where = f"{table.place(line, role)} is {shown}"
    if role != "status":
        raise UnreadableLogError(f"{where}: write yes or no")
    if cell in ("0", "1", "0.0", "1.0"):
        raise UnreadableLogError(
            f"{where}: {_ROWS}, or name the column 'failed' if 1 means failed, 'censored' if 1 means running"
        )
    raise UnreadableLogError(f"{where}: {_ROWS} (or left, if it was found failed at that age)")


def _between(table: Table, line: int, row: Sequence[str], unit: str) -> tuple[float, float, str]:
    """The ends of a row with the last age at which it was good and the first at which it had failed."""
    low, high = table.cell(row, "low"), table.cell(row, "high")
    high = "" if high.casefold() in _ENDLESS else high
    if not (low or high):
        both = f"'{table.names['low']}' and '{table.names['high']}'"
        raise UnreadableLogError(f"{table.name}, line {line}: columns {both} are empty. Fill one in")
    first = last = None
    if low:
        first = age_of(table, line, row, "low", unit)
        unit = first.unit
    if high:
        last = age_of(table, line, row, "high", unit)
        above_zero(table, line, "high", last)
        unit = last.unit
    begin = first.value if first else 0.0
    if first and last and last.value < begin:
        raise ParameterError(f"{table.place(line, 'high')}: {last} is less than low, {first}. Swap them")
    status = _status(table, line, row) if table.states else "running" if last is None else "failed"
    if status == "running":
        seen = last or first
        assert seen is not None
        return above_zero(table, line, "high" if last else "low", seen), math.inf, unit
    if last is None:
        raise UnreadableLogError(f"{table.place(line, 'high')} is empty, but it failed. Fill it in")
    return 0.0 if status == "left" else begin, last.value, unit


def _named_mode(table: Table, row: Sequence[str]) -> str:
    cell = table.cell(row, "mode")
    return "" if cell.casefold() in _RUNNING | {"none", "-", ""} else cell


def _mode(table: Table, line: int, row: Sequence[str], *, failed: bool) -> str:
    if "mode" not in table.at:
        return ""
    named = _named_mode(table, row)
    if failed and not named:
        raise UnreadableLogError(
            f"{table.place(line, 'mode')} is empty, but it failed. Name the mode, or write unknown"
        )
    return named if failed else ""


def _stress(table: Table, line: int, row: Sequence[str], stress: str) -> float:
    """Temperature in K, or a load in the unit of its heading."""
    place, unit = table.others[stress.casefold()]
    cell = text_of(row[place].strip()) if place < len(row) else ""
    return _number(cell, unit, table.place(line, "", stress))


def _number(text: str, unit: str, where: str) -> float:
    """A temperature in K, or any other stress in its own unit."""
    try:
        value = float(text)
    except ValueError:
        shown = f"'{text[:40]}'" if text else "empty"
        raise ParameterError(f"{where} is {shown}: write a number") from None
    kelvin = _kelvin(unit)
    value = value if kelvin is None else kelvin(value)
    if not (math.isfinite(value) and value > 0):
        least = "above absolute zero" if kelvin else "greater than 0"
        raise ParameterError(f"{where} is {text}: it must be {least}")
    return value


def _of_use(text: str, unit: str) -> float:
    """The stress of use, which states its unit: a temperature in K, or a load in the unit of the column."""
    where = _USE.to()
    match = _AMOUNT.fullmatch(text)
    if match is None or not (match[2] == unit or (_kelvin(unit) and _kelvin(match[2]))):
        raise ParameterError(
            f"{where} is '{text[:40]}': write a number in {unit}, e.g. {_USE.to(f'40 {unit}')}"
        )
    return _number(match[1], match[2], where)


def _refuse_half(arrhenius: str, power: str, use: str) -> None:
    """Refuse both relations, and a relation without the stress of use."""
    both = Setting("arrhenius"), Setting("power")
    column = both[0] if arrhenius else both[1]
    if arrhenius and power:
        named = " and ".join(each.to() for each in both)
        raise ParameterError(f"{named} exclude each other: give one of them")
    if (arrhenius or power) and not use:
        example = "40 degC" if arrhenius else "40 N"
        raise ParameterError(f"{column.to()} needs the stress of use: add e.g. {_USE.to(example)}")
    if use and not (arrhenius or power):
        named = " or ".join(each.to("COLUMN") for each in both)
        raise ParameterError(f"{_USE.to()} needs the column of the stress: add {named}")


def _kelvin(unit: str) -> Callable[[float], float] | None:
    """What makes kelvins of a unit of temperature; None for another unit."""
    from hersey.units import conversion

    try:
        to = conversion("temperature", unit)
    except HerseyError:
        return None
    return lambda value: to.scale * value + to.offset


def read_fleet(path: str | Path, unit: str) -> tuple[FloatArray, IntArray]:
    """Read the ages of specimens that run, in ``unit``, and how many of each: columns age and count.

    Raises
    ------
    HerseyError
        If a column or a cell is missing or unclear, naming file, line and column.
    """
    table = read_cells(Path(path))
    if "age" not in table.at:
        raise ChannelError(
            f"{table.name}: there is no column 'age'. {table.columns}",
            remedy=f"line 1 must name age, e.g. 'age [{unit or 'pages'}],count'",
        )
    if not table.rows:
        raise UnreadableLogError(f"{table.name} lists no specimens. Write one line per age below the header")
    ages = [age_of(table, line, row, "age", unit).value for line, row in table.rows]
    counts = [count_of(table, line, row) for line, row in table.rows]
    return np.array(ages), np.array(counts, dtype=np.intp)
