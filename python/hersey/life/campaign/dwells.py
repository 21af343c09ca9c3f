"""The dwells of all runs of a campaign, as a table or as numbers."""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Mapping
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from hersey.arrays import FloatArray, IntArray
from hersey.life.campaign.content import rows_of
from hersey.life.campaign.entry import COLUMNS

if TYPE_CHECKING:
    from hersey.damping.no_load_torque import NoLoadTorque

#: Dwells that are read at once.
_AT_ONCE = 100_000
_KINDS = {"INTEGER": pl.Int64, "REAL": pl.Float64, "TEXT": pl.String}


def dwells_of(
    database: sqlite3.Connection,
    runs: pl.DataFrame,
    rests: Mapping[int, NoLoadTorque | None],
    age_unit: str,
) -> pl.DataFrame:
    """Return one row per dwell, in SI, by specimen, age and run, as `Campaign.dwells`."""
    from hersey.life.campaign.conversion import rests_of

    columns = ", ".join(f'd."{name}"' for name in COLUMNS)
    rows = database.execute(
        f"SELECT r.id, {columns} FROM runs r JOIN dwells d ON d.run_id = r.id "
        "ORDER BY r.unit, r.age, r.id, d.number"
    )
    schema = {"run_id": pl.Int64()} | {name: _KINDS[kind]() for name, kind in COLUMNS.items()}
    parts = [pl.DataFrame(schema=schema)]
    while some := rows.fetchmany(_AT_ONCE):
        parts.append(pl.DataFrame(some, schema=schema, orient="row"))
    dwells = pl.concat(parts)
    dwells = dwells.with_columns(pl.Series("rest", rests_of(dwells, rests)))
    of = runs.select(pl.col("run").alias("run_id"), "unit", "age", "log")
    joined = of.join(dwells, on="run_id", how="inner", maintain_order="left_right")
    return with_units(joined, age_unit)


def with_units(dwells: pl.DataFrame, age_unit: str) -> pl.DataFrame:
    """Return dwells whose columns name their units."""
    units = {"start": "s", "end": "s", "load": "N", "tare": "N m", "rest": "N m"}
    for name, si in (("speed", "rad/s"), ("torque", "N m"), ("temperature", "K")):
        units |= {name: si, f"{name}_error": si}
    new = {name: f"{name.replace('_', ' ')} ({si})" for name, si in units.items()}
    return dwells.rename({**new, "age": f"age ({age_unit or 'unit'})"})


def measured_of(
    database: sqlite3.Connection, runs: Collection[int] | None = None
) -> tuple[IntArray, FloatArray]:
    """Return the numbers of every dwell, as `Campaign.measured`."""
    select = "SELECT run_id, speed, temperature, torque, torque_error FROM dwells"
    rows = rows_of(database, select, "run_id", runs, "ORDER BY run_id, number")
    parts = [np.empty((0, 5))]
    while some := list(islice(rows, _AT_ONCE)):
        parts.append(np.array(some, dtype=float))
    numbers = np.concatenate(parts)
    return numbers[:, 0].astype(np.intp), numbers[:, 1:]
