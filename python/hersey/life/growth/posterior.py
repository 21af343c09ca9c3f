"""How far what specimens share is known under each law of growth: weighed draws, and the evidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from hersey.arrays import FloatArray
from hersey.life.growth.importance import importance_sampled, systematic
from hersey.life.growth.laws import Law
from hersey.life.growth.limit_ages import CONFIDENCE, Interval
from hersey.life.growth.peaks import Peak, log_posterior, shared_of
from hersey.life.growth.points import Points

#: Draws of each round for `_USUAL` runs; more for fewer runs and fewer for more, within factors.
_ROUNDS, _USUAL = (250, 250, 300, 600), 80
_LEAST_SHARE, _MOST = 0.25, 3.0


@dataclass(frozen=True)
class Posterior:
    """Weighed draws of what all specimens share, under one law."""

    law: Law
    shared: FloatArray  #: columns m0, ln t0, ln sigma, m1, ln t1, shapes (as far as the law has them)
    weight: FloatArray  #: sums to 1
    log_evidence: float
    sizes: FloatArray  #: of each specimen at the mode: where searches for it begin

    @property
    def effective(self) -> float:
        """How many independent draws they are worth."""
        return float(1.0 / np.sum(self.weight**2))


def posterior(peak: Peak, points: Points, random: np.random.Generator) -> Posterior:
    """Return weighed draws of what all specimens share under a law."""
    law, middle, sizes = peak.law, peak.middle, peak.sizes
    more = float(np.clip(_USUAL / points.value.size, _LEAST_SHARE, _MOST))
    found = importance_sampled(
        lambda spots: log_posterior(law, points, spots, middle, sizes),
        peak.mode,
        peak.covariance,
        [round(more * each) for each in _ROUNDS],
        random,
    )
    shared, _ = shared_of(law, found.draws, middle, len(points.value))
    return Posterior(law, shared, found.weight, found.log_integral, sizes)


def parameters_of(found: Posterior, scale: tuple[float, float]) -> dict[str, Interval]:
    """Return medians and 90 % intervals of what all specimens share, in the units given."""
    shared, law = found.shared, found.law
    with np.errstate(over="ignore"):  # draws of no weight may be anywhere
        named = {"level": np.exp(shared[:, 0] + scale[1]), "spread of levels": np.exp(shared[:, 1])}
    if law.grows:
        per_age = 1.0 if law.ends else scale[0]
        named["rate"] = np.exp(shared[:, 3]) / per_age
        named["spread of rates"] = np.exp(shared[:, 4])
    for i, (name, _, _) in enumerate(law.shapes, 5):
        own = shared[:, i]
        if name.startswith("logit "):
            named[name.removeprefix("logit ")] = special.expit(own)
        elif name == "ln(tau/T)":
            named["tau"] = np.exp(own) * scale[0]
        elif name.startswith("ln "):
            named[name.removeprefix("ln ")] = np.exp(own)
        else:
            named[name] = own
    named["scatter of runs"] = np.exp(shared[:, 2])
    return {name: _weighed(values, found.weight) for name, values in named.items()}


def _weighed(values: FloatArray, weight: FloatArray) -> Interval:
    order = np.argsort(values)
    steps = np.cumsum(weight[order])
    ends = np.searchsorted(steps, [0.5, 0.5 - CONFIDENCE / 2, 0.5 + CONFIDENCE / 2])
    return Interval(*(float(values[order[min(i, values.size - 1)]]) for i in ends))


def resampled(
    found: list[Posterior], weights: FloatArray, count: int, random: np.random.Generator
) -> list[tuple[Posterior, FloatArray]]:
    """Return equally probable draws over all laws (systematic resampling); laws without any are left out."""
    every = np.concatenate([each.weight * w for each, w in zip(found, weights, strict=True)])
    index = systematic(every, count, random)
    ends = np.cumsum([0, *(len(each.shared) for each in found)])
    draws = []
    for each, begin, end in zip(found, ends, ends[1:], strict=False):
        own = index[(index >= begin) & (index < end)] - begin
        if own.size:
            draws.append((each, each.shared[own]))
    return draws
