"""Samples drawn from a fitted law under the plan of the real one, and what is estimated from each.

Where ages are exact, as many specimens fail as did, and the others are withdrawn after the same failure
(Viveros and Balakrishnan, Technometrics 36, 1994, 84-91). Where ages are known between inspections, each
specimen is looked at on the same ages. Each stress is a plan of its own.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.failures.distributions import Distribution
from hersey.life.failures.likelihood import Observed, log_between
from hersey.life.failures.sample import Failures


def can_draw(sample: Failures) -> bool:
    """Whether such samples can be drawn: not where exact ages and inspections are mixed."""
    failed = sample.failed
    return bool(sample.exact[failed].all() or not sample.exact[failed].any())


def drawn(
    law: Distribution,
    sample: Failures,
    covariate: FloatArray,
    parameters: tuple[float, float, float],
    draws: int,
    random: np.random.Generator,
) -> Observed:
    """Return samples of the law with parameters m, k and c."""
    plan = _exact if sample.exact[sample.failed].all() else _inspected
    return plan(law, sample, covariate, parameters, draws, random)


def _exact(
    law: Distribution,
    sample: Failures,
    covariate: FloatArray,
    parameters: tuple[float, float, float],
    draws: int,
    random: np.random.Generator,
) -> Observed:
    m, k, c = parameters
    ages, counts, stresses = [], [], []
    for stress in np.unique(covariate):
        mine = covariate == stress
        leave = leaving(sample.low[mine], sample.failed[mine], sample.count[mine])
        if not leave.size:
            continue
        at_risk = leave[::-1].cumsum()[::-1]
        hazard = (random.exponential(size=(draws, leave.size)) / at_risk).cumsum(axis=1)
        ages.append(m + c * stress + law.quantile(-np.expm1(-hazard), np.array(k)))
        counts.append(leave - 1.0)
        stresses.append(np.full(leave.size, stress))
    exact, withdrawn, stress = np.hstack(ages), np.hstack(counts), np.hstack(stresses)
    some = withdrawn > 0
    return Observed(
        exact=exact,
        right=exact[:, some],
        exact_count=np.ones(exact.shape[1]),
        right_count=withdrawn[some],
        exact_stress=stress,
        right_stress=stress[some],
    )


def leaving(ages: FloatArray, failed: BoolArray, count: IntArray) -> FloatArray:
    """Return how many specimens leave at each failure: one fails, others are withdrawn before the next.

    Specimens withdrawn before the first failure say least, and leave no trace.
    """
    order = np.lexsort((~failed, ages))
    leave: list[float] = []
    for one in order.tolist():
        if failed[one]:
            leave += [1.0] * int(count[one])
        elif leave:
            leave[-1] += float(count[one])
    return np.array(leave)


def _inspected(
    law: Distribution,
    sample: Failures,
    covariate: FloatArray,
    parameters: tuple[float, float, float],
    draws: int,
    random: np.random.Generator,
) -> Observed:
    m, k, c = parameters
    lows, highs, counts, stresses = [], [], [], []
    for stress in np.unique(covariate):
        mine = covariate == stress
        ends = np.concatenate([sample.low[mine], sample.high[mine]])
        looks = np.unique(ends[np.isfinite(ends) & (ends > 0)])
        last = np.where(sample.failed[mine], looks[-1], sample.low[mine])
        for end in np.unique(last):
            edges = np.log(looks[looks <= end])
            low, high = np.append(-np.inf, edges), np.append(edges, np.inf)
            shift = m + c * stress
            shares = np.exp(log_between(law, low - shift, high - shift, np.array(k)))
            total = int(sample.count[mine][last == end].sum())
            counts.append(random.multinomial(total, shares / shares.sum(), size=draws))
            lows.append(low)
            highs.append(high)
            stresses.append(np.full(low.size, stress))
    return Observed(
        exact=np.zeros((1, 0)),
        low=np.hstack(lows)[None, :],
        high=np.hstack(highs)[None, :],
        between_count=np.hstack(counts).astype(float),
        between_stress=np.hstack(stresses),
    )
