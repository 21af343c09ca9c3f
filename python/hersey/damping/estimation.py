"""Weighted least squares with an unknown scatter between points, and the intervals that follow.

The variance of a point is that of its own error plus a scatter common to all, found so that chi-square equals
the degrees of freedom (Paule and Mandel, J. Res. NBS 87 (1982) 377).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy import optimize, stats

from hersey.arrays import FloatArray

#: Confidence of every interval.
CONFIDENCE = 0.95
#: Residuals below this are those of exact data.
ROUNDING = 1e-13


@dataclass(frozen=True)
class Estimate:
    """A number with its standard error and its 95 % interval."""

    value: float
    error: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return value and interval with sensible digits."""
        return f"{self.value:.4g} [{self.low:.4g}, {self.high:.4g}]"


@dataclass(frozen=True)
class Solution:
    """Values with their covariance, the scatter found, and residuals with the sigma they were weighted by."""

    values: FloatArray
    covariance: FloatArray
    scatter: float
    residuals: FloatArray
    sigma: FloatArray
    jacobian: FloatArray  #: of residuals over sigma

    def interval_of_last(self) -> tuple[float, float]:
        """The interval of the last value alone."""
        picked = np.zeros(self.values.size)
        picked[-1] = 1.0
        estimate = self.estimate(picked)
        return estimate.low, estimate.high

    def chi_square(self, errors: FloatArray) -> float:
        """Against the errors alone, before any scatter is added (unless some are nil)."""
        sigma = errors if np.all(errors > 0) else self.sigma
        return float(np.sum((self.residuals / sigma) ** 2))

    def aicc(self, errors: FloatArray, more: int = 0) -> float:
        """Corrected Akaike criterion, with the scatter that makes the residuals likeliest.

        ``more`` counts variables that were chosen beside the values.
        """

        def deviance(scatter: float) -> float:
            variance = errors**2 + scatter**2
            return float(np.sum(np.log(2 * np.pi * variance) + self.residuals**2 / variance))

        top = 3.0 * float(np.std(self.residuals)) + 1e-12
        best = min(
            deviance(float(optimize.minimize_scalar(deviance, bounds=(0.0, top), method="bounded").x)),
            deviance(0.0) if np.all(errors > 0) else np.inf,
        )
        count, variables = self.residuals.size, self.values.size + 1 + more  # one is the scatter
        return best + 2 * variables + 2 * variables * (variables + 1) / max(count - variables - 1, 1)

    def estimate(self, weights: FloatArray) -> Estimate:
        """A linear combination of the values."""
        value = float(weights @ self.values)
        error = float(np.sqrt(max(float(weights @ self.covariance @ weights), 0.0)))
        reach = quantile(self.residuals.size - self.values.size) * error
        return Estimate(value, error, value - reach, value + reach)


def quantile(freedom: int) -> float:
    """Return how many standard errors an interval reaches to either side (Student's t)."""
    return float(stats.t.ppf(0.5 + CONFIDENCE / 2, max(freedom, 1)))


def solve(
    residual: Callable[[FloatArray], FloatArray], start: FloatArray, errors: FloatArray, common: FloatArray
) -> Solution:
    """Return the least-squares solution from ``start``.

    Parameters
    ----------
    residual
        Residuals of shape (points,) for values of shape (variables,).
    errors
        Standard error of each point, shape (points,).
    common
        What one standard error of a disturbance shared by all points (the tare) does to each residual.
    """
    freedom = errors.size - start.size
    values, scatter = start, float(np.std(residual(start)))
    floor = 1e-9 * max(scatter, float(np.max(errors)), 1e-12)
    result = None
    for _ in range(12):
        sigma = np.sqrt(errors**2 + scatter**2 + floor**2)
        result = optimize.least_squares(
            partial(_weighted, residual, sigma), values, x_scale="jac", xtol=1e-14
        )
        values = result.x
        updated = fitted_scatter(residual(values), errors, freedom)
        if abs(updated - scatter) <= 1e-6 * max(scatter, floor):
            break
        scatter = updated
    assert result is not None
    jacobian = np.asarray(result.jac)
    covariance = np.linalg.pinv(jacobian.T @ jacobian) + _shared(jacobian, common / sigma)
    return Solution(values, np.asarray(covariance), scatter, residual(values), sigma, jacobian)


def robust(solution: Solution, common: FloatArray) -> Solution:
    """Return the solution with a covariance that holds whatever each point's variance (sandwich, HC3)."""
    jacobian = solution.jacobian
    bread = np.linalg.pinv(jacobian.T @ jacobian)
    leverage = np.sum((jacobian @ bread) * jacobian, axis=1)
    spread = solution.residuals / solution.sigma / np.maximum(1.0 - leverage, 1e-3)
    filling = jacobian * spread[:, None]
    covariance = bread @ (filling.T @ filling) @ bread + _shared(jacobian, common / solution.sigma)
    return replace(solution, covariance=np.asarray(covariance))


def _shared(jacobian: FloatArray, disturbance: FloatArray) -> FloatArray:
    """Covariance that a disturbance of all points together adds."""
    shift = np.linalg.pinv(jacobian.T @ jacobian) @ (jacobian.T @ disturbance)
    return np.outer(shift, shift)


def _weighted(
    residual: Callable[[FloatArray], FloatArray], sigma: FloatArray, values: FloatArray
) -> FloatArray:
    return np.asarray(residual(values) / sigma)


def fitted_scatter(residuals: FloatArray, errors: FloatArray, freedom: int) -> float:
    """Return the scatter beyond the errors that brings chi-square to the degrees of freedom."""

    def excess(scatter: float) -> float:
        return float(np.sum(residuals**2 / (errors**2 + scatter**2))) - freedom

    top = float(np.sqrt(np.sum(residuals**2) / freedom))
    if top < ROUNDING or (np.all(errors > 0) and excess(0.0) <= 0):
        return 0.0
    low = 0.0 if np.all(errors > 0) else 1e-9 * top
    return float(optimize.brentq(excess, low, top)) if excess(low) > 0 > excess(top) else top
