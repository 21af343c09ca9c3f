"""The age at which specimens, and shares of the population, reach a limit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

import numpy as np
from scipy import special

from hersey.arrays import FloatArray
from hersey.life.growth.marginal import Specimens
from hersey.life.indicator import OwnAges
from hersey.life.maintenance import Followed
from hersey.result import OPEN, Means, Record, Result
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

#: Confidence of every interval of an age: what life tests are planned for.
CONFIDENCE = 0.9
#: Standard deviations of a normal distribution in half of such an interval.
DEVIATIONS = 1.645
#: A law is fitted up to the last run, and growth may depart from it later: what the law does at age t comes
#: at last (t / last)^k. Standard deviations of ln k in common to all specimens and of each alone.
BEYOND, OWN_BEYOND = 0.12, 0.12
#: Share of draws from which it is worth a word that they do not reach a limit.
_SAID = 0.05
#: Probability of having failed from which a specimen has failed, and up to which it is still running.
FAILED, RUNNING = 0.95, 0.05
#: Times the age followed up to which runs show an age: beyond it growth may set in or end that no run shows.
FAR = 3.0
#: Times the age followed beyond which no interval begins: what sets in later, runs did not show.
SURE = 1.75
#: Fewest specimens that show how specimens differ: fewer make no population.
POPULATION = 4
#: Integrals over age: places and weights, turns of the search and where it ends, the greatest logarithm.
_NODES, _HEIGHTS = np.polynomial.legendre.leggauss(8)
_PLACES, _PARTS = 0.5 * (1.0 + _NODES), 0.5 * _HEIGHTS
_TO_END = np.append(_PLACES, 1.0)
_TURNS, _SETTLED, _STEEPEST, _HUGE = 60, 3e-3, 3.0, 300.0
#: Turns from which on the range is halved: where growth is steep, Newton's method may swing from end to end.
_HALVING = 30


@dataclass(frozen=True)
class Interval(Record):
    """A number with its 90 % interval; infinite where it is never reached."""

    value: Annotated[float, OPEN]
    low: Annotated[float, OPEN]
    high: Annotated[float, OPEN]

    def __str__(self) -> str:
        """Return value and limits with sensible digits."""
        if math.isinf(self.value):
            return "not reached" if math.isinf(self.low) else f"later than {rounded(self.low)}"
        high = "no upper limit" if math.isinf(self.high) else rounded(self.high)
        return f"{rounded(self.value)} [{rounded(self.low)}, {high}]"


@dataclass(frozen=True)
class AgeAtLimit(Record):
    """The age at which one specimen, or a share of the population, reaches a limit."""

    unit: str
    age: Interval
    never: Annotated[
        float, Means("share of draws that never reach it")
    ]  #: share of draws that never reach it
    last: Annotated[
        float, Means("age when last seen; null for the population", open=True)
    ]  #: greatest age of its data; NaN for the population
    passed: Annotated[
        float, Means("share of draws that have reached it by then")
    ]  #: share of draws that have reached it by then
    begun: Annotated[
        float, Means("age of the last maintenance after which it aged from new; 0 without any")
    ] = 0.0  #: age from which it ages
    followed: Annotated[
        float, Means("age followed since then; that of all specimens if it was not seen since then")
    ] = 0.0  #: age followed since then

    def __str__(self) -> str:
        """Return the age in words."""
        return f"{self.unit}: {self.age}{self.outcome}"

    @property
    def state(self) -> str:
        """Whether the specimen has ``failed``, is ``running`` or ``unclear``, when last seen."""
        if self.passed >= FAILED:
            return "failed"
        return "unclear" if self.passed > RUNNING else "running"

    def shown(self, times: float) -> float:
        """Return the age after so many times the age followed since it ``begun`` to age."""
        return self.begun + times * self.followed

    @property
    def far(self) -> bool:
        """Whether it is beyond `FAR` times the age followed."""
        return self.age.value > self.shown(FAR) > self.begun

    @property
    def outcome(self) -> str:
        """Whether it has passed already, or may not come, in words that follow the age."""
        words, seen = "", f" (last seen at {self.last:.10g})"
        if self.state == "failed":
            words = f", already passed{seen}"
        elif self.state == "unclear":
            words = f", passed with a probability of {percent(self.passed)}{seen}"
        open_ = math.isfinite(self.age.value) and self.never > _SAID
        return words + (f", not reached in {self.never:.0%} of draws" if open_ else "")


@dataclass(frozen=True, repr=False)
class AgesAtLimit(Result):
    """Ages at which specimens and population reach a limit."""

    quantity: str
    age_unit: str
    limit: float
    units: tuple[AgeAtLimit, ...]
    b10: Annotated[
        AgeAtLimit | None,
        Means("a tenth of new specimens has reached it; null for fewer than four"),
    ]
    b50: Annotated[AgeAtLimit | None, Means("the same of half of new specimens")]
    warnings: tuple[Warning, ...]
    accumulates: Annotated[bool, Means("whether the limit applies to the integral over age")] = (
        False  #: the limit is that of the integral over age
    )

    def summary(self) -> str:
        """Return the ages as text."""
        unit = f" ({self.age_unit})" if self.age_unit else ""
        lines = [f"age{unit} at which {self.quantity} reaches {self.limit:.4g}, with 90 % intervals"]
        lines += [f"  {each}" for each in self.rows]
        return "\n".join([*lines, *(f"- {each}" for each in self.warnings)])

    def headline(self) -> str:
        """Return the age at which half of the population reaches the limit, or the first specimen."""
        limit = f"{self.quantity} = {self.limit:.4g}"
        if self.b50 is not None:
            return f"half of new specimens reach {limit} at {self.b50.age} {self.age_unit}"
        first = min(self.units, key=lambda each: each.age.value)
        return f"{first.unit} reaches {limit} at {first.age} {self.age_unit}"

    @property
    def rows(self) -> tuple[AgeAtLimit, ...]:
        """The specimens, then the population where there is one."""
        return (*self.units, *(each for each in (self.b10, self.b50) if each is not None))

    def to_frame(self) -> pl.DataFrame:
        """Return one row per specimen, then the population; infinite if never reached."""
        import polars as pl

        rows = self.rows
        unit = self.age_unit or "1"
        return pl.DataFrame(
            {
                "unit": [row.unit for row in rows],
                f"age ({unit})": [row.age.value for row in rows],
                f"age low ({unit})": [row.age.low for row in rows],
                f"age high ({unit})": [row.age.high for row in rows],
                "never (1)": [row.never for row in rows],
                f"last age ({unit})": [row.last for row in rows],
            }
        )


def age_at_limit(
    name: str,
    ages: FloatArray,
    last: float = math.nan,
    earliest: float = math.inf,
    greatest: float = 0.0,
    begun: float = 0.0,
) -> AgeAtLimit:
    """Return the age at the limit of a specimen that was last seen at ``last``, of equally probable ages.

    Where most draws do not reach it, the interval begins at ``earliest`` at the latest. It begins at `SURE`
    times the age followed since the specimen ``begun`` to age, and has no end where the age is beyond `FAR`
    times that. Of the population, and of a specimen not seen since then, the age followed is ``greatest``.
    """
    seen, soonest, since = (np.array([each], dtype=float) for each in (last, earliest, begun))
    found = ages_of_each([name], ages[:, None], seen, soonest, since, greatest)[0]
    return replace(found, last=last)  # the same NaN: results are compared


def ages_of_each(
    names: Iterable[str],
    ages: FloatArray,
    last: FloatArray,
    earliest: FloatArray,
    begun: FloatArray,
    greatest: float,
) -> list[AgeAtLimit]:
    """Return `age_at_limit` of each specimen; ``ages`` are (draws, specimens), the others (specimens,)."""
    never, passed = np.isinf(ages).mean(axis=0), (ages <= last).mean(axis=0)
    low, age, high = quantiles(ages)
    low = np.where(np.isinf(age), np.minimum(low, earliest), low)
    seen = _age_followed(last, begun, greatest)
    low = np.where(seen > 0.0, np.minimum(low, begun + SURE * seen), low)
    high = np.where((seen > 0.0) & (age > begun + FAR * seen), math.inf, high)
    columns = (each.tolist() for each in (age, low, high, never, last, passed, begun, seen))
    return [
        AgeAtLimit(name, Interval(*numbers[:3]), *numbers[3:])
        for name, *numbers in zip(names, *columns, strict=True)
    ]


def _age_followed(last: FloatArray, begun: FloatArray, greatest: float) -> FloatArray:
    """Age followed since each specimen ``begun`` to age; that of all where it was not seen since then."""
    return np.where(last > begun, last - begun, greatest)


def share_of_specimens(
    ages: FloatArray, share: float, earliest: float = math.inf, followed: float = 0.0
) -> AgeAtLimit:
    """Age that a share of new specimens has reached, ``ages`` being sorted along the specimens."""
    name = f"B{share * 100:.0f}"
    return age_at_limit(name, reached_by(ages, share), earliest=earliest, greatest=followed)


def reached_by(ages: FloatArray, share: float) -> FloatArray:
    """Return the age that a share of specimens has reached in each draw, ``ages`` being sorted along them."""
    return np.asarray(ages[:, math.ceil(share * ages.shape[1]) - 1])


@dataclass(frozen=True)
class Earliest:
    """Ages before which a limit is not reached even if an indicator without growth grows, at `CONFIDENCE`."""

    units: FloatArray  #: of each specimen
    first: float  #: of the first of them
    b10: float
    b50: float

    @classmethod
    def of(cls, own: OwnAges) -> Earliest:
        """Return those of draws of an indicator that grows; the new ones sorted along the specimens."""
        of_new = (reached_by(own.new, share) for share in (0.1, 0.5))
        return cls(_least(own.known), *(float(_least(e)) for e in (own.known.min(axis=1), *of_new)))

    @classmethod
    def of_first(cls, each: Sequence[Earliest]) -> Earliest:
        """Return those of the first of all modes; infinite without any."""
        return cls(
            np.min([e.units for e in each], axis=0),
            *(min(ages) for ages in zip(*((e.first, e.b10, e.b50) for e in each), strict=True)),
        )

    def within_reach(self, followed: Followed) -> Earliest:
        """Return those that runs show: up to `SURE` times the age followed.

        Of a specimen seen only when new, up to that of all.
        """
        last, begun = (np.array(list(ages.values())) for ages in (followed.last, followed.begun))
        most = SURE * followed.greatest
        units = np.minimum(self.units, begun + SURE * _age_followed(last, begun, followed.greatest))
        return Earliest(units, *(min(each, most) for each in (self.first, self.b10, self.b50)))

    @classmethod
    def unknown(cls, units: int) -> Earliest:
        """Return ages of which nothing is known but the draws."""
        return cls(np.full(units, math.inf), math.inf, math.inf, math.inf)


def _least(ages: FloatArray) -> FloatArray:
    return np.asarray(np.quantile(ages, 1.0 - CONFIDENCE, axis=0, method="inverted_cdf"))


def of_population(
    ages: FloatArray, specimens: int, least: Earliest, followed: float
) -> tuple[AgeAtLimit, AgeAtLimit] | tuple[None, None]:
    """B10 and B50 as `share_of_specimens`, of a population that so many specimens show; None for too few."""
    if specimens < POPULATION:
        return None, None
    shares = ((0.1, least.b10), (0.5, least.b50))
    b10, b50 = (share_of_specimens(ages, share, age, followed) for share, age in shares)
    return b10, b50


def ages_at_limit(
    quantity: str,
    age_unit: str,
    limit: float,
    followed: Followed,
    own: OwnAges,
    warnings: tuple[Warning, ...],
    *,
    accumulates: bool = False,
    earliest: Earliest | None = None,
) -> AgesAtLimit:
    """Return what draws of the ages of specimens, and of new ones, show.

    ``accumulates``: the limit is that of the integral of the quantity over age. ``earliest`` is stated of a
    quantity that does not grow.
    """
    least = earliest or Earliest.unknown(len(followed.last))
    quantity = f"the sum of {quantity} over age" if accumulates else quantity
    last, begun, greatest = followed
    seen, since = (np.array([of[name] for name in last], dtype=float) for of in (last, begun))
    known = ages_of_each(last, own.known, seen, least.units, since, greatest)
    b10, b50 = of_population(np.sort(own.new, axis=1), len(known), least, greatest)
    return AgesAtLimit(quantity, age_unit, limit, tuple(known), b10, b50, warnings, accumulates)


def ages_of(drawn: Specimens, level: FloatArray) -> FloatArray:
    """Ages, in the greatest age, at which drawn specimens reach a level (logarithm), shape (draws, 1)."""
    above = np.maximum(level - drawn.level, 0.0)
    with np.errstate(over="ignore"):
        return np.where(above > 0.0, drawn.law.age(drawn.size, above, drawn.shape), 0.0)


def ages_of_sum(
    drawn: Specimens, level: FloatArray, last: FloatArray | None = None, power: FloatArray | None = None
) -> FloatArray:
    """Ages at which the integral of the indicator from age 0 reaches a level (logarithm), as in `ages_of`.

    Growth beyond the ages ``last`` departs from the law by ``power``, as in `later`; both as the level.
    Newton's method in the logarithms of integral and age, kept between ends by halving.
    """
    need = level - drawn.level
    size, goal = (np.broadcast_to(x, need.shape).ravel() for x in (drawn.size, need))
    shape = np.broadcast_to(drawn.shape, (len(drawn.shape), *need.shape)).reshape(len(drawn.shape), need.size)
    # What grows has got there before a constant would, after a fall that is over.
    high, low = goal.copy(), np.full(goal.shape, -np.inf)
    if drawn.law.falls_by is not None:
        high += np.broadcast_to(drawn.law.falls_by(drawn.shape), need.shape).ravel()
    at, open_ = high.copy(), np.arange(goal.size)
    slows = None if last is None or power is None else _flat(need.shape, np.log(last), 1.0 / power)
    for turn in range(_TURNS):
        x, a, t = size[open_], shape[:, open_], at[open_]
        ages = np.exp(t)[:, None] * _TO_END if slows is None else _of_law(t, *(e[open_] for e in slows))
        with np.errstate(over="ignore"):
            grown = np.minimum(drawn.law.log_growth(x[:, None], ages, a[:, :, None]), _HUGE)
        end = grown[:, -1]
        sum_ = np.log(np.exp(grown[:, :-1]) @ _PARTS)
        left = goal[open_] - t - sum_
        high[open_] = np.where(left < 0.0, t, high[open_])
        low[open_] = np.where(left < 0.0, low[open_], t)
        step = t + left / np.exp(np.clip(end - sum_, -_STEEPEST, _STEEPEST))
        halved = np.where(np.isfinite(low[open_]), 0.5 * (low[open_] + high[open_]), high[open_] - 1.0)
        near = ~(np.abs(left) > _SETTLED)
        inside = (step > low[open_]) & (step < high[open_]) & (near | (turn < _HALVING))
        at[open_] = np.where(inside, step, halved)
        open_ = open_[~near & (high[open_] - low[open_] > _SETTLED)]
        if not open_.size:
            break
    return np.exp(at).reshape(need.shape)


def _flat(shape: tuple[int, ...], *arrays: FloatArray) -> list[FloatArray]:
    return [np.broadcast_to(each, shape).ravel() for each in arrays]


def _of_law(log_age: FloatArray, log_last: FloatArray, slows: FloatArray) -> FloatArray:
    """Ages of the law at the places of an integral up to ages, (ages, places)."""
    after = log_age[:, None] + np.log(_TO_END) - log_last[:, None]
    return np.asarray(np.exp(np.where(after > 0.0, after * slows[:, None], after) + log_last[:, None]))


def heavy_tailed(random: np.random.Generator, shape: tuple[int, int]) -> FloatArray:
    """Draws of Student's t of four degrees of freedom, none beyond five, evenly spread in each column."""
    spread = np.clip(special.stdtrit(4.0, (np.arange(shape[0]) + 0.5) / shape[0]), -5.0, 5.0)
    return np.asarray(spread[random.permuted(np.tile(np.arange(shape[0])[:, None], (1, shape[1])), axis=0)])


def beyond(random: np.random.Generator, draws: int, *widths: int) -> tuple[FloatArray, ...]:
    """Return powers by which ages beyond the last run depart from those of a law, as `later` takes them.

    One array of equally probable draws for each of ``widths``: numbers of specimens. Part of a row is in
    common to it, over all arrays.
    """
    common = BEYOND * heavy_tailed(random, (draws, 1))
    return tuple(np.exp(common + OWN_BEYOND * heavy_tailed(random, (draws, each))) for each in widths)


def later(ages: FloatArray, last: FloatArray, power: FloatArray) -> FloatArray:
    """Return ages of which the ratio to the last run, beyond that, is raised to a power."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        return np.asarray(np.where((ages > last) & (last > 0.0), last * (ages / last) ** power, ages))


def quantiles(values: FloatArray) -> FloatArray:
    """Lower end, median and upper end over the draws; infinite numbers are numbers."""
    ends = [0.5 - CONFIDENCE / 2, 0.5, 0.5 + CONFIDENCE / 2]
    return np.asarray(np.quantile(values, ends, axis=0, method="inverted_cdf"))


def interval(values: FloatArray) -> Interval:
    """Return the median of draws with its interval."""
    low, median, high = (float(each) for each in quantiles(values))
    return Interval(median, low, high)


def rounded(age: float, digits: int = 3) -> str:
    """Return a finite age with so many digits, those of pages without a power of ten."""
    return f"{float(f'{age:.{digits}g}'):.10g}"


def percent(share: float) -> str:
    """Return a probability in per cent that is neither certain nor impossible, as ``97 %``."""
    if share > 0.99:
        return "over 99 %"
    return "below 1 %" if share < 0.01 else f"{100.0 * share:.0f} %"
