"""Noise whose neighbours are correlated: an autoregression, and equations made independent by it.

Equations may be missing between others, so that the correlation matrix of those that are there is used, in
blocks. What is correlated across the edge of two blocks is a share of one in `BLOCK`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular

from hersey.arrays import FloatArray

#: Equations per block, and terms of the autoregression, at the most.
BLOCK, MOST_TERMS = 400, 12
#: Rows that each term needs, and standard errors by which a reflection must stay below 1.
_ROWS_PER_TERM, _NEAR_ONE = 40, 3.0


@dataclass(frozen=True)
class Autoregression:
    """Noise that follows from its last values; ``variance`` is that of the noise itself."""

    terms: FloatArray
    variance: float

    def correlation(self, lags: int) -> FloatArray:
        """Return the correlation of the noise at lags 0, 1, ... ``lags``."""
        count = self.terms.size
        if not count:
            return np.concatenate([[1.0], np.zeros(lags)])
        out = np.empty(lags + 1)
        first = _correlations(self.terms)
        out[: min(count, lags) + 1] = first[: lags + 1]
        for lag in range(count + 1, lags + 1):
            out[lag] = self.terms @ out[lag - count : lag][::-1]
        return out

    @property
    def together(self) -> float:
        """How many neighbours count as one, for a mean."""
        gain = 1.0 - float(np.sum(self.terms))
        reach = 2000
        return float(max(1.0, 2.0 * np.sum(self.correlation(reach)) - 1.0)) if gain > 0 else float(reach)


def _correlations(terms: FloatArray) -> FloatArray:
    """Correlations at the lags 0 to the number of terms, by the Yule-Walker equations."""
    count = terms.size
    system = np.eye(count)
    known = np.zeros(count)
    for row in range(count):
        for term, value in enumerate(terms):
            lag = abs(row - term)
            if lag == 0:
                known[row] += value
            else:
                system[row, lag - 1] -= value
    return np.concatenate([[1.0], np.linalg.solve(system, known)])


def autoregression(series: Sequence[tuple[np.ndarray, FloatArray]]) -> Autoregression:
    """Return the autoregression of residuals, with as many terms as AICc allows.

    Parameters
    ----------
    series
        Of each stretch: places of the residuals on an even grid, and columns whose products add up to their
        covariance: the residuals, and what a fit took from them, in standard errors of its numbers.
    """
    lags = MOST_TERMS
    sums, pairs = np.zeros(lags + 1), np.zeros(lags + 1)
    for places, columns in series:
        if not places.size:
            continue
        at = places - places[0]
        grid, there = np.zeros((at[-1] + 1, columns.shape[1])), np.zeros(at[-1] + 1)
        grid[at], there[at] = columns, 1.0
        for lag in range(min(lags, there.size - 1) + 1):
            sums[lag] += float(np.sum(grid[lag:] * grid[: there.size - lag]))
            pairs[lag] += float(there[lag:] @ there[: there.size - lag])
    count = pairs[0]
    variance = sums[0] / max(count, 1.0)
    if sums[0] <= 0.0:
        return Autoregression(np.empty(0), 0.0)
    unbiased = np.divide(sums, pairs, out=np.zeros(lags + 1), where=pairs > 0) / (sums[0] / count)
    terms, stationary = _terms(unbiased, pairs, 1.0 - _NEAR_ONE / np.sqrt(count))
    if not stationary:  # divided by all rows, correlations surely are
        terms = _terms(sums / sums[0], pairs, 1.0)[0]
    return Autoregression(terms, variance)


def _terms(correlation: FloatArray, pairs: FloatArray, most: float) -> tuple[FloatArray, bool]:
    """Terms by Levinson's recursion and AICc, and whether all reflections stay below ``most``."""
    count = pairs[0]
    terms, left = np.empty(0), 1.0
    chosen, least = terms, 0.0
    for size in range(1, pairs.size):
        if pairs[size] < _ROWS_PER_TERM * size:
            break
        reflection = (correlation[size] - float(terms @ correlation[size - 1 : 0 : -1])) / left
        if abs(reflection) >= most:
            return chosen, False
        terms = np.concatenate([terms - reflection * terms[::-1], [reflection]])
        left *= 1.0 - reflection**2
        score = count * np.log(left) + 2.0 * size * count / max(count - size - 1.0, 1.0)
        if score < least:
            chosen, least = terms, score
    return chosen, True


class Whitening:
    """What makes equations independent, by the correlation of their noise."""

    def __init__(self, noise: Autoregression, places: Sequence[np.ndarray]) -> None:
        """Take the noise, and the places of the equations of each stretch on an even grid."""
        self.factors: list[FloatArray] = []
        self.blocks: list[FloatArray] = []  #: how many places the equations of each block are apart
        longest = max((int(each[-1] - each[0]) for each in places if each.size), default=0)
        correlation = noise.correlation(longest)
        for each in places:
            for start in range(0, each.size, BLOCK):
                block = each[start : start + BLOCK]
                apart = np.abs(block[:, None] - block[None, :])
                matrix = correlation[apart]
                self.blocks.append(apart)
                self.factors.append(cholesky(matrix, lower=True))

    def __call__(self, values: FloatArray) -> FloatArray:
        """Return values, shape (equations, ...), as combinations whose noise is independent."""
        out, start = np.empty_like(values), 0
        for factor in self.factors:
            rows = slice(start, start + factor.shape[0])
            out[rows] = solve_triangular(factor, values[rows], lower=True)
            start += factor.shape[0]
        return out

    def power(self, covariances: FloatArray) -> float:
        """Return the expected sum of squares of other noise, by its covariances at lags 0, 1, ..."""
        padded = np.append(covariances, 0.0)
        total = 0.0
        for factor, apart in zip(self.factors, self.blocks, strict=True):
            other = padded[np.minimum(apart, covariances.size)]
            total += float(np.trace(cho_solve((factor, True), other)))
        return total
