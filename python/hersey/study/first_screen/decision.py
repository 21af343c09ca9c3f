"""The first screen: instruction, points, flags and what is missing, from all that is known."""

from __future__ import annotations

import math
from typing import Any

from hersey.damping.candidates.observations import Observations
from hersey.damping.trend import trend_of
from hersey.decision.behaviour import Behaviour
from hersey.decision.edges import edges_of
from hersey.decision.plausibility import asked
from hersey.study.findings import Findings
from hersey.study.first_screen.advice import advised, next_step
from hersey.study.first_screen.flags import few_slow_dwells, flags
from hersey.study.first_screen.friction import of_friction
from hersey.study.first_screen.instruction import of_log, of_machine
from hersey.study.first_screen.missing import missing
from hersey.study.first_screen.points import point_decision, points_of_log, unjudged, worst
from hersey.study.first_screen.questions import unanswered
from hersey.study.first_screen.result import DecisionPart, PointDecisionPart, Signal


def decision(known: Findings) -> DecisionPart:
    """Return what to do, why, and what stands against it."""
    points, surface, machine, map_ = known.points, known.surface, known.machine, known.map
    question = asked(points, surface, machine)
    if question is not None:
        return unanswered(question, known)
    trend = trend_of(Observations.of(points))
    if not points.domain.is_torque:
        said = of_friction(known, trend)
    elif known.behaviour is None or map_ is None:
        said = of_log(known, trend)
    else:
        few = few_slow_dwells(points, surface)
        said = of_machine(known.behaviour, map_, known.units["torque"], few=few)
    of_points = _of_points(known, rises=trend.rises and not trend.falls)
    against = flags(known)
    signals: list[Signal] = [said.signal, *(point.signal for point in of_points)]
    signals += [
        "good" if flag.severity == "note" else flag.severity
        for flag in against
        if flag.severity == "act" or flag.where == "compare"
    ]
    if (
        map_ is not None
        and known.behaviour is not None
        and (points.rest is None or not known.behaviour.points)
    ):
        signals.append("watch")  # torque of more than the film draws V* down; or nothing is asked for
    return DecisionPart(
        signal=worst(signals),
        instruction=said.instruction,
        interval=said.interval,
        otherwise=said.otherwise,
        **_speeds(known.behaviour),
        next="" if known.behaviour is None or map_ is None else next_step(known.behaviour, of_points),
        points=of_points,
        flags=against,
        missing=missing(known),
    )


def _of_points(known: Findings, *, rises: bool) -> list[PointDecisionPart]:
    """What is said of each operating point."""
    found, map_ = known.behaviour, known.map
    if found is not None and map_ is not None:
        alone, unit = known.points.rest is not None, known.units["torque"]
        drawn = found.posterior
        judged = [point_decision(each, drawn, map_, unit, film_alone=alone) for each in found.points]
        return judged + [unjudged(point) for point in found.unjudged]
    return [] if known.machine is None else points_of_log(known.surface, known.machine, rises=rises)


def _speeds(found: Behaviour | None) -> dict[str, Any]:
    """Safe speed, V*, closures and the next measurement, as fields of the document."""
    if found is None or found.map is None:
        return {}
    edges = edges_of(found.posterior, found.temperature)
    fold = edges.fold
    return {
        "temperature": found.temperature,
        "safe_speed": edges.safe if math.isfinite(edges.safe) else None,
        "fold": fold if fold.estimable else None,
        "closures": found.posterior.closures(),
        "measurement": advised(found),
    }
