"""How far a parameter is known, as a person writes it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, meant
from hersey.machine.rotational import at_radius
from hersey.motion.parameters import KINDS, OF_THE_BELT
from hersey.units import KINDS as UNITS
from hersey.units import convert, takes_si

#: Standard deviations that enclose 95 % of a normal distribution on either side.
_DEVIATIONS = 1.96
#: Share of an end of a range that rounding of units may take.
_BELOW = 1 - 1e-9


@takes_si()
@dataclass(frozen=True)
class Uncertainty:
    """Either a share of the value, or a range of SI values.

    ``share`` 0.1 means that 95 % of the values lie within a factor 1.1 of the nominal one (lognormal).
    ``limits`` are the ends of a range in which every order of magnitude is as likely (log-uniform).
    """

    share: float | None = None
    limits: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        """Check that one of them is given, and is possible."""
        if (self.share is None) == (self.limits is None):
            raise ParameterError("give either share or limits")
        if self.share is not None and not 0 < self.share < 100:
            raise ParameterError(f"share is {self.share}: it must be greater than 0")
        if self.limits is not None:
            low, high = self.limits
            if not (np.isfinite([low, high]).all() and low < high and low * high > 0):
                raise ParameterError(
                    f"range {low:g} to {high:g}: give the lower end first, and both ends on the same "
                    "side of 0"
                )

    def times(self, factor: float) -> Uncertainty:
        """Return that of a value so many times as large, as a speed is that moves with temperature."""
        if self.limits is None:
            return self
        return Uncertainty(limits=(self.limits[0] * factor, self.limits[1] * factor))

    def draw(self, rng: np.random.Generator, nominal: float, count: int) -> FloatArray:
        """Return ``count`` values of a parameter whose nominal value is given (not used with ``limits``)."""
        if self.share is not None:
            deviation = np.log1p(self.share) / _DEVIATIONS
            return np.asarray(nominal * np.exp(deviation * rng.standard_normal(count)))
        assert self.limits is not None
        low, high = self.limits
        share = rng.uniform(0.0, 1.0, count)
        return np.asarray(low * (high / low) ** share)


def read_uncertainty(parameter: str, text: object, *, roll_radius: float | None = None) -> Uncertainty:
    """Return what ``"10 %"``, ``"0.3 mm/s to 3 mm/s"`` or, for an exponent, ``"-0.75 to -0.65"`` says.

    With a ``roll_radius`` (m) the ends may be rotational quantities, e.g. ``"0.01 rad/s to 0.03 rad/s"``.

    Raises
    ------
    ParameterError, UnitError
        If the parameter is not known or the text cannot be read so.

    Examples
    --------
    >>> read_uncertainty("stick_speed", "0.3 mm/s to 3 mm/s").limits
    (0.0003, 0.003)
    """
    if parameter not in OF_THE_BELT:
        near = meant(parameter, OF_THE_BELT)
        hint = f"Did you mean {near}? Use" if near else "Use"
        raise ParameterError(f"there is no such parameter. {hint} one of {', '.join(OF_THE_BELT)}")
    if not isinstance(text, str):
        raise ParameterError(f"it is {text!r}. Write a string such as '10 %'")
    share = re.fullmatch(r"\s*(?:±\s*|\+/-\s*)?([0-9.]+)\s*%\s*", text)
    if share:
        try:
            return Uncertainty(share=float(share[1]) / 100)
        except ValueError:
            raise ParameterError(f"'{text}' is not a share. Write e.g. '10 %'") from None
    kind = KINDS[parameter]
    ends = range_ends(text)
    if ends is None:
        example = f"1 {UNITS[kind][1]} to 2 {UNITS[kind][1]}" if kind else "-0.75 to -0.65"
        raise ParameterError(f"'{text}' is neither a share ('10 %') nor a range ('{example}')")
    try:
        low, high = (float(end) if kind is None else at_radius(kind, end, roll_radius) for end in ends)
    except ValueError as error:
        if kind is not None or isinstance(error, ParameterError):
            raise
        raise ParameterError(f"'{text}' is not a range of two numbers: {error}") from None
    if low > high:
        raise ParameterError(f"'{text}' begins with its upper end. Write '{ends[1]} to {ends[0]}'")
    return Uncertainty(limits=(low, high))


def refuse_value_outside(
    known: Uncertainty, parameter: str, text: str, value: float, written: str, line: int
) -> None:
    """Refuse a range, read from ``text``, without the value that ``line`` of the file states as ``written``.

    Raises
    ------
    ParameterError
        If the value is outside the range.
    """
    if known.limits is None or known.limits[0] * _BELOW <= value <= known.limits[1] / _BELOW:
        return
    low, high = range_ends(text) or ("", "")
    wider = f"{written} to {high}" if value < known.limits[0] else f"{low} to {written}"
    si, usual = UNITS[str(KINDS[parameter])]
    middle = f"{convert(math.sqrt(known.limits[0] * known.limits[1]), si, usual):.4g} {usual}"
    raise ParameterError(
        f"the range {text} does not contain {written}, the value in line {line}. Write here: "
        f'{parameter} = "{wider}". If the range is right, write in line {line} a value within it, e.g. '
        f'{parameter} = "{middle}"'
    )


def range_ends(text: str) -> tuple[str, str] | None:
    """Return the ends of a range, as ``"0.3 to 3 mm/s"``; a unit at the upper end holds for both.

    Examples
    --------
    >>> range_ends("0.3 - 3 mm/s")
    ('0.3 mm/s', '3 mm/s')
    """
    ends = re.split(r"\s+(?:to|-)\s+|\s*(?:\u2013|\.{2,3}|\u2026)\s*|(?<=[0-9])-(?=[0-9])", text.strip())
    if len(ends) != 2 or not all(ends):
        return None
    low, high = ends
    unit = re.fullmatch(r"[-+]?[0-9.,]+(?:[eE][-+]?[0-9]+)?\s*(\D.*)?", high)
    if unit and unit[1] and re.fullmatch(r"[-+]?[0-9.,]+(?:[eE][-+]?[0-9]+)?", low):
        low = f"{low} {unit[1]}"
    return low, high
