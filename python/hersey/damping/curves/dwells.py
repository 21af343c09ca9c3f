"""What a drag curve must predict: the dwells with their errors, and the likelihood of predictions.

Errors of a dwell follow Student's t with few degrees of freedom, so that one bad dwell does not move a curve.
What dwells share (zero, visits, runs) are effects with the standard normal distribution as prior, fitted
beside the numbers of the law.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from hersey.arrays import FloatArray
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.shared_errors import disturbances, groupings
from hersey.damping.candidates.thermal import Thermal
from hersey.damping.dwells import SteadyPoints
from hersey.damping.fitted_law import SCALES
from hersey.damping.surface import DampingSurface

#: Degrees of freedom of the errors of single dwells.
TAIL = 6.0
_CONSTANT = float(gammaln((TAIL + 1.0) / 2.0) - gammaln(TAIL / 2.0) - 0.5 * np.log(TAIL * np.pi))
#: t of these degrees of freedom has this standard deviation.
_SPREAD = float(np.sqrt(TAIL / (TAIL - 2.0)))


@dataclass(frozen=True)
class Dwells:
    """Dwells as laws see them, arrays of shape (points,) unless said."""

    log_torque: FloatArray  #: ln(torque / N m)
    log_speed: FloatArray  #: ln(speed / reference)
    temperature: FloatArray  #: the law of temperature's s(T); zeros for an isothermal fit
    error: FloatArray  #: relative standard error, without the scatter between dwells
    shared: FloatArray  #: change of ln torque per effect, shape (points, effects)
    reference_speed: float  #: rad/s
    thermal: Thermal | None
    scatter: float  #: of the fitted surface, where the search begins
    quantity: str = "torque"  #: what was measured

    def __len__(self) -> int:
        """Return how many dwells there are."""
        return int(self.log_torque.size)

    def shape_of(self, kelvin: float | None) -> float:
        """Return s(T) at a temperature, K."""
        if self.thermal is None or kelvin is None:
            return 0.0
        return float(self.thermal.shape(np.array([kelvin]))[0][0])

    def log_likelihood(
        self, predicted: FloatArray, log_scatter: FloatArray, effects: FloatArray
    ) -> FloatArray:
        """Return the log-likelihood of each draw.

        Parameters
        ----------
        predicted
            ln torque, shape (draws, points).
        log_scatter
            ln of the relative scatter between dwells, shape (draws,).
        effects
            Shared errors in their standard errors, shape (draws, effects).
        """
        off = self.log_torque - predicted - effects @ self.shared.T
        sigma = np.sqrt(self.error**2 + np.exp(2.0 * np.clip(log_scatter, -20.0, 2.0))[:, None]) / _SPREAD
        each = _CONSTANT - np.log(sigma) - 0.5 * (TAIL + 1.0) * np.log1p((off / sigma) ** 2 / TAIL)
        return np.asarray(each.sum(axis=1))

    def slopes_of(
        self, predicted: FloatArray, log_scatter: float
    ) -> tuple[FloatArray, FloatArray, float, float]:
        """Return how the log-likelihood of one draw changes, for least squares weighed anew at each step.

        Returns
        -------
        Its slope by each prediction, and the weight of each dwell, shape (points,); its slope by ln scatter,
        and Fisher's information of that.
        """
        scatter = np.exp(2.0 * np.clip(log_scatter, -20.0, 2.0))
        variance = self.error**2 + scatter
        sigma = np.sqrt(variance) / _SPREAD
        u = (self.log_torque - predicted) / sigma
        weight = (TAIL + 1.0) / (TAIL + u**2)
        share = scatter / variance
        by_scatter = float(np.sum(share * (weight * u**2 - 1.0)))
        information = float(np.sum(share**2)) * 2.0 * TAIL / (TAIL + 3.0)
        return np.asarray(weight * u / sigma), np.asarray(weight / sigma**2), by_scatter, information


def dwells_of(points: SteadyPoints, surface: DampingSurface) -> Dwells:
    """Return steady points as the laws of curves see them; errors of inputs by the slopes of the surface."""
    data = Observations.of(points)
    thermal, shape = None, np.zeros(len(data))
    by_heat = np.zeros(len(data))
    if surface.b is not None and data.inputs.kelvin is not None and data.reference_kelvin is not None:
        thermal = Thermal(SCALES[surface.temperature_scale], data.reference_kelvin)
        shape, per_kelvin, _ = thermal.shape(data.inputs.kelvin)
        by_heat = surface.b.value * per_kelvin
    slope = max(abs(1.0 + surface.c.value), 0.5)
    error = np.sqrt(
        data.torque_error**2
        + (slope * data.speed_error) ** 2
        + (by_heat * data.temperature_error) ** 2
        + 1e-10
    )
    grouped = groupings(data)
    known = {each.name: each for each in surface.statistics.shared}
    kept = tuple(g for g in grouped if g.name in known)
    shared = disturbances(data, kept, tuple(known[g.name] for g in kept), by_heat)
    return Dwells(
        log_torque=data.log_torque,
        log_speed=data.inputs.log_speed,
        temperature=np.asarray(shape),
        error=error,
        shared=shared,
        reference_speed=data.reference_speed,
        thermal=thermal,
        scatter=max(surface.statistics.scatter, 1e-3),
        quantity=points.domain.quantity,
    )
