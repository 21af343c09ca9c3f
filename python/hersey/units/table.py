"""Units of drives in a table, so that reading them loads no registry.

A test holds the table to the definitions of pint.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from typing import cast

#: 0 degC, K.
ZERO_CELSIUS = 273.15

#: Exponents of m, kg, s, K and rad. The angle counts here, so that 1/s is no speed of a drive.
_Dimension = tuple[int, int, int, int, int]
_NONE: _Dimension = (0, 0, 0, 0, 0)
_LENGTH, _MASS, _TIME = (1, 0, 0, 0, 0), (0, 1, 0, 0, 0), (0, 0, 1, 0, 0)
_TEMPERATURE, _ANGLE = (0, 0, 0, 1, 0), (0, 0, 0, 0, 1)
_FORCE, _PRESSURE, _VISCOSITY = (1, 1, -2, 0, 0), (-1, 1, -2, 0, 0), (-1, 1, -1, 0, 0)
_POUND, _INCH, _GRAVITY = Fraction("0.45359237"), Fraction("0.0254"), Fraction("9.80665")
_PSI, _TURN = _POUND * _GRAVITY / _INCH**2, 2 * Fraction(math.pi)

#: Units of one dimension: value in SI, exact, by name.
_Units = dict[_Dimension, dict[str, Fraction | int]]
#: Units of drives that take SI prefixes, and those that take none.
_PREFIXED: _Units = {
    _LENGTH: {"m": 1}, _MASS: {"g": Fraction(1, 1000)}, _TIME: {"s": 1}, _ANGLE: {"rad": 1}, _FORCE: {"N": 1},
    _PRESSURE: {"Pa": 1, "bar": 100_000}, _VISCOSITY: {"P": Fraction(1, 10)},
    (2, 0, -1, 0, 0): {"St": Fraction(1, 10_000)},
}  # fmt: skip
#: Units of energy, known only where an energy is asked for: none is one of torque.
_OF_ENERGY: _Units = {(2, 1, -2, 0, 0): {"J": 1}, (2, 1, -3, 0, 0): {"W": 1}}
_UNPREFIXED: _Units = {
    _TIME: {"min": 60, "h": 3600}, _ANGLE: {"deg": _TURN / 360, "rev": _TURN},
    (0, 0, -1, 0, 1): {"rpm": _TURN / 60}, _TEMPERATURE: {"K": 1},
    _LENGTH: {"inch": _INCH, "in": _INCH, "ft": 12 * _INCH, "thou": _INCH / 1000},
    _MASS: {"lb": _POUND, "oz": _POUND / 16, "slug": _POUND * _GRAVITY / (12 * _INCH)},
    _FORCE: {"lbf": _POUND * _GRAVITY, "ozf": _POUND / 16 * _GRAVITY, "kgf": _GRAVITY, "gf": _GRAVITY / 1000},
    _PRESSURE: {"psi": _PSI}, _VISCOSITY: {"reyn": _PSI},
}  # fmt: skip
_PREFIXES = {"G": 9, "M": 6, "k": 3, "": 0, "d": -1, "c": -2, "m": -3, "u": -6, "µ": -6, "μ": -6, "n": -9}


def _table(units: _Units, prefixes: Mapping[str, int]) -> dict[str, tuple[Fraction, _Dimension]]:
    """Value and dimension of each unit with each prefix."""
    return {
        prefix + name: (Fraction(10) ** power * value, dimension)
        for prefix, power in prefixes.items()
        for dimension, values in units.items()
        for name, value in values.items()
    }


#: Value in SI and dimension of each unit by name.
TABLE = _table(_PREFIXED, _PREFIXES) | _table(_UNPREFIXED, {"": 0})
_TABLE_WITH_ENERGY = TABLE | _table(_OF_ENERGY, _PREFIXES)
#: Scales of temperature that do not start at absolute zero: K = scale * value + offset.
OFFSETS = {
    "degC": (1.0, ZERO_CELSIUS, _TEMPERATURE),
    "degF": (5 / 9, ZERO_CELSIUS - 32 * 5 / 9, _TEMPERATURE),
}

_TERM = re.compile(r"([*/]?)([A-Za-zµμ]+|1)(?:(?:\*\*|\^)(-?[1-4]))?")


@lru_cache(maxsize=256)
def from_table(text: str, *, energy: bool = False) -> tuple[float, float, _Dimension] | None:
    """Return scale, offset and dimension of a product of units of the table, as ``N*m``, or None."""
    table = _TABLE_WITH_ENERGY if energy else TABLE
    if text in OFFSETS or not text:
        return OFFSETS.get(text)
    scale, dimension, end = Fraction(1), _NONE, 0
    for match in _TERM.finditer(text):
        sign, name, power = match[1], match[2], int(match[3] or 1)
        if match.start() != end or bool(sign) == (end == 0) or (name != "1" and name not in table):
            return None
        value, of_unit = (Fraction(1), _NONE) if name == "1" else table[name]
        power = -power if sign == "/" else power
        scale *= value**power
        dimension = cast("_Dimension", tuple(a + power * b for a, b in zip(dimension, of_unit, strict=True)))
        end = match.end()
    if end < len(text) or not 1e-99 < scale < 1e99:
        return None
    return float(scale), 0.0, dimension
