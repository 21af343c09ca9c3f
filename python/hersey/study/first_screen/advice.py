"""The next measurement in words: what to do, and what it would bring."""

from __future__ import annotations

from collections.abc import Sequence

from hersey.decision.behaviour import Behaviour
from hersey.decision.edges import Edge
from hersey.decision.measurement import WORTH, Measurement
from hersey.posterior import Posterior
from hersey.study.first_screen.result import DesignPart, MeasurementPart
from hersey.study.first_screen.words import at, between, listed, mm


def advised(found: Behaviour) -> MeasurementPart | None:
    """Return the measurement that narrows V* most; None where V* is known well enough."""
    return None if found.measurement is None else _part(found.measurement)


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
        lines.append(f"  {number}. {_capital(_action(each))}: {gain}.")
    return lines


def _action(best: Measurement) -> str:
    where = f" {at(best.temperature, first=False)}".rstrip()
    speeds = listed([mm(speed) for speed in best.speeds]) if best.speeds else ""
    return {
        "starts": f"start from rest{where} at {speeds} mm/s and record the torque",
        "break-away": f"record the torque that starts the belt from rest{where}",
        "stick-slip": f"record 20 s of stick-slip{where} at {speeds} mm/s",
        "dwell": f"hold one dwell{where} at {speeds} mm/s",
    }[best.kind]


def _within(best: Measurement) -> str:
    share = 100.0 * (best.factor**0.5 - 1.0)
    return f"within about {max(share, 1.0):.0f} %"


def _capital(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}"
