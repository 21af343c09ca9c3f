"""What specimens that still run will do: the remaining life of one, and the failures of a fleet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray, IntArray, numbers_of, one_thread
from hersey.errors import ParameterError, capital
from hersey.life.failures.draws import Draws, sum_survival, survival_at
from hersey.life.failures.law import FailureLaw
from hersey.life.failures.records import span, written
from hersey.result import OPEN, Means, Result
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Points of a curve ahead, and bisections of a remaining life.
_POINTS, _BISECTIONS = 20, 60
#: Lives ahead are sought up to this many times the longest of age and scale.
_LONGEST = 1e6


@dataclass(frozen=True, repr=False)
class RemainingLife(Result):
    """How long a specimen of an age will still run, in ``unit``.

    ``median`` has bounds at ``level``; the specimen itself fails between ``earliest`` and ``latest`` from
    now with that probability, which counts both its own spread and that the law is uncertain.
    """

    age: float
    unit: Annotated[str, Means("unit of the ages; may be empty")]
    level: float
    median: Annotated[float, Means("half of such specimens run longer than this from now on", open=True)]
    low: Annotated[float, OPEN]
    high: Annotated[float, OPEN]
    earliest: Annotated[float, OPEN]
    latest: Annotated[float, OPEN]
    ahead: Annotated[FloatArray, Means("further age", shape="(n,)")]
    outlive: Annotated[FloatArray, Means("share that runs at least so much longer", shape="(n,)")]
    outlive_low: Annotated[FloatArray, Means(shape="(n,)")]
    outlive_high: Annotated[FloatArray, Means(shape="(n,)")]

    def headline(self) -> str:
        """Return the remaining life in half a line."""
        unit = f" {self.unit}" if self.unit else ""
        return (
            f"a specimen of {written(self.age)}{unit} has a median remaining life of {written(self.median)} "
            f"{span(self.low, self.high)}{unit}"
        )

    def summary(self) -> str:
        """Return the median remaining life, and between which ages this specimen fails."""
        unit = f" {self.unit}" if self.unit else ""
        text = self.headline()
        return (
            f"{capital(text)}.\nWith {100 * self.level:.4g} % probability it fails within the next "
            f"{written(self.earliest)} to {written(self.latest)}{unit}."
        )

    def to_frame(self) -> pl.DataFrame:
        """Return the share that runs longer against further age, with its bounds."""
        import polars as pl

        unit = self.unit or "1"
        names = (f"ahead ({unit})", "outlive (1)", "outlive low (1)", "outlive high (1)")
        columns = (self.ahead, self.outlive, self.outlive_low, self.outlive_high)
        return pl.DataFrame(dict(zip(names, columns, strict=True)))


@dataclass(frozen=True, repr=False)
class FleetForecast(Result):
    """How many specimens of a fleet fail while each ages further, with prediction intervals at ``level``.

    Intervals count the chance of each specimen and that the law is uncertain. The last entry of the arrays
    is the whole way ahead.
    """

    specimens: int
    unit: Annotated[str, Means("unit of the ages; may be empty")]
    level: float
    ahead: Annotated[FloatArray, Means("further age of every specimen", shape="(n,)")]
    expected: Annotated[FloatArray, Means("failures expected by the estimated law", shape="(n,)")]
    low: Annotated[IntArray, Means("fewest failures predicted", shape="(n,)")]
    high: Annotated[IntArray, Means("most failures predicted", shape="(n,)")]
    none: Annotated[float, Means("probability that none fails")]

    def headline(self) -> str:
        """Return how many are expected to fail."""
        unit = f" {self.unit}" if self.unit else ""
        return (
            f"of {self.specimens} specimens {written(float(self.expected[-1]), 3)} "
            f"[{self.low[-1]}, {self.high[-1]}] fail in the next {written(float(self.ahead[-1]))}{unit}"
        )

    def summary(self) -> str:
        """Return how many fail, with the prediction interval, and the probability that none does."""
        return (
            f"{self.headline().capitalize()} ({100 * self.level:.4g} % prediction interval).\n"
            f"The probability that none fails is {self._none}."
        )

    @property
    def _none(self) -> str:
        return f"{self.none:.2g}" if self.none > 0 else "below 0.001"

    def to_frame(self) -> pl.DataFrame:
        """Return the failures against further age, with their prediction interval."""
        import polars as pl

        unit = self.unit or "1"
        columns = (self.ahead, self.expected, self.low, self.high)
        names = (f"ahead ({unit})", "expected failures (1)", "low", "high")
        return pl.DataFrame(dict(zip(names, columns, strict=True)))


@one_thread()
@takes_si()
def remaining_life(law: FailureLaw, age: float) -> RemainingLife:
    """Return how long a specimen of an age will still run.

    Parameters
    ----------
    law
        The law, from `weibull`.
    age
        Its age now, in the unit of the law; 0 for a new one.

    Raises
    ------
    ParameterError
        If the age is less than 0.
    InsufficientDataError
        If no law is known.
    """
    law.refuse_unknown()
    if not (np.isfinite(age) and age >= 0):
        raise ParameterError(f"age is {age}: it must be 0 or greater", quantity="age")
    random = np.random.default_rng(law.seed)
    tails = [1 - law.one_sided, law.one_sided]
    own = law.estimated
    median = float(_ahead(own, age, np.log(0.5), law.stress)[0])
    low, high = np.quantile(_ahead(law.draws, age, np.log(0.5), law.stress), tails)
    chances = np.log(random.uniform(size=law.draws[0].m.size))
    earliest, latest = np.quantile(_ahead(law.draws, age, chances, law.stress), tails)
    finite = [each for each in (median, high, latest) if np.isfinite(each)]
    ahead = np.linspace(0.0, min(max(finite, default=1.0), 5 * median), _POINTS + 1)
    shares = np.exp(_further(law, law.draws, age, ahead))
    best = np.exp(_further(law, own, age, ahead))[0]
    bounds = np.quantile(shares, tails, axis=0)
    return RemainingLife(
        float(age),
        law.unit,
        law.level,
        median,
        float(low),
        float(high),
        float(earliest),
        float(latest),
        ahead,
        best,
        np.minimum(bounds[0], best),
        np.maximum(bounds[1], best),
    )


def _ahead(draws: Sequence[Draws], age: float, log_share: FloatArray | float, stress: float) -> FloatArray:
    """How much further a specimen runs before only a share of its kind is left, of each draw."""
    now = sum_survival(draws, np.full(1, max(age, 1e-300)), stress)
    wanted = now + log_share
    low = np.full(draws[0].m.size, np.log(max(age, 1e-300)))
    high = np.maximum(low, np.max([each.m + each.c * stress for each in draws], axis=0)) + np.log(_LONGEST)
    for _ in range(_BISECTIONS):
        between = 0.5 * (low + high)
        left = sum_survival(draws, np.exp(between), stress)
        low, high = np.where(left > wanted, between, low), np.where(left > wanted, high, between)
    with np.errstate(over="ignore"):
        return np.asarray(np.maximum(np.exp(0.5 * (low + high)) - age, 0.0))


def _further(law: FailureLaw, draws: Sequence[Draws], age: float, ahead: FloatArray) -> FloatArray:
    """Logarithm of the share of specimens of an age that outlive each further age, shape (draws, ages)."""
    ages = np.maximum(age + ahead, 1e-300)
    return survival_at(draws, ages, law.stress) - survival_at(draws, np.maximum([age], 1e-300), law.stress)


@one_thread()
@takes_si()
def fleet_forecast(
    law: FailureLaw, ages: ArrayLike, ahead: float, *, count: ArrayLike | None = None
) -> FleetForecast:
    """Return how many specimens of a fleet fail while each ages further.

    Parameters
    ----------
    law
        The law, from `weibull`.
    ages
        Age of each specimen that runs now, in the unit of the law; 0 for a new one, shape (ages,).
    ahead
        How much further each of them runs.
    count
        Number of specimens of each age, if more than one.

    Raises
    ------
    ParameterError
        If an age is less than 0 (with its index), or ``ahead`` is not greater than 0.
    InsufficientDataError
        If no law is known.
    """
    law.refuse_unknown()
    now = numbers_of("ages", ages)
    number = np.ones(now.size, dtype=int) if count is None else np.asarray(count)
    _refuse_wrong(now, number, ahead)
    further = np.linspace(0.0, ahead, _POINTS + 1)[1:]
    random = np.random.default_rng(law.seed)
    failed, expected = _counts(law, law.draws, now, number, further, random), np.zeros(_POINTS)
    for share in _shares(law, law.estimated, now, further):
        expected += (number[:, None] * share).sum(axis=0)
    low, high = np.quantile(failed, [1 - law.one_sided, law.one_sided], axis=0, method="inverted_cdf")
    none = float((failed[:, -1] == 0).mean())
    total = int(number.sum())
    return FleetForecast(
        total, law.unit, law.level, further, expected, low.astype(int), high.astype(int), none
    )


def _refuse_wrong(now: FloatArray, number: IntArray, ahead: float) -> None:
    wrong = np.flatnonzero(~(np.isfinite(now) & (now >= 0)))
    if wrong.size:
        place = int(wrong[0])
        raise ParameterError(
            f"age {place} is {now[place]:g}: it must be 0 or greater", quantity="ages", index=place
        )
    if number.shape != now.shape or number.dtype.kind not in "iu" or (number < 1).any():
        raise ParameterError("count must be a whole number, 1 or more, for each age", quantity="count")
    if not (np.isfinite(ahead) and ahead > 0):
        raise ParameterError(f"ahead is {ahead}: it must be greater than 0", quantity="ahead")


def _shares(
    law: FailureLaw, draws: Sequence[Draws], now: FloatArray, further: FloatArray
) -> Iterator[FloatArray]:
    """Share of each age that has failed after each way further, of each draw, shape (ages, further)."""
    for i in range(draws[0].m.size):
        one = [each.one(i) for each in draws]
        start = survival_at(one, np.maximum(now, 1e-300), law.stress)[0]
        end = survival_at(one, np.maximum(now[:, None] + further, 1e-300).ravel(), law.stress)[0]
        yield -np.expm1(end.reshape(now.size, further.size) - start[:, None])


def _counts(
    law: FailureLaw,
    draws: Sequence[Draws],
    now: FloatArray,
    number: IntArray,
    further: FloatArray,
    random: np.random.Generator,
) -> IntArray:
    """Failures by each way further, of each draw of the law, shape (draws, further)."""
    rows = []
    for share in _shares(law, draws, now, further):
        left, fell = number.copy(), np.zeros(further.size, dtype=np.intp)
        before = np.zeros(now.size)
        for step in range(further.size):
            chance = np.clip((share[:, step] - before) / np.maximum(1 - before, 1e-300), 0.0, 1.0)
            fails = random.binomial(left, chance)
            left, before = left - fails, share[:, step]
            fell[step] = fails.sum()
        rows.append(fell.cumsum())
    return np.array(rows)
