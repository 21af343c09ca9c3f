"""What a recording shows beyond its dwells, each at one temperature (K) and drive speed (m/s at the belt).

All forces are those of the spring at the belt, N, no-load torque included: torque over roll radius.
"""

from __future__ import annotations

from dataclasses import dataclass

from hersey.units import takes_si


@dataclass(frozen=True)
class CycleFigures:
    """Figures of recorded stick-slip, each with its relative standard error: value, error."""

    period: tuple[float, float]  #: s
    pull_max: tuple[float, float]  #: N
    drop: tuple[float, float]  #: N, from the greatest to the least pull
    slope: tuple[float, float] | None  #: N/s while the belt is held


@takes_si(temperature="temperature", drive_speed="belt speed", duration="time")
@dataclass(frozen=True)
class StickSlip:
    """A stretch that stuck and slipped; ``figures`` are None where sampling does not resolve the cycle."""

    temperature: float | None
    drive_speed: float
    duration: float  #: s
    figures: CycleFigures | None = None
    source: str = ""


@takes_si(temperature="temperature", drive_speed="belt speed", rise="time")
@dataclass(frozen=True)
class Start:
    """A start from rest that ended in sliding, or in stick-slip (``slid`` is False).

    ``peak`` is the greatest force before the first motion with its relative standard error; None if it was
    not resolved.
    """

    temperature: float | None
    drive_speed: float
    slid: bool
    rise: float = 0.0  #: s in which the drive came up to its speed
    peak: tuple[float, float] | None = None
    source: str = ""


@takes_si(temperature="temperature", force="force")
@dataclass(frozen=True)
class BreakAway:
    """A stated or measured force that starts a belt at rest, with its relative standard error."""

    temperature: float | None
    force: float
    error: float
    source: str = ""


Evidence = StickSlip | Start | BreakAway
