"""Parameters that the sample leaves possible, as draws, for forecasts and combined failure modes.

Up to 40 failures each draw turns the error of a drawn sample round (Lawless, Statistical Models and Methods
for Lifetime Data, 2003, section 5.1: exact for a location and a scale where a test ends at a failure);
beyond, draws are those of a normal law with the curvature of the likelihood.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.failures.distributions import Distribution
from hersey.life.failures.fit import Fit, covariance, middle

#: Draws where the likelihood is taken as normal.
_DRAWS = 2000


@dataclass(frozen=True)
class Draws:
    """Draws of m, k and c of a law, shape (draws,) each."""

    law: Distribution
    m: FloatArray
    k: FloatArray
    c: FloatArray

    def age(self, share: FloatArray | float, stress: float = 0.0) -> FloatArray:
        """Return the age by which a share has failed, of each draw; shares broadcast against draws."""
        with np.errstate(over="ignore"):
            return np.asarray(np.exp(self.m + self.c * stress + self.law.quantile(np.asarray(share), self.k)))

    def log_survival(self, age: FloatArray, stress: float = 0.0) -> FloatArray:
        """Return the logarithm of the share that outlives an age; ages broadcast against draws."""
        with np.errstate(divide="ignore"):
            return self.law.log_survival(np.log(age) - self.m - self.c * stress, self.k)

    def one(self, index: int) -> Draws:
        """Return one of the draws."""
        some = slice(index, index + 1)
        return Draws(self.law, self.m[some], self.k[some], self.c[some])


def survival_at(draws: Sequence[Draws], ages: FloatArray, stress: float) -> FloatArray:
    """Return the logarithm of the share that outlives each age all failure modes, shape (draws, ages)."""
    total = np.zeros((draws[0].m.size, ages.size))
    for each in draws:
        column = Draws(each.law, each.m[:, None], each.k[:, None], each.c[:, None])
        total = total + column.log_survival(ages[None, :], stress)
    return total


def sum_survival(draws: Sequence[Draws], ages: FloatArray, stress: float) -> FloatArray:
    """Return the same at one age of each draw, shape (draws,)."""
    return np.asarray(sum(each.log_survival(ages, stress) for each in draws))


def draws_of(fit: Fit) -> Draws:
    """Return draws of the parameters of a fit."""
    share = middle(fit.sample)
    u, log_k = float(np.log(fit.age(share))), float(np.log(fit.k))
    found = fit.replicates
    if found is None:
        mean = fit.start(fit.problem(share))
        random = np.random.default_rng(fit.seed)
        drawn = random.multivariate_normal(mean, covariance(fit), size=_DRAWS, method="cholesky")
        columns = list(drawn.T)
        age = columns.pop(0)
        k = np.exp(columns.pop(0)) if fit.known is None else np.full(_DRAWS, fit.k)
        c = columns.pop(0) if fit.accelerated else np.zeros(_DRAWS)
    else:
        good = found.good
        of_draw = found.m[good] + fit.law.quantile(np.full(int(good.sum()), share), found.k[good])
        k = np.exp(2 * log_k - np.log(found.k[good]))
        wider = found.k[good] / fit.k if fit.law.is_pivotal else np.sqrt(found.k[good] / fit.k)
        age = u - (of_draw - u) * wider
        c = fit.c - (found.c[good] - fit.c) * wider
    return Draws(fit.law, age - fit.law.quantile(np.full(k.size, share), k), k, c)
