"""Ages at failure over many specimens: a Weibull law with specimens that have not failed, B10 and B50.

The share failed by age t is F = 1 - exp(-(t / scale)^shape). Maximum likelihood takes what is known of a
specimen that has not failed: that it was older than the age at which it was last seen.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import betaincinv

from hersey.arrays import BoolArray, FloatArray, numbers_of
from hersey.errors import InsufficientDataError, ParameterError
from hersey.result import OPEN, Record, Result, json_record, table_of
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Fewest failures that determine a law, and fewest whose law is given without a warning.
_LEAST, _FEW = 2, 4
#: Draws behind the intervals: their ends scatter by a percent or two of their width.
_DRAWS = 4000
#: Ages of them that are held at a time: as many as a core keeps at hand.
_HELD = 32_000
#: Steps of Newton's method at the most, and where it ends; a step is e times at the most.
_STEPS, _SETTLED = 100, 1e-13


@dataclass(frozen=True)
class BLife(Record):
    """Age by which a share of all specimens has failed, with its interval."""

    share: float
    age: float
    low: float
    high: Annotated[float, OPEN]  #: infinite where no upper end is known
    level: float

    @property
    def name(self) -> str:
        """Usual name, e.g. B10."""
        return f"B{100 * self.share:g}"


@dataclass(frozen=True, repr=False)
class Population(Result):
    """Failure law of a population, from specimens that failed and specimens that did not.

    ``ages`` (ascending) are in ``unit``; ``failed`` marks the ages at failure. ``shape``, ``scale`` and their
    intervals at ``level`` are None if too few specimens have failed; ``warnings`` says so.
    """

    ages: FloatArray
    failed: BoolArray
    shape: float | None
    scale: float | None
    shape_interval: tuple[float, float] | None
    scale_interval: tuple[float, float] | None
    level: float
    unit: str
    warnings: tuple[Warning, ...]
    seed: int

    def b_life(self, share: float) -> BLife:
        """Return the age by which a share of all specimens has failed (0.10 for B10).

        Raises
        ------
        ParameterError
            If the share is not between 0 and 1.
        InsufficientDataError
            If too few specimens have failed.
        """
        if not 0 < share < 1:
            raise ParameterError(f"share is {share}: it must be between 0 and 1", quantity="share")
        if self.shape is None or self.scale is None:
            raise InsufficientDataError(self.warnings[0].sentence)
        age, low, high = (float(each[0]) for each in self.lives([share]))
        return BLife(share, age, low, high, self.level)

    def lives(self, shares: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the ages by which shares of all specimens have failed, and the bounds of their intervals.

        Raises
        ------
        InsufficientDataError
            If too few specimens have failed.
        """
        if self.shape is None or self.scale is None:
            raise InsufficientDataError(self.warnings[0].sentence)
        place = _place(np.asarray(shares, dtype=float))
        scale, shape = self._drawn
        # (ln of the estimated age - ln of the true one) x estimated shape has one law, whatever the truth.
        pivot = shape[:, None] * (np.log(scale)[:, None] - place) + place
        early, late = np.quantile(pivot, [0.5 + self.level / 2, 0.5 - self.level / 2], axis=0)
        middle = np.log(self.scale) + place / self.shape
        with np.errstate(over="ignore"):
            return np.exp(middle), np.exp(middle - early / self.shape), np.exp(middle - late / self.shape)

    @cached_property
    def median_ranks(self) -> tuple[FloatArray, FloatArray]:
        """Ages at failure and the share failed at each: median ranks after Johnson.

        A suspended specimen may have failed at any later rank, so each later failure moves up by its share. A
        specimen suspended at the age of a failure counts as having survived it.
        """
        total, rank, ranks = self.ages.size, 0.0, []
        for before in np.flatnonzero(self.failed).tolist():
            rank += (total + 1 - rank) / (1 + total - before)
            ranks.append(rank)
        order = np.array(ranks)
        return self.ages[self.failed], np.asarray(betaincinv(order, total + 1 - order, 0.5), dtype=float)

    @cached_property
    def _drawn(self) -> tuple[FloatArray, FloatArray]:
        return _estimates_of_standard(_plan(self.failed), self.seed)

    def verdict(self) -> str:
        """Return what the shape means in a sentence; empty if there is no shape."""
        if self.shape is None or self.shape_interval is None:
            return ""
        low, high = self.shape_interval
        if low > 1:
            return "The failure rate grows with age: specimens wear out."
        if high < 1:
            return "The failure rate falls with age: weak specimens fail early."
        return "Whether the failure rate grows or falls with age is unknown."

    def headline(self) -> str:
        """Return the number of failures, B10 and B50."""
        count = int(self.failed.sum())
        head = f"{self.ages.size} specimens, {count} failed"
        if self.shape is None:
            return f"{head}, no failure law is known"
        lives = (self.b_life(share) for share in (0.10, 0.50))
        return head + "".join(f", {each.name} {_written(each.age, 3)}{self._behind}" for each in lives)

    @property
    def _behind(self) -> str:
        return f" {self.unit}" if self.unit else ""

    def summary(self) -> str:
        """Return the law, B10 and B50 with their intervals as text."""
        lines = [self.headline()]
        if self.shape is not None:
            percent = f"{100 * self.level:g} %"
            lines += [
                f"  {each.name:6s} {_written(each.age)} {_span(each.low, each.high)}{self._behind}"
                for each in (self.b_life(share) for share in (0.10, 0.50))
            ]
            lines += [
                f"  {name:6s} {_written(value)} {_span(*interval)}{unit}"
                for name, value, interval, unit in (
                    ("shape", self.shape, self.shape_interval, ""),
                    ("scale", self.scale, self.scale_interval, self._behind),
                )
                if value is not None and interval is not None
            ]
            lines += [f"Weibull law by maximum likelihood, with {percent} intervals.", self.verdict()]
        return "\n".join([*lines, *(each.sentence for each in self.warnings)])

    def to_dict(self) -> dict[str, Any]:
        """Return every field, B10, B50 and the median ranks; None if unknown."""
        estimable = self.shape is not None
        return json_record(
            {
                **{each.name: getattr(self, each.name) for each in fields(self)},
                "b10": self.b_life(0.10) if estimable else None,
                "b50": self.b_life(0.50) if estimable else None,
                "median_ranks": self.median_ranks[1],
                "verdict": self.verdict(),
            }
        )

    def to_frame(self) -> pl.DataFrame:
        """Return shape, scale, B10 and B50 with their intervals, and the number of specimens."""
        rows: list[tuple[str, float | None, str]] = [
            ("units", self.ages.size, ""),
            ("failed", int(self.failed.sum()), ""),
        ]
        if self.shape is not None:
            named = [("shape", self.shape, self.shape_interval), ("scale", self.scale, self.scale_interval)]
            named += [
                (each.name, each.age, (each.low, each.high))
                for each in (self.b_life(share) for share in (0.10, 0.50))
            ]
            for name, value, interval in named:
                unit = "" if name == "shape" else self.unit
                low, high = interval or (None, None)
                rows += [(name, value, unit), (f"{name} low", low, unit), (f"{name} high", high, unit)]
        return table_of(rows)


@takes_si()
def weibull(
    ages: ArrayLike, failed: ArrayLike, *, unit: str = "", level: float = 0.90, seed: int = 0
) -> Population:
    """Return the Weibull law of ages at failure; some specimens may not have failed.

    Parameters
    ----------
    ages
        Age of each specimen at failure, or when last seen, in one unit, shape (specimens,).
    failed
        Whether each has failed, shape (specimens,).
    unit
        Unit of the ages, e.g. "pages" or "h", for texts and axes.
    level
        Level of the intervals, e.g. 0.9.
    seed
        Random seed of the intervals.

    Raises
    ------
    ParameterError
        If an age is not greater than 0 (with its index), or the shapes do not match.

    Examples
    --------
    >>> law = weibull([54, 187, 216, 240, 244, 335, 361, 373, 375, 386, 500], [True] * 10 + [False])
    >>> round(law.shape, 3), round(law.scale, 1)
    (2.457, 340.5)
    """
    if not 0 < level < 1:
        raise ParameterError(f"level is {level}: it must be between 0 and 1", quantity="level")
    values, ends = _checked(ages, failed)
    # At one age failures come first: a specimen last seen there had outlived it.
    order = np.lexsort((~ends, values))
    values, ends = values[order], ends[order]
    warnings = _warnings(values, ends, unit)
    if not _is_estimable(values, ends):
        return Population(values, ends, None, None, None, None, level, unit, warnings, seed)
    shape, scale = _fitted(np.log(values)[None, :], np.ones(values.size), ends)
    shapes = np.quantile(
        _estimates_of_standard(_plan(ends), seed)[1], [0.5 + level / 2, 0.5 - level / 2]
    )  # of a shape of 1: their ratio to the true one
    bounds = (float(shape[0] / shapes[0]), float(shape[0] / shapes[1]))
    law = Population(
        values, ends, float(shape[0]), float(scale[0]), bounds, None, level, unit, warnings, seed
    )
    _, low, high = law.lives([1 - np.exp(-1.0)])
    return replace(law, scale_interval=(float(low[0]), float(high[0])))


def _checked(ages: ArrayLike, failed: ArrayLike) -> tuple[FloatArray, BoolArray]:
    values, ends = numbers_of("ages", ages), np.asarray(failed)
    if values.ndim != 1 or ends.shape != values.shape:
        raise ParameterError(f"ages {values.shape} and failed {ends.shape} must be lists of equal length")
    if ends.dtype != bool:
        raise ParameterError("failed must be true or false for each specimen", quantity="failed")
    wrong = np.flatnonzero(~(np.isfinite(values) & (values > 0)))
    if wrong.size:
        place = int(wrong[0])
        raise ParameterError(
            f"age {place} is {values[place]:g}: it must be greater than 0", quantity="ages", index=place
        )
    return values, ends


def _is_estimable(ages: FloatArray, failed: BoolArray) -> bool:
    """Whether a law can be estimated: two failures, and some specimen that outlived the first of them."""
    return bool(failed.sum() >= _LEAST and ages[failed].min() < ages.max())


def _warnings(ages: FloatArray, failed: BoolArray, unit: str) -> tuple[Warning, ...]:
    """What is to be known of few failures; nothing where there are more."""
    count = int(failed.sum())
    if count >= _FEW and _is_estimable(ages, failed):
        return ()
    last = float(ages.max() if count != 1 else ages[failed][0])
    if not _is_estimable(ages, failed):
        return (_no_law(count, f"{last:.6g} {unit}".strip(), last),)
    return (
        Warning(
            "few failures",
            "two failures show little of the spread, so the intervals are wide"
            if count == _LEAST
            else "three failures show little of the spread, so the intervals are wide",
            remedy="follow specimens until more have failed",
            severity="watch",
            failures=count,
        ),
    )


def _no_law(count: int, shown: str, age: float) -> Warning:
    """Why so many failures determine no law; an age as a number, and as it is shown."""
    return Warning(
        "no law of failures",
        "no specimen has failed up to {shown}, so the failure law is unknown"
        if count == 0
        else "only one specimen has failed, at {shown}, so the failure law is unknown"
        if count == 1
        else "all specimens failed at {shown}, which shows no spread, so the failure law is unknown",
        remedy="follow specimens until more have failed",
        severity="act",
        failures=count,
        age=age,
        shown=shown,
    )


def _place(share: FloatArray) -> FloatArray:
    """Where a share stands on the axis of a Weibull plot: ln(age / scale) times shape."""
    return np.asarray(np.log(-np.log1p(-share)), dtype=float)


def _fitted(logs: FloatArray, counts: FloatArray, failed: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Shape and scale of greatest likelihood for rows of logarithms of ages, shape (rows, ages).

    At each age stand ``counts`` specimens, of which one has failed where ``failed``. The shape solves
    sum(t^b ln t) / sum(t^b) - 1/b = mean of ln t over failures; the left side grows with b.
    """
    top = logs.max(axis=1, keepdims=True)
    below = logs - top
    gap = -below[:, failed].mean(axis=1)
    shape = 1.0 / gap  # never above the root: there the left side is at most the right one
    for _ in range(_STEPS):
        weights = counts * np.exp(shape[:, None] * below)
        total = weights.sum(axis=1)
        weights *= below
        mean = weights.sum(axis=1) / total
        weights *= below
        spread = weights.sum(axis=1) / total - mean**2
        step = -(mean - 1.0 / shape + gap) / (shape * spread + 1.0 / shape)
        shape = shape * np.exp(np.clip(step, -1.0, 1.0))
        if np.abs(step).max() < _SETTLED:
            break
    weights = counts * np.exp(shape[:, None] * below)
    scale = np.exp(top[:, 0] + np.log(weights.sum(axis=1) / failed.sum()) / shape)
    return shape, scale


def _plan(failed: BoolArray) -> tuple[int, ...]:
    """How many specimens leave at each failure: the one that fails, and those withdrawn before the next.

    Specimens withdrawn before the first failure say least, and leave no trace in the draws.
    """
    return tuple(np.diff(np.append(np.flatnonzero(failed), failed.size)).tolist())


@lru_cache(maxsize=32)
def _estimates_of_standard(plan: tuple[int, ...], seed: int) -> tuple[FloatArray, FloatArray]:
    """Scales and shapes estimated from draws from the law of scale 1 and shape 1, withdrawn by the plan.

    Spacings of failures under such a plan are exponential, each over the specimens then at risk (Viveros and
    Balakrishnan, Technometrics 36, 1994, 84-91).
    """
    counts, random = np.array(plan, dtype=float), np.random.default_rng(seed)
    at_risk, fails = counts[::-1].cumsum()[::-1], np.ones(counts.size, dtype=bool)
    rows = max(_HELD // counts.size, 1)
    shape, scale = np.empty(_DRAWS), np.empty(_DRAWS)
    for i in range(0, _DRAWS, rows):
        some = slice(i, min(i + rows, _DRAWS))
        spacings = random.exponential(size=(some.stop - i, counts.size)) / at_risk
        shape[some], scale[some] = _fitted(np.log(spacings.cumsum(axis=1)), counts, fails)
    return scale, shape


def _written(value: float, digits: int = 4) -> str:
    """A number with so many digits, those up to ten millions without a power of ten."""
    return f"{float(f'{value:.{digits}g}'):.8g}" if np.isfinite(value) else "unknown"


def _span(low: float, high: float) -> str:
    return f"[{_written(low)}, {_written(high)}]"
