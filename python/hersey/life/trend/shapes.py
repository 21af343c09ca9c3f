"""How friction may change with age in one log: a share of it by a law of growth, up or down, the rest not.

The laws are those of `hersey.life.growth.laws`. Of each only the course is taken, scaled so that it goes from
0 at the first age to 1 at the last; how far friction moves along it, and which way, is fitted linearly. Ages
are in T, the greatest age of the record. The laws with two shapes that bend any way (curved, drying film) are
left out: one record does not tell them from the others.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.growth.laws import LAWS, SETTLING, Law

#: Size of a law without one of its own: its course is the same whatever the size, or there is none.
_ANY = 0.0
#: Exponents of the law that settles as a power of age.
_POWERS = np.log([0.5, 0.7, 1.0, 1.4, 2.0])
#: Sizes r T of the laws that bend by it: from nearly straight on.
_EXPONENTIAL, _SIDE_FLOW = (0.3, 8.0), (0.5, 200.0)
#: Longest time constant of the first change as faces meet, in T, how many are tried, and by how much, in its
#: logarithm, the other is longer.
_MEETING, _MEETINGS, _APART = 0.03, 6, 1.0
#: Greatest time constant, in T.
_SLOWEST = 3.0


@dataclass(frozen=True)
class Shape:
    """A course with the range of its parameter, and what is added to it."""

    name: str
    formula: str
    law: Law
    varied: str = ""  #: "tau" of a law that settles, "size" of one that bends by its size
    ends: tuple[float, float] = (0.0, 0.0)  #: of that parameter
    drifts: bool = False  #: whether a steady drift is added
    meets: bool = False  #: whether a first fast change is added, as faces meet
    fastest: float = 0.0  #: time constant of that, in T

    @property
    def settles(self) -> bool:
        """Whether friction comes to rest at a value."""
        return not self.drifts and (self.varied == "tau" or not self.law.grows)

    @property
    def parameters(self) -> int:
        """How many numbers it takes beside the level."""
        return (
            int(self.law.grows)
            + (bool(self.varied))
            + (len(self.law.shapes) == 2)
            + self.drifts
            + 2 * self.meets
        )

    def grid(self, count: int, ends: tuple[float, float] | None = None) -> FloatArray:
        """Return values of its parameters, (shapes, values): logarithms of tau/T or of r T, and of m."""
        if not self.varied:
            return np.zeros((1, 1))
        low, high = ends or (np.log(self.ends[0]), np.log(self.ends[1]))
        first = np.linspace(low, high, count)
        if len(self.law.shapes) == 2:
            return np.array(list(itertools.product(first, _POWERS))).T
        if self.meets:
            fast = np.log(np.geomspace(self.fastest, _MEETING, _MEETINGS))
            return np.array([at for at in itertools.product(first, fast) if at[0] > at[1] + _APART]).T
        return first[None, :]

    def course(self, age: FloatArray, at: FloatArray, start: float) -> FloatArray:
        """Return the course at ages, (ages, values): 0 at the ``start``, 1 at the greatest age."""
        if self.varied == "tau":
            size, shape = np.full(at.shape[1], _ANY), at[: len(self.law.shapes)]
        else:
            size, shape = at[0], at[:0]
        ages = np.concatenate([age, [start, 1.0]])
        grown = np.expm1(self.law.log_growth(size[None, :], ages[:, None], shape[:, None, :]))
        return np.asarray((grown[:-2] - grown[-2]) / (grown[-1] - grown[-2]))

    def limit(self, at: FloatArray, start: float) -> FloatArray:
        """Return how far the course goes in the end, shape (values,); 0 of friction that does not change."""
        if not self.law.grows:
            return np.zeros(at.shape[1])
        ages = np.array([start, 1.0])[:, None]
        grown = np.expm1(self.law.log_growth(np.full(at.shape[1], _ANY)[None, :], ages, at[:, None, :]))
        return np.asarray((np.expm1(np.log(2.0)) - grown[0]) / (grown[1] - grown[0]))


def shapes(fastest: float) -> tuple[Shape, ...]:
    """Return the courses that are compared; ``fastest`` is the least time constant that shows, in T."""
    by_name = {law.name: law for law in LAWS}
    constants = (fastest, _SLOWEST)
    return (
        Shape("constant", "f0", by_name["constant"]),
        Shape("linear", "f0 + r t", by_name["linear"]),
        Shape("saturating", "f1 + (f0 - f1) exp(-t/tau)", by_name["saturating"], "tau", constants),
        Shape("power", "f1 + (f0 - f1) (1 + t/tau)^-m", SETTLING, "tau", constants),
        Shape("exponential", "f0 + s (exp(r t) - 1)", by_name["exponential"], "size", _EXPONENTIAL),
        Shape("side flow", "f0 + s (sqrt(1 + r t) - 1)", by_name["side flow"], "size", _SIDE_FLOW),
        Shape(
            "saturating and linear",
            "f1 + (f0 - f1) exp(-t/tau) + r t",
            by_name["saturating"],
            "tau",
            (fastest, 0.3),
            drifts=True,
        ),
        Shape(
            "twice saturating",
            "f1 + (f0 - f1 - s) exp(-t/tau) + s exp(-t/tau0)",
            by_name["saturating"],
            "tau",
            (3.0 * fastest, _SLOWEST),
            meets=True,
            fastest=fastest,
        ),
    )
