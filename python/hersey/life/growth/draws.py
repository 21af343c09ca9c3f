"""Equally probable draws of specimens and of new ones, and the ages at which each reaches a limit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.growth.limit_ages import ages_of, ages_of_sum, beyond, later
from hersey.life.growth.marginal import Specimens, drawn_specimens, new_specimens
from hersey.life.growth.peaks import first_guess
from hersey.life.growth.points import Points
from hersey.life.growth.posterior import Posterior


@dataclass(frozen=True)
class Draws:
    """Draws under one law after the other; ages and levels scaled as the points are."""

    of_specimens: tuple[Specimens, ...]
    of_population: tuple[Specimens, ...]
    last: FloatArray = field(repr=False)  #: age from which each specimen may depart from its law
    seed: int

    @property
    def count(self) -> int:
        """How many draws there are."""
        return sum(len(units.scatter) for units in self.of_specimens)

    def powers(self) -> tuple[FloatArray, FloatArray]:
        """Return powers by which growth beyond the last run departs, of the specimens and of new ones."""
        widths = self.last.size, self.of_population[0].level.shape[1]
        known, new = beyond(np.random.default_rng([self.seed, 4]), self.count, *widths)
        return known, new

    def ages(self, level: float, level_error: float, *, accumulates: bool) -> tuple[FloatArray, FloatArray]:
        """Return ages at a level (logarithm) with its error, of the specimens and of new ones."""
        normals = np.random.default_rng([self.seed, 1]).standard_normal((self.count, 1))
        levels = level + level_error * normals
        lasts = self.last, self.last.max(keepdims=True)
        found = []
        for drawn, last, powers in zip(
            (self.of_specimens, self.of_population), lasts, self.powers(), strict=True
        ):
            parts = [
                ages_of_sum(units, levels[own], last, powers[own])
                if accumulates
                else later(ages_of(units, levels[own]), last, powers[own])
                for units, own in _each(drawn)
            ]
            found.append(np.concatenate(parts))
        return found[0], found[1]

    def curves(self, ages: FloatArray, places: Sequence[int]) -> FloatArray:
        """Return logarithms of the indicator of specimens at these places, (draws, specimens, ages)."""
        powers, drawn = self.powers()[0][:, places], []
        for units, own in _each(self.of_specimens):
            by_law = later(ages, self.last[places, None], 1.0 / powers[own, :, None])
            grown = units.law.log_growth(units.size[:, places, None], by_law, units.shape[..., None])
            drawn.append(units.level[:, places, None] + grown)
        return np.concatenate(drawn)

    def curve(self, unit: int, ages: FloatArray) -> FloatArray:
        """Return logarithms of the indicator of one specimen, (draws, ages)."""
        powers, drawn = self.powers()[0][:, unit, None], []
        for units, own in _each(self.of_specimens):
            by_law = later(ages, self.last[unit], 1.0 / powers[own])
            grown = units.law.log_growth(units.size[:, unit, None], by_law, units.shape)
            drawn.append(units.level[:, unit, None] + grown)
        return np.concatenate(drawn)

    def grown(self) -> FloatArray:
        """Return how much the median new specimen grows up to the greatest age, relative, (draws,)."""
        found = []
        for units in self.of_population:
            size = np.median(units.size, axis=1, keepdims=True)
            found.append(np.expm1(units.law.log_growth(size, np.ones(1), units.shape))[:, 0])
        return np.concatenate(found)


def _each(drawn: tuple[Specimens, ...]) -> Iterator[tuple[Specimens, slice]]:
    """Yield the specimens under each law, and which draws they are."""
    begin = 0
    for units in drawn:
        yield units, slice(begin, begin := begin + len(units.scatter))


def _begun(found: Posterior, points: Points) -> FloatArray:
    """Where the search for the size of each specimen begins; some may have been none of the posterior's."""
    return found.sizes if found.sizes.size == len(points.age) else first_guess(found.law, points)[1]


def draws_of(
    found: list[tuple[Posterior, FloatArray]], points: Points, seed: int, random: np.random.Generator
) -> Draws:
    """Return draws of specimens and of new ones for each draw of what they share."""
    last = points.age.max(axis=1, where=points.given, initial=0.0)
    return Draws(
        tuple(
            drawn_specimens(each.law, points, shared, _begun(each, points), random) for each, shared in found
        ),
        tuple(new_specimens(each.law, shared) for each, shared in found),
        np.where(last > 0.0, last, 1.0),
        seed,
    )
