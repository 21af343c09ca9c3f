"""What speed says about a friction force or coefficient: constant, rising, falling, or lowest somewhere.

Stick-slip and safe speeds are not spoken of: they depend on a machine, and friction alone states none.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from hersey.damping.candidates.collapse import hersey_collapse
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.groups import groups_of_temperature
from hersey.damping.dwells.hersey_number import CURVE
from hersey.damping.estimate import Estimate, rounded
from hersey.damping.surface import DampingSurface
from hersey.damping.trend import Trend
from hersey.errors import InsufficientDataError, capital
from hersey.log.pooling import SAME_LOAD
from hersey.schema.domain import HERSEY_NUMBER, Domain
from hersey.verdict.regimes import COULOMB, FALLING, Hypothesis

#: What a regime means where friction was measured, for those whose meaning is about torque.
_MEANINGS = {
    "constant film": "film of fixed thickness, e.g. if starved: friction proportional to speed",
    COULOMB: "friction independent of speed",
    FALLING: "friction falls with speed: boundary or mixed lubrication",
}
#: Change over the range of speeds below which friction is constant, whatever the interval of its exponent.
NEGLIGIBLE = 0.01
#: Change over the range of speeds up to which an exponent that may be zero makes friction constant.
CLOSE = 0.1
#: Scatter about a power of speed from which a lowest speed between the ends is spoken of.
_BENDS = 0.05
#: Share by which that speed must be off either end.
_INSIDE = 0.2


def of_friction(hypothesis: Hypothesis) -> Hypothesis:
    """Return a hypothesis whose meaning is that for friction."""
    return replace(hypothesis, meaning=_MEANINGS.get(hypothesis.name, hypothesis.meaning))


def friction_verdict(points: SteadyPoints, surface: DampingSurface, trend: Trend, because: str) -> str:
    """Return what friction does as speed rises; ``because`` is what the exponent says of films.

    Parameters
    ----------
    because
        Sentence on regimes, said where all dwells have one load.
    """
    seen = friction_finding(surface, trend)
    if CURVE in points.table.columns:
        return _of_curves(points, seen, because)
    if loads := points.varying_load:
        because = _of_loads(points, loads)
    return " ".join(filter(None, (seen, because)))


def friction_finding(surface: DampingSurface, trend: Trend) -> str:
    """Return what friction does as speed rises, without what causes it."""
    return _lowest(surface) if surface.transition is not None else _of_range(surface, trend)


def power_of(surface: DampingSurface) -> Estimate:
    """Return the exponent of friction in speed, which is one more than that of damping."""
    return _raised(surface.c)


def _raised(c: Estimate) -> Estimate:
    return replace(c, value=1.0 + c.value, low=1.0 + c.low, high=1.0 + c.high)


def _with_sensors(power: Estimate) -> str:
    sensors = f" (sensors ± {power.systematic:.2g})" if power.systematic else ""
    return f"{power}{sensors}"


def _lowest(surface: DampingSurface) -> str:
    """Where friction is least, and what it does on either side."""
    t, of = surface.transition, surface.domain
    assert t is not None
    unit, factor = of.shown_speed
    value, low, high = (factor * each for each in (t.speed.value, t.speed.low, t.speed.high))
    known = (
        rounded(value, low, high, unit) if t.speed.estimable else f"{value:.3g} {unit} (interval not known)"
    )
    mixed, name = _with_sensors(_raised(t.mixed_exponent)), capital(of.quantity)
    return (
        f"{name} is lowest at {_named_speed(of)}{known}. Above it, it rises as {of.speed_symbol}^"
        f"{_with_sensors(power_of(surface))}; below it, it falls as {of.speed_symbol}^{mixed}, as in mixed "
        "lubrication."
    )


def _named_speed(of: Domain) -> str:
    """What comes before a speed that is not the one that everybody expects."""
    named = {"entrainment speed": "an entrainment speed of ", HERSEY_NUMBER: "a Hersey number of "}
    return named.get(of.speed, "")


def _of_range(surface: DampingSurface, trend: Trend) -> str:
    """What friction does over the whole range of speeds."""
    of, power = surface.domain, power_of(surface)
    name, span = capital(of.quantity), of.between(*surface.speed_range)
    if not power.estimable:
        return f"{name} is {_level(surface)} at {span}; its dependence on {of.speed} cannot be determined."
    log_span = math.log(surface.speed_range[1] / surface.speed_range[0])
    least, most = power.low - power.systematic, power.high + power.systematic
    change = math.expm1(max(abs(least), abs(most)) * log_span)
    if change < NEGLIGIBLE or (least <= 0.0 <= most and change < CLOSE and trend.constant):
        return (
            f"{name} is constant: {_level(surface)} at {span}. It varies as {of.speed_symbol}^"
            f"{_with_sensors(power)}, less than {_per_cent(change)} over this range."
        )
    if least <= 0.0 <= most and not trend.constant:
        return (
            f"{name} is {_level(surface)} at {span}. It changes by up to ±{_per_cent(trend.spread)} with "
            f"{of.speed}, but neither rises nor falls throughout."
        )
    if least <= 0.0 <= most:
        return (
            f"{name} shows no change with {of.speed}: {_level(surface)} at {span}. A change of "
            f"{_size(change)} over this range is not excluded."
        )
    does = "rises" if least > 0.0 else "falls"
    slowest, fastest = (
        speed * (1.0 + s * _INSIDE) for speed, s in zip(surface.speed_range, (1, -1), strict=True)
    )
    if surface.statistics.scatter > _BENDS and slowest < trend.least < fastest:
        return (
            f"{name} is lowest near {of.at(trend.least)}, within {span}, so no one power of {of.speed} "
            "describes it. More dwells on either side would show how it falls and rises."
        )
    first, last = (_at(surface, speed) for speed in surface.speed_range)
    power_law = f"{of.speed_symbol}^{_with_sensors(power)}"
    return f"{name} {does} with {of.speed}, as {power_law}: from {first} to {last} at {span}."


def _level(surface: DampingSurface) -> str:
    """Friction at the middle speed, with its interval."""
    band = surface.predict(speed=surface.reference_speed, temperature=surface.reference_temperature)
    low, high = (float(np.ravel(each)[0]) for each in band.confidence)
    return rounded(float(np.ravel(band.torque)[0]), low, high, surface.domain.unit)


def _at(surface: DampingSurface, speed: float) -> str:
    value = surface.torque(speed=speed, temperature=surface.reference_temperature)
    return surface.domain.amount(float(np.ravel(value)[0]))


def _size(change: float) -> str:
    return _per_cent(change) if change < 1.0 else f"a factor of {1.0 + change:.2g}"


def _per_cent(share: float) -> str:
    return f"{100.0 * share:.2g} %"


def _of_curves(points: SteadyPoints, seen: str, because: str) -> str:
    """What friction does with the Hersey number, and whether temperatures and loads share one curve."""
    speed, friction = (np.abs(points.column(name)) for name in ("speed", "torque"))
    if loads := points.varying_load:
        because = f"Loads differ ({loads[0]:.3g} to {loads[1]:.3g} N), so no film regime is judged."
    curve = points.column(CURVE)
    number = np.unique(curve).size
    if number < 2:
        return " ".join(filter(None, (seen, because)))
    try:
        found = hersey_collapse(np.log(speed), np.log(friction), curve)
    except InsufficientDataError:
        found = None
    if found is not None and found.collapses is False:
        apart = _per_cent(found.deviation)
        return (
            f"Curves at {number} temperatures and loads do not collapse on the Hersey number: they lie "
            f"{apart} apart, so this is no single Stribeck curve. {seen}"
        )
    if found is not None and found.collapses:
        within = f"{number} curves at different temperatures or loads collapse on the Hersey number within "
        within += f"{_per_cent(max(found.deviation, found.scatter))}."
    else:
        within = "Whether curves at different temperatures or loads collapse cannot be determined."
    return " ".join(filter(None, (seen, within, because)))


def _temperatures(points: SteadyPoints) -> int:
    """How many temperatures there are, as far as the log has any."""
    if not points.log.has_temperature:
        return 0
    return sum(1 for _ in groups_of_temperature(points.column("temperature")))


def _of_loads(points: SteadyPoints, loads: tuple[float, float]) -> str:
    """Whether different loads share one curve."""
    apart = f"Loads differ ({loads[0]:.3g} to {loads[1]:.3g} N), so no film regime is judged."
    if points.domain.quantity != "friction coefficient" or _temperatures(points) > 1:
        return apart  # speed over load is the Hersey number at one viscosity
    speed, friction, load = (np.abs(points.column(name)) for name in ("speed", "torque", "load"))
    group = np.round(np.log(load / load.min()) / math.log(SAME_LOAD)).astype(int)
    try:
        found = hersey_collapse(np.log(speed / load), np.log(friction), group)
    except InsufficientDataError:
        return apart
    if found.collapses is False:
        return (
            f"{apart} Curves at different loads do not collapse on speed over load (the Hersey number at one "
            f"viscosity): they lie {_per_cent(found.deviation)} apart, so this is no single Stribeck curve."
        )
    if found.collapses:
        within = _per_cent(found.deviation)
        return f"{apart} Curves at different loads collapse on speed over load within {within}."
    return apart
