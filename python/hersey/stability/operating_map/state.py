"""What the belt does at one temperature and drive speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from hersey.result import OPEN, Means, Record

#: States, from the slow side up. ``creep``: below the stick speed the closure ``retained`` takes the belt
#: along at the speed of the drive. ``swing``: a small swing without sticking survives, a stuck belt sticks
#: on. ``stall``: the roll slips on the belt; ``motor``: the motor gives up.
STATES = ("creep", "stick_slip", "swing", "bistable", "smooth", "stall", "motor")
_VERDICTS = {
    "creep": "Slower than the stick speed, where nothing is measured: the belt creeps along or sticks.",
    "stick_slip": "Stick-slip is certain.",
    "swing": "The belt swings; it sticks once it has stuck.",
    "bistable": "Smooth only if it comes from above; from rest it sticks and slips.",
    "smooth": "Smooth.",
    "stall": "The drag is more than the roll grips: it slips on the belt.",
    "motor": "The drag is more than the motor can bear.",
}
#: The same on a roll that may slip on the belt.
_SLIPPING = (
    "Smooth only if it comes from above; from rest it goes on sticking, or swings while the roll slips."
)
#: The same of a belt at rest, which the drive does not start.
_NOT_STARTED = {
    "stall": "The roll slips on a belt at rest and does not start it",
    "motor": "The motor does not start a belt at rest",
}


#: Where the belts drawn do not agree.
_MAY_NOT_START = "The drive may not start a belt at rest. If it does:"


@dataclass(frozen=True)
class MapState(Record):
    """What the belt does at one temperature and drive speed; speeds in m/s, torque in N m.

    ``state`` is one of `STATES`: ``stall`` or ``motor`` where the drive does not start a belt at rest.
    ``torque`` is that of steady sliding, with which the drive must cope. ``slipping`` says that the roll
    slips for a part of the laps, ``extrapolated`` that no dwell of the fit lies that far out.
    """

    state: str
    moving: Annotated[str, Means("state of a belt that moves already")]
    torque: float
    holding: Annotated[float, Means("what a belt at rest bears before it starts")]
    starts: Annotated[bool, Means("whether the drive starts a belt at rest")]
    doubtful: Annotated[bool, Means("whether the 95 % interval of holding says otherwise")]
    lower: Annotated[float, OPEN]
    transition: float
    upper: Annotated[float, OPEN]
    stick_speed: Annotated[float, Means("at this temperature")]
    extrapolated: bool
    slipping: Annotated[bool, Means("the roll may slip for a part of the laps")] = False

    def verdict(self) -> str:
        """Return what the state means, in one sentence."""
        moving = _SLIPPING if self.slipping and self.moving == "bistable" else _VERDICTS[self.moving]
        if self.doubtful:
            return f"{_MAY_NOT_START} {moving}"
        if self.starts:
            return moving
        slides = self.moving in ("bistable", "smooth")
        return _NOT_STARTED[self.state] + ("; one that slides already goes on sliding." if slides else ".")


#: Verdicts of a posterior of drives, in words.
_OF_DRAWS = {
    "smooth": "Smooth from any start.",
    "depends": "Smooth once it slides; from rest it may stick.",
    "sticks": "Sticks from any start.",
    "not started": "The drive does not start it.",
    "stalls": "It stalls: sliding takes more than the drive gives.",
    "too fast": "Faster than the drive.",
    "unknown": "Not sure.",
}


@dataclass(frozen=True)
class PlacedPoint(Record):
    """An operating point of the user's and what the map says there: speed in m/s, temperature in K.

    ``judged`` is the verdict of the posterior that the edges are from; empty where there is none.
    """

    name: str
    speed: float
    temperature: float
    at: MapState
    judged: Annotated[str, Means("verdict of the posterior that the edges are from")] = ""

    def verdict(self) -> str:
        """Return what happens there, in one sentence."""
        return _OF_DRAWS[self.judged] if self.judged else self.at.verdict()
