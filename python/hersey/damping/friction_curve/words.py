"""What a friction curve says in words."""

from __future__ import annotations

from hersey.damping.estimate import Estimate, rounded
from hersey.damping.friction_curve import law as laws
from hersey.damping.friction_curve.fitted import BOTH, STRIBECK, FittedFriction, FrictionParameter
from hersey.units import celsius, rpm

_LAWS = {"coulomb_viscous": "Coulomb plus viscous friction", "stribeck": "Stribeck friction"}
_FORMULAS = {
    "coulomb_viscous": "torque = T_C + k_v w",
    "stribeck": "torque = T_C + (T_S - T_C) exp(-(w/w_S)^2) + k_v w",
}
#: From so much on torque is shown in N m, N m.
_LARGE = 1.0
#: p-value below which it is not written out.
_SMALL_P = 0.001


def law_of(curve: FittedFriction) -> str:
    """Return the name of the law."""
    own = ", each direction with its own parameters" if curve.apart else ""
    return f"{_LAWS[curve.kind]}{own}"


def named(curve: FittedFriction) -> str:
    """Return the law and its parameters, on one line."""
    return f"{law_of(curve)}: {_listed(curve)}{_at(curve)}"


def finding_of(curve: FittedFriction) -> str:
    """Return what torque does as the drive slows, and whether the directions differ."""
    return ". ".join(filter(None, (slowing_of(curve), directions_of(curve)))) + "."


def verdict_of(curve: FittedFriction) -> str:
    """Return law and parameters, what torque does as the drive slows, and whether the directions differ."""
    return f"{named(curve)}. {finding_of(curve)}"


def rows_of(curve: FittedFriction) -> list[tuple[str, str]]:
    """Return a row per parameter: its name with the direction, and value with interval and unit."""
    rows = []
    for each in curve.parameters:
        way = f" {each.direction}" if curve.apart and each.direction != BOTH else ""
        rows.append((f"{each.name}{way}", _valued(each, curve)))
    return rows


def formula_of(curve: FittedFriction) -> str:
    """Return the law as a formula."""
    formula = _FORMULAS[curve.kind]
    if curve.of_every_sample:
        formula = formula.replace("torque", "friction", 1)
    kelvin = curve.reference_temperature
    return formula if kelvin is None else f"{formula} exp(-s (T - {celsius(kelvin):.0f} °C))"


def summary_of(curve: FittedFriction) -> str:
    """Return law, parameters and laws tried, as text."""
    lines = [verdict_of(curve), f"{formula_of(curve)} (value, 95 % interval)"]
    width = max(len(name) for name, _ in rows_of(curve))
    lines += [f"  {name:{width}}  {text}" for name, text in rows_of(curve)]
    lines.append(f"{curve.points} {curve.what}, scatter {100 * curve.scatter:.2g} % of torque; laws tried:")
    best = curve.tried[0].aicc
    for each in curve.tried:
        way = "each direction separately" if each.apart else f"one law for all {curve.what}"
        worse = f"AICc +{each.aicc - best:.1f}, weight {each.weight:.2g}"
        lines.append(f"  {_LAWS[each.kind]}, {way}: {worse}")
    return "\n".join(lines)


def _at(curve: FittedFriction) -> str:
    kelvin = curve.reference_temperature
    return "" if kelvin is None else f" (k_v at {celsius(kelvin):.0f} °C)"


def _listed(curve: FittedFriction) -> str:
    """All parameters, those of both directions of one name together."""
    names = dict.fromkeys(each.name for each in curve.parameters)
    parts = []
    for name in names:
        own = [each for each in curve.parameters if each.name == name]
        each = " and ".join(
            _valued(one, curve) + (f" {one.direction}" if len(own) > 1 else "") for one in own
        )
        parts.append(f"{name} = {each}" if own[0].bounded or len(own) > 1 else f"{name} {each}")
    return (", " if len(parts) == len(curve.parameters) else "; ").join(parts)


def _valued(parameter: FrictionParameter, curve: FittedFriction) -> str:
    """Value, unit and interval, or why there is none."""
    if not parameter.bounded:
        return f"cannot be determined{_why(parameter, curve)}"
    known, unit, factor = parameter.estimate, parameter.unit, 1.0
    if unit.startswith("N m"):
        factor, unit = _torque_unit(curve)
        unit += "·s/rad" * (parameter.unit != "N m")
    text = rounded(factor * known.value, factor * known.low, factor * known.high, unit)
    if parameter.name == laws.STRIBECK_SPEED:
        text += f" ({rpm(known.value):.3g} rpm)"
    return text


def _why(parameter: FrictionParameter, curve: FittedFriction) -> str:
    if parameter.name in (laws.STATIC, laws.STRIBECK_SPEED):
        return f" (the slowest dwell, {_speed(curve.speed_range[0])}, is too fast: record slower ones)"
    if parameter.name == laws.THINNING:
        return " (each temperature was visited once: visit one again)"
    return ""


def slowing_of(curve: FittedFriction) -> str:
    """Return what torque does as the drive slows, and what that means for stick-slip."""
    if curve.kind == STRIBECK:
        return _of_stribeck(curve)
    slopes = curve.slopes
    low, high = curve.speed_range
    over = f"from {rpm(low):.3g} to {_speed(high)}"
    if curve.rises:
        return f"Torque rises with speed {over}, so the friction curve causes no stick-slip there"
    if curve.falls:
        return f"Torque falls with speed in some of the {curve.what}, so stick-slip is possible"
    if any(each.high < 0.0 for each in slopes):
        return f"Torque falls as speed rises {over}, so stick-slip is possible"
    what = "The motion does" if curve.of_every_sample else "The dwells do"
    return f"{what} not prove that torque changes with speed {over}"


def _of_stribeck(curve: FittedFriction) -> str:
    if not curve.least and curve.rises_beyond_rest:
        slowest = _speed(curve.speed_range[0])
        return f"Torque rises with speed above {slowest}, the slowest dwell: stick-slip is possible below it"
    if not curve.least:
        return "Torque falls as speed rises over the measured speeds, so stick-slip is possible"
    where = " and ".join(
        _speed_estimate(each.speed) + (f" {each.direction}" if curve.apart else "") for each in curve.least
    )
    return f"Torque is lowest at {where}; below it torque rises as the drive slows, so stick-slip is possible"


def directions_of(curve: FittedFriction) -> str:
    """Return whether the directions differ, and what else would explain it."""
    test = curve.directions
    if test is None:
        return ""
    p = f"p < {_SMALL_P:g}" if test.p_value < _SMALL_P else f"p = {test.p_value:.2g}"
    factor, unit = _torque_unit(curve)
    if not test.differ and test.offset is not None:
        return (
            f"One law describes both directions beside an offset of {factor * test.offset:.3g} {unit}, which "
            "is an error of the torque zero or half the difference in T_C: record a standstill to tell"
        )
    if not test.differ:
        return f"One law describes both directions ({p})"
    said = f"The directions differ ({p})"
    if test.offset is None:
        return said
    off = f"A torque zero off by {factor * test.offset:.3g} {unit}"
    return f"{said}. {off} would explain the difference in T_C: record a standstill to exclude it"


def _torque_unit(curve: FittedFriction) -> tuple[float, str]:
    """Factor from N m, and the unit in which torques read best."""
    torques = (laws.COULOMB, laws.STATIC)
    largest = max(each.estimate.value for each in curve.parameters if each.name in torques)
    return (1.0, "N·m") if largest >= _LARGE else (1e3, "mN·m")


def _speed(speed: float) -> str:
    return f"{rpm(speed):.3g} rpm"


def _speed_estimate(known: Estimate) -> str:
    if not known.estimable:
        return f"{_speed(known.value)} (interval not known)"
    return rounded(rpm(known.value), rpm(known.low), rpm(known.high), "rpm")
