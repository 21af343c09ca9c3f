"""Kinds of quantities: the SI unit of each, units as people write them, and what a wrong one should be."""

from __future__ import annotations

import re

from hersey.errors import WrongKindError
from hersey.units.pint_units import pint_unit, registry
from hersey.units.table import from_table

#: Of each kind of quantity that a log or a command carries: the SI unit, an example, and units as people
#: write them, which one that cannot be read may have been meant for.
_QUANTITIES: dict[str, tuple[str, str, str]] = {
    "time": ("s", "s", "s ms us min h"),
    "torque": ("N*m", "N*m", "N*m mN*m N*mm N*cm kN*m Nm mNm Nmm Ncm ozf*in lbf*in lbf*ft kgf*cm gf*cm"),
    "speed": ("rad/s", "rpm", "rpm rad/s rev/s rev/min deg/s"),
    "angle": ("rad", "deg", "rad deg rev"),
    "motor constant": ("N*m/A", "N*m/A", "N*m/A mN*m/A"),
    "temperature": ("K", "degC", "degC degF K"),
    "stiffness": ("N/m", "N/mm", "N/m N/mm kN/m N/um lbf/in ozf/in"),
    "mass": ("kg", "kg", "kg g mg lb oz slug"),
    "length": ("m", "mm", "m mm cm um nm inch ft mil"),
    "belt speed": ("m/s", "mm/s", "m/s mm/s cm/s um/s in/s m/min mm/min ft/min"),
    "force": ("N", "N", "N mN kN lbf ozf kgf gf"),
    "acceleration": ("m/s^2", "mm/s^2", "m/s^2 mm/s^2 in/s^2"),
    "translational damping": ("N*s/m", "N*s/m", "N*s/m N*s/mm lbf*s/in"),
    "rotational damping": ("N*m*s/rad", "mN*m*s/rad", "N*m*s/rad mN*m*s/rad mN*m/rpm"),
    "pressure": ("Pa", "MPa", "Pa kPa MPa GPa bar mbar psi N/mm^2"),
    "viscosity": ("Pa*s", "mPa*s", "Pa*s mPa*s cP P reyn"),
    "kinematic viscosity": ("m^2/s", "mm^2/s", "m^2/s mm^2/s cSt St"),
    "density": ("kg/m^3", "g/cm^3", "kg/m^3 g/cm^3"),
    "pressure-viscosity coefficient": ("Pa^-1", "GPa^-1", "Pa^-1 GPa^-1 1/GPa"),
    "thermal conductivity": ("W/m/K", "W/m/K", "W/m/K mW/m/K"),
    "power": ("W", "W", "W kW mW"),
    "energy": ("J", "J", "J kJ mJ Wh"),
    "heat capacity": ("J/K", "J/K", "J/K kJ/K"),
    "thermal conductance": ("W/K", "W/K", "W/K mW/K"),
    "torsional stiffness": ("N*m/rad", "N*m/rad", "N*m/rad N*m/deg mN*m/rad"),
    "moment of inertia": ("kg*m^2", "kg*m^2", "kg*m^2 g*cm^2 kg*cm^2"),
    "load per length": ("N/m", "N/m", "N/m N/mm kN/m lbf/in"),
    "stiffness per weight": ("m^-1", "m^-1", "m^-1 mm^-1 in^-1"),
    "mass per weight": ("s^2/m", "s^2/m", "s^2/m s^2/mm s^2/in"),
    "friction coefficient": ("1", "1", "1"),
}
#: SI unit and an example of each kind.
KINDS = {kind: (si, example) for kind, (si, example, _) in _QUANTITIES.items()}
_USUAL = {kind: usual for kind, (_, _, usual) in _QUANTITIES.items()}
#: Of kinds that are mistaken for another: SI unit of the other, what it is, and how to get from it.
_MISTAKEN = {
    "heat capacity": (("J/kg/K", "specific heat", "multiply by the mass: 1500 J/kg/K x 0.1 kg = '150 J/K'"),),
    "thermal conductance": (
        ("W/m^2/K", "heat transfer coefficient", "multiply by the area: 10 W/m^2/K x 0.05 m^2 = '0.5 W/K'"),
        ("W/m/K", "thermal conductivity", "multiply by area / thickness: 0.2 W/m/K x 0.5 m = '0.1 W/K'"),
        ("K/W", "thermal resistance", "write its inverse: 1 / 2 K/W = '0.5 W/K'"),
    ),
    "belt speed": (
        ("rad/s", "speed of rotation", "multiply by the radius: 10 rad/s x 15 mm = '150 mm/s'"),
    ),
    "speed": (
        ("m/s", "sliding speed", "divide by the radius: 150 mm/s / 15 mm = '10 rad/s'"),
    ),
    "power": (("W/m^2", "heat flux", "multiply by the area: 18000 W/m^2 x 0.05 m^2 = '900 W'"),),
}  # fmt: skip
#: How alike (`difflib`) a usual unit must be to an unknown one, and to one of another kind, to be proposed.
_ALIKE, _ALIKE_OF_ANOTHER_KIND = 0.6, 0.8


def _alike(text: str, si: str) -> bool:
    """Whether two units have one dimension, but for angles; pint, which loads slowly, is asked last."""
    line, standard = from_table(text), from_table(si)
    if line and standard:
        return line[2][:-1] == standard[2][:-1]
    parsed = pint_unit(text)
    return parsed is not None and bool(parsed.dimensionality == registry.parse_units(si).dimensionality)


def named(kind: str) -> str:
    """Return what people call a kind of quantity."""
    return "sliding speed" if kind == "belt speed" else kind


def wrong_kind(kind: str, unit: str, text: str) -> WrongKindError:
    """Return the error of a unit of another kind, which is written ``text`` without its factor."""
    for si, what, how in _MISTAKEN.get(kind, ()):
        if _alike(text, si):
            return WrongKindError(f"unit '{unit}' is that of a {what}, not of a {named(kind)}", remedy=how)
    way_out = meant(kind, unit, _ALIKE_OF_ANOTHER_KIND)
    return WrongKindError(f"unit '{unit}' is not a unit of {named(kind)}", remedy=way_out)


def meant(kind: str, unit: str, alike: float = _ALIKE) -> str:
    """Return the way out: the usual unit of the kind that the one written is nearest to, or an example."""
    near = nearest_unit(kind, unit, alike)
    return f"did you mean {near}?" if near else f"write one such as {KINDS[kind][1]}"


def nearest_unit(kind: str, unit: str, alike: float = _ALIKE) -> str:
    """Return the usual unit of a kind that one with a slip is nearest to, or an empty text."""
    from difflib import SequenceMatcher

    usual = _USUAL[kind].split()
    ratios = [SequenceMatcher(None, _folded(each), _folded(unit)).ratio() for each in usual]
    most = max(ratios)
    return usual[ratios.index(most)] if most >= alike else ""


def _folded(unit: str) -> str:
    return re.sub(r"[\s.·]", "*", unit.strip()).lower()
