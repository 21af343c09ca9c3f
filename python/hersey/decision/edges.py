"""The speeds that a decision rests on: transition and V* at one temperature, each with its interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hersey.decision.judge import drive_limit
from hersey.posterior import Posterior
from hersey.posterior.result import quantiles
from hersey.result import Record

#: V* is not determined where its interval reaches so many times the fastest dwell.
_DETERMINED = 30.0


@dataclass(frozen=True)
class Edge(Record):
    """A value with the ends of its 95 % interval, the upper one infinite if it is not determined."""

    value: float
    low: float
    high: float

    @property
    def estimable(self) -> bool:
        """Whether the interval has an upper end."""
        return math.isfinite(self.high)


@dataclass(frozen=True)
class Edges:
    """Transition and V* at a temperature (m/s); ``greatest`` is the speed (m/s) that the drive reaches.

    ``safe`` is the speed from which on the belt is smooth from any start with 97.5 % probability, and below
    ``sticks_below`` it sticks with 97.5 %; ``holding`` is the torque that starts a belt at rest (N m),
    ``limit`` what the drive gives. Transition and V* have no upper end where torque may still fall at the
    fastest dwell.
    """

    transition: Edge
    fold: Edge
    safe: float
    sticks_below: float
    greatest: float
    holding: Edge
    limit: float

    @property
    def starts(self) -> bool | None:
        """Whether the drive starts a belt at rest; None where that is not sure."""
        if self.holding.high <= self.limit:
            return True
        return False if self.holding.low > self.limit else None

    @property
    def turns(self) -> bool:
        """Whether torque turns among the dwells in nearly all draws."""
        return math.isfinite(self.transition.high)

    @property
    def bistable(self) -> bool:
        """Whether there are speeds at which the start decides."""
        return self.fold.high > self.transition.high * (1.0 + 1e-6)


def edges_of(found: Posterior, kelvin: float | None) -> Edges:
    """Return the edges of a posterior at a temperature (K; None if isothermal)."""
    machine, edges = found.model.machine, found.edges(kelvin)
    radius = machine.roll_radius
    value, low, high = found.fold_interval(kelvin)
    safe = found.safe_speed(kelvin)
    far = _DETERMINED * found.model.surface.speed_range[1] * radius
    fold = Edge(*(v if v <= far else math.inf for v in (value, low, high)))
    return Edges(
        transition=_edge(np.where(np.isfinite(edges.turns_by), math.inf, edges.transition)),
        fold=fold,
        safe=safe if safe <= far else math.inf,
        sticks_below=quantiles(np.minimum(edges.transition, edges.turns_by), (0.025,))[0],
        greatest=machine.limits.speed or math.inf,
        holding=_edge(edges.holding * radius),
        limit=drive_limit(machine.limits, radius, machine.train.grip) * radius,
    )


def _edge(draws: np.ndarray) -> Edge:
    low, middle, high = quantiles(draws, (0.025, 0.5, 0.975))
    return Edge(middle, low, high)
