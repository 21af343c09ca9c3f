"""How far a parameter is known, as a person writes it."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.motion.parameters import KINDS, OF_THE_BELT
from hersey.units import parse, takes_si

#: Standard deviations that enclose 95 % of a normal distribution on either side.
_DEVIATIONS = 1.96


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


def read_uncertainty(parameter: str, text: object) -> Uncertainty:
    """Return what ``"10 %"``, ``"0.1 mm/s to 1 mm/s"`` or, for an exponent, ``"-0.75 to -0.65"`` says.

    Raises
    ------
    ParameterError, UnitError
        If the parameter is not known or the text cannot be read so.

    Examples
    --------
    >>> read_uncertainty("stick_speed", "0.1 mm/s to 1 mm/s").limits
    (0.0001, 0.001)
    """
    if parameter not in OF_THE_BELT:
        raise ParameterError(f"there is no such parameter. Use one of {', '.join(OF_THE_BELT)}")
    if not isinstance(text, str):
        raise ParameterError(f"it is {text!r}. Write a string such as '10 %'")
    share = re.fullmatch(r"\s*(?:±\s*|\+/-\s*)?([0-9.]+)\s*%\s*", text)
    if share:
        try:
            return Uncertainty(share=float(share[1]) / 100)
        except ValueError:
            raise ParameterError(f"'{text}' is not a share. Write e.g. '10 %'") from None
    ends = re.split(r"\s+to\s+", text.strip())
    if len(ends) != 2:
        raise ParameterError(f"'{text}' is neither a share ('10 %') nor a range ('... to ...')")
    kind = KINDS[parameter]
    try:
        low, high = (float(end) if kind is None else parse(kind, end) for end in ends)
    except ValueError as error:
        if kind is not None or isinstance(error, ParameterError):
            raise
        raise ParameterError(f"'{text}' is not a range of two numbers: {error}") from None
    return Uncertainty(limits=(low, high))
