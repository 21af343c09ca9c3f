"""A moment of inertia as it is stated, and how far it is known: of a coast-down, or of a log that moves."""

from __future__ import annotations

import math
import re
from typing import Any

from hersey.damping.estimate import Estimate
from hersey.errors import ParameterError
from hersey.units import argument
from hersey.units.spelling import NUMBER

#: Half a 95 % interval of a normal distribution over its standard error.
NORMAL = 1.96
_KIND = "moment of inertia"
_EXAMPLE = "0.012 kg*m^2 ± 2 %"


def inertia_of(given: Any, name: str = "inertia", *, may_be_none: bool = False) -> Estimate:
    """Return a moment of inertia, kg m^2, with its 95 % interval, which is no wider than it if none is given.

    Where it is the only thing that resists, it must be greater than 0; else there ``may_be_none``.

    Raises
    ------
    ParameterError, UnitError
        If it is not a positive number with a unit, or its error cannot be read.

    Examples
    --------
    >>> inertia_of("0.012 kg*m^2 ± 2 %")
    Estimate(0.0120 [0.0118, 0.0122] at 95 %)
    """
    if isinstance(given, Estimate):
        return given
    text, half = given, 0.0
    if isinstance(given, str) and (parts := re.split(r"\s*(?:±|\+/-|\+-)\s*", given.strip())):
        text = parts[0]
        if len(parts) > 2:
            raise ParameterError(f"{name} '{given}' has two errors. Write e.g. '{_EXAMPLE}'")
        value = float(argument(name, _KIND, text, one=True))
        half = _half(name, given, parts[1], value) if len(parts) == 2 else 0.0
    else:
        value = float(argument(name, _KIND, text, one=True))
    if may_be_none and value < 0:
        raise ParameterError(f"the moment of inertia is {value:g} kg m^2: it must not be negative")
    if not ((value > 0 or may_be_none) and math.isfinite(value)):
        raise ParameterError(f"{name} is {given}: it must be greater than 0")
    if half < 0 or (half > 0 and not half < value):
        raise ParameterError(f"{name} is {given}: its error must be smaller than the value")
    return stated_inertia(value, half)


def stated_inertia(value: float, half: float) -> Estimate:
    """Return a moment of inertia with half its 95 % interval, both kg m^2."""
    return Estimate(value, half / NORMAL, value - half, value + half)


def _half(name: str, given: str, text: str, value: float) -> float:
    """Half the 95 % interval, kg m^2."""
    share = re.fullmatch(rf"({NUMBER})\s*%", text)
    if share:
        return float(share[1]) / 100.0 * value
    if re.fullmatch(NUMBER, text):
        raise ParameterError(f"{name} '{given}': the error has no unit. Write e.g. '{_EXAMPLE}'")
    return float(argument(name, _KIND, text, one=True))
