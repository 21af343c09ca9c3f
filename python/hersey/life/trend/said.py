"""Numbers of a trend from equally probable draws of the laws that fit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import CONFIDENCE, Estimate
from hersey.life.trend.comparing import Data, Draws, Fitted, draws_of

#: Draws of all laws together; a law of a smaller weight is left out.
_DRAWS, _FAINT = 3000, 0.01
#: Ages up to the last at which curves are followed, beyond it, and how far, in T.
_WITHIN, _BEYOND, _FAR = 400, 100, 30.0
#: Half distances of neighbouring blocks by which the place of a jump may be off.
_ASIDE = 2.0
#: Part of the record over which its last rate is taken.
_LAST = 0.1
#: Share of the change that has come after a time constant.
_CHANGED = 1.0 - 1.0 / np.e


@dataclass(frozen=True)
class Weighed:
    """Laws that fit, each with draws in proportion to its weight."""

    draws: tuple[Draws, ...]
    data: Data
    jumps: FloatArray  #: ages of the jumps, in T
    gaps: FloatArray  #: how far each may be off, in T

    def curves(self, age: FloatArray) -> FloatArray:
        """Return friction at ages in T, (draws, ages)."""
        jumped = (age[:, None] >= self.jumps).astype(float)
        return np.concatenate([each.curves(age, jumped) for each in self.draws])

    def of_each(self, what: Callable[[Draws], FloatArray]) -> FloatArray:
        """Return a number of every draw, law after law."""
        return np.concatenate([what(each) for each in self.draws])


def weighed(fits: Sequence[Fitted], weights: FloatArray, random: np.random.Generator) -> Weighed:
    """Return draws of laws by their weights, which are scaled to the sum 1."""
    data = fits[0].data
    shares = np.where(weights >= _FAINT * weights.max(), weights, 0.0)
    counts = np.round(_DRAWS * shares / shares.sum()).astype(int)
    draws = tuple(draws_of(f, n, random) for f, n in zip(fits, counts.tolist(), strict=True) if n > 0)
    age, places = data.age, np.array(data.jumps, dtype=int)
    return Weighed(draws, data, 0.5 * (age[places - 1] + age[places]), 0.5 * (age[places] - age[places - 1]))


def interval(values: FloatArray) -> Estimate:
    """Return median and 95 % interval of draws, which may be infinite."""
    tail = 0.5 * (1.0 - CONFIDENCE)
    low, middle, high = np.quantile(values, [tail, 0.5, 1.0 - tail], method="nearest")
    error = float(np.std(values)) if np.isfinite(values).all() else np.inf
    return Estimate(float(middle), error, float(low), float(high))


def last_rate(found: Weighed) -> FloatArray:
    """Return how fast friction changes over the last tenth of the record, per T, without jumps."""
    ends = found.curves(np.array([1.0 - _LAST, 1.0]))
    lost = found.jumps > 1.0 - _LAST
    if lost.any():
        jumped = np.array([found.jumps < 1.0 - _LAST] * 2).astype(float)
        ends = np.concatenate([each.curves(np.array([1.0 - _LAST, 1.0]), jumped) for each in found.draws])
    return np.asarray((ends[:, 1] - ends[:, 0]) / _LAST)


def steady_ages(found: Weighed, share: float, random: np.random.Generator) -> FloatArray:
    """Return from which age on friction is within a share of its steady value, in T; infinite if not soon."""
    age = _followed(found)
    steady = found.of_each(Draws.steady)[:, None]
    off = np.abs(found.curves(age) - steady) - share * np.abs(steady)
    outside = off > 0.0
    last = age.size - 1 - np.argmax(outside[:, ::-1], axis=1)
    rows = np.arange(off.shape[0])
    never, at_once = outside[:, -1], ~outside.any(axis=1)
    before, after = last, np.minimum(last + 1, age.size - 1)
    rise, fall = off[rows, before], -off[rows, after]
    crossed = age[before] + (age[after] - age[before]) * rise / np.where(rise + fall > 0.0, rise + fall, 1.0)
    for jump, gap in zip(found.jumps, found.gaps, strict=True):
        crossed += np.where(
            np.abs(crossed - jump) < 1e-6, gap * random.uniform(-_ASIDE, _ASIDE, rows.size), 0.0
        )
    return np.where(never, np.inf, np.where(at_once, 0.0, crossed))


def _followed(found: Weighed) -> FloatArray:
    """Ages at which curves are followed: denser at the start, and at both sides of a jump."""
    start = found.data.start
    within = start + (1.0 - start) * np.linspace(0.0, 1.0, _WITHIN) ** 2
    beyond = np.geomspace(1.0, _FAR, _BEYOND)[1:]
    sides = (found.jumps[:, None] + np.array([-1e-7, 1e-7])).ravel()
    return np.unique(np.concatenate([within, beyond, sides]))


def time_constants(found: Weighed) -> FloatArray:
    """Return after what age a settling law has come to 63 % of its change, in T."""

    def of(draws: Draws) -> FloatArray:
        tau = np.exp(draws.at[0])
        if len(draws.fitted.shape.law.shapes) == 1:
            return np.asarray(tau)
        return np.asarray(tau * np.expm1(-np.log1p(-_CHANGED) * np.exp(-draws.at[1])))

    return found.of_each(of)


def jump_heights(found: Weighed) -> FloatArray:
    """Return the jumps as shares of friction just before each, (draws, jumps)."""
    before = found.curves(found.jumps - 1e-7)
    after = found.curves(found.jumps + 1e-7)
    return np.asarray((after - before) / np.maximum(np.abs(before), 1e-300))
