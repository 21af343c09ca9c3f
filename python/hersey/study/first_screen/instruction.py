"""The one sentence of the first screen, its interval, and what happens otherwise."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hersey.damping.dwells import groups_of_temperature
from hersey.damping.estimate import Estimate
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.friction_curve.words import directions_of, slowing_of
from hersey.damping.trend import Trend
from hersey.decision.behaviour import Behaviour, PointBehaviour
from hersey.decision.edges import Edge, Edges, edges_of
from hersey.errors import capital
from hersey.posterior.result import SAFE
from hersey.schema.noun import Noun, puller_of
from hersey.stability.operating_map import OperatingMap
from hersey.study.findings import Findings
from hersey.study.first_screen.result import Signal
from hersey.study.first_screen.words import (
    MINUS,
    at,
    between,
    degrees,
    figures,
    listed,
    mm,
    per_cent_of,
    roll,
    starting,
    torque,
    within,
)
from hersey.verdict.regimes import FALLING, named_in_words, neighbours

#: Signals, the gravest last.
_ORDER: tuple[Signal, ...] = ("good", "watch", "act")


class Words(NamedTuple):
    """What is said of one speed, and of several."""

    one: str
    several: str


_SLIDES_ON = Words(
    "may stick from rest, and is smooth once it slides",
    "may stick from rest, and are smooth once they slide",
)
_SLIDES_ON_ONLY = Words(
    "sticks from rest, and is smooth once it slides",
    "stick from rest, and are smooth once they slide",
)
_NOT_KNOWN = Words(
    "cannot be judged: torque may still fall at the fastest dwell",
    "cannot be judged: torque may still fall at the fastest dwell",
)
_NOT_STARTED = Words("may not start", "may not start")
_NOT_STARTED_OR_STICKS = Words("may not start, or may stick", "may not start, or may stick")
_OF_KIND: Mapping[str, tuple[Words, Signal]] = {
    "smooth": (Words("runs smoothly", "run smoothly"), "good"),
    "unknown": (Words("may stick", "may stick"), "watch"),
    "sticks": (Words("sticks from any start", "stick from any start"), "act"),
    "not started": (Words("does not start", "do not start"), "act"),
    "stalls": (Words("stalls", "stall"), "act"),
    "too fast": (Words("is faster than the drive", "are faster than the drive"), "act"),
}


@dataclass(frozen=True)
class Instruction:
    """The decision in words."""

    signal: Signal
    instruction: str
    interval: str
    otherwise: str


def of_machine(found: Behaviour, map_: OperatingMap, unit: str, *, few: bool = False) -> Instruction:
    """Return what to do with a machine whose drives were drawn; torques in a unit.

    ``few`` says that too few slow dwells were recorded, so that one instruction asks for all that is missing.
    """
    kelvin = found.temperature
    edges = edges_of(found.posterior, kelvin)
    where, fold, turn = at(kelvin), edges.fold, edges.transition
    if edges.starts is False:
        return _not_started(where, kelvin, edges, map_, unit)
    if not edges.turns:
        interval = f"{where}V* is not known: torque may still fall at the fastest dwell"
        interval += f". Record faster {'and slower ' if few else ''}dwells" if found.points else ""
    elif edges.bistable:
        here = "" if kelvin is None else f" at {degrees(kelvin)}"
        interval = _interval(f"V*, above which stick-slip cannot last{here}, is", fold)
    else:
        interval = _interval(f"{where}torque is lowest, at the transition, at", turn)
    said, signal = _of_points(found)
    general, of_general = _general(edges, map_, unit, few=few)
    if not said:
        return Instruction(
            of_general, f"{where}{general}" if where else capital(general), interval, _below(edges)
        )
    otherwise = f"{capital(_slides(edges, map_.train.part))}{_below(edges)}"
    return Instruction(signal, said, interval, otherwise)


def _of_points(found: Behaviour) -> tuple[str, Signal]:
    """One sentence for each verdict on the user's points, and the gravest signal of them."""
    grouped: dict[Words, list[str]] = {}
    signals: list[Signal] = []
    levels = {point.point.temperature for point in found.points}
    for each in found.points:
        words, signal = _verdict_words(each)
        where = f" at {degrees(each.point.temperature)}" if len(levels) > 1 else ""
        grouped.setdefault(words, []).append(f"{mm(each.point.speed)} mm/s{where}")
        signals.append(signal)
    sentences = [
        f"{listed(speeds)} {words.one if len(speeds) == 1 else words.several}"
        for words, speeds in grouped.items()
    ]
    return ". ".join(sentences), max(signals, key=_ORDER.index, default="good")


def _verdict_words(found: PointBehaviour) -> tuple[Words, Signal]:
    """What happens at a point, and its signal."""
    kind, plan = found.verdict.kind, found.plan
    planned = plan is not None and plan.found
    if kind == "unknown" and found.verdict.probability.unknown > 1.0 - SAFE:
        return _NOT_KNOWN, "watch"
    if kind == "unknown" and found.verdict.starts < SAFE:  # which no profile changes
        sticks = found.verdict.sticks_from_rest > 1.0 - SAFE
        return _NOT_STARTED_OR_STICKS if sticks else _NOT_STARTED, "watch"
    if kind == "depends" and not planned:
        return _SLIDES_ON_ONLY if found.verdict.sticks_from_rest >= SAFE else _SLIDES_ON, "act"
    if kind in ("depends", "unknown") and planned:
        return Words("needs the start-up profile", "need the start-up profile"), "watch"
    return _OF_KIND[kind]


def _general(edges: Edges, map_: OperatingMap, unit: str, *, few: bool) -> tuple[str, Signal]:
    """What to do without operating points; ``few``: slower dwells are needed, too."""
    if not math.isfinite(edges.safe):
        if not edges.turns:
            return (
                "record faster and slower dwells: torque may still fall at the fastest, so V* is not known"
                if few
                else "record faster dwells: torque may still fall at the fastest, so V* is not known",
                "watch",
            )
        return "do not rely on a start from rest: no speed is known to be smooth", "watch"
    run = f"run above {_up(edges.safe)} mm/s"
    if edges.safe > edges.greatest:
        return f"{run}, which exceeds the maximum speed of the drive, {mm(edges.greatest)} mm/s", "act"
    if edges.starts is None:
        return f"{run}, and check that it starts: {_starting(edges, map_, unit)}", "watch"
    return run, "good"


def _slides(edges: Edges, part: Noun) -> str:
    if not math.isfinite(edges.safe):
        return "no speed is known to be smooth from any start. "
    return f"the {part} slides from any start above {_up(edges.safe)} mm/s. "


def _below(edges: Edges) -> str:
    turn = edges.transition
    if edges.turns:
        return (
            f"{between('Below the transition (lowest torque),', turn.value, turn.low, turn.high)}, it sticks."
        )
    return f"Below {figures(1e3 * edges.sticks_below, up=False)} mm/s it sticks."


def of_log(known: Findings, trend: Trend) -> Instruction:
    """Return what the log alone tells, in speeds of the shaft: what is known first, then what is missing."""
    surface = known.surface
    if known.friction is not None:
        return _of_friction(known.friction)
    if known.regime.driving is not None:
        return Instruction(
            "watch", str(known.regime.driving), "", "To see friction, record the drive without it."
        )
    if surface.transition is None:
        return _one_branch(known, trend)
    ends = [None] if surface.b is None or surface.temperature_range is None else [*surface.temperature_range]
    kelvin = max(ends, key=surface.transition_speed)
    found = surface.transition_estimate(kelvin)
    lowest, factor = f"torque is lowest at {roll(found.value)} rpm", 60.0 / math.tau
    if found.estimable:
        lowest += f" {within(found.low, found.high, factor)}"
        least = f"above {figures(found.high * factor, up=True)} rpm"
    else:
        lowest += ", interval not known"
        least = f"well above {roll(found.value)} rpm"
    otherwise = f"{_sides(known, kelvin, found)} Keep the speed {least}; the safe speed may be higher."
    if known.machine is None:
        otherwise += " To find it, add stiffness and mass in a machine file."
    text = _lead(at(kelvin), f"{lowest}. The safe speed is not yet known")
    return Instruction("watch", text, f"above the minimum, {_exponent(known)}", otherwise)


def _of_friction(curve: FrictionCurve) -> Instruction:
    """What the friction curve of a joint says."""
    signal: Signal = "good" if curve.rises else "watch"
    return Instruction(signal, slowing_of(curve), curve.headline(), directions_of(curve))


def _sides(known: Findings, kelvin: float | None, turn: Estimate) -> str:
    """On which side of the least torque the tested speeds lie, at the temperature that is spoken of."""
    speeds = np.abs(known.points.column("speed"))
    if kelvin is not None:
        levels = known.points.column("temperature")
        groups = list(groups_of_temperature(levels))
        speeds = speeds[min(groups, key=lambda group: abs(float(np.mean(levels[group])) - kelvin))]
    low, high = (turn.low, turn.high) if turn.estimable else (turn.value, turn.value)
    below, above = speeds[speeds < low], speeds[speeds > high]
    where = (
        f"The tested speeds up to {roll(below.max())} rpm lie below the minimum:"
        if below.size
        else "Below it"
    )
    said = f"{where} torque rises as the drive slows, and stick-slip is possible."
    return f"{said} Those from {roll(above.min())} rpm lie above it." if below.size and above.size else said


def _exponent(known: Findings) -> str:
    """How damping varies with speed, and the lubrication that this points to."""
    c, named = known.surface.c, known.regime.named
    value = f"damping varies as speed^{str(c).replace('-', MINUS)}"
    if named == FALLING:
        return f"{value}, as in mixed or boundary lubrication"
    if named is not None:
        return f"{value}, as expected for {named_in_words(named)}"
    nearest = neighbours(c.value).replace("(-", f"({MINUS}")
    return f"{value}, {nearest}" if nearest else value


def _one_branch(known: Findings, trend: Trend) -> Instruction:
    """What a log says whose fit shows no transition; claims are tested on the dwells themselves."""
    low, high = (roll(speed) for speed in known.surface.speed_range)
    c, interval = known.surface.c, _exponent(known)
    if trend.falls and not trend.rises:
        return Instruction(
            "watch",
            f"Measure faster dwells: torque falls as speed rises, from {low} to {high} rpm",
            interval,
            "Where torque falls with speed, stick-slip is possible. The end of that range is not known.",
        )
    if trend.falls:
        return Instruction(
            "watch",
            f"Torque is lowest near {roll(trend.least)} rpm, and below that rises as the drive slows",
            interval,
            f"Keep the speed well above {roll(trend.least)} rpm; the safe speed is not yet known. To "
            "determine the transition, record more dwells below that speed.",
        )
    if trend.constant:
        # the exponent of one law may exclude a level torque where no test without a law does
        level = not c.estimable or c.low <= -1.0 <= c.high
        what = "torque is constant within" if level else "torque varies about its mean by up to"
        return Instruction(
            "watch",
            f"Record dwells slower than {low} and faster than {high} rpm: {what} {per_cent_of(trend.spread)}",
            interval,
            "This log cannot show whether torque falls at lower speeds, so sticking cannot be ruled out.",
        )
    return Instruction(
        "watch",
        f"Measure dwells slower than {low} rpm: torque rises with speed down to there",
        interval,
        f"Once sliding, it keeps sliding down to {low} rpm. From rest it may stick: torque at "
        "lower speeds is not known.",
    )


def _not_started(
    where: str, kelvin: float | None, edges: Edges, map_: OperatingMap, unit: str
) -> Instruction:
    needed, limit = torque(edges.holding.high, unit, up=True), torque(edges.limit, unit)
    part, pulls = map_.train.part, puller_of(map_.train.part)
    if map_.limited_by == "motor torque":
        what = f"give the {pulls} more than {needed}: the motor's {limit} cannot start a {part} at rest"
    else:
        what = f"let the {pulls} grip more than {needed}: at {limit} it slips on a {part} at rest"
    turn = figures(1e3 * edges.transition.high, up=True)
    takes = map_.state_at(temperature=kelvin, speed=edges.transition.high).torque
    if takes <= edges.limit:
        otherwise = f"A {part} that already slides keeps sliding above {turn} mm/s."
    else:
        otherwise = f"It cannot keep sliding either: that takes {torque(takes, unit)} at {turn} mm/s."
    return Instruction("act", _lead(where, what), _starting(edges, map_, unit), otherwise)


def _starting(edges: Edges, map_: OperatingMap, unit: str) -> str:
    held = edges.holding
    return starting(held.low, held.value, held.high, edges.limit, map_, unit)


def _interval(what: str, edge: Edge) -> str:
    if edge.estimable:
        return f"{between(what, edge.value, edge.low, edge.high)} (95 %)"
    least = figures(1e3 * edge.low, up=False)
    value = f"{mm(edge.value)} mm/s" if math.isfinite(edge.value) else "not found"
    return f"{what} {value}, at least {least}; no upper end can be determined"


def _lead(where: str, what: str) -> str:
    return f"{where}{what}" if where else f"{what[0].upper()}{what[1:]}"


def _up(speed: float) -> str:
    return figures(1e3 * speed, up=True)
