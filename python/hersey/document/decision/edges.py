"""The speeds that an instruction stands on: transition and V* at one temperature, each with its interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hersey.arrays import FloatArray
from hersey.stability.operating_map import OperatingMap

#: V* is not told where its interval reaches so many transition speeds: the search ends at 10,000.
_TOLD = 5e3


@dataclass(frozen=True)
class Edge:
    """A speed (m/s) with the ends of its 95 % interval, the upper one infinite if it is not told."""

    value: float
    low: float
    high: float

    @property
    def told(self) -> bool:
        """Whether the interval has an upper end."""
        return math.isfinite(self.high)


@dataclass(frozen=True)
class Edges:
    """Transition and V* at a temperature; ``greatest`` is the speed (m/s) that the drive reaches.

    ``holding`` is what a belt at rest bears (N m), ``limit`` what the drive can. V* has no estimate (not a
    number) where the nominal belt is not started.
    """

    transition: Edge
    fold: Edge
    greatest: float
    holding: Edge
    limit: float

    @property
    def starts(self) -> bool | None:
        """Whether the drive starts a belt at rest; None where it may or may not."""
        if self.holding.high <= self.limit:
            return True
        return False if self.holding.low > self.limit else None

    @property
    def safe(self) -> float:
        """The speed from which on the belt is smooth from any start, by the ends of the intervals."""
        return max(self.transition.high, self.fold.high)

    @property
    def bistable(self) -> bool:
        """Whether there are speeds at which the start decides."""
        return self.fold.high > self.transition.high * (1.0 + 1e-6)


def edges_of(map_: OperatingMap, kelvin: float | None) -> Edges:
    """Return the edges of a map at a temperature (K; None if isothermal): speeds exact, ends interpolated."""
    state = map_.state_at(kelvin, float(map_.speed[-1]))
    turn = _ends(map_, map_.transition_interval, kelvin)
    fold = _ends(map_, map_.upper_interval, kelvin)
    upper, far = max(state.upper, state.transition), _TOLD * state.transition
    stall = map_.at(map_.stall_above, kelvin)
    bears = _ends(map_, map_.holding_interval, kelvin)
    limit = math.inf if map_.torque_limit is None else map_.torque_limit
    edge = Edge(upper, min(fold[0], upper), max(fold[1], upper))
    if state.holding > limit >= bears[0]:  # the bands of a belt that is not started are none of one that is
        edge = Edge(math.nan, max(fold[0], state.transition), max(fold[1], state.transition))
    return Edges(
        transition=Edge(state.transition, min(turn[0], state.transition), max(turn[1], state.transition)),
        fold=edge if edge.high <= far else Edge(edge.value, edge.low, math.inf),
        greatest=min(map_.speed_limit or math.inf, stall),
        holding=Edge(state.holding, min(bears[0], state.holding), max(bears[1], state.holding)),
        limit=limit,
    )


def _ends(map_: OperatingMap, interval: FloatArray, kelvin: float | None) -> tuple[float, float]:
    low, high = (map_.at(edge, kelvin) for edge in interval)
    return low, high
