"""The warnings of the first screen: contradictions, what V* hangs on, what the log leaves open."""

from __future__ import annotations

import numpy as np

from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.doubtful import doubtful_order, doubtful_tare
from hersey.damping.surface import DampingSurface
from hersey.document.decision.behaviour import Behaviour, StickSpeeds
from hersey.document.decision.edges import Edges, edges_of
from hersey.document.decision.instruction import start_unsure
from hersey.document.decision.words import at, figures, listed, mm, signed, starting
from hersey.document.parts import CarriedPart, ComparisonPart, FilmPart, RegimePart
from hersey.document.parts.decision import FlagPart, Signal
from hersey.log.doubtful import doubtful_units
from hersey.stability.operating_map import OperatingMap

#: How many the first screen has room for.
MOST = 3
#: Measured over stated torque beyond which the file does not make the log.
_FAR = 2.0
#: Dwells of a falling branch that are few: a transition is told from three on.
_FEW = 4
#: Scatter between dwells that is spoken of.
_SCATTER = 0.05


def flags(
    points: SteadyPoints,
    surface: DampingSurface,
    seen: RegimePart,
    film: FilmPart | None,
    carried: CarriedPart | None,
    found: Behaviour | None,
    why: str = "",
    compared: ComparisonPart | None = None,
    unit: str = "N·m",
) -> list[FlagPart]:
    """Return the gravest warnings, each with the section of the page that holds its evidence.

    What a comparison says was asked for, and stands among them whatever it is, first of its kind.
    """
    map_ = None if found is None else found.map
    out = [*_contradictions(film, carried), *_of_log(points, surface)]
    if why:
        out.append(FlagPart(signal="act", title="No band.", text=f"{_sentence(why)}.", section="band"))
    if found is not None and map_ is not None:
        out += [*_whole(points), *_of_machine(found, map_, unit)]
    if found is not None:
        out += [
            FlagPart(signal="watch", title="No map.", text=_sentence(reason), section="band")
            for reason in found.reasons
        ]
        out += _plans(found, map_)
    out += _left_open(points, surface, seen)
    grave = {"act": 0, "watch": 1, "good": 2}
    asked = [] if compared is None else [_compared(compared)]
    kept = sorted(out, key=lambda flag: grave[flag.signal])[: MOST - len(asked)]
    return sorted([*asked, *kept], key=lambda flag: grave[flag.signal])


def _compared(found: ComparisonPart) -> FlagPart:
    """What really changed since an earlier log."""
    differs = [each for each in found.changes if each.real]
    drags = any(low is not None and low > 1.0 for row in found.low for low in row)
    drags |= any(high is not None and high < 1.0 for row in found.high for high in row)
    signal: Signal = "watch" if drags or differs else "good"
    what = "Damping has changed" if drags else "The law has changed" if differs else "Nothing really changed"
    return FlagPart(signal=signal, title=f"{what} since {found.a}.", text=found.verdict, section="compare")


def _contradictions(film: FilmPart | None, carried: CarriedPart | None) -> list[FlagPart]:
    out = []
    if film is not None and film.contradicted and film.exponents is not None:
        e = film.exponents
        theory = e.expected if e.solved is None else e.solved
        value = e.exponent.value
        measured = "" if value is None else f"Measured {signed(value)}; "
        text = f"{measured}the film solved for this nip gives {signed(theory)}."
        out.append(FlagPart(signal="watch", title="Exponent and nip disagree.", text=text, section="regime"))
    if carried is not None and (carried.ratio[0] < 1 / _FAR or carried.ratio[2] > _FAR):
        low, mean, high = (figures(ratio) for ratio in carried.ratio)
        text = f"Measured torque is {mean} times what the file states, {low} to {high} by dwell."
        out.append(FlagPart(signal="watch", title="Torque and file disagree.", text=text, section="regime"))
    if not out and film is not None and film.misfits and film.misfits[0].signal == "act":
        text = f"{_sentence(film.misfits[0].text)}."
        out.append(FlagPart(signal="watch", title="Nip and log disagree.", text=text, section="regime"))
    return out


def _whole(points: SteadyPoints) -> list[FlagPart]:
    """Bearings and gears in the torque flatten its fall: V* is told too low."""
    if points.rest is not None:
        return []
    text = "V* is of the whole torque, and too low if bearings, rubber or gears are in it: state [rest]."
    return [FlagPart(signal="watch", title="Torque may hold more than the film.", text=text, section="data")]


def _of_machine(found: Behaviour, map_: OperatingMap, unit: str) -> list[FlagPart]:
    edges, kelvin = edges_of(map_, found.temperature), found.temperature
    out = []
    if edges.starts is not True:
        held, motor = edges.holding, map_.limited_by == "motor torque"
        needs = starting(held.low, held.value, held.high, edges.limit, map_.limited_by, unit)
        surely = edges.starts is False
        title = f"The roll {'slips' if surely else 'may slip'} at the start."
        if motor:
            title = f"The motor {'does' if surely else 'may'} not start the belt."
        signal: Signal = "act" if surely else "watch"
        text = _sentence(f"{at(kelvin)}{needs}.")
        out.append(FlagPart(signal=signal, title=title, text=text, section="band"))
    if found.stick_speeds is not None:
        out += _unmeasured(found.stick_speeds, edges, kelvin)
    if map_.train.grip is None:
        pulls = [p.plan.peak_force for p in found.points if p.plan is not None and p.plan.found]
        force = f"The first slip pulls {figures(max(pulls))} N; " if pulls else ""
        text = _sentence(f"{force}the roll's grip is not stated, so it is not in the model.")
        out.append(
            FlagPart(signal="watch", title="The roll may slip at the start.", text=text, section="plan")
        )
    far = [p.name for p in map_.points if p.at.extrapolated]
    if far:
        text = f"No dwell lies as far out as {listed(far)}."
        out.append(FlagPart(signal="watch", title="Points are extrapolated.", text=text, section="data"))
    return out


def _unmeasured(stick: StickSpeeds, edges: Edges, kelvin: float | None) -> list[FlagPart]:
    """What V* hangs on and no steady log shows: the stick speed, and how the belt comes to rest."""
    titles, texts = [], []
    if edges.bistable:
        # what of the range lies below the transition
        ends = stick.known or (stick.stick_speed[0], stick.stick_speed[-1])
        within = [
            (speed, upper)
            for speed, upper in zip(stick.stick_speed, stick.upper, strict=True)
            if ends[0] * (1 - 1e-9) <= speed <= ends[1] * (1 + 1e-9)
        ] or list(zip(stick.stick_speed, stick.upper, strict=True))
        started = [upper for _, upper in within if np.isfinite(upper)]
        there = f" {at(kelvin, first=False)}".rstrip() if kelvin is not None and stick.known else ""
        moves = f"V* is {mm(min(started))} to {mm(max(started))} mm/s" if started else "nothing starts"
        stalled = f", where the belt starts ({len(started)} of {len(within)})"
        counted = "" if stick.known else "; the interval does not count it"
        text = f"over {mm(within[0][0])} to {mm(within[-1][0])} mm/s{there} {moves}"
        texts.append(f"{text}{stalled if 0 < len(started) < len(within) else ''}{counted}")
        titles.append("the stick speed")
    if stick.stiction is not None and stick.stiction > edges.safe:
        what = "and" if titles else "V* is"
        texts.append(f"{what} {mm(stick.stiction)} mm/s if the belt stops dead (stiction)")
        titles.append("how the belt stops")
    if not titles:
        return []
    text = f"Nobody measures {'them' if len(titles) > 1 else 'it'}: {', '.join(texts)}."
    return [FlagPart(signal="watch", title=f"V* hangs on {listed(titles)}.", text=text, section="band")]


def _plans(found: Behaviour, map_: OperatingMap | None) -> list[FlagPart]:
    """Points that no start reaches; where the belt may not break loose the flag of the start says it."""
    out = []
    for each in found.points:
        if each.plan is not None and not each.plan.found and not (map_ and start_unsure(each, map_)):
            text = _sentence("; ".join(obstacle.text for obstacle in each.plan.obstacles)) + "."
            below = any(obstacle.limit == "target_speed" for obstacle in each.plan.obstacles)
            title = f"{'No plan' if below else 'No start'} for {each.point.name}."
            out.append(FlagPart(signal="act", title=title, text=text, section="plan"))
    return out


def _of_log(points: SteadyPoints, surface: DampingSurface) -> list[FlagPart]:
    """What is doubtful in the log itself: a unit or a zero shifts every number."""
    titled = {
        "A unit is doubtful.": doubtful_units(points.log),
        "The zero is doubtful.": doubtful_tare(points),
    }
    out = [
        FlagPart(signal="watch", title=title, text=text, section="data")
        for title, texts in titled.items()
        for text in texts[:1]
    ]
    if surface.transition is not None and (below := _below(points, surface)) <= _FEW:
        text = f"{below} of {len(points)} dwells lie below the transition: measure slower ones."
        title = "Few dwells hold the falling branch."
        out.append(FlagPart(signal="watch", title=title, text=text, section="torque"))
    if surface.transition is not None and surface.transition.freed is not None:
        text = "The transition moves with temperature otherwise than viscosity does: it is fitted by itself."
        title = "One Hersey number does not hold."
        out.append(FlagPart(signal="watch", title=title, text=text, section="torque"))
    if loads := points.varying_load:
        text = f"From {figures(loads[0])} to {figures(loads[1])} N: fit each load alone."
        out.append(FlagPart(signal="watch", title="The load differs.", text=text, section="data"))
    return out


def _below(points: SteadyPoints, surface: DampingSurface) -> int:
    """How many dwells lie below the transition at their temperature."""
    speed = np.abs(points.column("speed"))
    if surface.b is None:
        return int(np.count_nonzero(speed < surface.transition_speed()))
    at = [surface.transition_speed(float(t)) for t in points.column("temperature")]
    return int(np.count_nonzero(speed < np.array(at)))


def _left_open(points: SteadyPoints, surface: DampingSurface, seen: RegimePart) -> list[FlagPart]:
    out = []
    for text in doubtful_order(points)[:1]:
        title, rest = text.split(": ", 1)
        out.append(FlagPart(signal="watch", title=f"{title}.", text=_sentence(rest), section="data"))
    if seen.named is None:
        why = seen.why_unnamed or "several explain the dwells"
        text = f"{_sentence(why)}."
        out.append(FlagPart(signal="watch", title="No regime is told.", text=text, section="regime"))
    scatter = surface.statistics.scatter
    if scatter > _SCATTER:
        text = f"By {100 * scatter:.0f} %, more than their noise: a cause not recorded, or not this law."
        out.append(FlagPart(signal="watch", title="Dwells stand off the law.", text=text, section="torque"))
    return out


def _sentence(text: str) -> str:
    """The text with a capital, unless it begins with the name of a parameter."""
    return text if "_" in text.split(" ", 1)[0] else f"{text[:1].upper()}{text[1:]}"
