"""Units of the variables as FMI defines them: exponents of the base units, and units to show."""

from __future__ import annotations

import math
from dataclasses import dataclass
from xml.etree import ElementTree as Xml

from hersey.units import ZERO_CELSIUS


@dataclass(frozen=True)
class Unit:
    """A unit of SI: exponents by base unit, and that in which people read it, ``factor * value + offset``."""

    name: str
    exponents: dict[str, int]
    shown: str = ""
    factor: float = 1.0
    offset: float = 0.0


_UNITS = {
    unit.name: unit
    for unit in (
        Unit("1", {}),
        Unit("s", {"s": 1}, "ms", 1e3),
        Unit("m", {"m": 1}, "mm", 1e3),
        Unit("kg", {"kg": 1}),
        Unit("K", {"K": 1}, "degC", 1.0, -ZERO_CELSIUS),
        Unit("1/K", {"K": -1}, "%/K", 100.0),
        Unit("rad", {"rad": 1}, "deg", 180.0 / math.pi),
        Unit("rad/s", {"rad": 1, "s": -1}, "rpm", 30.0 / math.pi),
        Unit("m/s", {"m": 1, "s": -1}, "mm/s", 1e3),
        Unit("N", {"kg": 1, "m": 1, "s": -2}),
        Unit("N.m", {"kg": 1, "m": 2, "s": -2}, "mN.m", 1e3),
        Unit("N/m", {"kg": 1, "s": -2}, "N/mm", 1e-3),
        Unit("N.s/m", {"kg": 1, "s": -1}),
        Unit("W", {"kg": 1, "m": 2, "s": -3}),
        Unit("J", {"kg": 1, "m": 2, "s": -2}),
        Unit("Pa.s", {"kg": 1, "m": -1, "s": -1}, "mPa.s", 1e3),
    )
}
#: Shown as they are, for the other is rarely meant: a time, and a torque.
_AS_THEY_ARE = {"s", "N.m"}


def shown(unit: str) -> str:
    """Return the unit in which a tool shows values of a unit first; empty if in that itself."""
    return "" if unit in _AS_THEY_ARE else _UNITS[unit].shown


def as_shown(unit: str, value: float) -> str:
    """Return a value of a unit as people read it, with the unit in which they do."""
    name, of = shown(unit), _UNITS[unit]
    text = f"{of.factor * value + of.offset:.6g} {name}" if name else f"{value:.6g} {unit}"
    return text.removesuffix(" 1")


def unit_definitions(units: set[str]) -> Xml.Element:
    """Return ``UnitDefinitions`` of these units, the same in FMI 2.0 and 3.0."""
    top = Xml.Element("UnitDefinitions")
    for name in sorted(units):
        unit = _UNITS[name]
        element = Xml.SubElement(top, "Unit", name=name)
        Xml.SubElement(element, "BaseUnit", {base: str(power) for base, power in unit.exponents.items()})
        if unit.shown:
            scale = {"factor": repr(unit.factor)} | ({"offset": repr(unit.offset)} if unit.offset else {})
            Xml.SubElement(element, "DisplayUnit", {"name": unit.shown, **scale})
    return top
