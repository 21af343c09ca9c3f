"""The speeds that a decision rests on: transition and V* at one temperature, each with its interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hersey.decision.judge import drive_limit
from hersey.posterior import Posterior
from hersey.posterior.result import quantiles

#: V* is not determined where its interval reaches so many transition speeds: the search ends at 10,000.
_DETERMINED = 5e3


@dataclass(frozen=True)
class Edge:
    """A value with the ends of its 95 % interval, the upper one infinite if it is not determined."""

    value: float
    low: float
    high: float

    @property
    def told(self) -> bool:
        """Whether the interval has an upper end."""
        return math.isfinite(self.high)


@dataclass(frozen=True)
class Edges:
    """Transition and V* at a temperature (m/s); ``greatest`` is the speed (m/s) that the drive reaches.

    ``safe`` is the speed from which on the belt is smooth from any start with 97.5 % probability; ``holding``
    the torque that starts a belt at rest (N m), ``limit`` what the drive gives.
    """

    transition: Edge
    fold: Edge
    safe: float
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
    def bistable(self) -> bool:
        """Whether there are speeds at which the start decides."""
        return self.fold.high > self.transition.high * (1.0 + 1e-6)


def edges_of(found: Posterior, kelvin: float | None) -> Edges:
    """Return the edges of a posterior at a temperature (K; None if isothermal)."""
    machine, edges = found.model.machine, found.edges(kelvin)
    radius = machine.roll_radius
    value, low, high = found.fold_interval(kelvin)
    safe = found.safe_speed(kelvin)
    far = _DETERMINED * float(np.median(edges.transition))
    fold = Edge(value, low, high) if high <= far else Edge(value, low, math.inf)
    return Edges(
        transition=_edge(edges.transition),
        fold=fold,
        safe=safe if safe <= far else math.inf,
        greatest=machine.limits.speed or math.inf,
        holding=_edge(edges.holding * radius),
        limit=drive_limit(machine.limits, radius, machine.train.grip) * radius,
    )


def _edge(draws: np.ndarray) -> Edge:
    low, middle, high = quantiles(draws, (0.025, 0.5, 0.975))
    return Edge(middle, low, high)
