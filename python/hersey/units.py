"""The one unit registry: units are read and written at the door, everything inside is SI."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

import pint

from hersey.errors import UnitError

registry: pint.UnitRegistry[float] = pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)
registry.define("rev = revolution")

#: SI unit and an example of each kind of quantity that a log or a command carries.
KINDS: dict[str, tuple[str, str]] = {
    "time": ("s", "s"),
    "torque": ("N*m", "N*m"),
    "speed": ("rad/s", "rpm"),
    "temperature": ("K", "degC"),
    "stiffness": ("N/m", "N/m"),
    "mass": ("kg", "kg"),
    "length": ("m", "mm"),
    "belt speed": ("m/s", "mm/s"),
}

# Spellings of the field that pint does not know, or reads as something else.
_SPELLINGS = {
    r"°\s*C|deg\s*C|℃|C|Celsius": "degC",
    r"°\s*F|deg\s*F|℉|F|Fahrenheit": "degF",
    r"°\s*K|deg\s*K": "K",
    r"oz[f]?[\s.*·-]?in|in[\s.*·-]?oz[f]?": "ozf*in",
    r"lb[f]?[\s.*·-]?in|in[\s.*·-]?lb[f]?": "lbf*in",
    r"lb[f]?[\s.*·-]?ft|ft[\s.*·-]?lb[f]?": "lbf*ft",
    r"U/min|r/min|rev/min|1/min|min\^?-1|min⁻¹": "rpm",
    r"([mcknuµ]?)N[\s.·-]?([mc]?m)": r"\1N*\2",
    r"sec": "s",
}
# Powers that no unit has, and that would take for ever to evaluate.
_ABSURD = re.compile(r".{41,}|.*(\*\*|\^)\s*(-?\d{2,}|\(|-?\d+\s*(\*\*|\^))", re.DOTALL)
# A reciprocal time could be revolutions or radians: a factor of 2 pi that nobody would notice.
_AMBIGUOUS_SPEED = re.compile(r"[kM]?Hz|1/s(ec)?|s\^?-1|s⁻¹")


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
    UnitError
        If the unit is unknown, ambiguous, or not one of the kind.
    """
    si, example = KINDS[kind]
    text = unit.strip()
    if kind == "speed" and _AMBIGUOUS_SPEED.fullmatch(text):
        raise UnitError(f"unit '{unit}' of a speed could count revolutions or radians: write rev/s or rad/s")
    for spelling, standard in _SPELLINGS.items():
        if re.fullmatch(spelling, text):
            text = re.sub(spelling, standard, text)
            break
    try:
        if _ABSURD.match(text):
            raise ValueError(text)
        parsed = registry.parse_expression(re.sub(r"(?<=[A-Za-z])[.·](?=[A-Za-z])", "*", text))
    except Exception as error:  # pint raises many kinds, from its tokenizer too
        raise UnitError(f"unknown unit '{unit}': write one such as {example}") from error
    if not isinstance(parsed, registry.Quantity):
        raise UnitError(f"'{unit}' is no unit of {kind}: write one such as {example}")
    if parsed.magnitude == 1 and kind == "temperature" and not parsed.check("[temperature]"):
        raise _wrong_dimension(kind, unit, example)
    try:
        if kind == "temperature":
            zero, far = (registry.Quantity(x, parsed.units).to(si).magnitude for x in (0.0, 1e6))
            return Conversion(unit, (far - zero) / 1e6, zero)
        return Conversion(unit, float(parsed.to(si).magnitude), 0.0)
    except pint.DimensionalityError as error:
        raise _wrong_dimension(kind, unit, example) from error


def _wrong_dimension(kind: str, unit: str, example: str) -> UnitError:
    if unit.strip() in ("%", "percent") and kind == "torque":
        return UnitError(
            "unit '%' of a torque needs the torque that 100 % stands for: --torque-unit '9.84 mN*m / 100'"
        )
    return UnitError(f"unit '{unit}' is not a unit of {kind}: write one such as {example}")


def parse(kind: str, text: str) -> float:
    """Return the SI value of a quantity written with its unit, such as ``"25 rpm"``.

    Raises
    ------
    UnitError
        If there is no number, no unit, or a unit of another kind.
    """
    match = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*", text)
    example = KINDS[kind][1]
    if match is None or not match[2]:
        raise UnitError(f"'{text}' needs a number and a unit of {kind}, such as '1 {example}'")
    try:
        number = float(match[1])
    except ValueError:
        raise UnitError(f"'{match[1]}' in '{text}' is not a number") from None
    line = conversion(kind, match[2])
    return line.scale * number + line.offset


def convert(value: float, si: str, unit: str) -> float:
    """Return an SI value (given its SI unit) in ``unit``."""
    return float(registry.Quantity(value, si).to(unit).magnitude)
