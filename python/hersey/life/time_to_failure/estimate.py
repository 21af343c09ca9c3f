"""What ends each specimen, and when: the growth of every indicator against its limit, side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray, one_thread
from hersey.errors import (
    InsufficientDataError,
    Setting,
    capital,
    sentence,
)
from hersey.life.growth.limit_ages import (
    FAR,
    POPULATION,
    AgeAtLimit,
    Earliest,
    Interval,
    of_population,
    quantiles,
    rounded,
)
from hersey.life.indicator import NOT_JUDGED, Indicators
from hersey.life.replacement import Replacement
from hersey.life.time_to_failure.ageing import Ageing, ageing_of
from hersey.life.time_to_failure.attention import Attention, attention_of, half_failed
from hersey.life.time_to_failure.decided import Decided, decided
from hersey.life.time_to_failure.deciding_run import DecidingRun
from hersey.life.time_to_failure.failing_before import FollowedFailing, ShareFailing, failing_of_followed
from hersey.life.time_to_failure.first import SpecimenEnd, ages_of_new, ends_of_specimens, joint_order
from hersey.life.time_to_failure.joined import correlations
from hersey.life.time_to_failure.next_run import NextRun, next_runs
from hersey.life.time_to_failure.questions import questions_of
from hersey.life.time_to_failure.unsure import unsure
from hersey.life.time_to_failure.way import FittedWay, Mode, fitted_ways
from hersey.result import Means, Record, Result
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Places of the curve of the population.
_PLACES = 121
#: Specimens to inspect, and runs, that the advice names.
_ADVISED = 3
#: Rows that a summary shows.
_SHOWN = 24
#: Failure modes of one reason that an error names.
_NAMED = 2


@dataclass(frozen=True)
class ShareEnded(Record):
    """Share of new specimens that have ended at an age: median and 90 % band over the draws."""

    age: FloatArray
    median: FloatArray
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True, repr=False)
class TimeToFailure(Result):
    """Failure modes and times to failure of specimens and population; ages in ``age_unit``."""

    also_stated = ("attention", "advice")

    age_unit: str
    modes: tuple[Mode, ...]
    units: tuple[SpecimenEnd, ...]
    ageing: Annotated[
        Ageing, Means("whether anything ages, and the earliest age at which a specimen can fail")
    ]
    b10: Annotated[
        AgeAtLimit | None,
        Means(
            "age by which a tenth of new specimens has failed by any mode; null for fewer than four specimens"
        ),
    ]
    b50: Annotated[AgeAtLimit | None, Means("the same of half of new specimens")]
    shares: Annotated[
        dict[str, Interval] | None,
        Means("share of new specimens that fail by each mode; null for fewer than four specimens"),
    ]
    curve: Annotated[ShareEnded | None, Means("null for fewer than four specimens")]
    until: Annotated[
        float | None, Means("age that specimens should reach, as asked; null if none was stated")
    ]
    followed_failing: Annotated[
        FollowedFailing | None, Means("how many of the specimens fail before that age; null without it")
    ]
    share_failing: Annotated[
        ShareFailing | None,
        Means("whether at most a share of new specimens fails before that age; null if not asked or unknown"),
    ]
    replacement: Annotated[
        Replacement | None,
        Means("when a planned replacement costs least; null if not asked, or for fewer than four specimens"),
    ]
    next_runs: Annotated[
        tuple[NextRun, ...],
        Means(
            "runs that help to decide whether specimens reach that age or, if none was stated, have failed; "
            "the most helpful first"
        ),
    ]
    deciding_runs: Annotated[
        tuple[DecidingRun, ...],
        Means("the run that helps most to decide the share, and when to replace, where these are open"),
    ]
    warnings: Annotated[
        tuple[Warning, ...],
        Means("failure modes not judged, what is unknown, then warnings of the modes that may come first"),
    ]  #: failure modes not judged, what is not known, then those of the modes that may come first
    seed: int = 0

    @property
    def ending(self) -> tuple[Mode, ...]:
        """Failure modes that end a specimen: all but the precursors."""
        return tuple(mode for mode in self.modes if not mode.sign)

    @cached_property
    def attention(self) -> Attention:
        """Which specimens need attention, and what age the others should reach."""
        return attention_of(self.units)

    def summary(self) -> str:
        """Return specimens, population, what is unknown and what to measure next as text."""
        of_unit = f" ({self.age_unit})" if self.age_unit else ""
        lines = [
            self.headline(),
            *filter(None, [self.of_new(), *self.answers(), self.of_followed()]),
            f"age of first failure{of_unit}, with 90 % intervals",
        ]
        lines += [f"  {each}" for each in self.units[:_SHOWN]]
        if len(self.units) > _SHOWN:
            lines.append(f"  and {len(self.units) - _SHOWN} more specimens")
        lines += self._of_population(of_unit)
        lines += [
            f"{each.where} is not judged. {each.text}" if each.kind == NOT_JUDGED else f"- {each}"
            for each in self.warnings
        ]
        return "\n".join([*lines, *(f"next: {each}" for each in self.advice), self.planning()]).rstrip()

    def _of_population(self, of_unit: str) -> list[str]:
        """B10, B50 and shares as text, where there is a population."""
        if self.shares is None:
            return []
        ordered = sorted(self.shares.items(), key=lambda item: -item[1].value)
        shares = ", ".join(f"{name} {each.value:.0%}" for name, each in ordered if each.value >= 0.005)
        lines = [f"  {self.b10}", f"  {self.b50}"]
        if shares:
            lines.append(f"share of new specimens that fail by each mode: {shares}")
        lines += [
            f"age{of_unit} at which half of new specimens reach each limit, if it were the only one",
        ]
        half = [(mode, mode.ages.b50) for mode in self.modes if mode.ages.b50 is not None]
        far = [
            mode.name for mode, b50 in half if mode.grows and b50.age.value > FAR * max(mode.growth.last_age)
        ]
        for mode, b50 in half:
            sign = " (a precursor, not a failure)" if mode.sign else ""
            if mode.name not in far:
                lines.append(f"  {mode.name}{sign}: {b50}{'' if mode.grows else ', no growth shown'}")
        if far:
            lines.append(
                f"  half of new specimens reach these later than {FAR:g} times the age followed: "
                f"{'; '.join(far)}"
            )
        return lines

    def headline(self) -> str:
        """Return which specimens need attention, and what age the others should reach."""
        return " ".join(self.lead())

    def lead(self) -> list[str]:
        """Return which specimens need attention, or that nothing grows, as sentences."""
        if self.ageing.shown == "none" and not (self.attention.failed or self.attention.unclear):
            return [sentence(self.ageing.headline(self.age_unit))]
        return self.attention.words(self.age_unit)

    def of_new(self) -> str:
        """Return when half of new specimens fail, and how; empty without a population or growth."""
        if self.b50 is None or self.shares is None or self.ageing.shown == "none":
            return ""
        return half_failed(self.b50.age, self.shares, self.age_unit)

    def answers(self) -> list[str]:
        """Return the answers to what was asked of new specimens, as sentences."""
        share = [] if self.share_failing is None else [self.share_failing.words(self.age_unit)]
        return share if self.replacement is None else [*share, self.replacement.summary()]

    def of_followed(self) -> str:
        """Return how many of the specimens fail before the age asked; empty without one."""
        return "" if self.followed_failing is None else self.followed_failing.sentence(self.age_unit)

    @property
    def advice(self) -> tuple[str, ...]:
        """What to do next, in words: specimens to inspect, how long to go on without growth, runs.

        The runs come first if they answer a stated question.
        """
        deciding = self._deciding()
        likely = {each.unit: " or ".join(each.likely) for each in self.units}
        failed = [f"inspect {name} for {likely[name]}" for name in self.attention.failed]
        go_on = [self.ageing.advice(self.age_unit)]
        runs = [each.words(self.age_unit) for each in self.next_runs]
        asked, open_ = runs[:_ADVISED], (*failed[:_ADVISED], *filter(None, go_on))
        of_specimens = self.until is not None and self.share_failing is None
        return (*deciding, *asked, *open_) if of_specimens else (*deciding, *open_, *asked)

    def _deciding(self) -> list[str]:
        """What would decide the questions about new specimens."""
        share, asked = self.share_failing, {"replacement": "when to replace"}
        if share is not None:
            asked["share"] = share.question(self.age_unit)
        oldest = max(each.age.last for each in self.units)
        later = [] if share is None else [share.advice(self.age_unit, oldest)]
        runs = [each.words(self.age_unit, asked[each.question]) for each in self.deciding_runs]
        return [*filter(None, later), *runs]

    def planning(self) -> str:
        """Return how to state the age that specimens should reach; empty if a question was stated."""
        if self.until is not None or self.replacement is not None:
            return ""
        far = 1.5 * max(each.age.last for each in self.units)
        setting = Setting("until").to(f"{rounded(far, 2)} {self.age_unit}".strip())
        return f"To find the run that best shows which specimens last until an age, add {setting}."

    def to_frame(self) -> pl.DataFrame:
        """Return one row per specimen and failure mode, and the first of all; infinite if never reached."""
        import polars as pl

        rows: list[tuple[AgeAtLimit, str, float]] = []
        for i, end in enumerate(self.units):
            rows += [
                (mode.ages.units[i], mode.name, end.first.get(mode.name, math.nan)) for mode in self.modes
            ]
            rows.append((end.age, "first of all", math.nan))
        rows += [(each, "first of all", math.nan) for each in (self.b10, self.b50) if each is not None]
        unit = self.age_unit or "1"
        return pl.DataFrame(
            {
                "unit": [age.unit for age, _, _ in rows],
                "way": [name for _, name, _ in rows],
                f"age ({unit})": [age.age.value for age, _, _ in rows],
                f"age low ({unit})": [age.age.low for age, _, _ in rows],
                f"age high ({unit})": [age.age.high for age, _, _ in rows],
                "first (1)": [first for _, _, first in rows],
                "never (1)": [age.never for age, _, _ in rows],
                "passed (1)": [age.passed for age, _, _ in rows],
                f"last age ({unit})": [age.last for age, _, _ in rows],
            }
        )


@one_thread()
@takes_si()
def time_to_failure(
    indicators: Indicators,
    *,
    until: str | float | None = None,
    share: float | None = None,
    cost_of_failure: float | None = None,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> TimeToFailure:
    """Return how and when each specimen fails, from the indicators of the runs.

    The growth of each indicator is fitted over all specimens (`fit_growth`), and its draws give the ages at
    its limit. Failure modes are independent, given their growth, unless the runs of two modes are correlated:
    then the draws of a specimen have the correlation of the runs, and new specimens that of the ages of
    specimens.

    Parameters
    ----------
    indicators
        Indicators of the runs; those that cannot be fitted appear in the warnings with the reason.
    until
        Age that specimens should reach, e.g. "250000 pages". `next_runs` are those that show best which do;
        without it, which have failed. Where nothing grows `ageing` says how long to go on.
    share
        Share of new specimens that may fail before that age, e.g. 0.05.
    cost_of_failure
        Cost of a failure in service over that of a planned replacement, e.g. 10: `replacement` is the age
        at which a planned replacement costs least.
    seed
        Of the draws: the same data and seed give the same result.
    progress
        Called with indicators done and their total.

    Raises
    ------
    ParameterError, UnitError
        If ``until`` is no age in the unit of the runs, ``share`` is not from 0.01 to 1 or comes without
        ``until``, or ``cost_of_failure`` is not above 1 or beyond 100.
    InsufficientDataError
        If no indicator that ends a specimen can be fitted; the message names the reasons.
    """
    asked = questions_of(indicators.runs.age_unit, until, share, cost_of_failure)
    fitted, not_judged = fitted_ways(indicators, seed, progress)
    warnings = [*indicators.warnings, *not_judged]
    ending = [each for each in fitted if not each.mode.sign]
    if not ending:
        why = " ".join(_by_reason(warnings)) or "No indicator is given."
        raise InsufficientDataError(f"no failure mode can be judged. {why}")
    random = np.random.default_rng([seed, 2])
    of_runs = correlations([each.residuals for each in ending])
    names, last = indicators.runs.units, indicators.runs.last
    units, picks = ends_of_specimens(ending, of_runs, names, last, random)
    order = joint_order(ending, of_runs, random)
    new = np.stack(list(ages_of_new(ending, order, random)))
    greatest = min(each.followed.greatest for each in ending)
    first = np.sort(new.min(axis=0), axis=1)
    least = Earliest.of_first([each.earliest for each in ending])
    b10, b50 = of_population(first, len(units), least, greatest)
    known = len(units) >= POPULATION
    runs = next_runs(ending, units, picks, of_runs, asked.until, random)
    of_new = decided(asked, first, greatest, ending, units, order, of_runs, seed) if known else Decided()
    modes = tuple(each.mode for each in fitted)
    return TimeToFailure(
        age_unit=indicators.runs.age_unit,
        modes=modes,
        units=units,
        ageing=ageing_of(ending, float(indicators.runs.age.max()), asked.until),
        b10=b10,
        b50=b50,
        shares=_shares(ending, new) if known else None,
        curve=_curve(first, greatest) if known else None,
        until=asked.until,
        followed_failing=failing_of_followed(ending, order, asked.until, [each.age for each in units]),
        share_failing=of_new.share,
        replacement=of_new.replacement,
        next_runs=tuple(runs),
        deciding_runs=of_new.runs,
        warnings=(*warnings, *unsure(ending, units, asked), *_of_modes(ending, units)),
        seed=seed,
    )


def _by_reason(warnings: Sequence[Warning]) -> list[str]:
    """The reasons why something cannot be judged, as sentences, the one of most modes first."""
    concerned: dict[str, list[str]] = {}
    for each in warnings:
        concerned.setdefault(each.text, []).append(each.where)
    ordered = sorted(concerned.items(), key=lambda reason: -len(reason[1]))
    return [": ".join(filter(None, (_modes(where), sentence(why)))) for why, where in ordered]


def _modes(names: Sequence[str]) -> str:
    """The failure modes that a reason holds for: their number where there are many."""
    return f"{len(names)} failure modes" if len(names) > _NAMED else capital(", ".join(names))


def _shares(ending: Sequence[FittedWay], new: FloatArray) -> dict[str, Interval]:
    first = new.min(axis=0)
    found = {}
    for each, ages in zip(ending, new, strict=True):
        low, median, high = quantiles(((ages == first) & np.isfinite(ages)).mean(axis=1))
        found[each.mode.name] = Interval(float(median), float(low), float(high))
    return found


def _curve(first: FloatArray, greatest: float) -> ShareEnded:
    """Share ended against age, up to where ages are known to be late, no more."""
    ages = np.linspace(0.0, FAR * greatest, _PLACES)
    low, median, high = quantiles(np.stack([(first <= age).mean(axis=1) for age in ages], axis=1))
    return ShareEnded(ages, median, low, high)


def _of_modes(ending: Sequence[FittedWay], units: Sequence[SpecimenEnd]) -> list[Warning]:
    """The warnings of the modes that come first for a specimen."""
    named = {name for each in units for name in each.named}
    modes = [each.mode for each in ending if each.mode.name in named]
    return [warning.within(mode.name) for mode in modes for warning in mode.warnings]
