"""Noise of a speed log about its fit: how neighbours are correlated, and what that does to a fit.

The autocovariance is used up to the lag where it has died away (Politis, Econometric Reviews 23 (2004) 53),
with a flat-top window: noise that is white costs nothing, noise of any shape is counted as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray

#: Standard errors above which a correlation counts, as the rule of Politis has it.
_BEYOND = 2.0
#: Neighbouring lags that must all be small.
_FEWEST_LAGS = 5
#: Share of the rows that a lag may be at the most.
_LONGEST = 0.1
#: Least share that correlation may leave of the variance of a parameter: less cannot be estimated.
_LEAST = 0.05
#: Information about a direction below this share of the largest is none.
_SINGULAR = 1e-14
#: A row has at most this share of its own residual.
_MOST_LEVERAGE = 0.9
#: Correlation of neighbours, and of those two rows apart at the most, by which rows are differences of an
#: angle that was read with an error.
_DIFFERENCED, _NEXT = -0.35, 0.15


@dataclass(frozen=True)
class Noise:
    """Autocovariance of the noise times its flat-top window, and the window, of shape (lags,) from lag 0."""

    covariance: FloatArray
    window: FloatArray
    rows: int

    @property
    def variance(self) -> float:
        """Variance of one row."""
        return float(self.covariance[0])

    @property
    def is_differenced(self) -> bool:
        """Whether neighbours deviate to opposite sides, as speeds that are differences of an angle do."""
        if self.covariance.size < 2 or self.variance == 0.0:
            return False
        first = self.covariance[1] / self.variance
        second = self.covariance[2] / self.variance if self.covariance.size > 2 else 0.0
        return bool(first < _DIFFERENCED and abs(second) < _NEXT)

    @property
    def effective_rows(self) -> float:
        """Rows of independent noise that tell as much of a mean."""
        whole = self.variance + 2.0 * float(np.sum(self.covariance[1:]))
        return self.rows * min(1.0, self.variance / whole) if whole > 0 else float(self.rows)


def noise_of(parts: Sequence[FloatArray], parameters: int) -> Noise:
    """Return the noise of residuals of independent stretches, after a fit of so many parameters."""
    rows = sum(part.size for part in parts)
    longest = max(1, min(int(_LONGEST * rows), max(part.size for part in parts) - 1))
    scale = 1.0 / max(rows - parameters, 1)
    raw = scale * np.sum([_products(part, longest) for part in parts], axis=0)
    if raw[0] <= 0.0:
        return Noise(raw[:1], np.ones(1), rows)
    needed = max(_FEWEST_LAGS, int(np.sqrt(np.log10(rows))))
    small = np.abs(raw[1:] / raw[0]) < _BEYOND * np.sqrt(np.log10(rows) / rows)
    dead = next((m for m in range(small.size) if small[m : m + needed].all()), small.size)
    lags = np.arange(min(2 * dead, longest) + 1)
    window = np.clip(2.0 - lags / max(dead, 1), 0.0, 1.0)
    return Noise(raw[: lags.size] * window, window, rows)


def covariance_of_fit(
    jacobians: Sequence[FloatArray], residuals: Sequence[FloatArray], noise: Noise
) -> FloatArray:
    """Return the covariance of parameters that least squares fit, where the rows have this noise.

    The products of the residuals count as they are, row by row, because noise may differ along a coast; each
    is divided by what the fit leaves of it (MacKinnon and White, J. Econometrics 29 (1985) 305). No direction
    has less than a small share of the variance that white noise would leave.
    """
    information = sum(each.T @ each for each in jacobians)
    # in the directions in which white noise has unit variance
    size = np.sqrt(np.diag(information))
    size = np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    kept = values > values[-1] * _SINGULAR
    root = vectors[:, kept] / np.sqrt(values[kept]) / size[:, None]
    middle = np.zeros((int(kept.sum()),) * 2)
    for jacobian, residual in zip(jacobians, residuals, strict=True):
        plain = jacobian @ root
        leverage = np.minimum(np.einsum("ij,ij->i", plain, plain), _MOST_LEVERAGE)
        scores = plain * (residual / np.sqrt(1.0 - leverage))[:, None]
        middle += scores.T @ scores
        for lag in range(1, min(noise.window.size, residual.size)):
            crossed = noise.window[lag] * (scores[:-lag].T @ scores[lag:])
            middle += crossed + crossed.T
    own, turn = np.linalg.eigh(middle)
    half = root @ turn
    return np.asarray((half * np.maximum(own, _LEAST * noise.variance)) @ half.T)


def _products(part: FloatArray, longest: int) -> FloatArray:
    """Sums of products of a series with itself, shape (lags,)."""
    length = 1 << (2 * part.size - 1).bit_length()
    products = np.fft.irfft(np.abs(np.fft.rfft(part, length)) ** 2, length)[: min(part.size, longest + 1)]
    return np.pad(products, (0, longest + 1 - products.size))
