"""Draws of several failure modes side by side: those whose runs scatter together move together."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hersey.arrays import FloatArray, IntArray

#: Pairs below which a correlation is not counted.
_LEAST = 5
#: Least eigenvalue of a matrix of correlations.
_FLOOR = 1e-6


def correlations(columns: Sequence[FloatArray]) -> FloatArray:
    """Return correlations of columns over the rows that two of them have; 0 where chance may make them.

    A correlation counts from two standard errors of none, 2 / sqrt(pairs). The matrix is positive definite.
    """
    found = np.eye(len(columns))
    for i, one in enumerate(columns):
        for j, other in enumerate(columns[:i]):
            both = np.isfinite(one) & np.isfinite(other)
            number = int(both.sum())
            if number < _LEAST or min(one[both].std(), other[both].std()) <= 0.0:
                continue
            value = float(np.corrcoef(one[both], other[both])[0, 1])
            found[i, j] = found[j, i] = value if abs(value) > 2.0 / math.sqrt(number) else 0.0
    values, vectors = np.linalg.eigh(found)
    mended = (vectors * np.maximum(values, _FLOOR)) @ vectors.T
    scale = np.sqrt(np.diag(mended))
    return np.asarray(mended / np.outer(scale, scale))


def ranks_of(count: int, correlation: FloatArray, random: np.random.Generator) -> IntArray:
    """Return ranks of ``count`` normal draws with this correlation, one column for each of its rows."""
    return ranks_of_each(1, count, correlation, random)[:, :, 0].T


def ranks_of_each(
    specimens: int, count: int, correlation: FloatArray, random: np.random.Generator
) -> IntArray:
    """Return `ranks_of` for each of so many specimens, (rows of the correlation, draws, specimens)."""
    shape = specimens, count, len(correlation)
    normals = random.standard_normal(shape) @ np.linalg.cholesky(correlation).T
    order = np.argsort(normals.T, axis=1)
    ranks = np.empty_like(order)
    np.put_along_axis(ranks, order, np.arange(count)[:, None], axis=1)
    return ranks


def order_by(keys: FloatArray, ranks: IntArray) -> IntArray:
    """Return the draws of each column of ``keys`` in the order in which their keys have these ranks."""
    return np.asarray(np.take_along_axis(np.argsort(keys, axis=0, kind="stable"), ranks, axis=0))
