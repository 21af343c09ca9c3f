"""The runs of a campaign as `hersey.life.diagnostics` compares them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from hersey.arrays import FloatArray, IntArray
from hersey.life.diagnostics.diagnosis import Diagnosis, diagnosed
from hersey.life.diagnostics.measured import MeasuredRuns, drive_torque
from hersey.life.maintenance import Event

if TYPE_CHECKING:
    from hersey.damping.no_load_torque import NoLoadTorque
    from hersey.log.sensors import Sensors

#: Other specimens with which some are compared, half of them those added last, where logs get mixed up.
_OTHERS = 40
#: Runs from which on all are compared.
_MANY = 1000


def diagnosis_of(
    runs: pl.DataFrame,
    age_unit: str,
    events: tuple[Event, ...],
    of: Collection[int] | None,
    drives: Callable[[Collection[int] | None], Mapping[int, tuple[NoLoadTorque | None, Sensors]]],
    measured: Callable[[Collection[int] | None], tuple[IntArray, FloatArray]],
) -> Diagnosis:
    """Return what does not fit among all runs, or among some, ``of``, and those that they are compared with.

    ``drives`` and ``measured`` read that of runs, as `Campaign` has them.
    """
    some = None if of is None else compared_with(runs, of)
    if some is not None:
        runs = runs.filter(runs["run"].is_in(some))
    rests = {number: rest for number, (rest, _) in drives(some).items()}
    return diagnosed(measured_runs(runs, age_unit, *measured(some), rests, events))


def compared_with(runs: pl.DataFrame, of: Collection[int]) -> list[int] | None:
    """Return the runs with which some are compared: of their specimens and of others; None for all."""
    last = runs.group_by("unit", maintain_order=True).agg(run=pl.col("run").max())
    own = set(runs.filter(pl.col("run").is_in(list(of)))["unit"])
    others = [unit for unit in last.sort("run", descending=True)["unit"] if unit not in own]
    added, rest = others[: _OTHERS // 2], others[_OTHERS // 2 :]
    spread = np.linspace(0, len(rest) - 1, min(_OTHERS // 2, len(rest))).round().astype(int)
    chosen = own.union(added, (rest[place] for place in spread))
    some: list[int] = runs.filter(pl.col("unit").is_in(list(chosen)))["run"].to_list()
    return some if len(some) <= _MANY else None


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
