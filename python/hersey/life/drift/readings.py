"""What a drift is what would do: the smallest set of ageings that accounts for the change of a run's values.

Each ageing moves the values of `aged_torque` along its own direction, so any set of them is a linear
hypothesis about the change. The sets are weighed by how far the change stays from what they could do, in its
own covariance, and by how many they are; ageing that runs backwards counts more. Sets that do about as well
as the best, with other names, cannot be distinguished.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.drift.aged_torque import (
    CONTACT,
    COVER,
    EXPONENT,
    FILM,
    LAW,
    OWN,
    REST,
    SHARPNESS,
    STARVATION,
    Scales,
    parts,
)
from hersey.result import Means, Record

#: Names of what ages.
THICKER, STARVED, TOUCHING, LOADED, OTHER, LAWFUL = (
    "lubricant",
    "film",
    "contact",
    "load or grip",
    "no-load torque",
    "temperature law",
)
#: Words for each that grows and that falls.
WORDS = {
    THICKER: ("a thicker lubricant", "a thinner lubricant"),
    STARVED: ("a thinner, starved film", "a better-fed film"),
    TOUCHING: ("more asperity contact", "less asperity contact"),
    LOADED: ("more load or grip", "less load or grip"),
    OTHER: ("a higher no-load torque", "a lower no-load torque"),
    LAWFUL: (
        "a stronger temperature dependence of viscosity",
        "a weaker temperature dependence of viscosity",
    ),
}
#: Gain in minus twice the log-likelihood that one more ageing must bring, and an ageing that runs backwards;
#: a load that changes by itself is rarer, so that it must bring as much as two.
_PRICE, _BACKWARDS = 9.0, 3.0
_DEAR = {LOADED: 2.0}
#: Difference in it below which two sets cannot be distinguished: a ratio of likelihoods of ten.
_NEAR = 4.6
#: Of a 90 % interval.
NORMAL = 1.645
#: Part of the typical change of torque that the law may get wrong in each direction; more so where no
#: temperatures distinguish film and no-load torque.
_LAW_ERROR, _WITHOUT_TEMPERATURES = 0.06, 0.2
#: Least part of the greatest change of torque, and of torque, that is named.
_LEAST_PART, _LEAST_CHANGE = 0.05, 0.003


@dataclass(frozen=True)
class Change(Record):
    """An ageing that the change points to: whether it `grows`, and what it does to torque.

    ``torque`` (N m) is the change up to the oldest run at a state that shows it, ``low`` and ``high`` end
    its 90 % interval; ``share`` is the same relative to torque when new.
    """

    name: str
    grows: Annotated[bool, Means("whether there is more of it with age, e.g. a thicker lubricant")]
    torque: Annotated[float, Means("change up to the oldest run, at speed and temperature", "N m")]
    low: float
    high: float
    share: Annotated[float, Means("of torque when new")]
    speed: Annotated[float, Means(unit="rad/s")]  #: rad/s
    temperature: Annotated[float | None, Means(unit="K")]  #: K

    @property
    def words(self) -> str:
        """It in words."""
        return WORDS[self.name][0 if self.grows else 1]


@dataclass(frozen=True)
class Reading(Record):
    """What a change points to: sets of ageings, the best first; more than one cannot be distinguished.

    An empty set says that nothing moved beyond the errors.
    """

    sets: Annotated[
        tuple[tuple[Change, ...], ...],
        Means("sets of ageings that explain it equally well, the best first; an empty one: nothing moved"),
    ]

    @property
    def sure(self) -> tuple[Change, ...]:
        """What all sets have, with the interval that covers those of all: it is pointed to in any case."""
        common = []
        for each in self.sets[0]:
            alike = [o for one in self.sets for o in one if (o.name, o.grows) == (each.name, each.grows)]
            if len(alike) == len(self.sets):
                ends = min(o.low for o in alike), max(o.high for o in alike)
                common.append(replace(each, low=ends[0], high=ends[1]))
        return tuple(common)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of what all sets have."""
        return tuple(each.name for each in self.sure)


def directions(shared: FloatArray) -> list[tuple[str, FloatArray]]:
    """Return how each ageing moves the values of a run, with its name; contact has two."""
    exponent, sharp = shared[EXPONENT], np.exp(shared[SHARPNESS])
    found = []
    for name, moved in (
        (THICKER, {FILM: 1.0 - exponent, STARVATION: sharp * exponent, COVER: exponent}),
        (STARVED, {STARVATION: 1.0}),
        (TOUCHING, {CONTACT: 1.0}),
        (TOUCHING, {COVER: -1.0}),
        (LOADED, {FILM: 1.0, CONTACT: 1.0}),
        (OTHER, {REST: 1.0}),
        (LAWFUL, {LAW: 1.0}),
    ):
        along = np.zeros(len(OWN))
        along[list(moved)] = list(moved.values())
        found.append((name, along))
    return found


def states(scales: Scales) -> tuple[FloatArray, FloatArray]:
    """Return speeds (rad/s) and places of temperature over the range of the data, three of each at most."""
    speeds = np.geomspace(*scales.speed, 3)
    places = np.array([-0.5, 0.0, 0.5]) if scales.thermal else np.zeros(1)
    speed, place = np.meshgrid(speeds, places, indexing="ij")
    return speed.ravel(), place.ravel()


def read(
    scales: Scales, shared: FloatArray, new: FloatArray, change: FloatArray, covariance: FloatArray
) -> list[Reading]:
    """Return what the changes of several specimens, or of one population, point to.

    Parameters
    ----------
    new, change, covariance
        Of each: values when new, their change up to the oldest run, and its covariance; (specimens, `OWN`,
        ...).
    """
    speed, place = states(scales)
    middle = parts(scales, speed, place, new + 0.5 * change, shared)
    relative = middle.own / middle.torque[..., None]
    # The law is no truth: by this much it may mistake one value for another.
    typical = np.sqrt(((relative @ change[..., None])[..., 0] ** 2).mean(axis=1, keepdims=True))
    wrong = _LAW_ERROR if scales.thermal else _WITHOUT_TEMPERATURES
    blur = wrong * typical / np.maximum(np.abs(relative).max(axis=1), 1e-6)
    weight = np.linalg.inv(covariance + blur[:, :, None] ** 2 * np.eye(len(OWN)))
    every = directions(shared)
    # With many specimens chance does more.
    price = _PRICE + 2.0 * np.log(len(change))
    sets = _sets(every)
    scores, amounts = np.empty((len(change), len(sets))), []
    for k, chosen in enumerate(sets):
        along = np.array([every[i][1] for i in chosen]).reshape(len(chosen), len(OWN)).T
        projected = along.T @ weight
        amount = np.linalg.solve(projected @ along, projected @ change[..., None])[..., 0]
        left = change - amount @ along.T
        backwards = sum(
            _effect(relative, every, chosen, amount, name) < 0.0
            for name in {every[i][0] for i in chosen} - {LAWFUL}
        )
        dear = sum(_DEAR.get(every[i][0], 1.0) for i in chosen)
        scores[:, k] = np.einsum("ui,uij,uj->u", left, weight, left) + price * dear + _BACKWARDS * backwards
        amounts.append(amount)
    found = []
    for u in range(len(change)):
        likely: dict[frozenset[tuple[str, bool]], tuple[Change, ...]] = {}
        for k in np.argsort(scores[u], kind="stable"):
            if scores[u, k] > scores[u].min() + _NEAR:
                break
            ageings = [every[i] for i in sets[k]]
            along = np.array([each[1] for each in ageings]).reshape(len(ageings), len(OWN))
            errors = np.linalg.inv(along @ weight[u] @ along.T)
            named = _named(scales, shared, new[u], ageings, amounts[k][u], errors)
            likely.setdefault(frozenset((each.name, each.grows) for each in named), named)
        found.append(Reading(tuple(likely.values())))
    return found


def _sets(every: list[tuple[str, FloatArray]]) -> list[tuple[int, ...]]:
    """All sets of ageings of which none is made of the others."""
    along = np.array([each[1] for each in every])
    sets = [c for count in range(len(OWN) + 1) for c in combinations(range(len(every)), count)]
    return [each for each in sets if not each or np.linalg.matrix_rank(along[list(each)]) == len(each)]


def _effect(
    relative: FloatArray,
    every: list[tuple[str, FloatArray]],
    chosen: tuple[int, ...],
    amount: FloatArray,
    name: str,
) -> FloatArray:
    """Change of torque that an ageing of a set does, where it does most, to first order; of each specimen."""
    step = sum(amount[:, [k]] * every[i][1] for k, i in enumerate(chosen) if every[i][0] == name)
    effect = (relative @ step[..., None])[..., 0]  # type: ignore[index]
    if name in (THICKER, STARVED):  # at the hot and slow corner a thicker oil takes less
        return np.asarray(effect[:, -1])
    most = np.abs(effect).argmax(axis=1)
    return np.asarray(np.take_along_axis(effect, most[:, None], axis=1)[:, 0])


def _named(
    scales: Scales,
    shared: FloatArray,
    new: FloatArray,
    chosen: list[tuple[str, FloatArray]],
    amount: FloatArray,
    covariance: FloatArray,
) -> tuple[Change, ...]:
    """The ageings of a set with what they do to torque; those that do next to nothing are left out."""
    speed, place = states(scales)
    before = parts(scales, speed, place, new, shared, slopes=False).torque
    found = []
    for name in dict.fromkeys(each for each, _ in chosen):
        at = [i for i, (each, _) in enumerate(chosen) if each == name]
        step = sum(amount[i] * chosen[i][1] for i in at)
        effect = parts(scales, speed, place, new + step, shared, slopes=False).torque - before
        state = {THICKER: -1, STARVED: -1, OTHER: speed.size // 2}.get(
            name, int(np.argmax(np.abs(effect / before)))
        )
        slope = parts(scales, speed, place, new + 0.5 * step, shared).own[state]
        by = np.array([slope @ chosen[i][1] for i in at])
        error = NORMAL * float(np.sqrt(by @ covariance[np.ix_(at, at)] @ by))
        found.append((name, float(effect[state]), error, float(effect[state] / before[state]), state))
    greatest = max((abs(share) for *_, share, _ in found), default=0.0)
    changes = [
        Change(
            name,
            effect > 0.0 if name != LAWFUL else bool(amount[[each for each, _ in chosen].index(name)] > 0.0),
            scales.torque * effect,
            scales.torque * (effect - error),
            scales.torque * (effect + error),
            share,
            float(speed[state]),
            scales.temperature(place[state]),
        )
        for name, effect, error, share, state in found
        if abs(share) >= max(_LEAST_PART * greatest, _LEAST_CHANGE)
    ]
    return tuple(sorted(changes, key=lambda each: -abs(each.torque)))
