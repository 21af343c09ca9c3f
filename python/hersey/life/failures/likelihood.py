"""The likelihood of ages known exactly, at least, at most or between two, of many samples at once.

Parameters of a row are u, the logarithm of the age by which a share of all has failed, s, the logarithm of
the shape, and c, what one unit of stress adds to ln age. Any of them can be held.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.failures.distributions import Distribution
from hersey.life.failures.maximum import Function


def _none() -> FloatArray:
    return np.zeros((1, 0))


@dataclass(frozen=True)
class Observed:
    """Logarithms of ages, each of shape (samples or 1, ages), with the specimens at each and their stress.

    ``right`` are suspensions; between ``low`` (minus infinity for none) and ``high`` a failure lies.
    Specimens have shape (ages,) or (samples, ages), stress (ages,).
    """

    exact: FloatArray
    right: FloatArray = field(default_factory=_none)
    low: FloatArray = field(default_factory=_none)
    high: FloatArray = field(default_factory=_none)
    exact_count: FloatArray = field(default_factory=_none)
    right_count: FloatArray = field(default_factory=_none)
    between_count: FloatArray = field(default_factory=_none)
    exact_stress: FloatArray = field(default_factory=lambda: np.zeros(0))
    right_stress: FloatArray = field(default_factory=lambda: np.zeros(0))
    between_stress: FloatArray = field(default_factory=lambda: np.zeros(0))


def _of_rows(array: FloatArray, rows: IntArray) -> FloatArray:
    return array if array.ndim < 2 or len(array) == 1 else array[rows]


def log_likelihood(
    law: Distribution, of: Observed, m: FloatArray, k: FloatArray, c: FloatArray, rows: IntArray
) -> FloatArray:
    """Return the logarithm of the likelihood of ln ages for each row; m, k and c have shape (rows, 1)."""
    total = np.zeros(len(m))
    if of.exact.shape[1]:
        x = _of_rows(of.exact, rows) - m - c * of.exact_stress
        total = total + (_of_rows(of.exact_count, rows) * law.log_density(x, k)).sum(axis=1)
    if of.right.shape[1]:
        x = _of_rows(of.right, rows) - m - c * of.right_stress
        total = total + (_of_rows(of.right_count, rows) * law.log_survival(x, k)).sum(axis=1)
    if of.low.shape[1]:
        shift = m + c * of.between_stress
        low, high = _of_rows(of.low, rows) - shift, _of_rows(of.high, rows) - shift
        count = _of_rows(of.between_count, rows)
        total = total + np.where(count > 0, count * log_between(law, low, high, k), 0.0).sum(axis=1)
    return np.where(np.isfinite(total), total, -1e300)


def log_between(law: Distribution, low: FloatArray, high: FloatArray, k: FloatArray) -> FloatArray:
    """Return the logarithm of the share that fails between two ages, from the tail that keeps its digits."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        survive, fail = law.log_survival(low, k), law.log_failed(high, k)
        early = fail + np.log1p(-np.exp(law.log_failed(low, k) - fail))
        late = survive + np.log1p(-np.exp(law.log_survival(high, k) - survive))
    return np.where(fail < -0.7, early, late)


@dataclass(frozen=True)
class Problem:
    """A law and what was observed, by the age at which a share fails under a stress.

    ``share`` has shape () or (rows,); a parameter that is not free has its value in ``held``, shape () or
    (rows,).
    """

    law: Distribution
    of: Observed
    share: FloatArray
    stress: float = 0.0
    shape: FloatArray | None = None
    age: FloatArray | None = None
    effect: FloatArray | None = None

    def parameters(self, at: FloatArray, rows: IntArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return m, k and c of free parameters, shape (rows, 1) each."""
        columns = list(at.T[:, :, None])
        u = columns.pop(0) if self.age is None else _column(self.age, rows)
        s = columns.pop(0) if self.shape is None else _column(self.shape, rows)
        c = columns.pop(0) if self.effect is None else _column(self.effect, rows)
        k = np.exp(np.clip(s, -12.0, 12.0))
        m = u - self.law.quantile(_column(self.share, rows), k) - c * self.stress
        return m, k, c

    def function(self) -> Function:
        """Return the likelihood as a function of the free parameters."""

        def of(at: FloatArray, rows: IntArray) -> FloatArray:
            return log_likelihood(self.law, self.of, *self.parameters(at, rows), rows)

        return of


def _column(values: FloatArray, rows: IntArray) -> FloatArray:
    values = np.asarray(values, dtype=float)
    return np.broadcast_to(values[rows] if values.ndim else values, (len(rows),))[:, None]
