"""Tables in memory: polars and pandas frames."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, UnreadableLogError
from hersey.log.recording import Recording, Signal, Source, floats, seconds
from hersey.log.text.column import split_unit
from hersey.log.text.stamps import OF_WINCC
from hersey.processes.forks import refuse_after_fork


def is_frame(thing: object) -> bool:
    """Return whether a thing is a polars or pandas frame."""
    return isinstance(thing, pl.DataFrame | pl.LazyFrame) or (
        type(thing).__module__.split(".")[0] == "pandas" and type(thing).__name__ == "DataFrame"
    )


def frame_recording(frame: Any, name: str = "frame") -> Recording:
    """Return a frame as a recording, with the SHA-256 of its numbers and their size in bytes.

    Units stand in the names of the columns, or in ``frame.attrs["units"]`` (pandas) by column. An index of
    time stamps, or with a name, counts as a column.
    """
    refuse_after_fork()
    columns = _columns(frame)
    attributes = getattr(frame, "attrs", None)
    units = attributes.get("units", {}) if isinstance(attributes, dict) else {}
    if not isinstance(units, dict):
        raise ParameterError("frame.attrs['units'] is not a dictionary. Write one such as {'Tq': 'N*m'}")
    digest, size = hashlib.sha256(), 0
    signals, others = [], []
    for column, series in columns:
        kind = series.dtype
        if not (kind.is_numeric() or kind.is_temporal() or kind == pl.Boolean):
            others.append(f"'{column}' ({kind})")
            continue
        numbers = np.ascontiguousarray(series.to_physical().to_numpy())
        digest.update(column.encode() + numbers.tobytes())
        size += numbers.nbytes
        signals.append(column_signal(column, kind, len(series), series.clone, str(units.get(column, ""))))
    source = Source(name, digest.hexdigest(), size)
    return Recording("frame", tuple(signals), tuple(others), source=source)


def column_signal(
    name: str, kind: pl.DataType, rows: int, load: Callable[[], pl.Series], unit: str = ""
) -> Signal:
    """Return a column as a signal; time stamps and durations come in s."""
    plain, stated = (name, unit) if unit else split_unit(name)
    if name == OF_WINCC:  # what it counts shows by its size
        plain = name

    def numbers() -> FloatArray:
        series = load()
        if len(series) != rows:
            raise UnreadableLogError(f"column '{name}' has {len(series)} values instead of {rows}")
        if kind.is_temporal():
            if kind == pl.Duration or kind == pl.Time:
                return floats(series.to_physical().cast(pl.Float64).fill_null(np.nan)) * _tick(kind)
            return seconds(series.cast(pl.Datetime("ns")).to_numpy())
        return floats(series.cast(pl.Float64).fill_null(np.nan).to_numpy())

    return Signal(plain, "s" if kind.is_temporal() else stated, rows, numbers)


def _tick(kind: pl.DataType) -> float:
    """Seconds in one unit of the physical numbers of a duration or a time of day."""
    return {"ms": 1e-3, "us": 1e-6}.get(str(getattr(kind, "time_unit", "ns")), 1e-9)


def _columns(frame: Any) -> list[tuple[str, pl.Series]]:
    if isinstance(frame, pl.LazyFrame):
        frame = frame.collect()
    if isinstance(frame, pl.DataFrame):
        return [(series.name, series) for series in frame.get_columns()]
    named = [(" ".join(map(str, c)) if isinstance(c, tuple) else str(c)) for c in frame.columns]
    columns = [(name, frame.iloc[:, i]) for i, name in enumerate(named)]
    if getattr(frame.index.dtype, "kind", "O") in "Mm" or frame.index.name:
        columns.insert(0, (str(frame.index.name or "time"), frame.index.to_series()))
    return [(name, _series(name, column)) for name, column in columns]


def _series(name: str, column: Any) -> pl.Series:
    kind = getattr(column.dtype, "kind", "O")
    if kind == "M" and getattr(column.dtype, "tz", None) is not None:
        column = column.dt.tz_convert("UTC").dt.tz_localize(None)
    if kind in "iufb":  # also the kinds that can say that a value is missing
        return pl.Series(name, column.to_numpy(dtype=float, na_value=np.nan))
    values = column.to_numpy()
    if values.dtype == object:
        return pl.Series(name, [str(v) for v in values], dtype=pl.String)
    return pl.Series(name, values)
