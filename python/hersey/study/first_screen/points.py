"""What is said of each operating point."""

from __future__ import annotations

import math
from typing import NamedTuple

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
from hersey.study.first_screen.words import between, giving, mm, per_cent, starting, torque
from hersey.study.thinning import kept

#: Samples of a start that the page draws.
_SAMPLES = 600
#: The gravest last.
_ORDER: tuple[Signal, ...] = ("good", "watch", "act")


class _Said(NamedTuple):
    """What is said of a point: the verdict, its numbers and reason, and what qualifies it."""

    signal: Signal
    brief: str
    why: str = ""
    but: str = ""

    def qualified(self, but: str) -> _Said:
        """Return the same, which is no longer good, with a qualification."""
        return self._replace(signal=worst([self.signal, "watch"]), but=f"{self.but}{but}")


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
    said = _judged(found, verdict, edges_of(drawn, kelvin), map_, unit)
    if said.signal == "good" and not film_alone:
        said = said.qualified(", if all torque comes from the film")
    if map_.state_at(temperature=kelvin, speed=point.speed).extrapolated:
        said = said.qualified("; extrapolated")
    chances = verdict.probability
    return PointDecisionPart(
        name=point.name,
        speed=point.speed,
        temperature=point.temperature,
        signal=said.signal,
        words=f"{said.brief}{said.why}{said.but}",
        brief=f"{said.brief}{said.but}",
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


def _judged(found: PointBehaviour, verdict: Verdict, edges: Edges, map_: OperatingMap, unit: str) -> _Said:
    chances, kind = verdict.probability, verdict.kind
    held = edges.holding
    needs = starting(held.low, held.value, held.high, edges.limit, map_, unit)
    if kind == "too fast":
        limit = f"{mm(map_.speed_limit or math.nan)} mm/s"
        return _Said("act", f"exceeds the maximum speed of the drive, {limit}")
    if kind == "not started":
        return _Said("act", "does not start", f": {needs}")
    if kind == "stalls":
        return _Said("act", "stalls", f": {_beyond(map_, found, unit)}")
    if kind == "sticks":
        turn, why = edges.transition, "torque falls at this speed"
        if edges.turns:
            why = between("the transition is", turn.value, turn.low, turn.high)
        return _Said("act", "sticks from any start", f" ({per_cent(chances.sticks)}): {why}")
    if kind == "smooth":
        return _Said("good", "smooth from any start", f" (sticks: {per_cent(verdict.sticks_from_rest)})")
    if chances.unknown > 1.0 - SAFE:
        return _Said("watch", "cannot be judged", ": torque may still fall at the fastest dwell")
    if verdict.starts < SAFE:
        chance = f"may not start ({per_cent(1.0 - verdict.starts)})"
        return _Said("watch", f"{chance} or may stick ({per_cent(verdict.sticks_from_rest)})", f": {needs}")
    return _with_plan(found, verdict)


def _with_plan(found: PointBehaviour, verdict: Verdict) -> _Said:
    """What is said where the way to the point decides, or where that is not sure."""
    plan, sticks = found.plan, per_cent(verdict.sticks_from_rest)
    if plan is not None and plan.found:
        slides = per_cent(plan.share)
        why = f": sticks without it ({sticks}), slides with it ({slides})"
        return _Said("watch", "needs the start-up profile", why)
    if plan is not None and any(each.limit == "target_speed" for each in plan.obstacles):
        below = per_cent(verdict.probability.sticks)
        return _Said("act", "may stick", f": with {below} probability it is below the transition")
    once = ", smooth once it slides" if verdict.kind == "depends" else ""
    brief = f"{'sticks' if verdict.sticks_from_rest >= SAFE else 'may stick'} from rest ({sticks}){once}"
    if plan is None:
        return _Said("watch", brief)
    return _Said("act", brief, ": no start-up profile within the limits works")


def _beyond(map_: OperatingMap, found: PointBehaviour, unit: str) -> str:
    kelvin = found.point.temperature if map_.drag.varies_with_temperature else None
    takes = map_.state_at(temperature=kelvin, speed=found.point.speed).torque
    return (
        f"sliding takes {torque(takes, unit)}, {giving(map_)} {torque(map_.torque_limit or math.nan, unit)}"
    )


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
