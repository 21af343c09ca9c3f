"""The age at which a planned replacement costs least, against running to failure.

Who replaces a part at age t or at its failure, whichever comes first, pays per unit of age
C(t) = (R(t) + c F(t)) / integral of R from 0 to t, in planned replacements, where F is the share failed by
t, R = 1 - F, and a failure costs c times a planned replacement (Barlow and Hunter 1960, Operations Research
8:90).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from hersey.arrays import FloatArray, one_thread
from hersey.errors import ParameterError, Setting, sentence
from hersey.life.age import one_of
from hersey.life.failures.draws import Draws, survival_at
from hersey.life.growth.limit_ages import Interval, percent, rounded
from hersey.result import Means, Result
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.failures.law import FailureLaw

#: Ages that are compared, evenly in their logarithm, and the first of them, in the last.
_PLACES, _FIRST = 240, 1e-3
#: Saving below which a replacement does not pay: a curve so flat is level.
_LEVEL = 1e-3
#: Of a law specimens are run to failure at so many times the age by which this share has failed.
_LAST, _BEYOND = 0.999, 10.0
#: Ages of a law that are compared, from this part of the last one on, and the farthest.
_FINE, _PART, _FARTHEST = 1200, 1e-7, 1e300
#: Mean age reached below which all specimens have failed when new: their cost would be infinite.
_SHORTEST = 1e-300
#: Greatest ratio of costs that is taken.
_MOST = 1e4
#: Share of specimens up to which those that outlive the last age do not matter.
_LEFT = 0.05


@dataclass(frozen=True, repr=False)
class Replacement(Result):
    """The age at which a planned replacement costs least per unit of age, and what it saves.

    Costs are relative to running to failure.
    """

    cost_of_failure: Annotated[float, Means("cost of a failure over that of a planned replacement")]
    unit: Annotated[str, Means("unit of the ages; may be empty")]
    level: Annotated[float, Means("of the intervals")]
    pays: Annotated[
        Literal["yes", "no", "not yet decided"], Means("whether a planned replacement costs less")
    ]
    age: Annotated[Interval, Means("age of least cost; null where no planned replacement pays")]
    saving: Annotated[Interval, Means("share of the cost saved at that age; 0 without such an age")]
    until: Annotated[float | None, Means("greatest age that is judged, as far as runs show; null for a law")]
    ages: Annotated[FloatArray, Means("ages of replacement", shape="(n,)")]
    cost: Annotated[FloatArray, Means("cost per unit of age, over that of running to failure", shape="(n,)")]
    cost_low: Annotated[FloatArray, Means(shape="(n,)")]
    cost_high: Annotated[FloatArray, Means(shape="(n,)")]

    def headline(self) -> str:
        """Return at which age to replace, and what it saves."""
        of_unit, one = (f" {self.unit}", f" per {one_of(self.unit)}") if self.unit else ("", "")
        if self.pays == "no":
            until = "" if self.until is None else f" before {rounded(self.until)}{of_unit}"
            return f"no planned replacement{until} pays{self._if}"
        if self.pays == "yes":
            ends, last = rounded(self.age.low), self.age.high
            ends += f" to {rounded(last)}{of_unit}" if math.isfinite(last) else f"{of_unit} or later"
            return (
                f"replace at {rounded(self.age.value)}{of_unit} ({self._level}: {ends}). That costs "
                f"{_percent(self.saving.value)} less{one} than running to failure ({self._level}: "
                f"{_percent(self.saving.low)} to {_percent(self.saving.high)}){self._if}"
            )
        unknown = "whether a planned replacement pays is not yet decided"
        if math.isinf(self.age.value):
            return f"{unknown}{self._if}"
        if self.until is not None and self.age.value > self.until:
            late = f"{rounded(self.age.value)}{of_unit}, is later than the runs show"
            return f"{unknown}: the age of least cost, {late} ({rounded(self.until)}{of_unit}){self._if}"
        saved = (self.saving.low, self.saving.high)
        low, high = (f"{_percent(abs(each))} {'more' if each < 0 else 'less'}" for each in saved)
        cost = f"it costs {low} to {high}{one} than running to failure ({self._level})"
        return f"{unknown}. At {rounded(self.age.value)}{of_unit} {cost}{self._if}"

    @property
    def _if(self) -> str:
        return f", if a failure costs {self.cost_of_failure:g} times a planned replacement"

    @property
    def _level(self) -> str:
        return f"{100 * self.level:g} %"

    def summary(self) -> str:
        """Return at which age to replace, and what it saves, as sentences."""
        return sentence(self.headline())

    def to_frame(self) -> pl.DataFrame:
        """Return the cost against the age of replacement."""
        import polars as pl

        names = (f"age ({self.unit or '1'})", "cost (1)", "cost low (1)", "cost high (1)")
        return pl.DataFrame(
            dict(zip(names, (self.ages, self.cost, self.cost_low, self.cost_high), strict=True))
        )


def _percent(share: float) -> str:
    return percent(share) if share <= 1.0 else f"{100.0 * share:.0f} %"


def costs(survived: FloatArray, lived: FloatArray, cost_of_failure: float) -> FloatArray:
    """Return the cost per unit of age of replacement at ages, in planned replacements.

    Parameters
    ----------
    survived
        Share of specimens that outlives each age, shape (draws, ages).
    lived
        Mean age that specimens reach if they are replaced at each age.
    cost_of_failure
        Over that of a planned replacement.
    """
    return np.asarray((survived + cost_of_failure * (1.0 - survived)) / np.maximum(lived, _SHORTEST))


def places(until: float) -> FloatArray:
    """Return the ages of replacement that are compared, up to the last."""
    return np.geomspace(_FIRST * until, until, _PLACES)


def best_replacement(
    ages: FloatArray,
    relative: FloatArray,
    estimated: FloatArray,
    *,
    cost_of_failure: float,
    unit: str,
    until: float | None,
    left: float = 0.0,
    level: float = 0.90,
) -> Replacement:
    """Return the age of least cost.

    Parameters
    ----------
    ages
        Ages of replacement, ascending; at the last specimens are run to failure.
    relative
        Cost of each draw, as from `costs`, over that at the last age, shape (draws, ages).
    estimated
        That which decides, shape (ages,).
    left
        Share of specimens that outlives the last age. With many, what running to failure costs is unknown.
    """
    tails = [0.5 - level / 2, 0.5 + level / 2]
    own, best = _least(ages, relative), float(_least(ages, estimated[None])[0])
    saved = 1.0 - _at(best, ages, np.vstack([estimated, relative]))
    decided: Literal["yes", "no", "not yet decided"] = "not yet decided"
    if (own < math.inf).mean() <= tails[0] and left <= _LEFT:
        decided, best = "no", math.inf
    elif best <= (math.inf if until is None else until) and (saved[1:] > 0.0).mean() >= tails[1]:
        decided = "yes"
    saving = saved[0], *np.quantile(saved[1:], tails)
    low, high = np.quantile(own, tails, method="inverted_cdf")
    return Replacement(
        cost_of_failure,
        unit,
        level,
        decided,
        Interval(best, float(low), float(high)),
        Interval(*map(float, saving)) if math.isfinite(best) else Interval(0.0, 0.0, 0.0),
        until,
        ages,
        estimated,
        *np.quantile(relative, tails, axis=0),
    )


def _least(ages: FloatArray, relative: FloatArray) -> FloatArray:
    """The age of least cost of each row, between the ages by a parabola; infinite where none pays."""
    logs, row = np.log(ages), np.arange(len(relative))
    place = relative.argmin(axis=1)
    inner = np.clip(place, 1, ages.size - 2)
    before, here, after = (relative[row, inner + step] for step in (-1, 0, 1))
    bend = before - 2.0 * here + after
    with np.errstate(divide="ignore", invalid="ignore"):
        away = np.where(bend > 0.0, 0.5 * (before - after) / bend, 0.0)
    step = logs[1] - logs[0]
    found = np.exp(np.where(inner == place, logs[inner] + np.clip(away, -1.0, 1.0) * step, logs[place]))
    return np.where(relative[row, place] < 1.0 - _LEVEL, found, math.inf)


def _at(age: float, ages: FloatArray, rows: FloatArray) -> FloatArray:
    """Rows at an age, straight between the ages; at the last beyond."""
    age = min(age, float(ages[-1]))
    i = int(np.clip(np.searchsorted(ages, age), 1, ages.size - 1))
    part = (age - ages[i - 1]) / (ages[i] - ages[i - 1])
    return np.asarray(rows[:, i - 1] + part * (rows[:, i] - rows[:, i - 1]))


def cost_ratio(cost_of_failure: float, most: float = _MOST, why: str = "") -> float:
    """Return the cost of a failure over that of a planned replacement.

    Raises
    ------
    ParameterError
        If it is not above 1, where no planned replacement can pay, or beyond the ``most``.
    """
    where = Setting("cost_of_failure").to()
    if not 1.0 < cost_of_failure <= most:
        reason = f", {why}" if why and cost_of_failure > most else ""
        raise ParameterError(
            f"{where} is {cost_of_failure:g}: it must be above 1 and at most {most:g}{reason}. It is the "
            "cost of a failure over that of a planned replacement",
            quantity="cost_of_failure",
        )
    return float(cost_of_failure)


@one_thread()
@takes_si()
def replacement_age(law: FailureLaw, cost_of_failure: float) -> Replacement:
    """Return the age at which a planned replacement costs least per unit of age.

    Parameters
    ----------
    law
        The law, from `weibull`.
    cost_of_failure
        Cost of a failure in service over that of a planned replacement.

    Raises
    ------
    ParameterError
        If the cost is not above 1 or beyond 10,000.
    InsufficientDataError
        If no law is known.

    Examples
    --------
    >>> from hersey import weibull
    >>> law = weibull([54, 187, 216, 240, 244, 335, 361, 373, 375, 386, 500], [True] * 10 + [False])
    >>> round(replacement_age(law, 10.0).age.value)
    120
    """
    cost_ratio(cost_of_failure)
    law.refuse_unknown()
    until = min(_BEYOND * law.age_estimated(_LAST), _FARTHEST)
    ages = np.geomspace(_PART * until, until, _FINE)
    cost = _cost_of(law.draws, ages, law.stress, cost_of_failure)
    estimated = _cost_of(law.estimated, ages, law.stress, cost_of_failure)
    return best_replacement(
        ages,
        cost / cost[:, -1:],
        estimated[0] / estimated[0, -1],
        cost_of_failure=float(cost_of_failure),
        unit=law.unit,
        until=None,
        level=law.level,
    )


def _cost_of(draws: Sequence[Draws], ages: FloatArray, stress: float, cost_of_failure: float) -> FloatArray:
    survived = np.exp(survival_at(draws, ages, stress))
    parts = 0.5 * (survived[:, 1:] + survived[:, :-1]) * np.diff(ages)
    # None fails before the first age, so far below all of them it is.
    lived = ages[0] + np.concatenate([np.zeros((len(survived), 1)), parts.cumsum(axis=1)], axis=1)
    return costs(survived, lived, cost_of_failure)
