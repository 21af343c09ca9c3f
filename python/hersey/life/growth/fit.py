"""The growth of a positive indicator over specimens, and the ages at which it reaches a limit.

The laws of `laws` are fitted to the logarithm of the indicator over all specimens together, each with its
own level and rate, and weighed by their evidence; nothing depends on one law alone unless the data say so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray, numbers_of, one_thread
from hersey.errors import ParameterError
from hersey.life.growth.draws import Draws, draws_of
from hersey.life.growth.law_weights import evidence_of, selected, weights_by
from hersey.life.growth.laws import LAWS, Law
from hersey.life.growth.limit_ages import (
    AgesAtLimit,
    Earliest,
    Interval,
    ages_at_limit,
    quantiles,
)
from hersey.life.growth.peaks import peaks
from hersey.life.growth.points import Points, checked_runs, points_of, warnings_of
from hersey.life.growth.posterior import Posterior, parameters_of, posterior, resampled
from hersey.life.indicator import OwnAges
from hersey.life.maintenance import Followed
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Weight of no growth from which an indicator does not show any.
UNCHANGED = 0.5
#: Draws behind every interval; of many specimens fewer, so many in all, down to the fewest.
_DRAWS, _IN_ALL, _FEWEST = 2000, 200_000, 400
#: Specimens that show what all share: more would show it better than any law holds.
_SHOWING = 100
#: Level of the upper bound of a rate.
_AT_MOST = 0.95
#: Draws, about, behind the middle of a curve.
_OF_MIDDLE = 100


@dataclass(frozen=True)
class GrowthCurves:
    """The indicator of each specimen without the scatter of runs: median and 90 % band, (specimens, ages)."""

    units: tuple[str, ...]
    age: FloatArray
    median: FloatArray
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True, repr=False)
class Growth(Result):
    """Growth of an indicator over specimens.

    ``weights`` are those of the growth laws and sum to 1. ``parameters`` holds for each law: the value of the
    median new specimen (``level``), its growth per age (``rate``; the whole growth for a law that ends), the
    spreads between specimens and the scatter of runs (standard deviations of the logarithm), and the shape.
    """

    also_stated = ("law", "shown")
    not_stated = ("_draws", "_if_growing", "_points", "_scale", "_selected")

    quantity: str
    age_unit: str
    units: tuple[str, ...]
    runs: Annotated[tuple[int, ...], Means("of each specimen")]  #: of each specimen
    last_age: Annotated[tuple[float, ...], Means("of each specimen")]
    weights: Annotated[dict[str, float], Means("of the growth laws, sum 1")]
    parameters: Annotated[dict[str, dict[str, Interval]], Means("of each law")]
    effective: (
        Annotated[
            float, Means("number of independent draws that the posterior is worth")
        ]  #: how many independent draws the posterior is worth, of the least sampled law that counts
    )
    rate_high: Annotated[
        float, Means("growth of the median new specimen per age at the most, relative (upper 95 % bound)")
    ]
    warnings: tuple[Warning, ...]
    _draws: Draws = field(repr=False)
    _if_growing: Draws | None = field(repr=False)  #: as if it grew; None where growth shows
    _points: Points = field(repr=False)
    _scale: tuple[float, float] = field(repr=False)  #: greatest age; mean logarithm of the value
    _selected: str | None = field(repr=False)
    seed: int = 0

    @property
    def law(self) -> str | None:
        """The growth law that the data select by its whole evidence, or None if several fit."""
        return self._selected

    @property
    def shown(self) -> bool:
        """Whether the runs show growth."""
        return self.weights.get("constant", 0.0) < UNCHANGED

    def summary(self) -> str:
        """Return the growth as text."""
        unit = f" {self.age_unit}" if self.age_unit else ""
        heaviest = sorted(self.weights, key=lambda name: -self.weights[name])
        lines = [
            self.headline(),
            f"{len(self.units)} specimens, {sum(self.runs)} runs, up to {max(self.last_age):.6g}{unit}",
            "weights of the growth laws: "
            + ", ".join(f"{name} {self.weights[name]:.2f}" for name in heaviest),
        ]
        for name in heaviest:
            if self.weights[name] >= 0.1:
                shown = ", ".join(f"{k} {v}" for k, v in self.parameters[name].items())
                lines.append(f"  {name}: {shown}")
        return "\n".join([*lines, *(f"- {each}" for each in self.warnings)])

    def headline(self) -> str:
        """Return the growth law that the data select."""
        if not self.shown:
            return f"{self.quantity} shows no growth"
        if self.law:
            formula = next(law.formula for law in LAWS if law.name == self.law)
            return f"growth of {self.quantity}: {self.law}, {formula}"
        near = [name for name, weight in self.weights.items() if weight >= 0.05]
        return f"growth of {self.quantity}: several growth laws fit ({', '.join(near)})"

    def to_frame(self) -> pl.DataFrame:
        """Return the parameters of each law with its weight."""
        import polars as pl

        rows = [
            (law, self.weights[law], name, each.value, each.low, each.high)
            for law, named in self.parameters.items()
            for name, each in named.items()
        ]
        names = ("law", "weight (1)", "parameter", "value (given)", "low (given)", "high (given)")
        return pl.DataFrame(rows, schema=names, orient="row")

    def at(self, age: ArrayLike, *, units: Sequence[str] | None = None) -> GrowthCurves:
        """Return the indicator of each specimen at ages, without the scatter of runs.

        Parameters
        ----------
        age
            One or more ages, in the unit of the data.
        units
            Specimens. Default: all.

        Raises
        ------
        ParameterError
            If an age is negative or not a number, or a specimen has no runs here.
        """
        ages = np.atleast_1d(numbers_of("age", age)).ravel()
        if not (np.isfinite(ages) & (ages >= 0.0)).all():
            raise ParameterError("an age is negative or not a number. Ages count from new")
        names, place = tuple(self.units if units is None else units), {u: i for i, u in enumerate(self.units)}
        for name in names:
            if name not in place:
                raise ParameterError(f"'{name}' has no runs here. Name any of: {', '.join(self.units[:8])}")
        drawn = self._draws.curves(ages / self._scale[0], [place[name] for name in names])
        low, median, high = np.exp(quantiles(drawn) + self._scale[1])
        return GrowthCurves(names, ages, median, low, high)

    def reaches(self, limit: float, *, limit_error: float = 0.0, accumulates: bool = False) -> AgesAtLimit:
        """Return the ages at which each specimen, and 10 % and 50 % of new specimens, reach a limit.

        A specimen that has already passed the limit is treated with the same draws; one that starts above it
        has age 0.

        Parameters
        ----------
        limit
            Limit in the unit of the values, positive; for an indicator that accumulates, times the unit of
            age.
        limit_error
            Relative standard error of limit and sensor, common to all runs.
        accumulates
            Whether the limit applies to the integral of the values from age 0.

        Raises
        ------
        ParameterError
            If the limit is not positive, or its error negative.
        """
        own = OwnAges(*self.drawn_ages(limit, limit_error=limit_error, accumulates=accumulates))
        earliest = self.earliest(limit, limit_error=limit_error, accumulates=accumulates)
        return ages_at_limit(
            self.quantity,
            self.age_unit,
            limit,
            self._followed,
            own,
            self.warnings,
            accumulates=accumulates,
            earliest=earliest,
        )

    @property
    def _followed(self) -> Followed:
        return Followed.from_new(dict(zip(self.units, self.last_age, strict=True)))

    def earliest(
        self, limit: float, *, limit_error: float = 0.0, accumulates: bool = False
    ) -> Earliest | None:
        """Return ages before which a limit is not reached even if the indicator grows; None where it does.

        Arguments as for `reaches`.
        """
        if self.shown or self._if_growing is None:
            return None
        ages = self.drawn_ages(limit, limit_error=limit_error, accumulates=accumulates, if_growing=True)
        earliest = Earliest.of(OwnAges(ages[0], np.sort(ages[1], axis=1)))
        return earliest.within_reach(self._followed)

    def drawn_ages(
        self, limit: float, *, limit_error: float = 0.0, accumulates: bool = False, if_growing: bool = False
    ) -> tuple[FloatArray, FloatArray]:
        """Return equally probable ages at a limit, of the specimens and of new ones: (draws, specimens) each.

        Each row is one draw of the shared parameters and of the limit. Arguments as for `reaches`;
        ``if_growing``: as if the indicator grew, also where the runs do not show it.
        """
        if not (math.isfinite(limit) and limit > 0.0):
            raise ParameterError(f"a limit is {limit}: it must be greater than 0", value=limit)
        if not (math.isfinite(limit_error) and limit_error >= 0.0):
            raise ParameterError(f"the error of the limit is {limit_error}: it must not be negative")
        level = math.log(limit) - self._scale[1] - (math.log(self._scale[0]) if accumulates else 0.0)
        draws = self._if_growing if if_growing and self._if_growing is not None else self._draws
        known, new = draws.ages(level, limit_error, accumulates=accumulates)
        return known * self._scale[0], new * self._scale[0]

    def drawn_values(self, unit: int, age: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return logarithms of the indicator of a specimen at ages, (draws, ages), and the scatter of runs.

        The draws are those of `drawn_ages`, in the same order; the scatter has the shape (draws, 1).
        """
        values = self._draws.curve(unit, age / self._scale[0])
        return values + self._scale[1], np.concatenate([u.scatter for u in self._draws.of_specimens])

    def runs_of_units(self) -> list[tuple[FloatArray, FloatArray]]:
        """Return ages and values of the runs of each specimen, ascending in age, in the units given."""
        points, (greatest, middle) = self._points, self._scale
        return [
            (age[given] * greatest, np.exp(value[given] + middle))
            for age, value, given in zip(points.age, points.value, points.given, strict=True)
        ]

    def residuals(self) -> FloatArray:
        """Return the residuals of the logarithms of the runs, in the order given."""
        step = max(1, self._draws.count // _OF_MIDDLE)
        total, number = np.zeros(self._points.value.shape), 0
        for units in self._draws.of_specimens:
            for i in range(0, len(units.scatter), step):
                shape = units.shape[:, i, :, None]
                total += units.level[i][:, None] + units.law.log_growth(
                    units.size[i][:, None], self._points.age, shape
                )
                number += 1
        left = self._points.value - total / number
        return np.asarray(left[self._points.place[0], self._points.place[1]])


@one_thread()
@takes_si()
def fit_growth(
    unit: Sequence[object],
    age: ArrayLike,
    value: ArrayLike,
    error: ArrayLike = 0.0,
    *,
    quantity: str = "value",
    age_unit: str = "",
    laws: Sequence[str] | None = None,
    seed: int = 0,
) -> Growth:
    """Fit the growth of a positive indicator over specimens.

    Priors, all weak: ln(r T) of the median specimen N(-0.5, 2^2), T being the greatest age (ln s of a
    saturating law and a sigmoid); standard deviations between specimens of ln of level and rate
    lognormal, of medians 0.1 and 0.3 and logarithms that spread by 1.2 and 0.8; scatter of runs
    half-normal of scale 0.1; ln(tau/T) N(0.3, 1), of a run-in N(-2, 1), of a sigmoid N(0, 0.7^2), its ln
    m N(0.7, 0.5^2); c N(0.5, 1); logit q N(-1, 1.5^2); logit p N(1, 1); ln m N(0.3, 0.4^2); logit d N(-2,
    1). Growth and no growth are equally probable a priori; the growth laws share their half equally, and
    then by the square root of their evidence, since none of them is quite true.

    Parameters
    ----------
    unit
        Name of the specimen of each run.
    age
        Age of each run since the specimen was new, in one unit, shape (runs,).
    value
        Indicator, positive, in one unit, shape (runs,).
    error
        Relative standard error of each value from the fit of its run; one number or shape (runs,).
    quantity, age_unit
        Names of the indicator and of the unit of age.
    laws
        Names of the growth laws to compare. Default: all of `laws.LAWS`.
    seed
        Random seed; the same data and seed give the same result.

    Raises
    ------
    ParameterError
        If a value is not positive, an age or error negative, or any of them not a number.
    InsufficientDataError
        If no specimen was measured at two ages.

    Examples
    --------
    >>> growth = fit_growth(["A"] * 4 + ["B"] * 4, [0, 10, 20, 30] * 2,
    ...                     [1, 1.2, 1.4, 1.6, 1.1, 1.4, 1.7, 2.0], 0.005, laws=["linear"])
    >>> [round(each.age.value) for each in growth.reaches(2.0).units]
    [50, 30]
    """
    chosen = _chosen(laws)
    names, columns = checked_runs(unit, age, value, error)
    units = tuple(dict.fromkeys(names))
    points, scale = points_of(names, units, *columns)
    random = np.random.default_rng(seed)
    showing = points.spread(_SHOWING)
    found = [posterior(peak, showing, random) for peak in peaks(chosen, showing)]
    evidence = evidence_of(found, chosen)
    weights = weights_by(evidence, found)
    by_law = {law.name: 0.0 for law in chosen} | {
        each.law.name: float(w) for each, w in zip(found, weights, strict=True)
    }
    count = min(_DRAWS, max(_FEWEST, _IN_ALL // len(units)))
    draws = draws_of(resampled(found, weights, count, random), points, seed, random)
    growing = None
    if by_law.get("constant", 0.0) >= UNCHANGED:
        growing = _as_if_growing(found, weights, count, points, seed)
    last = tuple(float(row.max() * scale[0]) for row in points.age)
    runs = tuple(int(n) for n in points.given.sum(axis=1))
    return Growth(
        quantity=quantity,
        age_unit=age_unit,
        units=units,
        runs=runs,
        last_age=last,
        weights=by_law,
        parameters={each.law.name: parameters_of(each, scale) for each in found},
        effective=min(each.effective for each, w in zip(found, weights, strict=True) if w > 0.05),
        rate_high=_rate_high(growing or draws) / scale[0],
        warnings=warnings_of(points),
        _draws=draws,
        _if_growing=growing,
        _points=points,
        _scale=scale,
        _selected=selected(evidence, found),
        seed=seed,
    )


def _as_if_growing(
    found: list[Posterior], weights: FloatArray, count: int, points: Points, seed: int
) -> Draws | None:
    """Draws under the laws that grow; None without such a law."""
    grows = [each.law.grows for each in found]
    kept = [each for each, its in zip(found, grows, strict=True) if its]
    if not kept:
        return None
    shares = weights[grows] / weights[grows].sum()
    random = np.random.default_rng([seed, 5])
    return draws_of(resampled(kept, shares, count, random), points, seed, random)


def _rate_high(draws: Draws) -> float:
    """Relative growth up to the greatest age at the most."""
    return float(np.quantile(draws.grown(), _AT_MOST, method="inverted_cdf"))


def _chosen(laws: Sequence[str] | None) -> list[Law]:
    known = {law.name: law for law in LAWS}
    if laws is None:
        return list(LAWS)
    for name in laws:
        if name not in known:
            raise ParameterError(f"unknown growth law {name!r}. Known laws: {', '.join(known)}")
    if not laws:
        raise ParameterError(f"no growth law is given. Known laws: {', '.join(known)}")
    return [known[name] for name in dict.fromkeys(laws)]
