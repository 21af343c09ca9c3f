"""What is said of each operating point."""

from __future__ import annotations

import math

import numpy as np

from hersey.damping.surface import DampingSurface
from hersey.document.decision.behaviour import PointBehaviour
from hersey.document.decision.edges import Edges, edges_of
from hersey.document.decision.words import between, mm, starting, torque
from hersey.document.parts.decision import PointDecisionPart, Signal, StartPart
from hersey.document.parts.stability import DisturbancePart, PlanPart, StepPart
from hersey.document.thinning import kept
from hersey.machine.machine import Machine
from hersey.result import json_record
from hersey.stability.operating_map import OperatingMap
from hersey.stability.operating_map.state import MapState

#: Samples of a start that the page draws.
_SAMPLES = 600
#: The gravest last.
_ORDER: tuple[Signal, ...] = ("good", "watch", "act")


def worst(signals: list[Signal]) -> Signal:
    """Return the gravest signal; good where there is none."""
    return max(signals, key=_ORDER.index, default="good")


def point_decision(
    found: PointBehaviour, map_: OperatingMap, unit: str, *, film_alone: bool
) -> PointDecisionPart:
    """Return what is said of an operating point; torques in a unit.

    Where torque holds more than that of the film (not ``film_alone``) V* is too low: nothing is good.
    """
    point = found.point
    kelvin = point.temperature if map_.drag.varies_with_temperature else None
    state, edges = map_.state_at(kelvin, point.speed), edges_of(map_, kelvin)
    signal, words = _judged(found, state, edges, map_, unit)
    if signal == "good" and not film_alone:
        signal, words = "watch", f"{words}, if the torque is of the film alone"
    if state.extrapolated:
        signal, words = worst([signal, "watch"]), f"{words}; extrapolated"
    bears, plan = found.disturbance, found.plan
    return PointDecisionPart(
        name=point.name,
        speed=point.speed,
        temperature=point.temperature,
        signal=signal,
        words=words,
        disturbance=None if bears is None else DisturbancePart(**json_record(vars(bears))),
        steps=[StepPart(**json_record(vars(step))) for step in found.steps],
        plan=None if plan is None else PlanPart(**plan.to_dict()),
        motion=_motion(found),
        reason=found.reason,
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
            words = "not judged: no dwell lies that far out"
        elif rises:
            words = "slides on once it slides; from rest it may stick"
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
    found: PointBehaviour, state: MapState, edges: Edges, map_: OperatingMap, unit: str
) -> tuple[Signal, str]:
    speed, fold, turn = found.point.speed, edges.fold, edges.transition
    transition = between("the transition is", turn.value, turn.low, turn.high)
    upper = between("V* is", fold.value, fold.low, fold.high)
    held = edges.holding
    needs = starting(held.low, held.value, held.high, edges.limit, map_.limited_by, unit)
    if map_.speed_limit is not None and speed > map_.speed_limit:
        return "act", f"faster than the drive, {mm(map_.speed_limit)} mm/s"
    if edges.starts is False:
        return "act", f"not started: {needs}"
    if state.torque > edges.limit:
        return "act", f"stalls: {_beyond(map_, state.torque, unit)}"
    if speed < state.transition:
        return "act", f"sticks from any start: {transition}"
    if edges.starts is None:
        if speed >= edges.safe:
            return "watch", f"smooth once it slides, but may not start: {needs}"
        return "watch", f"may not start: {needs}; {upper}"
    if state.state == "smooth":
        if speed >= edges.safe and found.stiction is not None and speed < found.stiction:
            return (
                "watch",
                f"smooth unless the belt stops dead: V* is {mm(found.stiction)} mm/s then",
            )
        if speed >= edges.safe:
            return "good", "smooth from any start"
        return "watch", f"smooth by the estimate; {upper}"
    doubt = f"; {transition}" if speed < turn.high else ""
    if found.plan is None:
        return "watch", f"depends: only from above{doubt}"
    if not found.plan.found and any(each.limit == "target_speed" for each in found.plan.obstacles):
        return "act", f"may stick: no plan, for it may lie below the transition; {transition}"
    if not found.plan.found:
        return "act", f"depends: only from above, and no start within the limits gets there{doubt}"
    way = "only from above" if found.plan.kind == "overshoot" else "only if it starts gently"
    return "watch", f"depends: {way} (plan){doubt}"


def _beyond(map_: OperatingMap, takes: float, unit: str) -> str:
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
