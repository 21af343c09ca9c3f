"""What is said of each operating point."""

from __future__ import annotations

import math

import numpy as np

from hersey.damping.surface import DampingSurface
from hersey.decision.behaviour import PointBehaviour
from hersey.decision.edges import Edges, edges_of
from hersey.decision.judge import Unjudged, Verdict
from hersey.machine.machine import Machine
from hersey.posterior import Posterior
from hersey.posterior.result import SAFE
from hersey.stability.operating_map import OperatingMap
from hersey.study.first_screen.reasons import in_words
from hersey.study.first_screen.result import PointDecisionPart, Signal, StartPart
from hersey.study.first_screen.words import between, mm, per_cent, starting, torque
from hersey.study.thinning import kept

#: Samples of a start that the page draws.
_SAMPLES = 600
#: The gravest last.
_ORDER: tuple[Signal, ...] = ("good", "watch", "act")


def worst(signals: list[Signal]) -> Signal:
    """Return the gravest signal; good where there is none."""
    return max(signals, key=_ORDER.index, default="good")


def point_decision(
    found: PointBehaviour, drawn: Posterior, map_: OperatingMap, unit: str, *, film_alone: bool
) -> PointDecisionPart:
    """Return what is said of an operating point; torques in a unit.

    Where no-load torque was not subtracted (not ``film_alone``) V* may be too low: nothing is good.
    """
    point, verdict = found.point, found.verdict
    kelvin = point.temperature if map_.drag.varies_with_temperature else None
    signal, words = _judged(found, verdict, edges_of(drawn, kelvin), map_, unit)
    if signal == "good" and not film_alone:
        signal, words = "watch", f"{words}, if all torque comes from the film"
    if map_.state_at(temperature=kelvin, speed=point.speed).extrapolated:
        signal, words = worst([signal, "watch"]), f"{words}; extrapolated"
    chances = verdict.probability
    return PointDecisionPart(
        name=point.name,
        speed=point.speed,
        temperature=point.temperature,
        signal=signal,
        words=words,
        verdict=verdict.kind,
        smooth=chances.smooth,
        from_above=chances.from_above,
        sticks=chances.sticks,
        disturbance=found.disturbance,
        steps=list(found.steps),
        plan=found.plan,
        motion=_motion(found),
        reason="; ".join(in_words(error) for error in found.errors),
    )


def unjudged(found: Unjudged) -> PointDecisionPart:
    """Return what is said of a point without a verdict."""
    return PointDecisionPart(
        name=found.point.name,
        speed=found.point.speed,
        temperature=found.point.temperature,
        signal="watch",
        words=f"not judged: {in_words(found.error)}",
    )


def points_of_log(surface: DampingSurface, machine: Machine, *, rises: bool) -> list[PointDecisionPart]:
    """Return what is said of the points where there is no map: only whether torque falls in the log."""
    out = []
    (slowest, fastest), heat = surface.speed_range, surface.temperature_range
    for point in machine.points:
        speed = point.speed / machine.roll_radius
        measured = slowest <= speed <= fastest
        measured &= heat is None or heat[0] - 1.0 <= point.temperature <= heat[1] + 1.0
        if not measured:
            words = "not judged: outside the measured range"
        elif rises:
            words = "keeps sliding once it slides; may stick from rest"
        else:
            words = "not judged: there is no map"
        out.append(
            PointDecisionPart(
                name=point.name,
                speed=point.speed,
                temperature=point.temperature,
                signal="watch",
                words=words,
            )
        )
    return out


def _judged(
    found: PointBehaviour, verdict: Verdict, edges: Edges, map_: OperatingMap, unit: str
) -> tuple[Signal, str]:
    chances, kind = verdict.probability, verdict.kind
    held = edges.holding
    needs = starting(held.low, held.value, held.high, edges.limit, map_.limited_by, unit)
    if kind == "too fast":
        return "act", f"exceeds the maximum speed of the drive, {mm(map_.speed_limit or math.nan)} mm/s"
    if kind == "not started":
        return "act", f"does not start: {needs}"
    if kind == "stalls":
        return "act", f"stalls: {_beyond(map_, found, unit)}"
    if kind == "sticks":
        turn = edges.transition
        if not edges.turns:
            return "act", "sticks from any start: drag falls at this speed"
        return (
            "act",
            f"sticks from any start: {between('drag is lowest at', turn.value, turn.low, turn.high)}",
        )
    if kind == "smooth":
        return "good", f"smooth from any start, {per_cent(chances.smooth)}"
    if chances.unknown > 1.0 - SAFE:
        return "watch", "cannot be judged: torque may still fall at the fastest dwell"
    if verdict.starts < 1.0 and edges.starts is None:
        return "watch", f"may not start: {needs}"
    return _with_plan(found, verdict)


def _with_plan(found: PointBehaviour, verdict: Verdict) -> tuple[Signal, str]:
    """What is said where the way to the point decides, or where that is not sure."""
    chances, plan = verdict.probability, found.plan
    sure = verdict.kind == "depends"
    chance = f"smooth from any start with {per_cent(chances.smooth)}" if chances.smooth >= 0.005 else ""
    if plan is not None and plan.found:
        words = "needs the start-up profile"
        return "watch", f"{words}; {chance}" if chance else words
    if plan is not None and any(each.limit == "target_speed" for each in plan.obstacles):
        return (
            "act",
            f"may stick: with {per_cent(chances.sticks)} probability it is below the speed of lowest drag",
        )
    if plan is not None:
        why = "may stick from rest, smooth once it slides" if sure else "may stick"
        return "act", f"{why}: no start-up profile within the limits works"
    return "watch", f"may stick from rest, smooth once it slides{f'; {chance}' if chance else ''}"


def _beyond(map_: OperatingMap, found: PointBehaviour, unit: str) -> str:
    kelvin = found.point.temperature if map_.drag.varies_with_temperature else None
    takes = map_.state_at(temperature=kelvin, speed=found.point.speed).torque
    gives = "the motor gives" if map_.limited_by == "motor torque" else "the roll grips"
    return f"sliding takes {torque(takes, unit)}, {gives} {torque(map_.torque_limit or math.nan, unit)}"


def _motion(found: PointBehaviour) -> StartPart | None:
    """The plan's motion, thinned so that its peaks stay, with the drive and the motion straight up."""
    plan = found.plan
    if plan is None or plan.response is None or plan.schedule is None or found.straight is None:
        return None
    run, straight = plan.response, found.straight
    thin = kept(run.belt_speed, _SAMPLES)
    time = run.time[thin]
    return StartPart(
        time=_short(plan.wait + time),
        drive_speed=_short(np.array([plan.schedule.at(plan.wait + t) for t in time.tolist()])),
        belt_speed=_short(run.belt_speed[thin]),
        straight=_short(np.interp(time, straight.time, straight.belt_speed)),
    )


def _short(values: np.ndarray) -> list[float]:
    return [float(f"{value:.5g}") for value in values.tolist()]
