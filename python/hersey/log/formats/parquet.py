"""Parquet files, through polars."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import polars as pl

from hersey.log.formats.frame import column_signal
from hersey.log.recording import Recording


@contextmanager
def open_parquet(path: Path) -> Iterator[Recording]:
    """Open a Parquet file: columns of numbers or time stamps, units in their names."""
    with _silence():
        table = pl.scan_parquet(path)
        schema = table.collect_schema()
        rows = int(table.select(pl.len()).collect().item())
    signals, others = [], []
    for name, kind in schema.items():
        if kind.is_numeric() or kind.is_temporal() or kind == pl.Boolean:
            signals.append(column_signal(name, kind, rows, partial(_column, table, name)))
        else:
            others.append(f"'{name}' ({kind})")
    yield Recording("Parquet", tuple(signals), tuple(others))


def _column(table: pl.LazyFrame, name: str) -> pl.Series:
    with _silence():
        return table.select(pl.col(name)).collect().to_series()


@contextmanager
def _silence() -> Iterator[None]:
    """Keep polars from writing to the terminal where a damaged page makes it panic."""
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
