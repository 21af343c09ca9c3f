"""The first end: of each specimen by all ways together, and of new specimens."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.growth.limit_ages import AgeAtLimit, ages_of_each
from hersey.life.time_to_failure.joined import correlations, order_by, ranks_of, ranks_of_each
from hersey.life.time_to_failure.way import FittedWay
from hersey.result import Means, Record

#: Ways are named until they hold so much of the probability of being first.
NAMED = 0.9
#: A way is named from this probability to be first on, and from a probability to come up to so much later.
MENTIONED, CLOSE, NEAR = 0.05, 0.2, 1.25
#: Ways that a table names: the fewest that hold so much of that probability.
LIKELY = 0.8
#: Stands for the failure mode of a specimen that no mode can be expected to end.
_NONE = "none shows growth"


@dataclass(frozen=True)
class SpecimenEnd(Record):
    """What ends a specimen, and when."""

    also_stated = ("named", "likely", "state")

    unit: str
    age: Annotated[AgeAtLimit, Means("age of the first failure by any mode")]  #: of the first of all ways
    first: Annotated[
        dict[str, float], Means("probability of each mode to come first")
    ]  #: probability of each way to be the first; the rest is that none comes
    near: Annotated[
        tuple[str, ...],
        Means("modes that come at most 25 % later than the first with a probability of 20 % or more"),
    ]  #: ways that may come up to 25 % later than the first

    @property
    def named(self) -> tuple[str, ...]:
        """The ways that must be named, the likeliest first.

        The fewest that hold 90 % of the probability that any comes, each that has 5 % of it, and those near.
        """
        order = sorted(self.first, key=lambda name: -self.first[name])
        total, found = sum(self.first.values()), 0.0
        names = []
        for name in order:
            if found < NAMED * total or self.first[name] >= MENTIONED * total > 0.0 or name in self.near:
                names.append(name)
            found += self.first[name]
        return tuple(names)

    @property
    def likely(self) -> tuple[str, ...]:
        """The ways that a table names, the likeliest first: they hold 80 % of the probability of any.

        None if the specimen is not expected to fail.
        """
        if math.isinf(self.age.age.value):
            return ()
        order = sorted(self.first, key=lambda name: -self.first[name])
        total, found, names = sum(self.first.values()), 0.0, []
        for name in order:
            if found >= LIKELY * total:
                break
            names.append(name)
            found += self.first[name]
        return tuple(names)

    @property
    def state(self) -> str:
        """Whether it has ``failed``, is ``running`` or ``unclear``, when last seen."""
        return self.age.state

    @property
    def ways(self) -> str:
        """The ways in words."""
        likely = [name for name in self.named if self.first[name] >= MENTIONED]
        if not likely and math.isinf(self.age.age.value):
            return _NONE
        text = " or ".join(f"{name} ({self.first[name]:.0%})" for name in likely) or "no known failure mode"
        expected = math.isfinite(self.age.age.value)
        behind = [name for name in self.named if name not in likely and expected]
        return text + (f", perhaps soon followed by {' and '.join(behind)}" if behind else "")

    def __str__(self) -> str:
        """Return it in words."""
        return str(self.age) if self.ways == _NONE else f"{self.age} by {self.ways}"


class Picks(NamedTuple):
    """Which draws of each mode stand together for a specimen, and the first age in each draw."""

    order: IntArray  #: (modes, draws, specimens)
    first: FloatArray  #: (draws, specimens)


def ends_of_specimens(
    ending: Sequence[FittedWay],
    of_runs: FloatArray,
    names: Sequence[str],
    last: dict[str, float],
    random: np.random.Generator,
) -> tuple[tuple[SpecimenEnd, ...], Picks]:
    """The first end of each specimen, and of which draws it is made."""
    ranks = ranks_of_each(len(names), len(ending[0].ages), of_runs, random)
    order = np.stack([np.take_along_axis(e.order, own, axis=0) for e, own in zip(ending, ranks, strict=True)])
    joint = np.stack([np.take_along_axis(e.ages, own, axis=0) for e, own in zip(ending, order, strict=True)])
    first = joint.min(axis=0)
    seen = np.array([last[name] for name in names])
    begun = np.max([[each.followed.begun[name] for name in names] for each in ending], axis=0)
    least = np.min([each.earliest.units for each in ending], axis=0)
    greatest = min(each.followed.greatest for each in ending)
    ends = ages_of_each(names, first, seen, least, begun, greatest)
    ways = [each.mode.name for each in ending]
    soon = np.isfinite(first) & (joint <= NEAR * first)
    found = []
    for end, shares, near in zip(ends, _firsts(joint).T.tolist(), soon.mean(axis=1).T.tolist(), strict=True):
        close = tuple(way for way, share in zip(ways, near, strict=True) if share >= CLOSE)
        found.append(SpecimenEnd(end.unit, end, dict(zip(ways, shares, strict=True)), close))
    return tuple(found), Picks(order, first)


def _firsts(ages: FloatArray) -> FloatArray:
    """Share of draws in which each mode is the least of all, (modes, specimens), ties shared.

    ``ages`` are (modes, draws, specimens); the shares are less than 1 in all where none comes.
    """
    least = (ages == ages.min(axis=0)) & np.isfinite(ages)
    count = np.maximum(least.sum(axis=0), 1)
    return np.asarray((least / count).mean(axis=1))


def joint_order(ending: Sequence[FittedWay], of_runs: FloatArray, random: np.random.Generator) -> IntArray:
    """Return which draws of the population of each mode stand together, (draws, modes)."""
    middle = np.stack([each.middle for each in ending], axis=1)
    return order_by(middle, ranks_of(len(middle), of_runs, random))


def ages_of_new(
    ending: Sequence[FittedWay], order: IntArray, random: np.random.Generator
) -> Iterator[FloatArray]:
    """Yield ages of new specimens at each limit, (draws, specimens), specimens side by side.

    ``order`` is as from `joint_order`.
    """
    logs = [np.log(np.clip([a.age.value for a in each.mode.ages.units], 1e-9, 1e300)) for each in ending]
    of_specimens = correlations(logs)
    ranks = ranks_of(ending[0].new.shape[1], of_specimens, random)
    for m, each in enumerate(ending):
        yield each.new[np.ix_(order[:, m], ranks[:, m])]
