"""Shares failed without any law: Kaplan and Meier's, and Turnbull's where ages lie between inspections."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.failures.sample import Failures

#: Rounds of Turnbull's iteration at the most, and where it ends.
_ROUNDS, _SETTLED = 5000, 1e-10


def positions(sample: Failures) -> tuple[FloatArray, FloatArray]:
    """Return ages at failure and the share failed at each, to be drawn on a probability plot.

    At an exact age it is half way up the step (Meeker and Escobar, Statistical Methods for Reliability
    Data, 1998, section 6.4); at the end of an inspection interval it is the share failed by then.
    """
    edges, shares = steps(sample)
    before = np.append(0.0, shares[:-1])
    exact = np.isin(edges, sample.high[sample.exact])
    place = np.where(exact, 0.5 * (before + shares), shares)
    drawn = np.isfinite(edges) & (place > 0) & (place < 1 - 1e-12) & (shares > before + 1e-12)
    return edges[drawn], place[drawn]


def steps(sample: Failures) -> tuple[FloatArray, FloatArray]:
    """Return the ages at which the share failed steps up, and the share after each."""
    if sample.exact[sample.failed].all():
        return _kaplan_meier(sample)
    return _turnbull(sample)


def _kaplan_meier(sample: Failures) -> tuple[FloatArray, FloatArray]:
    ages = np.unique(sample.high[sample.failed])
    fail = np.array([sample.count[sample.exact & (sample.high == age)].sum() for age in ages], dtype=float)
    at_risk = np.array([sample.count[sample.low >= age].sum() for age in ages], dtype=float)
    return ages, 1.0 - np.cumprod(1.0 - fail / at_risk)


def _turnbull(sample: Failures) -> tuple[FloatArray, FloatArray]:
    """Shares of greatest likelihood of the cells between all ends (Turnbull, J. R. Stat. Soc. B 38, 1976)."""
    edges = np.unique(np.concatenate([sample.low, sample.high, [np.inf]]))
    edges = edges[edges > 0]
    # An exact age is a cell of its own, of no width, at its end.
    low, high = np.append(0.0, edges[:-1]), edges
    exact = np.unique(sample.high[sample.exact])
    lows, highs = np.concatenate([low, exact]), np.concatenate([high, exact])
    order = np.lexsort((lows, highs))
    lows, highs = lows[order], highs[order]
    point = lows == highs
    inside = (lows >= sample.low[:, None]) & (highs <= sample.high[:, None])
    inside &= ~(point & (lows <= sample.low[:, None])) | (
        sample.exact[:, None] & (highs == sample.high[:, None])
    )
    mass = np.full(lows.size, 1.0 / lows.size)
    weights = sample.count / sample.specimens
    for _ in range(_ROUNDS):
        shared = inside * mass
        new = (weights[:, None] * shared / shared.sum(axis=1, keepdims=True)).sum(axis=0)
        if np.abs(new - mass).max() < _SETTLED:
            break
        mass = new
    return highs, np.minimum(mass.cumsum(), 1.0)
