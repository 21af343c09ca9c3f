"""The first screen: instruction, points, flags and what is missing, from all that is known."""

from __future__ import annotations

import math
from typing import Any

from hersey.damping.candidates.observations import Observations
from hersey.damping.compare import LogComparison
from hersey.damping.dwells import SteadyPoints
from hersey.damping.surface import DampingSurface
from hersey.damping.trend import trend_of
from hersey.decision.behaviour import Behaviour
from hersey.decision.edges import edges_of
from hersey.decision.plausibility import asked
from hersey.machine.machine import Machine
from hersey.study.first_screen.advice import advised
from hersey.study.first_screen.flags import flags
from hersey.study.first_screen.instruction import of_log, of_machine
from hersey.study.first_screen.missing import missing
from hersey.study.first_screen.points import point_decision, points_of_log, unjudged, worst
from hersey.study.first_screen.questions import unanswered
from hersey.study.first_screen.result import DecisionPart, Signal
from hersey.study.nip_film import FilmPart
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.regime import Regime


def decision(
    points: SteadyPoints,
    surface: DampingSurface,
    machine: Machine | None,
    *,
    seen: Regime,
    film: FilmPart | None,
    torque_budget: TorqueBudgetPart | None,
    found: Behaviour | None,
    compared: LogComparison | None = None,
    why: str = "",
    machine_file: str = "",
    unit: str = "N·m",
) -> DecisionPart:
    """Return what to do, why, and what stands against it.

    ``found`` is None without a machine, or where nothing can be computed, for the reason ``why``;
    ``compared`` is this log over an earlier one, ``unit`` that of torques in words.
    """
    map_ = None if found is None else found.map
    trend = trend_of(Observations.of(points))
    question = asked(points, surface, machine)
    if question is not None:
        return unanswered(question, points, surface, machine, machine_file)
    said = of_log(surface, trend) if found is None or map_ is None else of_machine(found, map_, unit)
    if found is not None and map_ is not None:
        film_alone = points.rest is not None
        of_points = [
            point_decision(each, found.posterior, map_, unit, film_alone=film_alone) for each in found.points
        ]
        of_points += [unjudged(point) for point in found.unjudged]
    elif machine is not None:
        of_points = points_of_log(surface, machine, rises=trend.rises and not trend.falls)
    else:
        of_points = []
    against = flags(points, surface, seen, film, torque_budget, found, why, compared, unit)
    signals: list[Signal] = [said.signal, *(point.signal for point in of_points)]
    signals += [flag.signal for flag in against if flag.signal == "act" or flag.section == "compare"]
    if found is not None and map_ is not None and (points.rest is None or not found.points):
        signals.append("watch")  # torque of more than the film draws V* down; or nothing is asked for
    return DecisionPart(
        signal=worst(signals),
        instruction=said.instruction,
        interval=said.interval,
        otherwise=said.otherwise,
        **_speeds(found),
        points=of_points,
        flags=against,
        missing=missing(points, surface, machine, machine_file),
    )


def _speeds(found: Behaviour | None) -> dict[str, Any]:
    """Safe speed, V*, closures and the next measurement, as fields of the document."""
    if found is None or found.map is None:
        return {}
    edges = edges_of(found.posterior, found.temperature)
    fold = edges.fold
    return {
        "temperature": found.temperature,
        "safe_speed": edges.safe if math.isfinite(edges.safe) else None,
        "fold": fold if fold.told else None,
        "closures": found.posterior.closures(),
        "measurement": advised(found),
    }
