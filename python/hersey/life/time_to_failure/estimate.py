"""What ends each specimen, and when: the growth of every indicator against its limit, side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray, IntArray, one_thread
from hersey.errors import HerseyError, InsufficientDataError, capital, sentence
from hersey.life.growth.limit_ages import (
    CONFIDENCE,
    AgeAtLimit,
    Interval,
    quantiles,
    share_of_specimens,
)
from hersey.life.indicator import NOT_JUDGED, Indicators
from hersey.life.population import Population, weibull
from hersey.life.time_to_failure.first import SpecimenEnd, ages_of_new, ends_of_specimens
from hersey.life.time_to_failure.joined import correlations
from hersey.life.time_to_failure.next_run import (
    HORIZON,
    NextRun,
    candidate_ages,
    width,
    width_after_specimen,
    widths_after,
)
from hersey.life.time_to_failure.unsure import FAR, FEW, unsure
from hersey.life.time_to_failure.way import FittedWay, Mode, fitted_way, last_ages
from hersey.result import Means, Record, Result
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Places of the curve of the population.
_PLACES = 121
#: Specimens, of the widest intervals, for which a further run is weighed; advice that the summary gives.
_WEIGHED, _ADVISED = 24, 3
#: Rows that a summary shows.
_SHOWN = 24
#: Failure modes of one reason that an error names.
_NAMED = 2
NEVER = "none"


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

    also_stated = ("population", "advice")

    age_unit: str
    modes: tuple[Mode, ...]
    units: tuple[SpecimenEnd, ...]
    b10: Annotated[
        AgeAtLimit, Means("age by which a tenth of new specimens has failed, by any mode")
    ]  #: a tenth of new specimens has ended, by whichever way
    b50: AgeAtLimit
    shares: Annotated[
        dict[str, Interval], Means("share of new specimens that fail by each mode")
    ]  #: of new specimens that each way ends
    curve: ShareEnded
    next_runs: Annotated[tuple[NextRun, ...], Means("largest narrowing first")]  #: what narrows most first
    together: Annotated[
        tuple[str, ...], Means("failure modes whose runs scatter together")
    ]  #: ways whose runs scatter together
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
    def population(self) -> Population:
        """Population with failed specimens at their estimated ages; the others have not failed."""
        seen = [each for each in self.units if each.age.last > 0.0]
        failed = np.array([each.age.passed > 0.5 for each in seen])
        last = np.array([each.age.last for each in seen])
        ages = np.where(failed, np.minimum([each.age.age.value for each in seen], last), last)
        return weibull(
            np.maximum(ages, 1e-6 * last.max()), failed, unit=self.age_unit, level=CONFIDENCE, seed=self.seed
        )

    def summary(self) -> str:
        """Return specimens, population, what is unknown and what to measure next as text."""
        of_unit = f" ({self.age_unit})" if self.age_unit else ""
        lines = [self.headline(), f"age of first failure{of_unit}, with 90 % intervals"]
        lines += [f"  {each}" for each in self.units[:_SHOWN]]
        if len(self.units) > _SHOWN:
            lines.append(f"  and {len(self.units) - _SHOWN} more specimens")
        lines += [f"  {self.b10}", f"  {self.b50}"]
        ordered = sorted(self.shares.items(), key=lambda item: -item[1].value)
        shares = ", ".join(f"{name} {each.value:.0%}" for name, each in ordered if each.value >= 0.005)
        lines += [
            f"share of new specimens that fail by each mode: {shares}",
            f"age{of_unit} at which half of new specimens reach each limit, if it were the only one",
        ]
        soon = FAR * max(each.age.last for each in self.units)
        far = [mode.name for mode in self.modes if mode.ages.b50.age.low > soon]
        for mode in self.modes:
            sign = " (a precursor, not a failure)" if mode.sign else ""
            if mode.name not in far:
                lines.append(f"  {mode.name}{sign}: {mode.ages.b50}")
        if far:
            lines.append(
                f"  half of new specimens reach these later than {FAR:g} times the age followed: "
                f"{'; '.join(far)}"
            )
        lines += [
            f"{each.where} is not judged. {each.text}" if each.kind == NOT_JUDGED else f"- {each}"
            for each in self.warnings
        ]
        return "\n".join([*lines, *(f"next: {each}" for each in self.advice)])

    def headline(self) -> str:
        """Return the age by which half of new specimens fail, and the main failure mode."""
        unit = f" {self.age_unit}" if self.age_unit else ""
        if len(self.units) < FEW:
            first = min(self.units, key=lambda each: each.age.age.value)
            by = " or ".join(first.named) or "no known failure mode"
            return f"{first.unit} fails at {first.age.age}{unit} by {by}"
        likely = max(self.shares, key=lambda name: self.shares[name].value)
        return f"half of new specimens fail by {self.b50.age}{unit}, mostly by {likely}"

    @property
    def advice(self) -> tuple[str, ...]:
        """What to measure next, in words."""
        return tuple(each.words(self.age_unit) for each in self.next_runs[:_ADVISED])

    def to_frame(self) -> pl.DataFrame:
        """Return one row per specimen and failure mode, and the first of all; infinite if never reached."""
        import polars as pl

        rows: list[tuple[AgeAtLimit, str, float]] = []
        for i, end in enumerate(self.units):
            rows += [
                (mode.ages.units[i], mode.name, end.first.get(mode.name, math.nan)) for mode in self.modes
            ]
            rows.append((end.age, "first of all", math.nan))
        rows += [(each, "first of all", math.nan) for each in (self.b10, self.b50)]
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
    indicators: Indicators, *, seed: int = 0, progress: Callable[[int, int], None] | None = None
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
    seed
        Of the draws: the same data and seed give the same result.
    progress
        Called with indicators done and their total.

    Raises
    ------
    InsufficientDataError
        If no indicator that ends a specimen can be fitted; the message names the reasons.
    """
    fitted, warnings = [], list(indicators.warnings)
    for i, each in enumerate(indicators.each):
        try:
            fitted.append(fitted_way(indicators, each, seed + i))
        except HerseyError as error:
            warnings.append(
                Warning(NOT_JUDGED, "{reason}", severity="act", where=each.name, reason=str(error))
            )
        if progress:
            progress(i + 1, len(indicators.each))
    ending = [each for each in fitted if not each.mode.sign]
    if not ending:
        why = " ".join(_by_reason(warnings)) or "No indicator is given."
        raise InsufficientDataError(f"no failure mode can be judged. {why}")
    random = np.random.default_rng([seed, 2])
    of_runs = correlations([each.residuals for each in ending])
    names, last = indicators.runs.units, last_ages(indicators)
    units, picks = ends_of_specimens(ending, of_runs, names, last, random)
    new = np.stack(list(ages_of_new(ending, of_runs, random)))
    greatest = float(indicators.runs.age.max())
    first = np.sort(new.min(axis=0), axis=1)
    b10, b50 = (share_of_specimens(first, share) for share in (0.1, 0.5))
    runs = [*_again(ending, units, picks, of_runs, greatest, random), *_one_more(first, greatest, random)]
    modes = tuple(each.mode for each in fitted)
    return TimeToFailure(
        age_unit=indicators.runs.age_unit,
        modes=modes,
        units=units,
        b10=b10,
        b50=b50,
        shares=_shares(ending, new),
        curve=_curve(first, greatest),
        next_runs=tuple(sorted(runs, key=lambda each: -each.narrowing)),
        together=_together(ending, of_runs),
        warnings=(*warnings, *unsure(ending, units, _together(ending, of_runs)), *_of_modes(ending, units)),
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


def _again(
    ending: Sequence[FittedWay],
    units: Sequence[SpecimenEnd],
    picks: Sequence[tuple[IntArray, FloatArray]],
    of_runs: FloatArray,
    greatest: float,
    random: np.random.Generator,
) -> list[NextRun]:
    """How far one more run of each specimen would narrow the interval of its end."""
    open_ = [i for i, each in enumerate(units) if each.age.passed <= 0.5]
    spans = {i: width(np.minimum(picks[i][1], HORIZON * greatest)) for i in open_}
    open_.sort(key=lambda i: -spans[i])
    found = []
    for i in sorted(open_[:_WEIGHED]):
        order, first = picks[i]
        capped = np.minimum(first, HORIZON * greatest)
        ages = candidate_ages(units[i].age.last, float(np.median(capped)))
        observed = [m for m, each in enumerate(ending) if units[i].unit in each.row]
        if not (ages.size and observed):
            continue
        values, errors = [], []
        for m in observed:
            each = ending[m]
            value, scatter = each.drawn_values(units[i].unit, ages)
            values.append(value[order[:, m]])
            errors.append(np.hypot(scatter, each.error)[order[:, m]])
        among = of_runs[np.ix_(observed, observed)]
        after = widths_after(capped, values, errors, among, random)
        runs = zip(ages.tolist(), after.tolist(), strict=True)
        found += [NextRun(units[i].unit, age, spans[i], each) for age, each in runs]
    return found


def _one_more(first: FloatArray, greatest: float, random: np.random.Generator) -> list[NextRun]:
    """How far a new specimen, followed to its end, would narrow the interval of B10."""
    capped = np.clip(first, 1e-6 * greatest, HORIZON * greatest)
    b10 = capped[:, math.ceil(0.1 * first.shape[1]) - 1]
    age = float(np.median(capped))
    return [NextRun(None, age, width(b10), width_after_specimen(b10, capped, random))]


def _together(ending: Sequence[FittedWay], of_runs: FloatArray) -> tuple[str, ...]:
    return tuple(
        f"{ending[j].mode.name} and {ending[i].mode.name} ({of_runs[i, j]:.2f})"
        for i in range(len(ending))
        for j in range(i)
        if abs(of_runs[i, j]) > 0.5
    )


def _of_modes(ending: Sequence[FittedWay], units: Sequence[SpecimenEnd]) -> list[Warning]:
    """The warnings of the modes that come first for a specimen."""
    named = {name for each in units for name in each.named}
    modes = [each.mode for each in ending if each.mode.name in named]
    return [warning.within(mode.name) for mode in modes for warning in mode.warnings]
