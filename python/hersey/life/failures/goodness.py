"""How well a law fits: Anderson and Darling's statistic, judged by samples drawn from the law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.failures.fit import Fit
from hersey.life.failures.replicates import leaving
from hersey.result import Means, Record


@dataclass(frozen=True)
class GoodnessOfFit(Record):
    """The statistic of Anderson and Darling, and how often samples of the law have one as great."""

    statistic: Annotated[float, Means("squared distance of the law from the share failed, weighted")]
    p_value: Annotated[float, Means("share of samples drawn from the law with a statistic at least as great")]


def goodness_of_fit(fit: Fit) -> GoodnessOfFit | None:
    """Return how well a law fits; None where ages lie between inspections, under stress, or of many failures.

    Suspensions count by Kaplan and Meier's shares, and the distance by what lies before the last failure;
    without suspensions it is the usual statistic.
    """
    found, sample = fit.replicates, fit.sample
    if found is None or fit.accelerated or not sample.exact[sample.failed].all():
        return None
    leave = leaving(sample.low, sample.failed, sample.count)
    lost = sample.specimens - leave.sum()
    shares = _kaplan_meier(leave)
    ages = np.sort(np.repeat(sample.low[sample.failed], sample.count[sample.failed]))
    own = _statistic(fit.share(ages)[None, :], shares, sample.specimens - lost)[0]
    x = found.of.exact - found.m[:, None]
    drawn = np.exp(fit.law.log_failed(x, found.k[:, None]))[found.good]
    others = _statistic(drawn, shares, sample.specimens - lost)
    return GoodnessOfFit(float(own), float((1 + (others >= own).sum()) / (1 + others.size)))


def _kaplan_meier(leave: FloatArray) -> FloatArray:
    at_risk = leave[::-1].cumsum()[::-1]
    return np.asarray(1.0 - np.cumprod(1.0 - 1.0 / at_risk))


def _statistic(failed: FloatArray, shares: FloatArray, specimens: float) -> FloatArray:
    """Specimens times the integral of (F_n - F)^2 / (F (1 - F)) over F, up to the last failure or to 1."""
    ends = np.clip(failed, 1e-12, 1 - 1e-12)
    begin = np.hstack([np.zeros((len(ends), 1)), ends])
    heights = np.append(0.0, shares)
    if shares[-1] > 1 - 1e-12:
        end = np.hstack([ends, np.ones((len(ends), 1))])
    else:
        begin, end, heights = begin[:, :-1], ends, heights[:-1]
    return np.asarray(specimens * (_integral(end, heights) - _integral(begin, heights)).sum(axis=1))


def _integral(share: FloatArray, height: FloatArray) -> FloatArray:
    with np.errstate(divide="ignore", invalid="ignore"):
        below = np.where(height > 0, height**2 * np.log(share), 0.0)
        above = np.where(height < 1 - 1e-12, (1 - height) ** 2 * np.log1p(-share), 0.0)
    return np.asarray(below - above - share)
