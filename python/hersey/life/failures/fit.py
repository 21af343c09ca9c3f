"""The law of greatest likelihood, and its likelihood-ratio bounds, calibrated where failures are few.

The bounds of an age by which a share fails, of the shape or of the effect of stress are where the signed
root of the likelihood ratio reaches its quantiles. Up to 40 failures these are the quantiles of samples
drawn from the fitted law under the plan of the real one, which makes the bounds of the Weibull and
lognormal law exact where a test ends at a failure; beyond, those of the normal law.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import ndtri

from hersey.arrays import BoolArray, FloatArray
from hersey.life.failures.crossing import crossing
from hersey.life.failures.distributions import Distribution
from hersey.life.failures.likelihood import Observed, Problem
from hersey.life.failures.maximum import curvature_at, maximum
from hersey.life.failures.replicates import can_draw, drawn
from hersey.life.failures.sample import Failures

#: Failures up to which bounds are calibrated, and samples that are drawn for it.
_FEW, _DRAWS = 40, 2000
#: Shares of which quantiles are drawn, for a band.
_NODES = 5
#: Logarithms of shapes that count as none: all failures at one age, or at none more than at another.
_STEEPEST, _FLATTEST = 8.0, -3.0
#: How far from the estimate a bound is sought first and at the most, in ln age or ln shape.
_FIRST, _FARTHEST = 0.1, 40.0
#: Logit of a share beyond which no bound is sought.
_EXTREME = 16.0
#: Logarithm of age or of shape held, or the effect of a stress held; given its value, the problem.
Held = Callable[[Problem, FloatArray], Problem]


def age_held(problem: Problem, value: FloatArray) -> Problem:
    """Return the problem with the age of its share held."""
    return replace(problem, age=value)


def shape_held(problem: Problem, value: FloatArray) -> Problem:
    """Return the problem with the shape held."""
    return replace(problem, shape=value)


def effect_held(problem: Problem, value: FloatArray) -> Problem:
    """Return the problem with the effect of stress held."""
    return replace(problem, effect=value)


@dataclass(frozen=True)
class Fit:
    """A law fitted to a sample; m, k and c are those of ``ln age = m + c stress + x``, x of shape k.

    ``known`` is the shape where it was given, not estimated; ``draws`` are None where bounds are not
    calibrated.
    """

    law: Distribution
    sample: Failures
    covariate: FloatArray
    m: float
    k: float
    c: float
    accelerated: bool
    log_likelihood: float
    known: float | None
    seed: int
    calibrated: bool = True

    @property
    def is_estimable(self) -> bool:
        """Whether there is a law: not if all failures lie at one age, or the share failed does not grow."""
        return bool(not self.is_flat and np.log(self.k) < _STEEPEST and np.isfinite(self.m))

    @property
    def is_flat(self) -> bool:
        """Whether the share failed does not grow with age."""
        return bool(np.log(self.k) < _FLATTEST)

    @property
    def parameters(self) -> int:
        """Number of parameters estimated."""
        return 1 + (self.known is None) + self.accelerated

    def age(self, share: FloatArray | float, stress: float = 0.0) -> FloatArray:
        """Return the age by which a share has failed under a stress."""
        x = self.law.quantile(np.asarray(share, dtype=float), np.array(self.k))
        with np.errstate(over="ignore"):
            return np.asarray(np.exp(self.m + self.c * stress + x))

    def share(self, age: FloatArray | float, stress: float = 0.0) -> FloatArray:
        """Return the share that has failed by an age under a stress."""
        with np.errstate(divide="ignore"):
            x = np.log(np.asarray(age, dtype=float)) - self.m - self.c * stress
        return np.asarray(np.exp(self.law.log_failed(x, np.array(self.k))))

    def problem(self, share: FloatArray | float, stress: float = 0.0, of: Observed | None = None) -> Problem:
        """Return what is to be greatest, by the age of a share."""
        known = None if self.known is None else np.array(np.log(self.known))
        data = self.sample.observed(self.covariate) if of is None else of
        effect = None if self.accelerated else np.array(0.0)
        return Problem(self.law, data, np.asarray(share, dtype=float), stress, known, None, effect)

    def start(self, problem: Problem) -> FloatArray:
        """Return free parameters of a problem at the estimate, shape (parameters,)."""
        parts = []
        if problem.age is None:
            parts.append(float(np.log(self.age(float(np.ravel(problem.share)[0]), problem.stress))))
        if problem.shape is None:
            parts.append(float(np.log(self.k)))
        return np.array([*parts, *([self.c] * (problem.effect is None))])

    @cached_property
    def replicates(self) -> _Replicates | None:
        """Samples drawn from the law with their estimates; None where bounds are not calibrated."""
        if not (self.calibrated and self.sample.failures <= _FEW and can_draw(self.sample)):
            return None
        random = np.random.default_rng(self.seed)
        truth = (self.m, self.k, self.c)
        of = drawn(self.law, self.sample, self.covariate, truth, _DRAWS, random)
        problem = self.problem(middle(self.sample), of=of)
        at, value = maximum(problem.function(), np.tile(self.start(problem), (_DRAWS, 1)))
        m, k, c = (each[:, 0] for each in problem.parameters(at, np.arange(_DRAWS)))
        good = np.abs(np.log(k)) < _STEEPEST
        return _Replicates(of, m, k, c, value, good)

    def bounds(
        self, share: FloatArray, level: float, held: Held, stress: float = 0.0
    ) -> tuple[FloatArray, FloatArray]:
        """Return the bounds of what is held, a row per share; equal tails of a two-sided level.

        Ages and shape come as logarithms. Of more shares than five, quantiles between are interpolated.
        """
        share = np.atleast_1d(np.asarray(share, dtype=float))
        first, last = self._roots(share, level, held, stress)
        problem = self.problem(share, stress)
        best = self.estimate(held, share, stress)
        return self._bound(problem, best, held, last), self._bound(problem, best, held, first)

    def share_bounds(self, age: float, level: float, stress: float = 0.0) -> tuple[float, float]:
        """Return the bounds of the share that has failed by an age."""
        estimate = float(np.clip(self.share(age, stress), 1e-9, 1 - 1e-9))
        roots = np.concatenate(self._roots(np.array([estimate]), level, age_held, stress))
        place = np.full(2, np.log(age))
        started: list[FloatArray] = []

        def short(logit: FloatArray) -> FloatArray:
            share = 1.0 / (1.0 + np.exp(-logit))
            best = np.log(self.age(share, stress))
            return roots - self._root(self.problem(share, stress), best, place, age_held, started)

        low, high = 1.0 / (1.0 + np.exp(-crossing(short, np.full(2, -_EXTREME), np.full(2, _EXTREME))))
        return float(low), float(high)

    def estimate(self, held: Held, share: FloatArray, stress: float = 0.0) -> FloatArray:
        """Return the estimate of what can be held: ln age, ln shape or the effect of stress."""
        if held is age_held:
            return np.asarray(np.log(self.age(share, stress)))
        return np.full(share.size, np.log(self.k) if held is shape_held else self.c)

    def _bound(self, problem: Problem, middle: FloatArray, held: Held, root: FloatArray) -> FloatArray:
        """Where the signed root has a value; infinite where it never has."""
        side = np.where(root > 0, -1.0, 1.0)
        started: list[FloatArray] = []

        def short(value: FloatArray) -> FloatArray:
            """How far the root still is from its value; negative beyond the bound."""
            return side * (self._root(problem, middle, value, held, started) - root)

        inside, outside = middle.copy(), middle + side * _FIRST
        reached = short(outside) <= 0
        while not reached.all() and (np.abs(outside - middle) < _FARTHEST).any():
            inside = np.where(reached, inside, outside)
            outside = np.where(reached, outside, middle + 2.0 * (outside - middle))
            reached = short(outside) <= 0
        found = crossing(short, np.where(reached, inside, middle), np.where(reached, outside, middle))
        return np.where(reached, found, side * np.inf)

    def _root(
        self,
        problem: Problem,
        middle: FloatArray,
        value: FloatArray,
        held: Held,
        started: list[FloatArray],
    ) -> FloatArray:
        """The signed root of the likelihood ratio, positive below the estimate."""
        fixed = held(problem, value)
        start = started.pop() if started else np.tile(self.start(fixed), (value.size, 1))
        at, best = maximum(fixed.function(), start)
        started.append(at)
        ratio = np.maximum(2.0 * (self.log_likelihood - best), 0.0)
        return np.asarray(np.sign(middle - value) * np.sqrt(ratio))

    def _roots(
        self, share: FloatArray, level: float, held: Held, stress: float
    ) -> tuple[FloatArray, FloatArray]:
        """Quantiles of the signed root at which the bounds lie."""
        tails = [0.5 - level / 2, 0.5 + level / 2]
        drawn = self.replicates
        if drawn is None:
            low, high = ndtri(tails)
            return np.full(share.size, low), np.full(share.size, high)
        some = share if share.size <= _NODES else np.unique(np.quantile(share, np.linspace(0, 1, _NODES)))
        rows = [drawn.roots(self, one, held, stress) for one in some.tolist()]
        low, high = np.quantile(np.array(rows), tails, axis=1)
        if some is not share:
            places, nodes = (np.log(-np.log1p(-each)) for each in (share, some))
            low, high = np.interp(places, nodes, low), np.interp(places, nodes, high)
        # As long as a law is not excluded at all, its quantiles have the signs of the tails.
        return np.minimum(low, -1e-6), np.maximum(high, 1e-6)


@dataclass(frozen=True)
class _Replicates:
    """Samples drawn from a fitted law, and what is estimated from each; ``good`` ones have a law."""

    of: Observed
    m: FloatArray
    k: FloatArray
    c: FloatArray
    value: FloatArray
    good: BoolArray

    def roots(self, fit: Fit, share: float, held: Held, stress: float) -> FloatArray:
        """Return the signed roots of the likelihood ratio at the true value, of the samples with a law."""
        problem = fit.problem(share, stress, self.of)
        truth = float(fit.estimate(held, np.array([share]), stress)[0])
        if held is age_held:
            x = fit.law.quantile(np.full(self.k.size, share), self.k)
            estimate = self.m + self.c * stress + x
        else:
            estimate = np.log(self.k) if held is shape_held else self.c
        fixed = held(problem, np.array(truth))
        _, best = maximum(fixed.function(), np.tile(fit.start(fixed), (self.k.size, 1)))
        ratio = np.maximum(2.0 * (self.value - best), 0.0)
        return np.asarray((np.sign(estimate - truth) * np.sqrt(ratio))[self.good])


def fitted(
    law: Distribution,
    sample: Failures,
    covariate: FloatArray | None = None,
    *,
    known: float | None = None,
    seed: int = 0,
    calibrated: bool = True,
) -> Fit:
    """Return the law of greatest likelihood; ``covariate`` is what acts on ln age, of each row."""
    accelerated = covariate is not None
    acts = np.zeros(sample.low.size) if covariate is None else covariate
    fit = Fit(law, sample, acts, *_guess(sample, law), 0.0, accelerated, 0.0, known, seed, calibrated)
    if known is not None:
        fit = replace(fit, k=known)
    problem = fit.problem(middle(sample))
    at, value = maximum(problem.function(), fit.start(problem)[None, :])
    m, k, c = (float(each[0, 0]) for each in problem.parameters(at, np.zeros(1, dtype=int)))
    return replace(fit, m=m, k=k, c=c, log_likelihood=float(value[0]))


def covariance(fit: Fit) -> FloatArray:
    """Return the covariance of ln age of the middle share, ln shape and effect of stress."""
    problem = fit.problem(middle(fit.sample))
    return np.asarray(np.linalg.inv(-curvature_at(problem.function(), fit.start(problem)[None, :])[0]))


def middle(sample: Failures) -> float:
    """Return the share whose age is known best: about two thirds of those that failed."""
    return float(np.clip(0.63 * sample.failures / sample.specimens, 1e-4, 0.63))


def _guess(sample: Failures, law: Distribution) -> tuple[float, float]:
    """M and k to begin with."""
    failed = sample.failed
    low, high = np.maximum(sample.low[failed], 1e-300), sample.high[failed]
    ages = np.log(np.where(sample.low[failed] > 0, np.sqrt(low) * np.sqrt(high), 0.5 * high))
    weights = sample.count[failed]
    mean = float(np.average(ages, weights=weights))
    spread = float(np.sqrt(np.average((ages - mean) ** 2, weights=weights)))
    k = 1.2 / max(spread, 0.05)
    k = k if law.is_pivotal else k**2
    return mean - float(law.quantile(np.array(middle(sample)), np.array(k))), k
