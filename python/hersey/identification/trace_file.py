"""A trace read from a CSV or MAT file: time and one quantity, in SI."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, MissingFileError, ParameterError, UnitError, UnreadableLogError
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
_HEADING = re.compile(r"\s*(?P<name>.*?)\s*(?:[\[(]\s*(?P<unit>[^\[\]()]*?)\s*[\])])?\s*")
_MISSING = {"", "nan", "na", "n/a", "null", "none", "-"}


@dataclass(frozen=True)
class TraceFile:
    """Time, s, and a quantity in SI (or as a share of a weight), NaN where the file has no number."""

    time: FloatArray
    value: FloatArray
    quantity: str
    unit: str
    name: str


def read_trace(
    path: str | Path,
    *,
    quantity: str = "",
    time: str = "",
    value: str = "",
    time_unit: str = "",
    unit: str = "",
) -> TraceFile:
    """Read a trace from a CSV file with a heading such as ``time [s],force [N]``, or from a MAT file.

    Parameters
    ----------
    quantity
        ``force``, ``torque`` or ``speed``; found by name if left out.
    time, value
        Names of the columns (or MAT variables); found by name if left out.
    time_unit, unit
        Their units, needed where the heading has none; ``1`` for a force as a share of a weight.

    Raises
    ------
    MissingFileError, UnreadableLogError, ChannelError, UnitError, ParameterError
        Each names the file, and the column or line.
    """
    path = Path(path)
    if not path.is_file():
        raise MissingFileError(f"{path}: there is no such file")
    if quantity and quantity not in QUANTITIES:
        raise ParameterError(f"quantity '{quantity}' is not known: {', '.join(QUANTITIES)}")
    is_mat = path.suffix.lower() == ".mat"
    arrays = _mat_columns(path) if is_mat else {}
    columns = tuple(arrays) if is_mat else _csv_names(path)
    time_name = _chosen(path, columns, time, _TIMES, "time")
    quantity = quantity or _quantity(path, columns, value)
    value_name = _chosen(path, columns, value, QUANTITIES[quantity][1], quantity)
    if is_mat:
        times, values = arrays[time_name], arrays[value_name]
        heading_units = {time_name: "", value_name: ""}
    else:
        times, values = _csv_columns(path, time_name, value_name)
        heading_units = {name: _split(name)[1] for name in (time_name, value_name)}
    if times.shape != values.shape:
        raise UnreadableLogError(
            f"{path.name}: {time_name} has {times.size} numbers, {value_name} {values.size}: they must agree"
        )
    seconds = _si(path, "time", times, time_unit or heading_units[time_name], time_name, "--time-unit")
    used = unit or heading_units[value_name]
    if used == RELATIVE and quantity == "force":
        return TraceFile(seconds, values, quantity, RELATIVE, value_name)
    kind = _kind(quantity, used)
    converted = _si(path, kind, values, used, value_name, "--unit")
    return TraceFile(seconds, converted, quantity, KINDS[kind][0], value_name)


def _kind(quantity: str, unit: str) -> str:
    """A speed may be that of a belt or of a roll."""
    kind = QUANTITIES[quantity][0]
    if quantity == "speed" and unit:
        try:
            conversion(kind, unit)
        except UnitError:
            return "speed"
    return kind


def _si(path: Path, kind: str, values: FloatArray, unit: str, name: str, flag: str) -> FloatArray:
    if not unit:
        raise UnitError(f"{path.name}: {name} has no unit: give {flag} {KINDS[kind][1]}")
    try:
        line = conversion(kind, unit)
    except UnitError as error:
        raise UnitError(f"{path.name}: {name}: {error}") from None
    return line.scale * values + line.offset


def _split(heading: str) -> tuple[str, str]:
    match = _HEADING.fullmatch(heading)
    return (match["name"], match["unit"] or "") if match else (heading.strip(), "")


def _plain(heading: str) -> str:
    return _split(heading)[0].lower().replace("_", " ")


def _chosen(path: Path, columns: tuple[str, ...], wanted: str, names: tuple[str, ...], role: str) -> str:
    known = ", ".join(columns)
    if wanted:
        found = [name for name in columns if wanted in (name, _split(name)[0])]
        if not found:
            raise ChannelError(f"{path.name}: there is no column '{wanted}': it has {known}")
    else:
        found = [name for name in columns if _plain(name) in names]
    if len(found) != 1:
        flag = "--time" if role == "time" else "--value"
        what = "no column is" if not found else f"{', '.join(found)} could be"
        raise ChannelError(f"{path.name}: {what} the {role}: name it with {flag}; it has {known}")
    return found[0]


def _quantity(path: Path, columns: tuple[str, ...], value: str) -> str:
    """What the named column is, or the only one that has a known name."""
    if value and _plain(value) not in {n for _, names in QUANTITIES.values() for n in names}:
        return "force"
    found = [
        quantity
        for quantity, (_, names) in QUANTITIES.items()
        if any(_plain(name) in names for name in ([value] if value else columns))
    ]
    if len(found) != 1:
        what = " and ".join(found) or "no force, torque or speed"
        raise ChannelError(
            f"{path.name} holds {what}: name the column with --value; it has {', '.join(columns)}"
        )
    return found[0]


def _csv_names(path: Path) -> tuple[str, ...]:
    import polars as pl

    try:
        frame = pl.read_csv(path, comment_prefix="#", n_rows=0, infer_schema=False)
    except (pl.exceptions.PolarsError, UnicodeDecodeError, OSError) as error:
        raise UnreadableLogError(f"{path.name}: {str(error).splitlines()[0]}") from None
    return tuple(frame.columns)


def _csv_columns(path: Path, *names: str) -> list[FloatArray]:
    import polars as pl

    try:
        frame = pl.read_csv(path, comment_prefix="#", columns=list(names), infer_schema=False)
    except (pl.exceptions.PolarsError, UnicodeDecodeError, OSError) as error:
        raise UnreadableLogError(f"{path.name}: {str(error).splitlines()[0]}") from None
    columns = []
    for name in names:
        text = frame[name].str.strip_chars()
        numbers = text.cast(pl.Float64, strict=False)
        wrong = numbers.is_null() & text.is_not_null() & ~text.str.to_lowercase().is_in(list(_MISSING))
        if wrong.any():
            row = int(wrong.arg_true()[0])
            raise UnreadableLogError(
                f"{path.name}: column {name}: row {row + 1} is '{text[row]}', which is no number"
            )
        columns.append(numbers.fill_null(float("nan")).to_numpy().astype(float))
    return columns


def _mat_columns(path: Path) -> dict[str, FloatArray]:
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        content = loadmat(path)
    except NotImplementedError:
        raise UnreadableLogError(
            f"{path.name} is a MAT file of version 7.3 (HDF5): save it with '-v7' or as CSV"
        ) from None
    except (MatReadError, ValueError, TypeError, KeyError, OSError, EOFError, IndexError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise UnreadableLogError(f"{path.name} cannot be read as a MAT file: {reason}") from None
    found = {
        name: np.asarray(value, dtype=float).ravel()
        for name, value in content.items()
        if not name.startswith("__") and isinstance(value, np.ndarray) and value.dtype.kind in "fiu"
    }
    if not found:
        raise UnreadableLogError(f"{path.name} holds no array of numbers")
    return found
