"""Distributions of the statistics, from `scipy.special`: `scipy.stats` takes half a second to import.

Each is that of `scipy.stats` to the last digit; freedoms may be infinite where they may be there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import special

#: A number or an array; several are broadcast together.
Value = Any


def normal_density(x: Value) -> Value:
    """Return the density of the normal distribution."""
    return np.exp(-(np.asarray(x, dtype=float) ** 2) / 2.0) / np.sqrt(2 * np.pi)


def normal_above(x: Value) -> Value:
    """Return the probability of more than x."""
    return special.ndtr(-np.asarray(x, dtype=float))


def normal_quantile(share: Value) -> Value:
    """Return the value that a share lies below."""
    return special.ndtri(share)


def student_below(x: Value, freedom: Value) -> Value:
    """Return the probability of less than x by Student's t."""
    return special.stdtr(freedom, x)


def student_above(x: Value, freedom: Value) -> Value:
    """Return the probability of more than x by Student's t."""
    return student_below(-np.asarray(x, dtype=float), freedom)


def student_quantile(share: Value, freedom: Value) -> Value:
    """Return the value that a share lies below by Student's t."""
    return special.stdtrit(freedom, share)


def square_above(x: Value, freedom: Value) -> Value:
    """Return the probability of more than x by chi-square."""
    return special.chdtrc(freedom, np.maximum(x, 0.0))


def square_quantile(share: Value, freedom: Value) -> Value:
    """Return the value that a share lies below by chi-square."""
    return 2.0 * special.gammaincinv(np.asarray(freedom, dtype=float) / 2.0, share)


def ratio_above(x: Value, over: Value, under: Value) -> Value:
    """Return the probability of more than x by F."""
    return special.fdtrc(over, under, np.maximum(x, 0.0))


def ratio_quantile(share: Value, over: Value, under: Value) -> Value:
    """Return the value that a share lies below by F."""
    return special.fdtri(over, under, share)


def beta_quantile(share: Value, a: Value, b: Value) -> Value:
    """Return the value that a share lies below by the beta distribution."""
    return special.betaincinv(a, b, share)


def holm(p_values: Sequence[float]) -> list[float]:
    """Return p-values of claims made together, each so that one in the family is wrong as seldom as alone.

    S. Holm, Scand. J. Stat. 6 (1979) 65.
    """
    out, least = [0.0] * len(p_values), 0.0
    for rank, index in enumerate(np.argsort(p_values)):
        least = max(least, min(1.0, p_values[index] * (len(p_values) - rank)))
        out[index] = least
    return out
