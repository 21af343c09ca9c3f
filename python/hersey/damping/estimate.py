"""A number with its uncertainty."""

from __future__ import annotations

from dataclasses import dataclass

from scipy import stats

#: Confidence of every interval.
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """A number with its standard error and its 95 % interval."""

    value: float
    error: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return value and interval with sensible digits."""
        return f"{self.value:.4g} [{self.low:.4g}, {self.high:.4g}]"


def quantile(freedom: int) -> float:
    """Return how many standard errors an interval reaches to either side (Student's t)."""
    return float(stats.t.ppf(0.5 + CONFIDENCE / 2, max(freedom, 1)))


def estimate(value: float, error: float, freedom: int) -> Estimate:
    """Return a value with the interval that its standard error and degrees of freedom give."""
    reach = quantile(freedom) * error
    return Estimate(value, error, value - reach, value + reach)
