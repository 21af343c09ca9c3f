"""The runs of a campaign as `hersey.life.diagnostics` compares them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.diagnostics.measured import MeasuredRuns, drive_torque
from hersey.life.maintenance import Event

if TYPE_CHECKING:
    import polars as pl

    from hersey.damping.no_load_torque import NoLoadTorque


def measured_runs(
    runs: pl.DataFrame,
    age_unit: str,
    of_run: IntArray,
    table: FloatArray,
    rests: Mapping[int, NoLoadTorque | None],
    events: tuple[Event, ...],
) -> MeasuredRuns:
    """Return the runs of a campaign with their dwells.

    Parameters
    ----------
    runs, age_unit, events
        As `Campaign.runs`, its unit of age, and its maintenance.
    of_run, table
        As `Campaign.measured`.
    rests
        No-load torque that was subtracted from each run, by its number.
    """
    number = runs["run"].to_list()
    place = {each: i for i, each in enumerate(number)}
    return MeasuredRuns(
        number=tuple(number),
        unit=tuple(runs["unit"].to_list()),
        age=runs["age"].to_numpy().astype(float),
        age_unit=age_unit,
        of_run=np.array([place[each] for each in of_run.tolist()], dtype=np.intp),
        speed=np.abs(table[:, 0]),
        kelvin=table[:, 1],
        torque=drive_torque(of_run, table, rests),
        events=events,
    )
