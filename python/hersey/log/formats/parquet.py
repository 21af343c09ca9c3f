"""Parquet files, through polars."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import BinaryIO

import polars as pl

from hersey.log.formats.frame import column_signal
from hersey.log.recording import Recording

#: Rows of a column that are read at once.
_AT_ONCE = 1 << 18


@contextmanager
def open_parquet(file: BinaryIO, _name: str) -> Iterator[Recording]:
    """Open a Parquet file: columns of numbers or time stamps, units in their names."""
    table = pl.scan_parquet(file)  # no name, which polars would take as a pattern
    schema = table.collect_schema()
    rows = int(table.select(pl.len()).collect().item())
    signals, others = [], []
    for column, kind in schema.items():
        if kind.is_numeric() or kind.is_temporal() or kind == pl.Boolean:
            parts = partial(_parts, table, column)
            signals.append(column_signal(column, kind, rows, partial(_column, table, column), parts=parts))
        else:
            others.append(f"'{column}' ({kind})")
    yield Recording("Parquet", tuple(signals), tuple(others))


def _column(table: pl.LazyFrame, name: str) -> pl.Series:
    return table.select(pl.col(name)).collect().to_series()


def _parts(table: pl.LazyFrame, name: str) -> Iterator[pl.Series]:
    for part in table.select(pl.col(name)).collect_batches(chunk_size=_AT_ONCE):
        yield part.to_series()
