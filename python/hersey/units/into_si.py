"""From a unit to SI and back."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, TypeVar

from hersey.errors import UnitError, WrongKindError
from hersey.units.kinds import KINDS, meant, wrong_kind
from hersey.units.pint_units import pint_unit, registry
from hersey.units.spelling import COUNTS, LONGEST_UNIT, of_encoder, split_factor
from hersey.units.table import ZERO_CELSIUS, from_table

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


#: One number, or an array of them.
Number = TypeVar("Number", float, "NDArray[np.float64]")
_ENERGY_KINDS = frozenset(("power", "energy", "heat capacity", "thermal conductance", "thermal conductivity"))
_ANGLES = re.compile(r"radian|degree|rev|turn|cycle|arc")
#: The full value of a torque without dimension, and how to state it.
_AT_FULL = {"percent": ("100 %", "9.84 mN*m / 100"), "permille": ("1000 ‰", "0.48 N*m / 1000")}
_ENERGIES = re.compile(r"joule|watt|volt|calorie|erg|british")


@dataclass(frozen=True)
class Conversion:
    """A unit as written, and the line ``si = scale * value + offset`` that leads to SI."""

    unit: str
    scale: float
    offset: float


@lru_cache(maxsize=256)
def conversion(kind: str, unit: str) -> Conversion:
    """Return how numbers in ``unit`` become SI numbers of ``kind`` (a key of `KINDS`).

    ``unit`` may carry a factor (``"9.84 mN*m / 100"`` for percent of a nominal torque).

    Raises
    ------
    WrongKindError, UnitError
        If the unit is one of another kind; if it is unknown, or could be read in two ways.
    """
    si, example = KINDS[kind]
    if len(unit) > LONGEST_UNIT:
        shown = f"'{unit[:20]}...' ({len(unit)} characters, at most {LONGEST_UNIT} are allowed)"
        raise UnitError(f"unknown unit {shown}", remedy=f"write one such as {example}")
    if kind == "speed" and (counted := of_encoder(unit)):
        raise WrongKindError(
            f"unit '{unit}' of a speed needs the counts of one revolution",
            remedy=f"write {counted}, with your value instead of {COUNTS}",
        )
    factor, text = split_factor(unit.strip(), unit, kind)
    line, standard = (from_table(each, energy=kind in _ENERGY_KINDS) for each in (text, si))
    if line and standard and line[2] == standard[2]:
        scale, zero = line[:2]
    elif line and standard and line[2][:-1] != standard[2][:-1]:
        raise wrong_kind(kind, unit, text)
    else:  # a unit beside the table, or one that differs by an angle, which need not matter
        scale, zero = _from_registry(kind, text, unit)
    if not 1e-15 < abs(factor * scale) < 1e15:
        raise UnitError(f"the factor in unit '{unit}' is impossible")
    return Conversion(unit, factor * scale, zero)


def _from_registry(kind: str, text: str, unit: str) -> tuple[float, float]:
    """Scale and offset of any unit that pint knows."""
    si = KINDS[kind][0]
    parsed = pint_unit(text)
    if parsed is None:
        raise UnitError(f"unknown unit '{unit}'", remedy=meant(kind, unit))
    names = " ".join(str(name) for name in parsed._units)
    if kind == "speed" and parsed.dimensionality == {"[time]": -1} and not _ANGLES.search(names):
        raise UnitError(
            f"unit '{unit}' of a speed could mean revolutions or radians",
            remedy="write rev/s or rad/s; for the frequency of an inverter and 2 pole pairs, rev/s/2",
        )
    if parsed.dimensionality != registry.parse_units(si).dimensionality or (
        kind == "torque" and _ENERGIES.search(names)
    ):
        if kind == "torque" and names in _AT_FULL:
            full, example = _AT_FULL[names]
            raise WrongKindError(
                f"unit '{unit}' of a torque needs the torque at {full}",
                remedy=f"write it as '{example}', with your value",
            )
        raise wrong_kind(kind, unit, text)
    if "delta_" in names:
        raise UnitError(f"unit '{unit}' is a temperature difference. Write degC or K")
    zero, far = (float(registry.Quantity(x, parsed).to(si).magnitude) for x in (0.0, 1e6))
    return (far - zero) / 1e6, zero


def convert(value: float, si: str, unit: str) -> float:
    """Return an SI value (given its SI unit) in ``unit``."""
    given, wanted = (from_table(each, energy=True) for each in (si, unit))
    if given is None or wanted is None or given[2] != wanted[2]:
        return float(registry.Quantity(value, si).to(unit).magnitude)
    return float((value * given[0] + given[1] - wanted[1]) / wanted[0])


#: Revolutions per minute of one radian per second.
_RPM = convert(1.0, "rad/s", "rpm")


def rpm(speed: Number) -> Number:
    """Return speeds in rad/s as revolutions per minute, for people."""
    return speed * _RPM


def celsius(kelvin: Number) -> Number:
    """Return temperatures in K as degC, for people."""
    return kelvin - ZERO_CELSIUS
