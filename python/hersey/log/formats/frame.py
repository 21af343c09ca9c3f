"""Tables in memory: polars and pandas frames."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Iterator
from datetime import datetime
from typing import Any

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, UnreadableLogError
from hersey.log.recording import Recording, Signal, Source, floats, seconds
from hersey.log.text.column import split_unit
from hersey.log.text.numbers import is_missing, looks_numeric, style_of
from hersey.log.text.stamps import OF_WINCC
from hersey.processes.forks import refuse_after_fork

#: Format of a recording that is a frame.
FRAME = "frame"
#: Types of columns that may hold numbers written as text.
_TEXT = (pl.String, pl.Categorical, pl.Enum)
#: How a time stamp in text begins.
_STAMP = r"^\s*[0-9]{4}-[0-9]{2}-[0-9]{2}[T ][0-9]{2}:"


def is_frame(thing: object) -> bool:
    """Return whether a thing is a polars or pandas frame."""
    return isinstance(thing, pl.DataFrame | pl.LazyFrame) or (
        type(thing).__module__.split(".")[0] == "pandas" and type(thing).__name__ == "DataFrame"
    )


def frame_recording(frame: Any, name: str = "frame") -> Recording:
    """Return a frame as a recording, with the SHA-256 of its numbers and their size in bytes.

    Units stand in the names of the columns, or in ``frame.attrs["units"]`` (pandas) by column. An index of
    time stamps, or with a name, counts as a column. Text whose every cell is a number is read as numbers,
    with decimal commas if the frame has them.
    """
    refuse_after_fork()
    columns = _as_numbers(_columns(frame))
    attributes = getattr(frame, "attrs", None)
    units = attributes.get("units", {}) if isinstance(attributes, dict) else {}
    if not isinstance(units, dict):
        raise ParameterError("frame.attrs['units'] is not a dictionary. Write one such as {'Tq': 'N*m'}")
    digest, size = hashlib.sha256(), 0
    signals, others = [], []
    for column, series in columns:
        kind = series.dtype
        if not (kind.is_numeric() or kind.is_temporal() or kind == pl.Boolean):
            others.append(f"'{column}' ({_held(series)})")
            continue
        numbers = np.ascontiguousarray(series.to_physical().to_numpy())
        digest.update(column.encode() + numbers.tobytes())
        size += numbers.nbytes
        signals.append(column_signal(column, kind, len(series), series.clone, str(units.get(column, ""))))
    source = Source(name, digest.hexdigest(), size)
    return Recording(FRAME, tuple(signals), tuple(others), source=source)


def _as_numbers(columns: list[tuple[str, pl.Series]]) -> list[tuple[str, pl.Series]]:
    """The same columns, numbers that are written as text as numbers."""
    written = [series.cast(pl.String) for _, series in columns if series.dtype in _TEXT]
    style = style_of([cell.strip() for series in written for cell in series.drop_nulls()])
    found = []
    for column, series in columns:
        numbers = style.values(series.cast(pl.String)) if series.dtype in _TEXT else None
        if numbers is not None and np.isfinite(numbers).any():
            series = pl.Series(column, numbers)
        elif series.dtype in _TEXT and _are_stamps(series.cast(pl.String)):
            series = series.cast(pl.String).str.to_datetime(time_unit="ns", strict=False)
        found.append((column, series))
    return found


def _are_stamps(texts: pl.Series) -> bool:
    """Whether every text is a time stamp that begins with the year, which can be read in one way only."""
    if texts.drop_nulls().is_empty() or not texts.drop_nulls().str.contains(_STAMP).all():
        return False
    try:
        return texts.str.to_datetime(time_unit="ns", strict=False).null_count() == texts.null_count()
    except pl.exceptions.PolarsError:  # no one format
        return False


def _times(name: str, values: list[Any]) -> pl.Series | None:
    """Objects that are dates with times as a column, or None if they are others."""
    if not any(isinstance(each, datetime) for each in values):
        return None
    try:
        return pl.Series(name, values, dtype=pl.Datetime("us"))
    except (TypeError, pl.exceptions.PolarsError):
        return None


def _held(series: pl.Series) -> str:
    """What a column holds that is none of numbers, in words."""
    cells = series.cast(pl.String).drop_nulls() if series.dtype in _TEXT else series.clear()
    there = [cell for cell in cells if not is_missing(cell.strip())]
    odd = next((cell for cell in there if not looks_numeric(cell.strip())), there[0] if there else "")
    return f"text, e.g. '{odd[:40]}'" if odd else str(series.dtype)


def column_signal(
    name: str,
    kind: pl.DataType,
    rows: int,
    load: Callable[[], pl.Series],
    unit: str = "",
    parts: Callable[[], Iterator[pl.Series]] | None = None,
) -> Signal:
    """Return a column as a signal; time stamps and durations come in s.

    ``parts`` yields what ``load`` returns, part by part, if a column can be had so.
    """
    plain, stated = (name, unit) if unit else split_unit(name)
    if name == OF_WINCC:  # what it counts shows by its size
        plain = name

    def numbers(series: Iterable[pl.Series]) -> Iterator[FloatArray]:
        found, start = 0, None
        for each in series:
            found += len(each)
            if kind.is_temporal() and kind not in (pl.Duration, pl.Time):
                stamps = each.cast(pl.Datetime("ns")).to_numpy()
                known = stamps[~np.isnat(stamps)]
                start = known[0] if start is None and known.size else start
                yield seconds(stamps, start)
            elif kind.is_temporal():
                yield floats(each.to_physical().cast(pl.Float64).fill_null(np.nan)) * _tick(kind)
            else:
                yield floats(each.cast(pl.Float64).fill_null(np.nan).to_numpy())
        if found != rows:
            raise UnreadableLogError(f"column '{name}' has {found} values instead of {rows}")

    def whole() -> FloatArray:
        (values,) = numbers([load()])
        return values

    by_parts = None if parts is None else lambda: numbers(parts())
    return Signal(plain, "s" if kind.is_temporal() else stated, rows, whole, parts=by_parts)


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
        missing = column.isna().to_numpy()
        times = _times(name, [None if gone else v for v, gone in zip(values, missing, strict=True)])
        if times is not None:
            return times
        texts = [None if gone else str(v) for v, gone in zip(values, missing, strict=True)]
        return pl.Series(name, texts, dtype=pl.String)
    return pl.Series(name, values)
