"""How many specimens to test, and how long, so that a B-life is demonstrated or known well enough."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Annotated

import numpy as np
from scipy.special import betaincinv

from hersey.arrays import one_thread
from hersey.errors import ParameterError
from hersey.life.failures.distributions import WEIBULL
from hersey.life.failures.fit import age_held, fitted
from hersey.life.failures.records import written
from hersey.life.failures.sample import Failures
from hersey.result import Means, Record, Result
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Test ages over the age to be demonstrated, failures allowed, and the most specimens that are searched.
_LENGTHS, _ALLOWED, _MOST = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0), (0, 1, 2), 10**7
#: Specimens of tests whose precision is given.
_SIZES = (5, 8, 10, 15, 20, 30)


@dataclass(frozen=True)
class Demonstration(Record):
    """A test that demonstrates the B-life if at most so many specimens fail by an age."""

    age: float
    allowed: Annotated[int, Means("failures allowed")]
    specimens: int


@dataclass(frozen=True)
class Precision(Record):
    """Upper bound over lower bound of the B-life that a test would leave."""

    specimens: int
    all_fail: Annotated[float, Means("upper bound over lower bound if all are run to failure", open=True)]
    half_fail: Annotated[float, Means("the same if the test ends when half have failed", open=True)]


@dataclass(frozen=True, repr=False)
class LifeTestPlan(Result):
    """Specimens and test ages for a B-life of at least ``target``, at a one-sided ``confidence``.

    The law is a Weibull law whose ``shape`` is taken as known for a demonstration. For the precision of a
    test to failure it is not: there both bounds hold at ``confidence`` each.
    """

    share: Annotated[float, Means("share that may have failed by the target, 0.1 for B10")]
    target: float
    unit: Annotated[str, Means("unit of the ages; may be empty")]
    shape: Annotated[float, Means("shape of the Weibull law")]
    confidence: Annotated[float, Means("one-sided level")]
    demonstrations: tuple[Demonstration, ...]
    precision: tuple[Precision, ...]

    @property
    def _name(self) -> str:
        return f"B{100 * self.share:g} of {written(self.target)}{f' {self.unit}' if self.unit else ''}"

    def headline(self) -> str:
        """Return how many specimens must survive the target itself."""
        own = next(d for d in self.demonstrations if d.age == self.target and not d.allowed)
        return (
            f"{own.specimens} specimens that all outlive the target demonstrate a {self._name} "
            f"with {100 * self.confidence:.4g} % confidence"
        )

    def summary(self) -> str:
        """Return both tables as text."""
        head = ("test age", *(f"{allowed} failed" for allowed in _ALLOWED))
        rows = [
            (written(age), *(str(self.specimens(age, allowed)) for allowed in _ALLOWED))
            for age in dict.fromkeys(d.age for d in self.demonstrations)
        ]
        lines = [f"{self.headline()} (shape {self.shape:.3g} taken as known)."]
        lines += ["Specimens to test, by test age and failures allowed:", *_table(head, rows)]
        lines.append(f"Upper over lower bound of B{100 * self.share:g} if tested to failure, shape unknown:")
        known = [(str(p.specimens), _ratio(p.all_fail), _ratio(p.half_fail)) for p in self.precision]
        return "\n".join([*lines, *_table(("specimens", "all fail", "half fail"), known)])

    def specimens(self, age: float, allowed: int) -> int:
        """Return the specimens to test to an age with so many failures allowed."""
        return next(d.specimens for d in self.demonstrations if d.age == age and d.allowed == allowed)

    def to_frame(self) -> pl.DataFrame:
        """Return one row per test that demonstrates the target."""
        import polars as pl

        return pl.DataFrame(
            {
                f"test age ({self.unit or '1'})": [d.age for d in self.demonstrations],
                "failures allowed": [d.allowed for d in self.demonstrations],
                "specimens": [d.specimens for d in self.demonstrations],
            }
        )


def _table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    return ["  " + "  ".join(f"{c:>{w}}" for c, w in zip(row, widths, strict=True)) for row in (head, *rows)]


def _ratio(value: float) -> str:
    return f"{value:.3g}" if np.isfinite(value) and value < 1e4 else "unbounded"


@one_thread()
@takes_si()
def life_test_plan(
    target: float,
    *,
    shape: float,
    share: float = 0.10,
    confidence: float = 0.90,
    unit: str = "",
    seed: int = 0,
) -> LifeTestPlan:
    """Return how many specimens to test, and how long, for a B-life of at least a target.

    With a known shape, n specimens tested to age t demonstrate it if at most f fail, where the chance of
    that would be 1 - ``confidence`` if the B-life were just the target (success run for f = 0).

    Parameters
    ----------
    target
        Age by which at most a share may have failed.
    shape
        Shape of the Weibull law, e.g. of an earlier test.
    share
        That share, 0.10 for B10.
    confidence
        One-sided level.
    unit
        Unit of the ages, e.g. "pages".
    seed
        Random seed of the precision.

    Raises
    ------
    ParameterError
        If a number is out of its range.

    Examples
    --------
    >>> life_test_plan(100_000, shape=2.0).specimens(100_000, 0)
    22
    """
    for name, value, least, most in (
        ("target", target, 0.0, np.inf),
        ("shape", shape, 0.0, np.inf),
        ("share", share, 0.0, 1.0),
        ("confidence", confidence, 0.0, 1.0),
    ):
        if not least < value < most:
            span = "greater than 0" if most > 1 else "between 0 and 1"
            raise ParameterError(f"{name} is {value}: it must be {span}", quantity=name)
    tests = tuple(
        Demonstration(length * target, allowed, specimens_for(length, allowed, shape, share, confidence))
        for length in _LENGTHS
        for allowed in _ALLOWED
    )
    level = 2 * confidence - 1 if confidence > 0.5 else 0.5
    known = []
    for size in _SIZES:
        ratios = (_log_ratio(size, fails, share, level, seed) for fails in (size, (size + 1) // 2))
        with np.errstate(over="ignore"):
            known.append(Precision(size, *(float(np.exp(each / shape)) for each in ratios)))
    return LifeTestPlan(share, target, unit, shape, confidence, tests, tuple(known))


def specimens_for(length: float, allowed: int, shape: float, share: float, confidence: float) -> int:
    """Return the fewest specimens that demonstrate the target when tested to ``length`` times its age."""
    failed = -np.expm1(np.log1p(-share) * length**shape)
    low, high = allowed, _MOST
    while high - low > 1:
        middle = (low + high) // 2
        # at most `allowed` of n fail with probability 1 - confidence at a share that grows as n falls
        worst = 1.0 - betaincinv(middle - allowed, allowed + 1, 1 - confidence)
        low, high = (middle, high) if worst > failed else (low, middle)
    return high


@cache
def _log_ratio(size: int, fails: int, share: float, level: float, seed: int) -> float:
    """Logarithm of upper over lower bound of a sample of shape 1 whose ages lie where they are expected.

    Of another shape it is that over the shape: ln age has the same law, stretched.
    """
    ranks = (np.arange(1, fails + 1) - 0.5) / size
    ages = np.exp(WEIBULL.quantile(ranks, np.array(1.0)))
    low, high, count = ages, ages, np.ones(fails, dtype=int)
    if fails < size:
        low, high = np.append(low, ages[-1]), np.append(high, np.inf)
        count = np.append(count, size - fails)
    fit = fitted(WEIBULL, Failures(low, high, count), seed=seed)
    first, last = fit.bounds(np.array([share]), level, age_held)
    return float(last[0] - first[0])
