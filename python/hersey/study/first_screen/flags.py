"""The warnings of the first screen: contradictions, what V* hangs on, what the log leaves open."""

from __future__ import annotations

import numpy as np

from hersey.damping.compare import LogComparison
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.doubtful import doubtful_order, doubtful_tare
from hersey.damping.surface import DampingSurface
from hersey.decision.behaviour import Behaviour
from hersey.decision.edges import edges_of
from hersey.log.doubtful import doubtful_units
from hersey.posterior.result import SAFE
from hersey.stability.operating_map import OperatingMap
from hersey.study.findings import Findings
from hersey.study.first_screen.reasons import in_words
from hersey.study.first_screen.result import FlagPart, Signal
from hersey.study.first_screen.words import at, figures, listed, mm, signed, starting
from hersey.study.nip_film import FilmPart
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.regime import Regime

#: How many the first screen has room for.
MOST = 3
#: Measured over stated torque beyond which the file does not make the log.
_FAR = 2.0
#: Dwells of a falling branch that are few: a transition is told from three on.
_FEW = 4
#: Probability of a closure from which it counts as known, and ratio of V* of two from which they differ.
_DECIDED, _APART = 0.95, 1.25
#: Scatter between dwells that is spoken of.
_SCATTER = 0.05


def flags(known: Findings) -> list[FlagPart]:
    """Return the gravest warnings, each with the section of the page that holds its evidence.

    What a comparison says was asked for, and stands among them whatever it is, first of its kind.
    """
    points, surface, found, map_ = known.points, known.surface, known.behaviour, known.map
    out = [] if found is None else _unused(found)
    out += [*_contradictions(known.nip, known.torque_budget), *_of_log(points, surface)]
    if known.why:
        out.append(FlagPart(signal="act", title="No band.", text=f"{_sentence(known.why)}.", section="band"))
    if found is not None and map_ is not None:
        out += [*_whole(points), *_of_machine(found, map_, known.units["torque"])]
    if found is not None:
        out += [*_not_computed(found), *_plans(found)]
    scatter = surface.statistics.scatter if found is None else found.posterior.model.curves.scatter
    out += _left_open(points, known.regime, scatter)
    grave = {"act": 0, "watch": 1, "good": 2}
    asked = [] if known.comparison is None else [_compared(known.comparison)]
    kept = sorted(out, key=lambda flag: grave[flag.signal])[: MOST - len(asked)]
    return sorted([*asked, *kept], key=lambda flag: grave[flag.signal])


def _not_computed(found: Behaviour) -> list[FlagPart]:
    """Why there is no band or no map."""
    return [
        FlagPart(signal="watch", title=title, text=f"{_sentence(in_words(error))}.", section="band")
        for title, errors in (("No band.", found.no_band), ("No map.", found.no_map))
        for error in errors
    ]


def _compared(found: LogComparison) -> FlagPart:
    """What really changed since an earlier log."""
    differs = [each for each in found.changes if each.real]
    drags = any(low is not None and low > 1.0 for row in found.low for low in row)
    drags |= any(high is not None and high < 1.0 for row in found.high for high in row)
    signal: Signal = "watch" if drags or differs else "good"
    what = "Damping has changed" if drags else "The law has changed" if differs else "Nothing really changed"
    return FlagPart(signal=signal, title=f"{what} since {found.a}.", text=found.verdict, section="compare")


def _contradictions(film: FilmPart | None, torque_budget: TorqueBudgetPart | None) -> list[FlagPart]:
    out = []
    if film is not None and film.contradicted and film.exponents is not None:
        e = film.exponents
        theory = e.expected if e.solved is None else e.solved
        value = e.exponent.value
        measured = "" if value is None else f"Measured {signed(value)}; "
        text = f"{measured}the film solved for this nip gives {signed(theory)}."
        out.append(FlagPart(signal="watch", title="Exponent and nip disagree.", text=text, section="regime"))
    if torque_budget is not None and (torque_budget.ratio[0] < 1 / _FAR or torque_budget.ratio[2] > _FAR):
        low, mean, high = (figures(ratio) for ratio in torque_budget.ratio)
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
    edges, kelvin = edges_of(found.posterior, found.temperature), found.temperature
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
    out += _closures(found)
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


def _closures(found: Behaviour) -> list[FlagPart]:
    """That V* depends on how the belt comes to rest, where the evidence does not decide that."""
    drawn, kelvin = found.posterior, found.temperature
    chances = drawn.closures()
    if max(chances.values()) >= _DECIDED:
        return []
    fold, closure = drawn.edges(kelvin).fold, drawn.drives.closure
    medians = {
        name: float(np.median(fold[closure == i])) for i, name in enumerate(chances) if np.any(closure == i)
    }
    soft, dead = medians.get("retained"), medians.get("stiction")
    if soft is None or dead is None or dead < _APART * soft:
        return []
    text = (
        f"It may come to rest gradually ({_chance(chances['retained'])}) or stop abruptly "
        f"({_chance(chances['stiction'])}). V* is {mm(soft)} or {mm(dead)} mm/s."
    )
    title = "The safe speed depends on how the belt comes to rest."
    return [FlagPart(signal="watch", title=title, text=text, section="band")]


def _chance(value: float) -> str:
    return f"{100.0 * value:.0f} %"


def _unused(found: Behaviour) -> list[FlagPart]:
    """Evidence that does not count, and draws that do not agree."""
    out = [
        FlagPart(signal="watch", title="A recording was not used.", text=each.sentence, section="band")
        for each in found.posterior.warnings[:1]
    ]
    if not found.posterior.convergence.converged:
        text = "Two runs of the sampler differ: take the intervals as rough, or run hersey posterior."
        out.append(FlagPart(signal="watch", title="V* has not converged.", text=text, section="band"))
    return out


def _plans(found: Behaviour) -> list[FlagPart]:
    """Operating points that cannot be reached from rest."""
    out = []
    for each in found.points:
        if each.plan is not None and not each.plan.found and each.verdict.starts >= SAFE:
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


def _left_open(points: SteadyPoints, seen: Regime, scatter: float) -> list[FlagPart]:
    out = []
    for each in doubtful_order(points)[:1]:
        text = _sentence(each.advice)
        out.append(FlagPart(signal="watch", title=f"{each.title}.", text=text, section="data"))
    if seen.named is None:
        why = seen.why_unnamed or "several explain the dwells"
        text = f"{_sentence(why)}."
        out.append(FlagPart(signal="watch", title="No regime is told.", text=text, section="regime"))
    if scatter > _SCATTER:
        text = "More than sensor noise explains. Something unrecorded varied, or the model is wrong."
        title = f"Points scatter {100 * scatter:.0f} % about the fit."
        out.append(FlagPart(signal="watch", title=title, text=text, section="torque"))
    return out


def _sentence(text: str) -> str:
    """The text with a capital, unless it begins with the name of a parameter."""
    return text if "_" in text.split(" ", 1)[0] else f"{text[:1].upper()}{text[1:]}"
