"""Windows of a moving log as steady points: bins of direction, speed and temperature.

The torque of a window is the fitted law at its mean speed plus the mean of what the law leaves there, so that
the width of a window costs nothing. Noise is its own; what one standard error of inertia, gravity,
offset and delay does is shared by all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.damping.dwells.reasons import Reason
from hersey.damping.dwells.rejection import Rejection
from hersey.damping.moving.fitting import Fitting, MovingLawFit
from hersey.damping.moving.friction import MovingFriction, MovingPoints
from hersey.damping.moving.gravity import COSINE, SINE
from hersey.damping.moving.model import DELAY, INERTIA, OFFSET
from hersey.errors import InsufficientDataError
from hersey.log.torque_log import TorqueLog
from hersey.schema.warning import Warning

#: Windows per direction at the most, ratio of speeds and kelvin that one may span, moments that it must have.
_SPEEDS, _RATIO, _KELVIN, _LEAST = 12, 1.15, 4.0, 8
#: Moments whose correlation is summed one by one; of more, every few.
_MOST = 1500


class FittedLog(Protocol):
    """A log with the law fitted to it: `MovingFit` is one."""

    @property
    def log(self) -> TorqueLog:
        """The log."""

    @property
    def fitted(self) -> MovingLawFit:
        """The law."""

    @property
    def fitting(self) -> Fitting:
        """Equations and noise."""

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """What is to be known of it."""

    @property
    def numbers(self) -> MovingFriction:
        """Its numbers."""

    def friction(self, speed: FloatArray, kelvin: FloatArray | None = None) -> FloatArray:
        """Return friction alone, N m."""


@dataclass(frozen=True)
class _Moments:
    """All moments that are used, in order: arrays of shape (moments,)."""

    run: np.ndarray
    stretch: np.ndarray
    place: np.ndarray
    time: FloatArray
    speed: FloatArray
    kelvin: FloatArray | None


def windows(fit: FittedLog, rotation: str) -> MovingPoints:
    """Return the windows of a fit; see `MovingFit.points`."""
    moments = _moments(fit)
    of = [each for each in _members(moments) if each.size >= _LEAST]
    rows = [_row(fit, moments, each) for each in of]
    signs = {"both": (1.0, -1.0), "forward": (1.0,), "reverse": (-1.0,)}[rotation]
    signed = [(float(np.sign(row["speed"])), float(np.sign(row["torque"]))) for row in rows]
    kept = [i for i, (way, pull) in enumerate(signed) if way == pull and way in signs]
    if not kept:
        raise InsufficientDataError(
            f"{fit.log.files[0].name}: no window of speed holds {_LEAST} moments",
            remedy="record a longer motion",
        )
    table = pl.DataFrame([rows[i] for i in kept], schema_overrides=_OPTIONAL)
    return MovingPoints(
        table=table,
        rejected=_rejected(fit, table),
        tare=0.0,
        standing_torque=None,
        log=fit.log,
        warnings=fit.warnings,
        window_errors=_shared(fit, [of[i] for i in kept]),
        temperature_rates=np.zeros(len(kept)),
        of_every_sample=True,
        friction=fit.numbers,
    )


_OPTIONAL = dict.fromkeys(("temperature", "temperature_error", "load"), pl.Float64)


def _moments(fit: FittedLog) -> _Moments:
    equations = fit.fitting.equations
    counts = [each.size for each in equations.places]
    of = equations.filtered
    return _Moments(
        run=np.repeat([each.stretch.run for each in of], counts),
        stretch=np.repeat(np.arange(len(of)), counts),
        place=np.concatenate(equations.places),
        time=equations.joined([each.time for each in of]),
        speed=equations.speed,
        kelvin=equations.temperature if fit.log.has_temperature else None,
    )


def _members(moments: _Moments) -> list[np.ndarray]:
    """Indices of the moments of each window, by run, temperature, direction and speed."""
    size = np.abs(moments.speed)
    whole = float(np.log(size.max() / size.min()) / np.log(_RATIO))
    edges = np.geomspace(size.min(), size.max(), int(np.clip(np.ceil(whole), 1, _SPEEDS)) + 1)
    warm = np.zeros(size.size)
    if moments.kelvin is not None:
        low, high = float(moments.kelvin.min()), float(moments.kelvin.max())
        count = max(1, int(np.ceil((high - low) / _KELVIN)))
        warm = np.minimum(np.floor((moments.kelvin - low) / max(high - low, 1e-9) * count), count - 1)
    bins = np.clip(np.searchsorted(edges, size, side="right") - 1, 0, edges.size - 2)
    keys = np.column_stack([moments.run, warm, np.sign(moments.speed), bins])
    _, inverse = np.unique(keys, axis=0, return_inverse=True)
    return [np.flatnonzero(inverse == each) for each in range(int(inverse.max()) + 1)]


def _row(fit: FittedLog, moments: _Moments, of: np.ndarray) -> dict[str, Any]:
    run = fit.log.runs[int(moments.run[of[0]])]
    speed = float(np.mean(moments.speed[of]))
    kelvin = None if moments.kelvin is None else float(np.mean(moments.kelvin[of]))
    at = None if kelvin is None else np.array([kelvin])
    torque = float(fit.friction(np.array([speed]), at)[0] + np.mean(fit.fitted.residuals[of]))
    variance = float(np.var(fit.fitted.residuals, ddof=fit.fitted.values.size))
    together = _together(fit, moments, of)
    filtered = fit.fitting.equations.filtered[int(moments.stretch[of[0]])]
    step = filtered.low_pass.step * round(filtered.low_pass.interval / run.sampling_interval)
    spread = 0.0 if moments.kelvin is None else float(np.std(moments.kelvin[of]))
    return {
        "run": int(moments.run[of[0]]),
        "start": float(moments.time[of].min()),
        "end": float(moments.time[of].max()),
        "speed": speed,
        "speed_error": 0.0,
        "torque": torque,
        "torque_error": float(np.sqrt(variance * together / of.size)),
        "temperature": kelvin,
        "temperature_error": None if kelvin is None else spread / float(np.sqrt(of.size)),
        "rows": int(of.size * step),
        "effective_rows": of.size / together,
        "settling_rows": 0,
        "approach": "start",
        "load": None if run.load is None else float(np.mean(run.load)),
        "tare": 0.0,
    }


def _together(fit: FittedLog, moments: _Moments, of: np.ndarray) -> float:
    """How many moments of a window count as one, by the correlation of the noise."""
    some = of[:: -(-of.size // _MOST)]
    apart = np.abs(moments.place[some][:, None] - moments.place[some][None, :])
    same = moments.stretch[some][:, None] == moments.stretch[some][None, :]
    correlation = fit.fitting.noise.correlation(int(apart.max()))
    every = of.size / some.size
    return float(max(1.0, 1.0 + every * (np.sum(correlation[apart] * same) / some.size - 1.0)))


def _shared(fit: FittedLog, of: list[np.ndarray]) -> FloatArray:
    """What one standard error of each number that windows share does to each of them, N m."""
    law, equations = fit.fitted.law, fit.fitting.equations
    indices = [i for i, name in enumerate(law.names) if name in (INERTIA, OFFSET, COSINE, SINE, DELAY)]
    columns = law.jacobian(fit.fitted.values, equations)[:, indices]
    covariance = fit.fitted.covariance[np.ix_(indices, indices)]
    if law.inertia_error:
        columns = np.column_stack([columns, law.by_inertia(fit.fitted.values, equations)])
        along = law.inertia_error**2 * np.append(fit.fitted.by_inertia[indices], 1.0)
        covariance = np.block([[covariance, along[:-1, None]], [along[None, :]]])
    means = np.array([np.mean(columns[each], axis=0) for each in of])
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(-means @ (vectors * np.sqrt(np.maximum(values, 0.0))))


def _rejected(fit: FittedLog, table: pl.DataFrame) -> tuple[Rejection, ...]:
    """Rows of each run that are in no window."""
    out = []
    for index, run in enumerate(fit.log.runs):
        used = int(table.filter(pl.col("run") == index)["rows"].sum())
        if (rows := run.time.size - used) > 0:
            out.append(Rejection(index, float(run.time[0]), float(run.time[-1]), rows, Reason("too slow")))
    return tuple(out)
