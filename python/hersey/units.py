"""The one door for units: they are read and written here, everything inside is SI.

The units in which logs and machine files of drives are written stand in a table, so that reading one loads no
registry. Pint reads every other unit, and says what is wrong with one that misleads; a test holds the table
to its definitions.
"""

from __future__ import annotations

import inspect
import math
import re
import sys
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache, wraps
from typing import TYPE_CHECKING, Any, TypeVar, cast

from hersey.arguments.door import ROLL_RADIUS, Door, Keys, Words
from hersey.arguments.frozen import explained
from hersey.arguments.numbers import duration, numbers
from hersey.errors import ParameterError, PlausibilityWarning, UnitError, WrongKindError

if TYPE_CHECKING:
    import numpy as np
    import pint
    from numpy.typing import NDArray

F = TypeVar("F", bound=Callable[..., Any])
#: A key of `KINDS`, or several where an argument may be one of them.
Kind = str | tuple[str, ...]


class _OnFirstUse:
    """The registry of pint, which takes longer to import and fill than many a command to run."""

    def __getattr__(self, name: str) -> Any:
        return getattr(_full_registry(), name)


@cache
def _full_registry() -> pint.UnitRegistry[float]:
    import pint

    full: pint.UnitRegistry[float] = pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)
    full.define("rev = revolution")
    return full


registry = cast("pint.UnitRegistry[float]", _OnFirstUse())
#: One number, or an array of them.
Number = TypeVar("Number", float, "NDArray[np.float64]")
#: 0 degC, K.
ZERO_CELSIUS = 273.15
#: Of each kind of quantity that a log or a command carries: the SI unit, an example, and units as people
#: write them, which one that cannot be read may have been meant for.
_QUANTITIES: dict[str, tuple[str, str, str]] = {
    "time": ("s", "s", "s ms us min h"),
    "torque": ("N*m", "N*m", "N*m mN*m N*mm N*cm kN*m Nm mNm Nmm Ncm ozf*in lbf*in lbf*ft kgf*cm gf*cm"),
    "speed": ("rad/s", "rpm", "rpm rad/s rev/s rev/min deg/s"),
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
        ("rad/s", "speed of rotation", "multiply by the radius of the roll: 10 rad/s x 15 mm = '150 mm/s'"),
    ),
    "speed": (
        ("m/s", "belt speed", "divide by the radius of the roll: 150 mm/s / 15 mm = '10 rad/s'"),
    ),
    "power": (("W/m^2", "heat flux", "multiply by the area: 18000 W/m^2 x 0.05 m^2 = '900 W'"),),
}  # fmt: skip
#: How alike (`difflib`) a usual unit must be to an unknown one, and to one of another kind, to be proposed.
_ALIKE, _ALIKE_OF_ANOTHER_KIND = 0.6, 0.8
#: Counts of one revolution of an encoder, as an example.
COUNTS = 2000

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
_ENERGY_KINDS = frozenset(("power", "energy", "heat capacity", "thermal conductance", "thermal conductivity"))
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


_TABLE = _table(_PREFIXED, _PREFIXES) | _table(_UNPREFIXED, {"": 0})
_TABLE_WITH_ENERGY = _TABLE | _table(_OF_ENERGY, _PREFIXES)
#: Scales of temperature that do not start at absolute zero: K = scale * value + offset.
_OFFSETS = {
    "degC": (1.0, ZERO_CELSIUS, _TEMPERATURE),
    "degF": (5 / 9, ZERO_CELSIUS - 32 * 5 / 9, _TEMPERATURE),
}

# Spellings of the field that pint does not know, or reads as something else.
_SPELLINGS = (
    (r"(?i:(°|º|deg(\.|rees?)?)\s*C|℃|celsius)|C", "degC"),
    (r"(?i:(°|º|deg(\.|rees?)?)\s*F|℉|fahrenheit)|F", "degF"),
    (r"°\s*K|deg\s*K|(?i:kelvin)", "K"),
    (r"(?i:ozf?s?[\s.*·-]?in|in[\s.*·-]?ozf?s?)", "ozf*in"),
    (r"(?i:lbf?s?[\s.*·-]?in|in[\s.*·-]?lbf?s?)", "lbf*in"),
    (r"(?i:lbf?s?[\s.*·-]?ft|ft[\s.*·-]?lbf?s?)", "lbf*ft"),
    (r"(?i:rpm|(U|r|rev|1)?\s*/\s*min|min(\^|\*\*)?\(?-1\)?|min⁻¹)", "rpm"),
    (r"U/s|r/s", "rev/s"),
    (r"rad\s+s(\^|\*\*)?-1|rad\s+s⁻¹", "rad/s"),
    (r"([mcdknuµμ]?)N[\s.·*-]?([mc]?m)((?:[\s.·*]s)?/[A-Za-z°]+)?", r"\1N*\2\3"),
    (r"(?i:sec)", "s"),
    (r"mils?", "thou"),
)
_ALPHABET = re.compile(r"[A-Za-z0-9_°ºµμΩ%℃℉\s.·*/^()⁻¹²³-]{0,60}")
#: Characters of a unit, and of a quantity, at the most: the patterns below take longer than linear.
_LONGEST_UNIT, _LONGEST_QUANTITY = 100, 160
_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_FACTORED = re.compile(rf"\s*({_NUMBER})?\s*\*?\s*([A-Za-z°ºµμ%℃℉/(1].*?)\s*(?:/\s*({_NUMBER}))?\s*")
#: A factor of which a reader cannot tell whether it multiplies the unit or has multiplied the numbers.
_COUNT = rf"10\^[-+]?[0-9]{{1,2}}|{_NUMBER}"
_TIMES = re.compile(rf"[x\u00d7]\s*({_COUNT})\s*([A-Za-z°%].*)|([A-Za-z°%].*?)\s*[x\u00d7]\s*({_COUNT})")
_POWER = re.compile(r"(?<=[A-Za-z)])(\*\*|\^)-?[1-4](?![\d.^]|\*\*)")
_TERM = re.compile(r"([*/]?)([A-Za-zµμ]+|1)(?:(?:\*\*|\^)(-?[1-4]))?")
#: Counts of an encoder in a time, or alone.
_COUNTS = re.compile(
    r"(?:counts?|cn?ts?|puls(?:es?)?|ticks?|in[ck]r?|increments?|inkremente?|imp|impulses?|steps?|[cp]ps)"
    r"(?:\s*/\s*(s|ms|sec|second|min))?",
    re.IGNORECASE,
)
#: Units of a frequency as people write them, in lower case, and each in Hz.
_HERTZ = {"hz": 1.0, "hertz": 1.0, "khz": 1e3, "mhz": 1e6, "sps": 1.0}
_ANGLES = re.compile(r"radian|degree|rev|turn|cycle|arc")
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
    if len(unit) > _LONGEST_UNIT:
        shown = f"'{unit[:20]}...' ({len(unit)} characters, at most {_LONGEST_UNIT} are allowed)"
        raise UnitError(f"unknown unit {shown}", remedy=f"write one such as {example}")
    if kind == "speed" and (counted := of_encoder(unit)):
        raise WrongKindError(
            f"unit '{unit}' of a speed needs the counts of one revolution",
            remedy=f"write {counted}, with your value instead of {COUNTS}",
        )
    factor, text = _split_factor(unit.strip(), unit, kind)
    line, standard = (_from_table(each, energy=kind in _ENERGY_KINDS) for each in (text, si))
    if line and standard and line[2] == standard[2]:
        scale, zero = line[:2]
    elif line and standard and line[2][:-1] != standard[2][:-1]:
        raise _wrong_kind(kind, unit, text)
    else:  # a unit beside the table, or one that differs by an angle, which need not matter
        scale, zero = _from_registry(kind, text, unit)
    if not 1e-15 < abs(factor * scale) < 1e15:
        raise UnitError(f"the factor in unit '{unit}' is impossible")
    return Conversion(unit, factor * scale, zero)


def of_encoder(unit: str) -> str:
    """Return the unit of a speed in counts of an encoder, `COUNTS` a revolution; nothing for any other unit.

    Examples
    --------
    >>> of_encoder("counts/s"), of_encoder("inc/min"), of_encoder("rpm")
    ('rev/s/2000', 'rev/min/2000', '')
    """
    match = _COUNTS.fullmatch(unit.strip())
    return f"rev/{(match[1] or 's').lower()}/{COUNTS}" if match else ""


@lru_cache(maxsize=256)
def _from_table(text: str, *, energy: bool = False) -> tuple[float, float, _Dimension] | None:
    """Scale, offset and dimension of a product of units of the table, as ``N*m``; None for any other."""
    table = _TABLE_WITH_ENERGY if energy else _TABLE
    if text in _OFFSETS or not text:
        return _OFFSETS.get(text)
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


def _from_registry(kind: str, text: str, unit: str) -> tuple[float, float]:
    """Scale and offset of any unit that pint knows."""
    si = KINDS[kind][0]
    parsed = _parsed(text)
    if parsed is None:
        raise UnitError(f"unknown unit '{unit}'", remedy=_meant(kind, unit))
    names = " ".join(str(name) for name in parsed._units)
    if kind == "speed" and parsed.dimensionality == {"[time]": -1} and not _ANGLES.search(names):
        raise UnitError(
            f"unit '{unit}' of a speed could mean revolutions or radians",
            remedy="write rev/s or rad/s; for the frequency of an inverter and 2 pole pairs, rev/s/2",
        )
    if parsed.dimensionality != registry.parse_units(si).dimensionality or (
        kind == "torque" and _ENERGIES.search(names)
    ):
        if unit.strip() in ("%", "percent") and kind == "torque":
            raise WrongKindError(
                "unit '%' of a torque needs the torque at 100 %",
                remedy="write it as '9.84 mN*m / 100', with your value",
            )
        raise _wrong_kind(kind, unit, text)
    if "delta_" in names:
        raise UnitError(f"unit '{unit}' is a temperature difference. Write degC or K")
    zero, far = (float(registry.Quantity(x, parsed).to(si).magnitude) for x in (0.0, 1e6))
    return (far - zero) / 1e6, zero


@lru_cache(maxsize=4096)
def _parsed(text: str) -> Any:
    """The unit of pint, or None if it knows none such."""
    try:
        return registry.parse_units(text)
    except Exception:  # pint raises many kinds, from its tokenizer too
        return None


def _alike(text: str, si: str) -> bool:
    """Whether two units have one dimension, but for angles; pint, which loads slowly, is asked last."""
    line, standard = _from_table(text), _from_table(si)
    if line and standard:
        return line[2][:-1] == standard[2][:-1]
    parsed = _parsed(text)
    return parsed is not None and bool(parsed.dimensionality == registry.parse_units(si).dimensionality)


def _wrong_kind(kind: str, unit: str, text: str) -> WrongKindError:
    for si, what, how in _MISTAKEN.get(kind, ()):
        if _alike(text, si):
            return WrongKindError(f"unit '{unit}' is that of a {what}, not of a {kind}", remedy=how)
    meant = _meant(kind, unit, _ALIKE_OF_ANOTHER_KIND)
    return WrongKindError(f"unit '{unit}' is not a unit of {kind}", remedy=meant)


def _meant(kind: str, unit: str, alike: float = _ALIKE) -> str:
    """The way out: the usual unit of the kind that the one written is nearest to, or an example."""
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


def _split_factor(text: str, unit: str, kind: str) -> tuple[float, str]:
    """Factor and plain unit; what is left holds no digits but small powers, so it cannot run for ever."""
    if times := _TIMES.fullmatch(text):
        number, plain = (times[1], times[2]) if times[1] else (times[4], times[3])
        number = number.replace("10^", "1e")
        raise UnitError(
            f"unit '{unit}' is ambiguous. Write '{number} {plain}' if 1 in the file means {number} "
            f"{plain}, or '{plain} / {number}' if the numbers are {number} times too large"
        )
    match = _FACTORED.fullmatch(text)
    if match is None or _ALPHABET.fullmatch(re.sub(_NUMBER, "", text)) is None:
        if not text:
            raise UnitError("the unit is missing", remedy=f"write one such as {KINDS[kind][1]}")
        raise UnitError(f"unknown unit '{unit[:40]}'", remedy=_meant(kind, unit))
    factor = float(match[1] or 1.0) / (float(match[3] or 1.0) or math.nan)
    plain = f"1{match[2]}" if match[2].startswith("/") else match[2]
    if plain == "1":
        return factor, plain
    for spelling, standard in _SPELLINGS:
        if re.fullmatch(spelling, plain):
            return factor, re.sub(f"^(?:{spelling})$", standard, plain)
    plain = re.sub(r"(?<=[A-Za-z])[.·](?=[A-Za-z])", "*", plain)
    if re.search(r"\d", _POWER.sub("", re.sub(r"^1\s*/", "/", plain))):
        raise UnitError(f"unknown unit '{unit}'", remedy=_meant(kind, unit))
    return factor, plain


def without_factor(unit: str) -> str:
    """Return a unit without the number that multiplies or divides it; one that cannot be read as it is.

    Examples
    --------
    >>> without_factor("9.84 mN*m / 100"), without_factor("-1 rpm"), without_factor("1/min")
    ('mN*m', 'rpm', '1/min')
    """
    match = _FACTORED.fullmatch(unit) if len(unit) <= _LONGEST_UNIT else None
    if match is None or match[2].startswith(("/", "1")):
        return unit
    return match[2]


def parse(kind: str, text: str) -> float:
    """Return the SI value of a quantity written with its unit, such as ``"25 rpm"``.

    Raises
    ------
    UnitError
        If there is no number, no unit, or a unit of another kind.
    """
    example = KINDS[kind][1]
    if len(text) > _LONGEST_QUANTITY:
        shown = f"'{text[:20]}...' has {len(text)} characters; at most {_LONGEST_QUANTITY} are allowed"
        raise UnitError(f"{shown}. Write a number and a unit of {kind}, e.g. '1 {example}'")
    match = re.fullmatch(rf"\s*({_NUMBER})\s*([A-Za-z°ºµμ%℃℉].*?)\s*", text)
    if match is None:
        raise UnitError(f"'{text}' is not a number with a unit of {kind}. Write {_written(kind, text)}")
    if re.match(r"(\S+\s+)?to\s", match[2]):
        raise UnitError(f"'{text}' is a range. Write one value here, e.g. '{match[1]} {example}'")
    if kind == "time" and (period := _period(float(match[1]), match[2])):
        raise WrongKindError(f"'{text}' is a frequency, not a time", remedy=f"write its period, '{period}'")
    line = conversion(kind, match[2])
    value = line.scale * float(match[1]) + line.offset
    if not math.isfinite(value):
        raise UnitError(f"'{text}' is not a finite number")
    return value


def _period(number: float, unit: str) -> str:
    """The period of a frequency; nothing for any other quantity."""
    scale = _HERTZ.get(unit.lower(), 0.0)
    if not 0.0 < number * scale < math.inf:
        return ""
    period = 1.0 / (number * scale)
    size, name = next(((s, n) for s, n in ((1.0, "s"), (1e-3, "ms")) if period >= s), (1e-6, "us"))
    return f"{period / size:.9g} {name}"


def _written(kind: str, text: str) -> str:
    """A quantity as it was probably meant, or an example."""
    example = KINDS[kind][1]
    plain = re.sub(r"^(?:[^\w.+-]+|(?i:ca\.?|about|approx\.?)\s)\s*", "", text.strip())
    comma = re.fullmatch(r"([-+]?[0-9]+),([0-9]+)([^\d.,].*)?", plain)
    grouped = re.fullmatch(r"([-+]?[1-9][0-9]{0,2}(?:[,.'\s][0-9]{3})+)(?:[.,]([0-9]+))?([^\d.,].*)?", plain)
    mark = comma or re.fullmatch(r"([-+]?[1-9][0-9]{0,2})\.([0-9]{3})([^\d.,].*)?", plain)
    if mark:  # three digits behind it could be thousands
        numbers, rest = [f"{mark[1]}.{mark[2]}"], mark[3]
        grouping = len(mark[2]) == 3 and re.fullmatch(r"[-+]?[1-9][0-9]{0,2}", mark[1])
        numbers += [mark[1] + mark[2]] if grouping else []
    elif grouped:
        whole = re.sub(r"[,.'\s]", "", grouped[1])
        numbers, rest = [f"{whole}.{grouped[2]}" if grouped[2] else whole], grouped[3]
    elif number := re.match(rf"{_NUMBER}(?![.\d])", plain):
        numbers, rest = [number[0]], plain[number.end() :]
    else:
        return f"e.g. '1 {example}'"
    unit = (rest or "").strip()
    unit = "inch" if unit in ('"', "''") else unit
    try:
        conversion(kind, unit or example)
    except UnitError:
        return f"e.g. '{numbers[0]} {example}'"
    such = "" if unit else "e.g. "
    return such + " or ".join(f"'{number} {unit or example}'" for number in numbers)


def si(kind: str, value: Any) -> Any:
    """Return an argument in SI, whatever way it was given.

    Parameters
    ----------
    kind
        A key of `KINDS`.
    value
        Number or array in SI, returned as it is; string with its unit (``"400 rpm"``); pint quantity; or a
        list, tuple or column of strings or quantities, which becomes an array.

    Raises
    ------
    UnitError
        If a string or a quantity has no unit, or one of another kind.

    Examples
    --------
    >>> si("temperature", "150 degC"), si("belt speed", 0.1)
    (423.15, 0.1)
    """
    if isinstance(value, str):
        return parse(kind, value)
    if (items := _with_units(value)) is not None:
        import numpy as np

        return np.array([si(kind, item) for item in items], dtype=float)
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        line = conversion(kind, f"{value.units:~C}" or str(value.units))
        return line.scale * value.magnitude + line.offset
    return value


def _with_units(value: Any) -> list[Any] | None:
    """The items of a list or a column of strings or quantities; None for anything else."""
    if isinstance(value, list | tuple):
        held = any(isinstance(v, str | list | tuple) or hasattr(v, "magnitude") for v in value)
        return list(value) if held else None
    if hasattr(value, "dtype") and not hasattr(value, "magnitude") and getattr(value, "ndim", 1) == 1:
        import numpy as np

        return list(value) if np.asarray(value).dtype.kind in "OU" else None
    return None


#: A plain number below this is no temperature of a drive in K, but one in degC.
_COLDEST = 250.0
#: A roll of a greater radius, m, is none of a drive, but one in mm.
_LARGEST_ROLL = 2.0
#: Frames from the warning of an argument to the call of the user.
_USER = 6


def argument(name: str, kind: Kind, value: Any, *, one: bool = False) -> Any:
    """Return an argument in SI as `si` does, of the first of several kinds that its unit is one of.

    Raises
    ------
    UnitError
        With the name of the argument.
    ArgumentError, ParameterError
        If it is no number or array, not the ``one`` that is needed, or a temperature in K that can only be
        one in degC.
    """
    if value is None:
        return None
    kinds = (kind,) if isinstance(kind, str) else kind
    if "time" in kinds and (seconds := duration(value)) is not None:
        return seconds
    if not isinstance(value, str) and not hasattr(value, "magnitude"):
        if (items := _with_units(value)) is None:
            found = numbers(name, value, one=one)
            if name == ROLL_RADIUS:
                _doubt_radius(found)
            if kinds == ("temperature",) and name != "temperature_zero":
                _refuse_celsius(name, found)
            return found
        import numpy as np

        value = np.array([argument(name, kind, item) for item in items], dtype=float)
        return numbers(name, value, one=one)
    for each in kinds:
        try:
            return numbers(name, si(each, value), one=one)
        except UnitError as error:
            if each == kinds[-1] or not isinstance(error, WrongKindError):
                raise type(error)(f"{name}: {error}") from None
    return value


def _refuse_celsius(name: str, value: Any) -> None:
    """Refuse plain numbers in K that a user can only have meant in degC."""
    coldest = value
    if not isinstance(value, float | int):
        import numpy as np

        coldest = float(np.nanmin(value)) if np.size(value) and not np.all(np.isnan(value)) else _COLDEST
    if coldest < _COLDEST and not _called_from_inside():
        kelvin = f", or '{coldest:g} K' if that is meant" if coldest > 0 else ""
        raise ParameterError(
            f"{name} is {coldest:g} without a unit, which means {coldest:g} K ({celsius(coldest):.4g} degC)",
            quantity=name,
            value=float(coldest),
            unit="K",
            remedy=f"write '{coldest:g} degC'{kelvin}",
        )


def _doubt_radius(value: Any) -> None:
    """Warn of a plain number in m that a user can only have meant in mm."""
    if isinstance(value, float | int) and value > _LARGEST_ROLL and not _called_from_inside():
        said = f"roll_radius is {value:g} without a unit, which means {value:g} m. If it is in mm, write"
        warnings.warn(PlausibilityWarning(f"{said} '{value:g} mm'"), stacklevel=_USER)


def _called_from_inside() -> bool:
    """Whether the package itself called what checks its arguments here: its plain numbers are in SI."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_globals["__name__"] in (__name__, Door.__module__):
        frame = frame.f_back
    return str(frame.f_globals["__name__"]).startswith("hersey.")


def takes_si(**kinds: Kind | Words | Keys) -> Callable[[F], F]:
    """Check what a function or a record is called with; take the arguments named as `argument` does.

    Names and types follow from the signature (`hersey.arguments`). Quantities, each of its kind, may be
    parameters of the function, or keywords that it takes by ``**``.
    """

    def decorate(function: F) -> F:
        if isinstance(function, type):
            _check_fields(function, kinds)
            return function
        title = function.__name__
        if title == "__init__":
            title = function.__qualname__.split(".")[-2]
        door = Door(inspect.signature(function), title, kinds, _read)

        @wraps(function)
        def called(*args: Any, **kwargs: Any) -> Any:
            return function(**door.admit(args, kwargs))

        return cast("F", called)

    return decorate


def _check_fields(record: Any, kinds: Mapping[str, Kind | Words | Keys]) -> None:
    """Let a record check the fields that it is made with."""
    door, made = Door(inspect.signature(record), record.__name__, kinds, _read), record.__init__

    @wraps(made)
    def called(self: Any, *args: Any, **kwargs: Any) -> None:
        made(self, **door.admit(args, kwargs))

    record.__init__ = called
    if record.__dataclass_params__.frozen:
        explained(record)


def _read(name: str, kind: Kind | None, value: Any, *, one: bool) -> Any:
    """Return a quantity in SI, or plain numbers if no kind is given; refuse what cannot be."""
    if kind is None:
        return numbers(name, value, one=one)
    return argument(name, kind, value, one=one)


def convert(value: float, si: str, unit: str) -> float:
    """Return an SI value (given its SI unit) in ``unit``."""
    given, wanted = (_from_table(each, energy=True) for each in (si, unit))
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
