"""The next measurement in words: what to do, and what it would bring."""

from __future__ import annotations

from hersey.decision.measurement import Measurement
from hersey.document.decision.behaviour import Behaviour
from hersey.document.decision.words import at, listed, mm
from hersey.document.parts.decision import MeasurementPart


def advised(found: Behaviour) -> MeasurementPart | None:
    """Return the measurement that narrows V* most; None where V* is known well enough."""
    best = found.measurement
    if best is None:
        return None
    return MeasurementPart(
        kind=best.kind,
        text=f"{_action(best)}. {_gain(best)}",
        temperature=best.temperature,
        speeds=list(best.speeds),
        left=best.left,
    )


def _action(best: Measurement) -> str:
    where = f" {at(best.temperature, first=False)}".rstrip()
    speeds = listed([mm(speed) for speed in best.speeds]) if best.speeds else ""
    return {
        "starts": f"Measure next: start from rest{where} at {speeds} mm/s and record the torque",
        "break-away": f"Measure next: record the torque that starts the belt from rest{where}",
        "stick-slip": f"Measure next: record 20 s of stick-slip{where} at {speeds} mm/s",
        "dwell": f"Measure next: hold one dwell{where} at {speeds} mm/s",
    }[best.kind]


def _gain(best: Measurement) -> str:
    share = 100.0 * (best.factor**0.5 - 1.0)
    return f"V* would then be known within about {max(share, 1.0):.0f} %"
