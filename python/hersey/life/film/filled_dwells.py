"""The dwells of all runs of a campaign as rows filled up, for what is computed over all of them at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.errors import InsufficientDataError
from hersey.life.indicator import Runs
from hersey.life.padded_rows import PaddedRows

if TYPE_CHECKING:
    from hersey.life.campaign import Campaign


@dataclass(frozen=True)
class FilledDwells:
    """Dwells of runs, shape (runs, dwells): speed (rad/s), temperature (K), torque and its error (N m).

    Speed and torque without sign; ``given`` says which are dwells, the others fill a row up.
    """

    speed: FloatArray
    kelvin: FloatArray
    torque: FloatArray
    error: FloatArray
    given: BoolArray

    def rows(self, chosen: slice | IntArray) -> FilledDwells:
        """Return some of the runs."""
        return FilledDwells(**{name: values[chosen] for name, values in vars(self).items()})


def filled_dwells(campaign: Campaign, runs: Runs) -> tuple[FilledDwells, IntArray]:
    """Return the dwells of a campaign that have a temperature, and the places in ``runs`` of their runs.

    Raises
    ------
    InsufficientDataError
        If no dwell has one.
    """
    table = campaign.dwells()
    names = ("speed (rad/s)", "temperature (K)", "torque (N m)", "torque error (N m)")
    columns = np.abs(
        np.column_stack([table[name].cast(float).fill_null(np.nan).to_numpy() for name in names])
    )
    columns[:, 3] = np.nan_to_num(columns[:, 3])
    known = np.isfinite(columns).all(axis=1) & (columns[:, 0] > 0.0) & (columns[:, 2] > 0.0)
    if not known.any():
        raise InsufficientDataError(
            "no dwell of the campaign has both temperature and torque, which the film needs. Record both"
        )
    place = {run: i for i, run in enumerate(runs.run)}
    of = np.array([place[run] for run in table["run_id"].to_list()])[known]
    rows = PaddedRows.of(of)
    speed, kelvin, torque, error = (rows.filled(column) for column in columns[known].T)
    return FilledDwells(speed, kelvin, torque, error, rows.given), np.unique(of)
