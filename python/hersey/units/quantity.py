"""A number with its unit, as text."""

from __future__ import annotations

import math
import re

from hersey.errors import UnitError, WrongKindError
from hersey.units.into_si import conversion
from hersey.units.kinds import KINDS, named
from hersey.units.spelling import NUMBER

#: Characters of a quantity at the most: the patterns below take longer than linear.
_LONGEST_QUANTITY = 160
#: Units of a frequency as people write them, in lower case, and each in Hz.
_HERTZ = {"hz": 1.0, "hertz": 1.0, "khz": 1e3, "mhz": 1e6, "sps": 1.0}


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
        raise UnitError(f"{shown}. Write a number and a unit of {named(kind)}, e.g. '1 {example}'")
    match = re.fullmatch(rf"\s*({NUMBER})\s*([A-Za-z°ºµμ%℃℉].*?)\s*", text)
    if match is None:
        raise UnitError(
            f"'{text}' is not a number with a unit of {named(kind)}. Write {_written(kind, text)}"
        )
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
    elif number := re.match(rf"{NUMBER}(?![.\d])", plain):
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
