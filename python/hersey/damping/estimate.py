"""A number with its uncertainty."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from hersey.damping.distributions import student_quantile
from hersey.result import OPEN, Record

#: Confidence of every interval.
CONFIDENCE = 0.95
#: Figures of a number with its interval, at the most.
_MOST_FIGURES = 3
#: Decimals that distinguish it from the ends of its interval, at the most.
_MOST_PLACES = 8


@dataclass(frozen=True)
class Estimate(Record):
    """A number with its standard error and its 95 % interval, which is unbounded if unknown.

    ``systematic`` is the half width, at 95 %, that errors of the sensors may add to the interval.
    """

    value: Annotated[float, OPEN]
    error: Annotated[float, OPEN]
    low: Annotated[float, OPEN]
    high: Annotated[float, OPEN]
    freedom: Annotated[float, OPEN] = np.inf  #: degrees of freedom of the error
    systematic: Annotated[float, OPEN] = 0.0

    @property
    def estimable(self) -> bool:
        """Whether the interval is bounded."""
        return bool(np.isfinite(self.low) and np.isfinite(self.high))

    def with_systematic(self, half_width: float) -> Estimate:
        """Return the estimate with the half width that errors of the sensors may add."""
        return replace(self, systematic=half_width)

    def __str__(self) -> str:
        """Return value and interval with sensible digits."""
        if not self.estimable:
            return f"{self.value:.3g} (interval not known)"
        return rounded(self.value, self.low, self.high)

    def __repr__(self) -> str:
        """Return value and interval on one line; the unit is that of the field that holds the estimate."""
        if self.estimable:
            interval = f"{self} at {CONFIDENCE:.0%}".replace("%", " %")
        else:
            interval = f"{self.value:.4g}, interval not known"
        sensors = f", sensor errors add up to {self.systematic:.2g}" if self.systematic else ""
        return f"Estimate({interval}{sensors})"


def rounded(value: float, low: float, high: float, unit: str = "") -> str:
    """Return a value, its unit and its interval, all numbers with the same decimals.

    The width of the interval has two figures, the value three, or more if these do not differ.

    Examples
    --------
    >>> rounded(3.6914, 3.1684, 4.3, "rpm"), rounded(-0.59624, -0.62019, -0.57221)
    ('3.7 rpm [3.2, 4.3]', '-0.596 [-0.620, -0.572]')
    """
    named = f" {unit}" if unit else ""
    each = f"{value:.3g}{named} [{low:.3g}, {high:.3g}]"
    width, largest = high - low, max(abs(value), abs(low), abs(high))
    if not 1e-5 < largest < 1e6:
        return each
    places = _MOST_FIGURES - 1 - math.floor(math.log10(largest))
    if width > 0.0:
        places = min(places, 1 - math.floor(math.log10(width)))
    least = min(abs(low), abs(high))
    if low * high > 0.0 and least * 10.0**places < 1.0:  # an end would be shown as 0
        return each
    shown = [f"{number:.{max(places, 0)}f}" for number in (value, low, high)]
    while low < value < high and len({*shown}) < len(shown) and places < _MOST_PLACES:
        places += 1
        shown = [f"{number:.{max(places, 0)}f}" for number in (value, low, high)]
    first, *ends = shown
    return f"{first}{named} [{', '.join(ends)}]"


def quantile(freedom: float) -> float:
    """Return the half width of an interval in standard errors (Student's t)."""
    return float(student_quantile(0.5 + CONFIDENCE / 2, max(freedom, 1)))


def estimate(value: float, error: float, freedom: float) -> Estimate:
    """Return an estimate from a value, its standard error and its degrees of freedom."""
    reach = quantile(freedom) * error
    return Estimate(value, error, value - reach, value + reach, freedom)
