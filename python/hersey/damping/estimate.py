"""A number with its uncertainty."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from hersey.damping.distributions import student_quantile
from hersey.result import OPEN, Record

#: Confidence of every interval.
CONFIDENCE = 0.95


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
        """Return it with what errors of the sensors may add."""
        return replace(self, systematic=half_width)

    def __str__(self) -> str:
        """Return value and interval with sensible digits."""
        if not self.estimable:
            return f"{self.value:.4g} (interval not told)"
        return f"{self.value:.4g} [{self.low:.4g}, {self.high:.4g}]"

    def __repr__(self) -> str:
        """Return value and interval on one line; the unit is that of the field that holds the estimate."""
        if self.estimable:
            interval = f"{self} at {CONFIDENCE:.0%}".replace("%", " %")
        else:
            interval = f"{self.value:.4g}, interval unknown"
        sensors = f", sensor errors add up to {self.systematic:.2g}" if self.systematic else ""
        return f"Estimate({interval}{sensors})"


def quantile(freedom: float) -> float:
    """Return how many standard errors an interval reaches to either side (Student's t)."""
    return float(student_quantile(0.5 + CONFIDENCE / 2, max(freedom, 1)))


def estimate(value: float, error: float, freedom: float) -> Estimate:
    """Return a value with the interval that its standard error and degrees of freedom give."""
    reach = quantile(freedom) * error
    return Estimate(value, error, value - reach, value + reach, freedom)
