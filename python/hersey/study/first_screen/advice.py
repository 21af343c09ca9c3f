"""The next measurement in words: what to do, and what it would bring."""

from __future__ import annotations

import math
from collections.abc import Sequence

from hersey.decision.behaviour import Behaviour
from hersey.decision.edges import Edge, Edges, edges_of
from hersey.decision.measurement import NARROW, WORTH, Measurement
from hersey.errors import capital
from hersey.posterior import Posterior
from hersey.study.first_screen.result import DesignPart, MeasurementPart, PointDecisionPart
from hersey.study.first_screen.words import at, between, figures, listed, mm

#: Ratio of the ends of V* up to which it counts as known: `NARROW`, and what few draws leave unsure of it.
_KNOWN = 1.1 * NARROW


def advised(found: Behaviour) -> MeasurementPart | None:
    """Return the measurement that narrows V* most; None where V* is known well enough."""
    return None if found.measurement is None else _part(found.measurement)


def next_step(found: Behaviour, points: Sequence[PointDecisionPart]) -> str:
    """Return what to do next: the measurement that narrows V* most, else what the operating points need.

    Empty where the instruction itself says it: torque may still fall at the fastest dwell, or nothing starts.
    """
    edges = edges_of(found.posterior, found.temperature)
    if found.measurement is not None:
        return _part(found.measurement).text
    if not edges.turns or edges.starts is False:
        return ""
    done = "No single measurement would narrow V* much."
    if (ratio := _ratio(edges.fold)) <= _KNOWN:
        done = f"V* is known {_within_ratio(ratio)}."
    todo = _of_points(edges, points)
    return f"Next: {todo}. {done}" if todo else done


def _of_points(edges: Edges, points: Sequence[PointDecisionPart]) -> str:
    """What the operating points need, the gravest first; empty if nothing."""
    if edges.starts is None:
        return "record the torque that starts it from rest, since the drive may not start it"
    if not points:
        return "add your operating points to the machine file"
    slow = [p.name for p in points if p.verdict in ("sticks", "depends", "unknown") and p.signal == "act"]
    if slow and edges.safe <= edges.greatest and math.isfinite(edges.safe):
        return f"run {listed(slow)} above {figures(1e3 * edges.safe, up=True)} mm/s"
    if beyond := [p.name for p in points if p.signal == "act"]:
        return f"change the speed of {listed(beyond)}, or the limits of the drive"
    planned = [p.name for p in points if p.signal != "good" and p.plan is not None and p.plan.found]
    if planned:
        profile = "its start-up profile" if len(planned) == 1 else "their start-up profiles"
        return f"start {listed(planned)} with {profile}, and check that it slides"
    return ""


def _ratio(fold: Edge) -> float:
    return fold.high / fold.low if fold.low > 0.0 else math.inf


def _part(measurement: Measurement) -> MeasurementPart:
    return MeasurementPart(
        kind=measurement.kind,
        text=f"Measure next: {_action(measurement)}. V* would then be known {_within(measurement)}",
        temperature=measurement.temperature,
        speeds=list(measurement.speeds),
        left=measurement.left,
    )


def design_part(found: Posterior, ranked: Sequence[Measurement]) -> DesignPart:
    """Return what would narrow V*, the most useful measurement first."""
    value, low, high = found.fold_interval(found.temperature)
    return DesignPart(
        quantity="V*",
        unit="m/s",
        error_now=None,
        points=[],
        law=max(found.laws, key=lambda law: law.weight).words,
        seed=found.seed,
        fold=Edge(value=value, low=low, high=high),
        measurements=[_part(each) for each in ranked],
    )


def ranking(found: Posterior, ranked: Sequence[Measurement]) -> list[str]:
    """Return what would narrow V*, the most useful measurement first, as lines."""
    value, low, high = found.fold_interval(found.temperature)
    lines = [f"{at(found.temperature)}{between('V* is', value, low, high)}."]
    if not ranked:
        return [*lines, "No measurement would make the interval much narrower."]
    lines.append("These measurements would narrow it most:")
    for number, each in enumerate(ranked, 1):
        gain = _within(each) if each.left <= WORTH else "hardly narrower"
        lines.append(f"  {number}. {capital(_action(each))}: {gain}.")
    return lines


def _action(best: Measurement) -> str:
    where = f" {at(best.temperature, first=False)}".rstrip()
    speeds = listed([mm(speed) for speed in best.speeds]) if best.speeds else ""
    return {
        "starts": f"start from rest{where} at {speeds} mm/s and record the torque",
        "break-away": f"record the torque that starts it from rest{where}",
        "stick-slip": f"record 20 s of stick-slip{where} at {speeds} mm/s",
        "dwell": f"hold one dwell{where} at {speeds} mm/s",
    }[best.kind]


def _within(best: Measurement) -> str:
    return _within_ratio(best.factor)


def _within_ratio(ratio: float) -> str:
    """Half the width of an interval whose ends have a ratio, in per cent."""
    return f"within about {max(100.0 * (ratio**0.5 - 1.0), 1.0):.0f} %"
