"""What happens at one temperature and drive speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from hersey.result import OPEN, Means, Record

#: States, from the slow side up. ``creep``: below the stick speed the closure ``retained`` takes the belt
#: along at the speed of the drive. ``swing``: a small oscillation without sticking survives, a stuck
#: belt sticks on. ``stall``: the roll slips on the belt; ``motor``: the motor gives up.
STATES = ("creep", "stick_slip", "swing", "bistable", "smooth", "stall", "motor")
_VERDICTS = {
    "creep": "Below the stick speed, where nothing was measured: it creeps or sticks.",
    "stick_slip": "Stick-slip is certain.",
    "swing": "It oscillates; once it has stuck, it keeps sticking.",
    "bistable": "Smooth only if slowed from above; sticks if started from rest.",
    "smooth": "Smooth.",
    "stall": "Drag exceeds the grip: the drive slips.",
    "motor": "Drag exceeds what the motor can give.",
}
#: The same on a roll that may slip on the belt.
_SLIPPING = (
    "Smooth only if slowed from above; from rest it keeps sticking, or oscillates while the drive slips."
)
#: The same of a belt at rest, which the drive does not start.
_NOT_STARTED = {
    "stall": "The drive slips and cannot start it from rest",
    "motor": "The motor cannot start it from rest",
}


#: Where the belts drawn do not agree.
_MAY_NOT_START = "The drive may be unable to start it from rest. If it starts:"


@dataclass(frozen=True)
class MapState(Record):
    """What happens at one temperature and drive speed; speeds in m/s, torque in N m.

    ``state`` is one of `STATES`: ``stall`` or ``motor`` where the drive does not start a belt at rest.
    ``torque`` is that of steady sliding, with which the drive must cope. ``slipping`` says that the roll
    slips for a part of the laps, ``extrapolated`` that no dwell of the fit lies that far out.
    """

    state: str
    moving: Annotated[str, Means("state once it moves")]
    torque: float
    holding: Annotated[float, Means("torque to start from rest")]
    starts: Annotated[bool, Means("whether it starts from rest")]
    doubtful: Annotated[bool, Means("whether the 95 % interval of holding allows the opposite")]
    lower: Annotated[float, OPEN]
    transition: float
    upper: Annotated[float, OPEN]
    stick_speed: Annotated[float, Means("at this temperature")]
    extrapolated: bool
    slipping: Annotated[bool, Means("whether the drive may slip for part of each cycle")] = False

    def verdict(self) -> str:
        """Return what the state means, in one sentence."""
        moving = _SLIPPING if self.slipping and self.moving == "bistable" else _VERDICTS[self.moving]
        if self.doubtful:
            return f"{_MAY_NOT_START} {moving}"
        if self.starts:
            return moving
        slides = self.moving in ("bistable", "smooth")
        return _NOT_STARTED[self.state] + ("; once sliding, it keeps sliding." if slides else ".")


#: Verdicts of a posterior of drives, in words.
_OF_DRAWS = {
    "smooth": "Smooth from any start.",
    "depends": "Smooth once it slides; may stick from rest.",
    "sticks": "Sticks from any start.",
    "not started": "The drive cannot start it.",
    "stalls": "Stalls: sliding needs more than the drive gives.",
    "too fast": "Faster than the drive can run.",
    "unknown": "Uncertain.",
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
    judged: Annotated[str, Means("verdict from the posterior of the edges")] = ""

    def verdict(self) -> str:
        """Return what happens there, in one sentence."""
        return _OF_DRAWS[self.judged] if self.judged else self.at.verdict()
