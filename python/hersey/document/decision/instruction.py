"""The one sentence of the first screen, its interval, and what happens otherwise."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hersey.damping.surface import DampingSurface
from hersey.document.decision.behaviour import Behaviour, PointBehaviour
from hersey.document.decision.edges import Edge, Edges, edges_of
from hersey.document.decision.words import (
    at,
    between,
    degrees,
    figures,
    mm,
    roll,
    signed,
    starting,
    torque,
    within,
)
from hersey.document.parts import RegimePart
from hersey.document.parts.decision import Signal
from hersey.stability.operating_map import OperatingMap

#: Temperatures that are alike, K.
_ALIKE = 0.5
#: Scatter of dwells about one law, from which it cannot be counted on.
_FAR_OFF = 0.1
#: Starts that are named in one sentence.
_NAMED = 2
#: p-value of one exponent over all speeds, below which it does not hold.
_SURE = 0.05


@dataclass(frozen=True)
class Instruction:
    """The decision in words."""

    signal: Signal
    instruction: str
    interval: str
    otherwise: str


def of_machine(found: Behaviour, map_: OperatingMap, unit: str) -> Instruction:
    """Return what to do with a machine whose band is known; torques in a unit."""
    kelvin = found.temperature
    edges = edges_of(map_, kelvin)
    where, fold, turn = at(kelvin), edges.fold, edges.transition
    if edges.starts is False:
        return _not_started(where, kelvin, edges, map_, unit)
    interval = _interval("V* is", fold) if edges.bistable else _interval("the transition is", turn)
    starts = _starts(found, kelvin, map_)
    if not math.isfinite(edges.safe):
        lead = _lead(where, "measure the stick speed before you count on a start from rest")
        return Instruction("watch", lead, interval, _otherwise(edges, starts))
    if edges.safe > edges.greatest:
        return _out_of_reach(found, where, edges, interval, _otherwise(edges, starts))
    run = f"run above {_up(edges.safe)} mm/s"
    if edges.starts is None:
        text = _lead(where, f"{run}, and make sure that it starts: {_starting(edges, map_, unit)}")
        return Instruction("watch", text, interval, _otherwise(edges, starts))
    return Instruction("good", _lead(where, run), interval, _otherwise(edges, starts))


def _out_of_reach(found: Behaviour, where: str, edges: Edges, interval: str, otherwise: str) -> Instruction:
    """What to do where no speed that the drive reaches is surely smooth."""
    most = f"{mm(edges.greatest)} mm/s"
    if any(each.plan is not None and each.plan.found for each in found.points):
        what = f"start as the plan says: no speed up to {most}, all that the drive gives, is surely smooth"
        return Instruction("watch", _lead(where, what), interval, otherwise)
    what = f"give the drive {_up(edges.safe)} mm/s: up to its {most} no speed is surely smooth"
    more = "" if found.points else " State your speeds as [[points]] for a plan that starts them."
    return Instruction("act", _lead(where, what), interval, f"{otherwise}{more}")


def of_log(surface: DampingSurface, seen: RegimePart) -> Instruction:
    """Return what the log alone tells, in speeds of the roll."""
    if surface.transition is None:
        return _one_branch(surface, seen)
    ends = [None] if surface.b is None or surface.temperature_range is None else [*surface.temperature_range]
    kelvin = max(ends, key=surface.transition_speed)
    found = surface.transition_estimate(kelvin)
    lead = at(kelvin)
    slower = "Below it torque rises as the drive slows, and the drive can stick and slip"
    if not found.told:
        text = _lead(lead, f"keep the roll well above {roll(found.value)} rpm")
        interval = f"torque is least at {roll(found.value)} rpm, interval not told"
        return Instruction("watch", text, interval, f"{slower}.")
    factor = 60.0 / math.tau
    value, low, high = found.value, found.low, found.high
    text = _lead(lead, f"keep the roll above {figures(high * factor, up=True)} rpm")
    interval = f"torque is least at {roll(value)} {within(low, high, factor)} rpm"
    return Instruction(
        "watch", text, interval, f"{slower}; how far above it that lasts, only the machine tells."
    )


def _one_branch(surface: DampingSurface, seen: RegimePart) -> Instruction:
    """What a log says that shows no transition: nothing sticks, or torque falls all the way."""
    low, high = (roll(speed) for speed in surface.speed_range)
    c = surface.c
    interval = f"exponent of damping {signed(c.value)}"
    interval += f" [{signed(c.low)}, {signed(c.high)}]" if c.told else ", interval not told"
    if c.told and c.high < -1.0:
        measured = f"over all that was measured, {low} to {high} rpm"
        return Instruction(
            "watch",
            f"Measure faster dwells: torque falls as speed rises, {measured}",
            interval,
            "Where torque falls with speed the drive can stick and slip; where it ends to fall is not known.",
        )
    slow = _local(seen)
    if slow is not None and slow < -1.0:
        return Instruction(
            "watch",
            f"Keep the roll well above {low} rpm: there torque falls as speed rises",
            f"exponent of damping {signed(slow)} at the slow end, {signed(c.value)} over all",
            "Where torque falls with speed the drive can stick and slip; no transition is told.",
        )
    if doubt := doubt_of(surface, seen):
        what = f"Measure dwells slower than {low} rpm"
        if surface.b is None and surface.statistics.scatter > _FAR_OFF:
            what = "Fit with temperature, or record it"
        elif not (c.told and c.low > -1.0):
            what = f"Record dwells slower than {low} and faster than {high} rpm"
        return Instruction(
            "watch", f"{what}: {doubt}", interval, "Whether torque falls anywhere is not told: it may stick."
        )
    return Instruction(
        "watch",
        f"Measure dwells slower than {low} rpm: down to there torque rises with speed",
        interval,
        f"A belt that slides already goes on sliding down to {low} rpm. From rest it may stick: "
        "where torque falls is not known.",
    )


def doubt_of(surface: DampingSurface, seen: RegimePart) -> str:
    """Return why one rising law may not hold down to the slowest dwell; nothing where it does."""
    lack, scatter = seen.lack_of_fit, surface.statistics.scatter
    if scatter > _FAR_OFF:
        return f"dwells stand {100 * scatter:.0f} % off one law"
    if lack is None:
        return "too few speeds tell whether one law holds"
    tested = (lack.curvature, lack.exponent_with_temperature, lack.temperature)
    if any(p is not None and p < _SURE for p in tested):
        return "one law does not hold over all dwells"
    if not (surface.c.told and surface.c.low > -1.0):
        return "whether torque rises with speed is not told"
    return ""


def _local(seen: RegimePart) -> float | None:
    """The exponent at the slow end, where one exponent does not hold over all speeds."""
    lack = seen.lack_of_fit
    if lack is None or lack.curvature is None or lack.curvature > _SURE:
        return None
    return lack.local_exponents[0]


def _not_started(
    where: str, kelvin: float | None, edges: Edges, map_: OperatingMap, unit: str
) -> Instruction:
    needed, limit = torque(edges.holding.high, unit, up=True), torque(edges.limit, unit)
    if map_.limited_by == "motor torque":
        what = f"give the roll more than {needed}: the motor's {limit} do not start a belt at rest"
    else:
        what = f"let the roll grip more than {needed}: at {limit} it slips on a belt at rest"
    turn = figures(1e3 * edges.transition.high, up=True)
    takes = map_.state_at(kelvin, edges.transition.high).torque
    if takes <= edges.limit:
        otherwise = f"A belt that slides already goes on sliding above {turn} mm/s."
    else:
        otherwise = f"It does not slide on either: sliding takes {torque(takes, unit)} at {turn} mm/s."
    return Instruction("act", _lead(where, what), _starting(edges, map_, unit), otherwise)


def _starting(edges: Edges, map_: OperatingMap, unit: str) -> str:
    held = edges.holding
    return starting(held.low, held.value, held.high, edges.limit, map_.limited_by, unit)


def _otherwise(edges: Edges, starts: str) -> str:
    turn = figures(1e3 * edges.transition.low, up=False)
    sticks = f"Below {turn} mm/s it sticks."
    if not edges.bistable:
        return f"{sticks} The way there does not matter."
    upper = f"{turn} and {_up(edges.safe)} mm/s" if math.isfinite(edges.safe) else ""
    between = f"Between {upper}" if upper else f"Above {turn} mm/s"
    return f"{between} it may depend on how you get there{starts}. {sticks}"


def _starts(found: Behaviour, kelvin: float | None, map_: OperatingMap) -> str:
    """How the plans start the points that need one."""
    said = list(dict.fromkeys(text for each in found.points if (text := _start(each, kelvin, map_))))
    more = f"; and {len(said) - _NAMED} more" if len(said) > _NAMED else ""
    return f": {'; '.join(said[:_NAMED])}{more}" if said else ""


def _start(found: PointBehaviour, kelvin: float | None, map_: OperatingMap) -> str:
    plan, point = found.plan, found.point
    if plan is None:
        return ""
    apart = kelvin is not None and abs(point.temperature - kelvin) > _ALIKE
    goal = f"{mm(point.speed)} mm/s" + (f" at {degrees(point.temperature)}" if apart else "")
    if plan.kind == "overshoot":
        slowly = f" in {figures(plan.rise)} s" if plan.rise else ""
        return f"for {goal} overshoot to {mm(plan.peak_speed)} mm/s{slowly} first (plan)"
    if plan.kind == "direct":
        return f"for {goal} come straight up in {figures(plan.rise)} s (plan)" if plan.rise else ""
    if any(each.limit == "target_speed" for each in plan.obstacles):
        return f"{goal} may lie below the transition"
    if start_unsure(found, map_):
        return f"for {goal} no start is sure: the belt may not break loose"
    return f"for {goal} no start within the limits works"


def start_unsure(found: PointBehaviour, map_: OperatingMap) -> bool:
    """Return whether the drive may or may not start the belt at a point, so that no plan is sure of it."""
    kelvin = found.point.temperature if map_.drag.varies_with_temperature else None
    return edges_of(map_, kelvin).starts is None


def _interval(what: str, edge: Edge) -> str:
    if edge.told:
        return between(what, edge.value, edge.low, edge.high)
    least = figures(1e3 * edge.low, up=False)
    value = f"{mm(edge.value)} mm/s" if math.isfinite(edge.value) else "not found"
    return f"{what} {value}, at least {least}; its upper end is not told"


def _lead(where: str, what: str) -> str:
    return f"{where}{what}" if where else f"{what[0].upper()}{what[1:]}"


def _up(speed: float) -> str:
    return figures(1e3 * speed, up=True)
