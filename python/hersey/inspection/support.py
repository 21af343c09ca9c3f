"""What the dwells of a log can tell, and what they cannot: said before a fit is tried."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from hersey.arrays import FloatArray
from hersey.damping.dwells import SteadyPoints, distinct_speeds, groups_of_temperature
from hersey.damping.dwells.constant import constant_torque, dead_temperature
from hersey.damping.dwells.least_duration import speeds_lost, temperatures_lost
from hersey.damping.dwells.reasons import Kind
from hersey.damping.estimate import Estimate, rounded
from hersey.damping.fit import fit
from hersey.damping.rising import Rising, rising
from hersey.damping.surface import DampingSurface
from hersey.errors import InsufficientDataError, Setting
from hersey.log.means import MeansTable
from hersey.result import Means, Record
from hersey.schema.domain import TORQUE, Domain
from hersey.units import convert

#: Speeds that span less than this factor, and temperatures that span less than so many kelvin, give an
#: exponent only with a wide interval.
NARROW_SPEEDS, NARROW_TEMPERATURES = 2.0, 30.0
#: Speeds at one temperature that two branches and the place where they meet need.
BRANCH_SPEEDS = 6
#: Speed and temperature vary together beyond this correlation: their exponents cannot be separated.
TOGETHER = 0.95


@dataclass(frozen=True)
class Support(Record):
    """Dwells of a log and what they support.

    Attributes
    ----------
    dwells
        How many.
    speeds
        How many different speeds; ``speed_range`` in rad/s.
    temperatures
        Mean of each group of temperatures, K, coldest first.
    rejected
        Rows of every other stretch by the kind of its reason.
    domain
        What was measured: a torque, or a friction force or coefficient.
    can, cannot
        In words; what is not known names what is missing.
    """

    dwells: int
    speeds: int
    speed_range: Annotated[tuple[float, float] | None, Means("least and greatest, without sign", "rad/s")]
    temperatures: tuple[float, ...]
    rejected: dict[Kind, int]
    can: tuple[str, ...]
    cannot: tuple[str, ...]
    domain: Domain = TORQUE


def support_of_points(
    points: SteadyPoints, *, temperature_scale: str = "degC", no_temperature: str = "none was recorded"
) -> Support:
    """Return what dwells support; ``temperature_scale`` is that of the fit to come.

    ``no_temperature`` is why the dwells have no temperature, where they have none.
    """
    log = points.log
    speed = np.abs(points.column("speed"))
    kelvin = points.column("temperature") if log.has_temperature else None
    groups = [] if kelvin is None else list(groups_of_temperature(kelvin))
    levels = () if kelvin is None else tuple(float(np.mean(kelvin[group])) for group in groups)
    fitted = _fitted(_comparable(points, len(groups)), temperature_scale)
    can: list[str] = []
    cannot: list[str] = []
    constant = constant_torque(points)
    for says in (
        *(
            (
                _speed(speed, points),
                _temperature(levels, points, fitted) if levels else _no_temperature(no_temperature),
                _branches(points, groups or [np.arange(speed.size)], speed, fitted),
            )
            if constant is None
            else (_nothing(constant, points),)
        ),
        *(() if isinstance(log, MeansTable) else (_approach(points), _tare(points))),
    ):
        can += says[0]
        cannot += says[1]
    cannot += [str(warning) for warning in points.warnings if isinstance(log, MeansTable)]
    rejected: Counter[Kind] = Counter()
    for stretch in points.rejected:
        rejected[stretch.why.kind] += stretch.rows
    limits = (float(speed.min()), float(speed.max()))
    return Support(
        dwells=len(points),
        speeds=distinct_speeds(speed),
        speed_range=limits,
        temperatures=levels,
        rejected=dict(rejected),
        can=tuple(can),
        cannot=tuple(cannot),
        domain=points.domain,
    )


Said = tuple[list[str], list[str]]


def _fitted(points: SteadyPoints, scale: str) -> DampingSurface | str:
    """The surface that a fit gives, or why there is none."""
    try:
        return fit(points, temperature_scale=scale)
    except InsufficientDataError as error:
        return str(error)


def _nothing(torque: float, points: SteadyPoints) -> Said:
    """What a torque that stands still tells."""
    of = points.domain
    return [], [
        f"any exponent: {of.quantity} always reads {of.small(torque, '.4g')}. Check the sensor, or name "
        f"another column with {Setting('torque', 'channel').to()}"
    ]


def _speed(speed: FloatArray, points: SteadyPoints) -> Said:
    count, low, high = distinct_speeds(speed), float(speed.min()), float(speed.max())
    span = points.domain.between(low, high)
    if count < 3:
        held = points.domain.at(low, ".4g") if count == 1 else span
        few = "one speed" if count == 1 else "two speeds"
        if lost := speeds_lost(points):
            return [], [f"exponent c (speed): {few} ({held}): {lost}"]
        return [], [f"exponent c (speed): {few} ({held}). Record dwells at three or more speeds"]
    if high < NARROW_SPEEDS * low:
        return [], [
            f"exponent c (speed) accurately: {count} speeds span only {span}. Cover more than a factor of 2"
        ]
    return [f"exponent c (speed): {count} speeds, {span}"], []


def _no_temperature(why: str) -> Said:
    return [], [f"any dependence on temperature: {why}"]


def _temperature(levels: tuple[float, ...], points: SteadyPoints, fitted: DampingSurface | str) -> Said:
    temperatures = _levels(levels)
    if len(levels) == 1 and (lost := temperatures_lost(points)):
        return [], [f"exponent b (temperature): all dwells are at {temperatures}: {lost}"]
    if len(levels) == 1:
        dead = dead_temperature(points)
        said = f"{temperatures}: {dead}. Check it and" if dead else f"{temperatures}."
        record = "record again" if dead else "Record other temperatures"
        return [], [f"exponent b (temperature): all dwells are at {said} {record}"]
    kelvin, speed = points.column("temperature"), np.abs(points.column("speed"))
    if distinct_speeds(speed) > 1 and abs(np.corrcoef(np.log(speed), kelvin)[0, 1]) > TOGETHER:
        return [], [
            "b separately from c: speed and temperature vary together. Record several speeds at each "
            "temperature"
        ]
    if levels[-1] - levels[0] < NARROW_TEMPERATURES:
        span = f"only {levels[-1] - levels[0]:.0f} K ({temperatures})"
        return [], [f"exponent b (temperature) accurately: the dwells span {span}. Cover more than 30 K"]
    can, cannot = [f"exponent b (temperature): {len(levels)} temperatures, {temperatures}"], []
    if isinstance(fitted, DampingSurface) and fitted.b is not None and not fitted.b.estimable:
        once = f"{temperatures} were visited once each. Visit one again, or record another"
        can, cannot = [], [f"the interval of exponent b (temperature): {once}"]
    laws = "which temperature law holds (power, Arrhenius, VFT)"
    if len(levels) > 3:
        can.append(laws)
    else:
        cannot.append(f"{laws}: {len(levels)} temperatures, but four are needed")
    return can, cannot


def _branches(
    points: SteadyPoints, groups: list[NDArray[np.intp]], speed: FloatArray, surface: DampingSurface | str
) -> Said:
    most = max(distinct_speeds(speed[group]) for group in groups)
    few = f"at most {most} speed{'s' if most > 1 else ''} at one temperature"
    too_few = [f"a transition: {few}, but two branches need {BRANCH_SPEEDS}"]
    if isinstance(surface, str):
        return [], too_few if most < BRANCH_SPEEDS else [f"a transition: {surface}"]
    branch = rising(_comparable(points, 0 if surface.b is None else 2), surface)
    if most < BRANCH_SPEEDS and surface.transition is None:
        return _one_exponent(branch, too_few)
    if surface.transition is None:
        return _one_exponent(branch, [f"a transition: {_without(surface, branch)}"])
    at = surface.transition.speed
    of = surface.domain
    said = f"a transition: {of.quantity} falls, then rises; it is lowest at {_shown(at, of)}"
    if surface.reference_temperature is not None:
        said += f" at {_levels([surface.reference_temperature])}"
    can, cannot = _one_exponent(branch, [])
    return [said, *can], cannot


def _without(surface: DampingSurface, branch: Rising) -> str:
    """Why there is no transition, and where one could lie; an exponent that does not hold says neither."""
    of = surface.domain
    low, high = map(of.at, surface.speed_range)
    ends = [surface.c.low, surface.c.high]
    if branch.bent and branch.lack_of_fit is not None:
        ends += [*branch.lack_of_fit.local_exponents, *branch.lack_of_fit.by_temperature]
    if min(ends) > -1.0:
        return f"{of.quantity} rises from {low} on, so a transition may lie at slower speeds"
    if max(ends) < -1.0:
        return f"{of.quantity} does not rise up to {high}, so a transition may lie at faster speeds"
    return surface.rejected_transition


def _comparable(points: SteadyPoints, temperatures: int) -> SteadyPoints:
    """The points as they can be fitted: at one temperature without it."""
    if temperatures > 1 or not points.log.has_temperature:
        return points
    log = points.log
    if isinstance(log, MeansTable):
        return replace(points, log=replace(log, means=_bare(log.means)))
    return replace(points, log=replace(log, runs=_bare(log.runs)))


def _bare(recorded: tuple[Any, ...]) -> tuple[Any, ...]:
    """Runs or rows without their temperature."""
    return tuple(replace(each, temperature=None) for each in recorded)


def _one_exponent(branch: Rising, cannot: list[str]) -> Said:
    """Whether one exponent of speed holds, above the transition if there is one."""
    if branch.lack_of_fit is None:
        return [], [*cannot, branch.why_not]
    if branch.bent:
        return [], [*cannot, f"one exponent of speed: {'; '.join(branch.lack_of_fit.misses())}"]
    return ["one exponent of speed: consistent with all dwells"], cannot


def _shown(speed: Estimate, of: Domain) -> str:
    if not speed.estimable:
        return f"{of.at(speed.value)} (interval not known)"
    unit, factor = of.shown_speed
    value, low, high = (factor * each for each in (speed.value, speed.low, speed.high))
    return rounded(value, low, high, unit)


def _levels(kelvin: Sequence[float]) -> str:
    return ", ".join(f"{convert(level, 'K', 'degC'):.0f}" for level in kelvin[:12]) + " degC"


def _approach(points: SteadyPoints) -> Said:
    ways = Counter(points.table["approach"].to_list())
    if ways["from below"] > 2 and ways["from above"] > 2:
        below, above = ways["from below"], ways["from above"]
        return [f"the difference between speeding up and slowing down: {below} and {above} dwells"], []
    return [], ["the difference between speeding up and slowing down. Record speeds on the way up and down"]


def _tare(points: SteadyPoints) -> Said:
    if points.standing_torque is None:
        return [], ["a tare: the drive never stands still for 2 s"]
    of = points.domain
    return [f"a tare: {of.quantity} reads {of.small(points.standing_torque)} at standstill"], []
