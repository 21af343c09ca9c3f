"""The warnings of the first screen: contradictions, what V* depends on, what the log leaves open."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hersey.damping.compare import LogComparison
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.doubtful import constant_load, doubtful_order, doubtful_tare
from hersey.damping.moving.beside_dwells import motion_beside
from hersey.damping.surface import DampingSurface
from hersey.decision.behaviour import Behaviour
from hersey.decision.edges import edges_of
from hersey.errors import Setting
from hersey.log.channels import CLOCK_PASSED_OVER
from hersey.log.doubtful import doubtful_units
from hersey.log.replaced import UNIT_REPLACED, replaced_in
from hersey.log.wrapped import READ_AS_NEGATIVE
from hersey.posterior.result import SAFE
from hersey.schema.noun import BELT, puller_of
from hersey.schema.warning import Warning
from hersey.stability.operating_map import OperatingMap
from hersey.study.findings import Findings
from hersey.study.first_screen.reasons import in_words
from hersey.study.first_screen.temperature import temperature_unknown
from hersey.study.first_screen.words import (
    at,
    between,
    degrees,
    figures,
    listed,
    mm,
    signed,
    starting,
    torque,
)
from hersey.study.nip_film import FilmPart, VerdictPart
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.held_values import held_values
from hersey.verdict.warnings import SCATTER

#: How many the first screen has room for.
MOST = 3
#: Measured over stated torque beyond which the file does not make the log.
_FAR = 2.0
#: Dwells of a falling branch that are few: a transition is fitted from three on.
_FEW = 4
#: Probability of a closure from which it counts as known, and ratio of V* of two from which they differ.
_DECIDED, _APART = 0.95, 1.25


def flags(known: Findings) -> list[Warning]:
    """Return the gravest warnings, each with the section of the page that holds its evidence as ``where``.

    What a comparison says was asked for, and stands among them whatever it is, first of its kind.
    """
    points, surface, found, map_ = known.points, known.surface, known.behaviour, known.map
    out = [*_replaced(points, known.comparison), *([] if found is None else _unused(found))]
    turns = found is None or map_ is None or edges_of(found.posterior, found.temperature).turns
    out += [*_contradictions(known.nip, known.torque_budget), *_of_log(points, surface, asked=not turns)]
    out += temperature_unknown(points, known.machine)
    if known.why:
        out.append(Warning("no band", "{why}", severity="act", title="No band", where="band", why=known.why))
    if found is not None and map_ is not None:
        unit = known.units["torque"]
        out += [*([] if known.friction else _whole(points, found, unit)), *_of_machine(found, map_, unit)]
    if found is not None:
        out += [*_not_computed(found), *_plans(found)]
    of_fit = surface.statistics.scatter if known.friction is None else known.friction.scatter
    scatter = of_fit if found is None else found.posterior.model.curves.scatter
    out += _left_open(known, scatter)
    grave = {"act": 0, "watch": 1, "note": 2, "good": 3}
    asked = [] if known.comparison is None else [_compared(known.comparison)]
    kept = sorted(out, key=lambda flag: grave[flag.severity])[: MOST - len(asked)]
    return sorted([*asked, *kept], key=lambda flag: grave[flag.severity])


def _not_computed(found: Behaviour) -> Iterator[Warning]:
    """Why there is no band or no map."""
    for kind, errors in (("band", found.no_band), ("map", found.no_map)):
        for error in errors:
            yield Warning(
                f"no {kind}",
                "{why}",
                severity="watch",
                title="No {what}",
                where="band",
                what=kind,
                why=in_words(error),
            )


def _compared(found: LogComparison) -> Warning:
    """What really changed since an earlier log."""
    differs = [each.name for each in found.changes if each.real]
    drags = any(low is not None and low > 1.0 for row in found.low for low in row)
    drags |= any(high is not None and high < 1.0 for row in found.high for high in row)
    return Warning(
        "drag changed" if drags else "law changed" if differs else "nothing changed",
        "{verdict}",
        severity="watch" if drags or differs else "good",
        title="Damping has changed since {log}"
        if drags
        else "Fitted parameters have changed since {log}"
        if differs
        else "Nothing significant has changed since {log}",
        where="compare",
        log=found.a,
        verdict=found.verdict,
    )


def _contradictions(film: FilmPart | None, torque_budget: TorqueBudgetPart | None) -> list[Warning]:
    out = []
    if film is not None and film.contradicted and film.exponents is not None:
        out.append(_exponent(film.exponents))
    if torque_budget is not None and (torque_budget.ratio[0] < 1 / _FAR or torque_budget.ratio[2] > _FAR):
        out.append(_torque(*torque_budget.ratio))
    if not out and film is not None and film.warnings and film.warnings[0].severity == "act":
        why = film.warnings[0].text
        title = "Nip and log disagree"
        out.append(
            Warning("nip and log disagree", "{why}", severity="watch", title=title, where="regime", why=why)
        )
    return out


def _exponent(e: VerdictPart) -> Warning:
    theory = e.expected if e.solved is None else e.solved
    value = e.exponent.value
    return Warning(
        "exponent and nip disagree",
        "the film solved for this nip gives {gives}"
        if value is None
        else "the measured exponent is {measured}, but the film solved for this nip gives {gives}",
        severity="watch",
        title="Exponent and nip disagree",
        where="regime",
        exponent=value,
        predicted=theory,
        gives=signed(theory),
        measured="" if value is None else signed(value),
    )


def _torque(low: float, mean: float, high: float) -> Warning:
    return Warning(
        "torque and file disagree",
        "measured torque is {shown} times the prediction of the machine file ({least} to {most} for "
        "single dwells)",
        severity="watch",
        title="Torque and machine file disagree",
        where="regime",
        low=low,
        ratio=mean,
        high=high,
        shown=figures(mean),
        least=figures(low),
        most=figures(high),
    )


def _whole(points: SteadyPoints, found: Behaviour, unit: str) -> Iterator[Warning]:
    """Bearings and gears in the torque flatten its fall: V* is estimated too low."""
    if points.rest is None:
        fold = edges_of(found.posterior, found.temperature).fold
        least = float(np.min(np.abs(points.column("torque"))))
        yield Warning(
            "torque of more than the film",
            "{fold} assumes that the whole torque, {shown} at its lowest, comes from the film. If part of "
            "it is that of bearings, gears or other parts, V* is higher. State that part in [rest]",
            severity="watch",
            title="Torque may hold more than the film",
            where="data",
            fold=between("V* of", fold.value, fold.low, fold.high) if fold.estimable else "V*",
            least=least,
            shown=torque(least, unit),
        )


def _of_machine(found: Behaviour, map_: OperatingMap, unit: str) -> Iterator[Warning]:
    yield from _start(found, map_, unit)
    yield from _closures(found, map_)
    if map_.train.grip is None and map_.train.part == BELT:  # others have no roll that could slip
        pulls = [p.plan.peak_force for p in found.points if p.plan is not None and p.plan.found]
        yield Warning(
            "grip not stated",
            ("the first slip pulls with {shown} N, but " if pulls else "")
            + "the grip of the roll is not stated and therefore not in the model",
            severity="watch",
            title="The roll may slip at the start",
            where="plan",
            pull=max(pulls, default=None),
            shown=figures(max(pulls)) if pulls else "",
        )
    far = [p.name for p in map_.points if p.at.extrapolated]
    if far:
        words = "the dwells do not reach {points}: they range from {slow} to {fast} mm/s{levels}"
        title = "Operating points are extrapolated"
        slow, fast = map_.measured_speed
        levels = ""
        if map_.measured_temperature is not None:
            levels = " and from " + " to ".join(degrees(kelvin) for kelvin in map_.measured_temperature)
        yield Warning(
            "points extrapolated",
            words,
            severity="watch",
            title=title,
            where="data",
            points=listed(far),
            slow=mm(slow),
            fast=mm(fast),
            levels=levels,
        )


def _start(found: Behaviour, map_: OperatingMap, unit: str) -> Iterator[Warning]:
    """That grip or motor may not start the part."""
    edges, kelvin = edges_of(found.posterior, found.temperature), found.temperature
    if edges.starts is True:
        return
    held, surely = edges.holding, edges.starts is False
    needs = starting(held.low, held.value, held.high, edges.limit, map_, unit)
    kind = "motor" if map_.limited_by == "motor torque" else "roll"
    yield Warning(
        f"start: {kind}",
        "{at}{needs}",
        severity="act" if surely else "watch",
        title=("The motor does not start the {part}" if surely else "The motor may not start the {part}")
        if kind == "motor"
        else ("The {puller} slips at the start" if surely else "The {puller} may slip at the start"),
        where="band",
        part=map_.train.part,
        puller=puller_of(map_.train.part),
        temperature=kelvin,
        held=held.value,
        limit=edges.limit,
        at=at(kelvin),
        needs=needs,
    )


def _closures(found: Behaviour, map_: OperatingMap) -> Iterator[Warning]:
    """That V* depends on how the part comes to rest, where the evidence does not decide that."""
    drawn, kelvin = found.posterior, found.temperature
    chances = drawn.closures()
    if max(chances.values()) >= _DECIDED:
        return
    fold, closure = drawn.edges(kelvin).fold, drawn.drives.closure
    medians = {
        name: float(np.median(fold[closure == i])) for i, name in enumerate(chances) if np.any(closure == i)
    }
    soft, dead = medians.get("retained"), medians.get("stiction")
    if soft is None or dead is None or dead < _APART * soft:
        return
    yield Warning(
        "closure undecided",
        "it comes to rest gradually ({gradually:.0f %} probability, V* {soft} mm/s) or stops "
        "abruptly ({abruptly:.0f %}, V* {dead} mm/s)",
        severity="watch",
        title="The safe speed depends on how the {part} comes to rest",
        where="band",
        part=map_.train.part,
        gradually=chances["retained"],
        abruptly=chances["stiction"],
        retained=soft,
        stiction=dead,
        soft=mm(soft),
        dead=mm(dead),
    )


def _unused(found: Behaviour) -> list[Warning]:
    """Evidence that does not count, and draws that do not agree."""
    out = [each.titled("A recording was not used", section="band") for each in found.posterior.warnings[:1]]
    if not found.posterior.convergence.converged:
        agreed = found.posterior.convergence
        words = (
            "V* of two runs of the sampler differs by a factor of up to {apart:.2f}, and {distinct:.0f %} of "
            "the draws are distinct. Treat the intervals as rough, or run hersey posterior"
        )
        warning = Warning(
            "not converged",
            words,
            severity="watch",
            title="V* has not converged",
            where="band",
            apart=agreed.ratio,
            distinct=agreed.distinct,
        )
        out.append(warning)
    return out


def _plans(found: Behaviour) -> Iterator[Warning]:
    """Operating points that cannot be reached from rest."""
    for each in found.points:
        if each.plan is not None and not each.plan.found and each.verdict.starts >= SAFE:
            below = any(obstacle.limit == "target_speed" for obstacle in each.plan.obstacles)
            yield Warning(
                "no plan" if below else "no start",
                "{why}",
                severity="act",
                title="No start-up profile for {point}" if below else "No start for {point}",
                where="plan",
                point=each.point.name,
                why=" ".join(obstacle.text for obstacle in each.plan.obstacles),
            )


def few_slow_dwells(points: SteadyPoints, surface: DampingSurface) -> bool:
    """Return whether too few dwells lie below the transition."""
    return surface.transition is not None and _below(points, surface) <= _FEW


def _replaced(points: SteadyPoints, comparison: LogComparison | None) -> Iterator[Warning]:
    """The first unit of a file that was replaced, of this log or the one it is compared with."""
    others = () if comparison is None else comparison.warnings
    for each in [*replaced_in(points.log.files), *(e for e in others if e.kind == UNIT_REPLACED)][:1]:
        yield each.titled("A unit was replaced", section="data")
    clocks = [
        w.within(file.name) for file in points.log.files for w in file.warnings if w.kind == CLOCK_PASSED_OVER
    ]
    for each in clocks[:1]:
        yield each.titled("The clock is not used", section="data")
    for each in points.log.files[0].warnings:
        if each.kind == READ_AS_NEGATIVE:
            yield each.titled("Counts lacked their sign", section="data")


def _of_log(points: SteadyPoints, surface: DampingSurface, *, asked: bool) -> Iterator[Warning]:
    """What is doubtful in the log itself: a unit or a zero shifts every number.

    ``asked``: the instruction asks for slower dwells already.
    """
    for each in doubtful_units(points.log)[:1]:
        yield each.titled("A unit is doubtful", section="data")
    for each in (each.about(points.domain) for each in held_values(points)[:1]):
        yield each.titled("{channel:capital} is {fault}", section="data")
    for each in (each.about(points.domain) for each in doubtful_tare(points)[:1]):
        yield each.titled("The zero is doubtful", section="data")
    yield from (
        each.titled("Motion between the dwells is not used", section="data") for each in motion_beside(points)
    )
    if few_slow_dwells(points, surface):
        yield Warning(
            "few slow dwells",
            "only {below} of {dwells} dwells lie below the transition",
            severity="watch",
            title="Few dwells support the falling branch",
            where="torque",
            below=_below(points, surface),
            remedy="" if asked else "measure slower dwells",
            dwells=len(points),
        )
    if surface.transition is not None and surface.transition.freed is not None:
        yield Warning(
            "transition apart from viscosity",
            "the transition does not move with temperature as viscosity does, so its temperature "
            "exponent is fitted separately",
            severity="watch",
            title="The transition is not at a fixed Hersey number",
            where="torque",
        )
    if (loads := points.varying_load) and points.domain.quantity != "friction coefficient":
        yield Warning(
            "loads differ",
            "it ranges from {low:.3g} to {high:.3g} N. Fit each load separately",
            severity="watch",
            title="The load varies",
            where="data",
            low=loads[0],
            high=loads[1],
        )


def _below(points: SteadyPoints, surface: DampingSurface) -> int:
    """How many dwells lie below the transition at their temperature."""
    speed = np.abs(points.column("speed"))
    if surface.b is None:
        return int(np.count_nonzero(speed < surface.transition_speed()))
    at = [surface.transition_speed(float(t)) for t in points.column("temperature")]
    return int(np.count_nonzero(speed < np.array(at)))


def _left_open(known: Findings, scatter: float) -> Iterator[Warning]:
    points, seen, c = known.points, known.regime, known.surface.c
    yield from (each.titled("A constant load acts", section="data") for each in constant_load(points))
    yield from (each.titled(each.heading, section="data") for each in doubtful_order(points)[:1])
    if seen.named is None and known.friction is None:
        remedy = ""
        if seen.driving is not None:
            remedy = "record the drive without it"
        elif points.rest is None and c.value > -1.0 and points.domain.is_torque:
            remedy = (
                "a no-load torque brings the exponent closer to -1. Record the drive without the contact, "
                "and subtract its torque with {how}"
            )
        elif len(seen.explanations) > 1:
            remedy = "record a wider range of speeds to tell them apart"
        yield Warning(
            "no regime",
            "{why}",
            severity="watch",
            title="The lubrication regime is not determined",
            where="regime",
            remedy=remedy,
            why=seen.why_unnamed or "several regimes fit the dwells",
            how=Setting("no_load"),
        )
    if scatter > SCATTER:
        yield Warning(
            "scatter",
            "more than sensor noise explains. Something unrecorded varied, or the model is wrong",
            severity="watch",
            title="Points scatter {scatter:.0f %} about the fit",
            where="torque",
            scatter=scatter,
        )
