"""The share of the drag that does not follow the film, and what each share makes of the runs.

Rolling, seals and gears add to the torque and hide that the film thins. The more of such drag there is, the
sooner a film starves that shows the same torque. Its share is assumed to be anything from 0 to 45 %, the
greater the less likely; the dwells narrow that where a share does not describe them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.film.layer import LayerFit, Layers
from hersey.result import Means, Record

#: Shares that are tried, and the ends of what each stands for.
SHARES = np.array([0.05, 0.2, 0.3, 0.4])
_ENDS = np.array([0.0, 0.125, 0.25, 0.35, 0.45])
#: How likely each is beforehand: the more, the less likely, and the most half as likely as none.
_BEFOREHAND = np.diff(_ENDS - _ENDS**2 / (4.0 * _ENDS[-1]))
#: Width of the interval of the share (of 45 %) from which the dwells say little.
_NARROW = 0.25
#: Runs above which only some specimens are followed at each share.
_RUNS = 240


@dataclass(frozen=True)
class StarvesAt(Record):
    """When specimens starve if a share of the drag does not follow the film."""

    share: Annotated[float, Means("of the drag, flooded, that does not follow the film")]
    first: Annotated[float, Means("age of the specimen that starves first", open=True)]
    median: Annotated[float, Means("age of the median of the specimens", open=True)]

    @property
    def shown(self) -> str:
        """The age of the median specimen in words."""
        return f"{float(f'{self.median:.3g}'):.10g}" if np.isfinite(self.median) else "never"


@dataclass(frozen=True)
class OtherDrag(Record):
    """The share of the drag that does not follow the film, at the first point and flooded, 90 % interval.

    ``computed`` is the rolling part of the contact as stated; ``starves`` says what the ages would be at
    some shares.
    """

    share: Annotated[float, Means("median")]
    low: float
    high: float
    computed: Annotated[float, Means("rolling part by the machine file")]
    starves: Annotated[tuple[StarvesAt, ...], Means("ages at the first point at some shares")]

    def lines(self, unit: str, point: str) -> list[str]:
        """Return the share and what the ages would be at others, as lines of text."""
        ages = ", ".join(f"{each.shown} {unit} at {each.share:.0%}" for each in self.starves)
        return [
            f"share of the drag at {point} that does not follow the film (rolling, seals, gears), flooded: "
            f"{self.share:.0%} [{self.low:.0%}, {self.high:.0%}]; rolling as computed {self.computed:.0%}",
            f"age at which the median specimen starves, by that share: {ages}",
        ]

    @property
    def sooner(self) -> bool:
        """Whether specimens starve sooner the greater the share is."""
        return self.starves[-1].median < self.starves[0].median

    @property
    def determined(self) -> bool:
        """Whether the dwells narrow the share."""
        return self.high - self.low < _NARROW


@dataclass(frozen=True)
class ByShare:
    """How likely each of `SHARES` of other drag is, and the layers of some runs at each."""

    weight: FloatArray
    some: IntArray  #: the runs that were fitted at each share
    layers: tuple[Layers, ...]  #: of those
    likeliest: Layers  #: of all runs, at the likeliest share
    computed: float  #: the share by the contact as stated

    @property
    def is_of_all(self) -> bool:
        """Whether all runs were fitted at each share."""
        return self.some.size == len(self.likeliest.best)

    def quantile(self, of: float) -> float:
        """Return a quantile of the share."""
        return float(np.interp(of, np.concatenate([[0.0], np.cumsum(self.weight)]), _ENDS))


def by_share(fit: LayerFit, units: list[str], young: BoolArray) -> ByShare:
    """Return the layers of runs at shares of other drag from 0 to 45 %.

    ``units`` are their specimens, and ``young`` says in which the lubricant is as good as new.
    """
    found = [fit.together(share) for share in SHARES.tolist()]
    some = _some_runs(units)
    part = replace(fit, dwells=fit.dwells.rows(some))
    layers = tuple(part.layers(each.common) for each in found)
    # All runs err alike where the law errs, so they count as one.
    unlikely = np.array([each.unlikely for each in found])
    unlikely += [_off_level(each, fit.level, young[some]) for each in layers]
    weight = _BEFOREHAND * np.exp(-0.5 * (unlikely - unlikely.min()))
    weight /= weight.sum()
    best = int(np.argmax(weight))
    likeliest = layers[best] if some.size == len(units) else fit.layers(found[best].common)
    return ByShare(weight, some, layers, likeliest, fit.computed_share)


def _off_level(layers: Layers, deviation: float, young: BoolArray) -> float:
    """How unlikely the viscosity of new lubricant is, -2 ln of it: what is not of the film is of the rest."""
    if not young.any():
        return 0.0
    viscosity, error = (each[young] for each in layers.likeliest_viscosity())
    return float(np.median(viscosity) ** 2 / (deviation**2 + np.median(error) ** 2))


def _some_runs(units: list[str]) -> IntArray:
    """Runs of so many specimens, evenly chosen, that they are not too many."""
    names = list(dict.fromkeys(units))
    every = max(1, -(-len(units) // _RUNS))
    chosen = set(names[::every])
    return np.flatnonzero([unit in chosen for unit in units])


def other_drag(by: ByShare, starves: list[StarvesAt]) -> OtherDrag:
    """Return what runs show of the share, and the ages at each."""
    low, middle, high = (by.quantile(each) for each in (0.05, 0.5, 0.95))
    return OtherDrag(middle, low, high, by.computed, tuple(starves))


def slower_by_share(starves: list[StarvesAt], weight: FloatArray, draws: int, seed: int) -> FloatArray:
    """Return factors on ages of draws for shares other than the likeliest, as often as they are likely."""
    ages = np.array([each.median for each in starves])
    known = np.isfinite(ages) & (ages > 0.0)
    best = int(np.argmax(weight))
    factor = np.where(known & known[best], ages / ages[best] if known[best] else 1.0, 1.0)
    return factor[np.random.default_rng(seed).choice(factor.size, draws, p=weight)]
