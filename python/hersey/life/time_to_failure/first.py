"""The first end: of each specimen by all ways together, and of new specimens."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.growth.limit_ages import AgeAtLimit, age_at_limit
from hersey.life.time_to_failure.joined import correlations, order_by, ranks_of
from hersey.life.time_to_failure.way import FittedWay
from hersey.result import Means, Record

#: Ways are named until they hold so much of the probability of being first.
NAMED = 0.9
#: A way is named from this probability on, and where its age is so little later than the first.
MENTIONED, NEAR = 0.05, 1.25
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
        tuple[str, ...], Means("modes whose own age is at most 25 % later than the first")
    ]  #: ways whose own age, the middle one, is up to 25 % later than the first

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
        return text + (f", close behind {' and '.join(behind)}" if behind else "")

    def __str__(self) -> str:
        """Return it in words."""
        return str(self.age) if self.ways == _NONE else f"{self.age} by {self.ways}"


def ends_of_specimens(
    ending: Sequence[FittedWay],
    of_runs: FloatArray,
    names: Sequence[str],
    last: dict[str, float],
    random: np.random.Generator,
) -> tuple[tuple[SpecimenEnd, ...], list[tuple[IntArray, FloatArray]]]:
    """The first end of each specimen; and which draws of each way stand together, with their first ages."""
    found, picks = [], []
    greatest = min(each.followed.greatest for each in ending)
    for i, name in enumerate(names):
        keys = np.stack([each.ages[:, i] for each in ending], axis=1)
        own = np.stack([each.order[:, i] for each in ending], axis=1)
        order = np.take_along_axis(own, ranks_of(len(keys), of_runs, random), axis=0)
        joint = np.take_along_axis(keys, order, axis=0)
        first = joint.min(axis=1)
        shares = {e.mode.name: float(s) for e, s in zip(ending, _firsts(joint.T), strict=True)}
        least = min(float(each.earliest.units[i]) for each in ending)
        begun = max(each.followed.begun[name] for each in ending)
        end = age_at_limit(name, first, last[name], least, greatest, begun)
        middle = {e.mode.name: float(e.medians[i]) for e in ending}
        near = tuple(way for way, age in middle.items() if age <= NEAR * end.age.value < np.inf)
        found.append(SpecimenEnd(name, end, shares, near))
        picks.append((order, first))
    return tuple(found), picks


def _firsts(ages: FloatArray) -> FloatArray:
    """Share in which each row is the least of all, ties shared; less than 1 in all where none comes."""
    least = (ages == ages.min(axis=0)) & np.isfinite(ages)
    count = np.maximum(least.sum(axis=0), 1)
    return np.asarray((least / count).reshape(len(ages), -1).mean(axis=1))


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
