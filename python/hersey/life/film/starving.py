"""When specimens starve, from the draws of the law of their layers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.life.film.depletion_law import Depletion
from hersey.life.film.of_runs import Estimates, FilmPoint
from hersey.life.film.shares import StarvesAt
from hersey.life.film.starved_drag import Flooded, cubic
from hersey.life.growth.limit_ages import AgesAtLimit, Interval, ages_at_limit, interval, quantiles
from hersey.life.indicator import OwnAges
from hersey.life.maintenance import Followed
from hersey.result import Record
from hersey.schema.warning import Warning

#: Ages looked at, over the greatest of the data; past the last it counts as never.
_AGES = np.concatenate([[0.0], np.geomspace(3e-3, 10.0, 110)])
#: Layers of draws that are computed at once.
_AT_ONCE = 200_000
#: How far the law of film and starvation may be off, ln of layer over film, in common to all specimens, as
#: films by other laws showed (`benchmarks/starvation.py`); film over roughness below which faces that touch
#: make it more; and the power by which they do.
_LAW, _THICK, _TOUCHING = 0.09, 8.0, 1.5
#: Share of the draws that stay finite where nothing bounds the layer from above.
_OPEN = 0.9
#: New specimens drawn for B10 and B50, of each draw of what specimens share.
_NEW = 40
#: Draws of what specimens share from which new ones are drawn.
_NEW_OF = 400


@dataclass(frozen=True)
class OilLeft(Record):
    """The oil in the layer of a specimen, m^3: new, when last seen, and what the film then needs."""

    unit: str
    new: Interval
    last: Interval
    needed: Interval


@dataclass(frozen=True)
class LayersOfSpecimens:
    """The layers of the specimens of a campaign: draws of their law, names, and ages when last seen.

    A layer that was renewed thins from the age ``begun`` on; before it, it is NaN here.
    """

    drawn: Depletion
    names: list[str]
    last: FloatArray
    roughness: float | None = None  #: m
    slower: FloatArray | None = None  #: factors on the ages of draws, by the share of other drag
    seen: BoolArray | None = None  #: which specimens show starvation in any run; None: all
    begun: FloatArray | None = None  #: age from which each layer thins; None: all from new

    def of(self, names: tuple[str, ...], begun: dict[str, float]) -> LayersOfSpecimens:
        """Return those of some names that are there, which thin from the ages ``begun`` on."""
        places = [self.names.index(name) for name in names if name in self.names]
        kept = [self.names[k] for k in places]
        return replace(
            self,
            drawn=replace(self.drawn, specimens=self.drawn.specimens[:, places]),
            names=kept,
            last=self.last[places],
            seen=None if self.seen is None else self.seen[places],
            begun=np.array([begun[name] for name in kept]),
        )

    def _since(self, k: int, ages: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Ages of a layer since it was new or renewed, and 0, or NaN before that."""
        since = ages - (0.0 if self.begun is None else self.begun[k])
        return np.maximum(since, 0.0), np.where(since < 0.0, np.nan, 0.0)

    def spread(self, of: Callable[[FloatArray, FloatArray], FloatArray], ages: FloatArray) -> Estimates:
        """Return median and 90 % ends of exp of a function of what a specimen has, (specimens, ages)."""
        found = []
        for k, own in enumerate(np.moveaxis(self.drawn.specimens, 1, 0)):
            since, known = self._since(k, ages)
            found.append(np.exp(quantiles(of(own, since))) + known)
        low, middle, high = np.moveaxis(np.array(found), 1, 0)
        return Estimates(middle, low, high)

    def thickness(self, ages: FloatArray) -> Estimates:
        """Return the layer at ages, m."""
        return self.spread(self.drawn.layer, ages)

    def film(self, point: Flooded, ages: FloatArray) -> Estimates:
        """Return the film over the flooded one at a point."""
        drawn = self.drawn
        return self.spread(lambda own, age: drawn.log_share(own, age, point), ages)

    def needs(self, point: Flooded, ages: FloatArray) -> FloatArray:
        """Return the layer below which the film starves at a point, m, median of (specimens, ages)."""
        drawn, found = self.drawn, []
        for k, own in enumerate(np.moveaxis(drawn.specimens, 1, 0)):
            since, known = self._since(k, ages)
            needed = drawn.layer(own, since) - drawn.over_starved(own, since, point)
            found.append(np.exp(np.median(needed, axis=0)) + known)
        return np.array(found)

    def oil(self, point: Flooded, area: float) -> tuple[OilLeft, ...]:
        """Return the oil on a track of an area (m^2), and what the film at a point needs of it."""
        return tuple(self._oil(k, point, area) for k in range(len(self.names)))

    def _oil(self, k: int, point: Flooded, area: float) -> OilLeft:
        own, ages = self.drawn.specimens[:, k], self._since(k, np.array([0.0, self.last[k]]))[0]
        layer = self.drawn.layer(own, ages)
        needed = layer - self.drawn.over_starved(own, ages, point)
        drawn = (layer[:, 0], layer[:, 1], needed[:, 1])
        return OilLeft(self.names[k], *(interval(area * np.exp(each)) for each in drawn))

    def rates(self) -> dict[str, Interval]:
        """Return K (1/(m^2 age)), p, e and g (1/age) of the median specimen."""
        drawn = self.drawn.rate(self.drawn.mean)
        return {name: interval(each) for name, each in drawn.items()}

    def starving(self, point: Flooded) -> OwnAges:
        """Return draws of the ages at which these specimens and new ones starve at a point."""
        drawn, many = self.drawn, len(self.drawn.mean)
        some = np.linspace(0, many - 1, min(many, _NEW_OF)).astype(np.intp)
        random = np.random.default_rng(0)
        normals = random.standard_normal((some.size, _NEW, drawn.mean.shape[1]))
        off = self._law(point) * random.standard_normal(many)
        new = drawn.mean[some, None] + drawn.spread[some, None] * normals
        known = _ages_below(drawn, drawn.specimens, point, off[:, None])
        later = _ages_below(drawn, new, point, off[some, None])
        if self.slower is not None:
            known, later = known * self.slower[:, None], later * self.slower[some, None]
        known = self._open(known) + (0.0 if self.begun is None else self.begun)
        return OwnAges(known, later)

    def _open(self, ages: FloatArray) -> FloatArray:
        """Ages of draws, without an upper end where a specimen shows no more than a lower bound."""
        if self.seen is None or self.seen.all():
            return ages
        latest = ages >= np.quantile(ages, _OPEN, axis=0, method="lower")
        return np.where(latest & ~self.seen, np.inf, ages)

    def _law(self, point: Flooded) -> float:
        """How far the law may be off at a point, ln of layer over film."""
        if self.roughness is None:
            return _LAW
        over = float(np.exp(cubic(point.film, np.zeros(()))[0].item())) / self.roughness
        return float(_LAW * max(_THICK / over, 1.0) ** _TOUCHING)

    def starves(
        self, own: OwnAges, state: FilmPoint, age_unit: str, warnings: tuple[Warning, ...]
    ) -> AgesAtLimit:
        """Return the ages at which the specimens starve at a point, of their draws."""
        quantity = f"ratio of oil layer needed to oil layer at {state.name}"
        last = dict(zip(self.names, self.last.tolist(), strict=True))
        begun = np.zeros(len(last)) if self.begun is None else self.begun
        since = dict(zip(self.names, begun.tolist(), strict=True))
        followed = Followed(last, since, self.drawn.greatest_age)
        return ages_at_limit(quantity, age_unit, 1.0, followed, own, warnings)

    def with_all(self, own: OwnAges, begun: dict[str, float]) -> OwnAges:
        """Return the draws of all specimens: one that no run shows is new at the age ``begun``."""
        spare = np.resize(own.new[:, 0], len(own.known))
        columns = [
            own.known[:, self.names.index(name)] if name in self.names else spare + since
            for name, since in begun.items()
        ]
        return OwnAges(np.stack(columns, axis=1), own.new)


def starves_at(layers: LayersOfSpecimens, point: Flooded, share: float) -> StarvesAt:
    """Return when specimens starve at a point, fitted for a share of other drag."""
    drawn = layers.drawn
    ages = np.median(_ages_below(drawn, drawn.specimens, point, np.zeros((len(drawn.mean), 1))), axis=0)
    return StarvesAt(share, float(ages.min()), float(np.median(ages)))


def _ages_below(drawn: Depletion, own: FloatArray, point: Flooded, off: FloatArray) -> FloatArray:
    """Ages at which the film of draws (..., 10) is first starved; infinite where never.

    ``off`` is the error of ln of layer over film that all specimens have in common, of each draw.
    """
    many = max(1, _AT_ONCE // (own[0].size // own.shape[-1] * _AGES.size))
    blocks = [slice(first, first + many) for first in range(0, len(own), many)]
    return np.concatenate([_ages_of_some(drawn, own[some], point, off[some]) for some in blocks])


def _ages_of_some(drawn: Depletion, own: FloatArray, point: Flooded, off: FloatArray) -> FloatArray:
    ages = _AGES * drawn.greatest_age
    above = drawn.over_starved(own, ages, point) + off[..., None]
    below = above <= 0.0
    first = np.argmax(below, axis=-1)
    before = np.maximum(first - 1, 0)
    high = np.take_along_axis(above, before[..., None], -1)[..., 0]
    low = np.take_along_axis(above, first[..., None], -1)[..., 0]
    share = np.where(first > 0, high / np.where(high > low, high - low, 1.0), 0.0)
    met = ages[before] + share * (ages[first] - ages[before])
    return np.asarray(np.where(below.any(axis=-1), met, np.inf))
