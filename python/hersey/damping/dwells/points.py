"""What dwells are reduced to: one steady point each, and what is not used."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.log.torque_log import TorqueLog
from hersey.result import Result, json_record
from hersey.units import rpm


@dataclass(frozen=True)
class Rejection:
    """A stretch of the log that is not used, and why; times in s, first row from 0 within the run."""

    run: int
    start: float
    end: float
    rows: int
    reason: str
    speed: float = float("nan")  #: mean, rad/s


@dataclass(frozen=True, repr=False)
class SteadyPoints(Result):
    """One row per dwell.

    Attributes
    ----------
    table
        Columns ``run`` (index), ``start``, ``end`` (s), ``speed``, ``speed_error`` (rad/s), ``torque``,
        ``torque_error`` (N m), ``temperature``, ``temperature_error`` (K, null if not recorded), ``rows``,
        ``effective_rows`` (independent samples), ``settling_rows`` (cut at the ends), ``approach``
        (``from below``, ``from above`` or ``start``), ``tare`` (N m). Errors are standard errors of the mean.
        Speed and torque carry the sign of the rotation.
    rejected
        Every other stretch, with the reason. Rows of the table and of this list add up to the log's.
    tare
        Torque subtracted, N m: the mean over the dwells.
    tare_errors
        What one standard error of each independent disturbance of the tare does to the torque of each dwell,
        N m, shape (points, disturbances); one column for a zero that is constant, none without a tare.
    notes
        What there is to say of the tare, in sentences.
    standing_torque
        Mean torque while the drive stood, N m, or None if it never did.
    log
        What was reduced.
    """

    table: pl.DataFrame
    rejected: tuple[Rejection, ...]
    tare: float
    standing_torque: float | None
    log: TorqueLog
    tare_errors: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Give what has no tare no disturbances of it."""
        if not self.tare_errors.size:
            object.__setattr__(self, "tare_errors", np.empty((self.table.height, 0)))

    @property
    def tare_error(self) -> float:
        """Standard error of the tare, N m: root mean square over the dwells."""
        return float(np.sqrt(np.mean(np.sum(self.tare_errors**2, axis=1))))

    def __len__(self) -> int:
        """Return how many steady points there are."""
        return self.table.height

    def column(self, name: str) -> FloatArray:
        """Return a column as an array of shape (points,)."""
        return self.table[name].to_numpy()

    def summary(self) -> str:
        """Return how many dwells, their ranges, the tare, and what is not used, as text."""
        rows = f"{self.table['rows'].sum()} of {self.log.rows} rows used"
        lines = [f"{self.headline()}; {rows}", f"tare {self.tare:.4g} N m"]
        if self.standing_torque is not None:
            lines[-1] += f", standing torque {self.standing_torque:.4g} N m"
        lines += [f"  not used: {rows} rows, {why}" for why, rows in self._unused().items()]
        return "\n".join([*lines, *self.notes])

    def headline(self) -> str:
        """Return how many dwells, and the ranges of speed and torque."""
        speed, torque = np.abs(self.column("speed")), np.abs(self.column("torque"))
        return (
            f"{len(self)} dwells, {rpm(float(speed.min())):.4g} to {rpm(float(speed.max())):.4g} rpm, "
            f"{torque.min():.4g} to {torque.max():.4g} N m"
        )

    def _unused(self) -> dict[str, int]:
        """Rows of every other stretch by its reason."""
        rows: dict[str, int] = {}
        for stretch in self.rejected:
            rows[stretch.reason] = rows.get(stretch.reason, 0) + stretch.rows
        return rows

    def to_dict(self) -> dict[str, Any]:
        """Return the dwells, what is not used, and the tare, in SI."""
        return json_record(
            {
                "points": self.table.to_dicts(),
                "rejected": self.rejected,
                "tare": self.tare,
                "tare_error": self.tare_error,
                "tare_errors": self.tare_errors,
                "notes": self.notes,
                "standing_torque": self.standing_torque,
            }
        )

    def to_frame(self) -> pl.DataFrame:
        """Return one row per dwell."""
        units = {
            "start": "s",
            "end": "s",
            "speed": "rad/s",
            "torque": "N m",
            "temperature": "K",
            "tare": "N m",
        }
        units |= {f"{name}_error": units[name] for name in ("speed", "torque", "temperature")}
        return self.table.rename({name: f"{name.replace('_', ' ')} ({unit})" for name, unit in units.items()})
