"""What the belt does at one temperature and drive speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    pass

#: States, from the slow side up. ``swing``: a small swing without sticking survives, a stuck belt sticks on.
STATES = ("stick_slip", "swing", "bistable", "smooth", "stall")
_VERDICTS = {
    "stick_slip": "Stick-slip is certain.",
    "swing": "The belt swings; it sticks once it has stuck.",
    "bistable": "Smooth only if it comes from above; from rest it sticks and slips.",
    "smooth": "Smooth.",
    "stall": "The drag is more than the drive can bear.",
}


@dataclass(frozen=True)
class MapState:
    """What the belt does at one temperature and drive speed; speeds in m/s, torque in N m.

    ``state`` is one of `STATES`. ``torque`` is that of steady sliding, with which the drive must cope.
    ``stick_speed`` is that at this temperature. ``extrapolated`` says that no dwell of the
    fit lies that far out.
    """

    state: str
    torque: float
    lower: float
    transition: float
    upper: float
    stick_speed: float
    extrapolated: bool

    def verdict(self) -> str:
        """Return what the state means, in one sentence."""
        return _VERDICTS[self.state]


@dataclass(frozen=True)
class PlacedPoint:
    """An operating point of the user's and what the map says there: speed in m/s, temperature in K."""

    name: str
    speed: float
    temperature: float
    at: MapState
