"""The law of ages at failure as a result: parameters, B-lives and reliability with their bounds."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError, capital
from hersey.life.failures.acceleration import Acceleration
from hersey.life.failures.distributions import DISTRIBUTIONS
from hersey.life.failures.draws import Draws, draws_of, sum_survival, survival_at
from hersey.life.failures.fit import Fit, age_held
from hersey.life.failures.goodness import GoodnessOfFit
from hersey.life.failures.positions import positions
from hersey.life.failures.records import (
    BLife,
    LawComparison,
    LawParameter,
    ModeLaw,
    Reliability,
    span,
    written,
)
from hersey.life.failures.sample import Failures
from hersey.result import Means, Result, table_of
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

#: p-value of the goodness of fit below which a law is doubted.
_DOUBTED = 0.05
#: Shares whose ages are shown.
SHOWN = (0.10, 0.50)


@dataclass(frozen=True, repr=False)
class FailureLaw(Result):
    """The law of ages at failure of specimens, in ``unit``.

    Bounds are two-sided at ``level``, equal in both tails. Each bound alone is one-sided at ``one_sided``.
    ``parameters`` and ``b_lives`` are empty if no law is known; ``warnings`` says why.
    """

    also_stated = ("one_sided",)
    not_stated = ("sample", "fits", "stress", "seed")

    law: Annotated[str, Means("weibull, lognormal or gamma")]
    unit: Annotated[str, Means("unit of the ages; may be empty")]
    specimens: int
    failures: int
    parameters: tuple[LawParameter, ...]
    b_lives: Annotated[tuple[BLife, ...], Means("ages by which 10 and 50 % have failed")]
    level: Annotated[float, Means("of the two-sided bounds")]
    calibrated: Annotated[bool, Means("whether bounds are calibrated by samples drawn from the law")]
    log_likelihood: float | None
    comparison: tuple[LawComparison, ...]
    goodness: GoodnessOfFit | None
    modes: tuple[ModeLaw, ...]
    acceleration: Acceleration | None
    warnings: tuple[Warning, ...]
    sample: Failures = field(repr=False)
    fits: tuple[Fit, ...] = field(repr=False)
    stress: float = field(repr=False)
    seed: int = field(repr=False)

    @property
    def one_sided(self) -> Annotated[float, Means("level of each bound alone")]:
        """Level of each bound alone."""
        return 0.5 + self.level / 2

    @property
    def is_known(self) -> bool:
        """Whether there is a law."""
        return bool(self.fits)

    def b_life(self, share: float) -> BLife:
        """Return the age by which a share of all specimens has failed (0.10 for B10).

        Raises
        ------
        ParameterError
            If the share is not between 0 and 1.
        InsufficientDataError
            If no law is known.
        """
        if not 0 < share < 1:
            raise ParameterError(f"share is {share}: it must be between 0 and 1", quantity="share")
        age, low, high = (float(each[0]) for each in self.lives([share]))
        return BLife(share, age, low, high, self.level)

    def lives(self, shares: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the ages by which shares of all specimens have failed, and their bounds.

        Raises
        ------
        InsufficientDataError
            If no law is known.
        """
        self.refuse_unknown()
        places = np.asarray(shares, dtype=float)
        if len(self.fits) > 1:
            return self._combined(places)
        low, high = self.fits[0].bounds(places, self.level, age_held, self.stress)
        with np.errstate(over="ignore"):
            return self.fits[0].age(places, self.stress), np.exp(low), np.exp(high)

    def age_estimated(self, share: float) -> float:
        """Return the age by which a share has failed, without its bounds."""
        return float(self._age_of(share, self.estimated)[0])

    def share_failed(self, ages: ArrayLike) -> FloatArray:
        """Return the share of all specimens that has failed by each age.

        Raises
        ------
        InsufficientDataError
            If no law is known.
        """
        self.refuse_unknown()
        outlive = [1.0 - fit.share(np.asarray(ages, dtype=float), self.stress) for fit in self.fits]
        return np.asarray(1.0 - np.prod(outlive, axis=0))

    def reliability(self, age: float) -> Reliability:
        """Return the share of all specimens that outlives an age, with its bounds.

        Raises
        ------
        ParameterError
            If the age is not greater than 0.
        InsufficientDataError
            If no law is known.
        """
        if not (np.isfinite(age) and age > 0):
            raise ParameterError(f"age is {age}: it must be greater than 0", quantity="age")
        failed = float(self.share_failed(age))
        if len(self.fits) > 1:
            drawn = 1.0 - np.exp(survival_at(self.draws, np.array([age]), self.stress)[:, 0])
            low, high = np.quantile(drawn, [1 - self.one_sided, self.one_sided])
        else:
            low, high = self.fits[0].share_bounds(age, self.level, self.stress)
        return Reliability(age, 1.0 - failed, float(1.0 - high), float(1.0 - low), self.level)

    def refuse_unknown(self) -> None:
        """Refuse to go on without a law.

        Raises
        ------
        InsufficientDataError
            If no law is known.
        """
        if not self.fits:
            raise InsufficientDataError(self.warnings[0].sentence)

    @cached_property
    def draws(self) -> tuple[Draws, ...]:
        """Draws of the parameters of each failure mode, as many of each."""
        drawn = [draws_of(fit) for fit in self.fits]
        most = min(each.m.size for each in drawn)
        return tuple(Draws(each.law, each.m[:most], each.k[:most], each.c[:most]) for each in drawn)

    @cached_property
    def estimated(self) -> tuple[Draws, ...]:
        """The estimated parameters of each failure mode, as one draw."""
        return tuple(Draws(f.law, *(np.array([each]) for each in (f.m, f.k, f.c))) for f in self.fits)

    def _combined(self, shares: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Ages of shares where several failure modes end specimens, whichever comes first."""
        ages = np.array([self._age_of(share, self.estimated) for share in shares])
        drawn = np.array([self._age_of(share, self.draws) for share in shares])
        low, high = np.quantile(drawn, [1 - self.one_sided, self.one_sided], axis=1)
        return ages[:, 0], low, high

    def _age_of(self, share: float, draws: tuple[Draws, ...]) -> FloatArray:
        """The age by which a share has failed, of each draw; by bisection in ln age."""
        wanted = np.log1p(-share)
        with np.errstate(divide="ignore"):
            high = np.min([np.log(each.age(share, self.stress)) for each in draws], axis=0)
            part = -np.expm1(wanted / len(draws))
            low = np.min([np.log(each.age(part, self.stress)) for each in draws], axis=0)
        for _ in range(60):
            between = 0.5 * (low + high)
            outlive = sum_survival(draws, np.exp(between), self.stress)
            low, high = np.where(outlive > wanted, between, low), np.where(outlive > wanted, high, between)
        return np.asarray(np.exp(0.5 * (low + high)))

    @cached_property
    def positions(self) -> tuple[FloatArray, FloatArray]:
        """Ages at failure, under the stress of use, and the share failed at each without any law."""
        return positions(self.at_use)

    @cached_property
    def at_use(self) -> Failures:
        """The sample as it would be under the stress of use, by the estimated effect of stress."""
        if self.acceleration is None:
            return self.sample
        fit = self.fits[0]
        factor = np.exp(fit.c * (self.stress - fit.covariate))
        return replace(self.sample, low=self.sample.low * factor, high=self.sample.high * factor)

    def headline(self) -> str:
        """Return the number of failures, B10 and B50."""
        head = f"{self.specimens} specimens, {self.failures} failed"
        if not self.fits:
            return f"{head}, no failure law is known"
        return head + "".join(f", {each.name} {written(each.age, 3)}{self.behind}" for each in self.b_lives)

    @property
    def named(self) -> str:
        """The law as sentences call it."""
        return DISTRIBUTIONS[self.law].title

    @property
    def behind(self) -> str:
        """The unit with a space before it."""
        return f" {self.unit}" if self.unit else ""

    def summary(self) -> str:
        """Return the law, B-lives and parameters with their bounds as text."""
        return "\n".join([*self.lines(), *(each.sentence for each in self.warnings)])

    def lines(self) -> list[str]:
        """Return headline, B-lives, parameters, failure modes and how well the law fits, without warnings."""
        lines = [self.headline()]
        if not self.is_known:
            return lines
        rows = [
            (each.name, f"{written(each.age)} {span(each.low, each.high)}{self.behind}")
            for each in self.b_lives
        ]
        rows += [(each.name, _shown(each)) for each in self.parameters]
        for mode in self.modes:
            law = ", ".join(f"{each.name} {_shown(each)}" for each in mode.parameters)
            rows.append((mode.mode, f"{mode.failures} failed, {law}"))
        widest = max(len(name) for name, _ in rows)
        lines += [f"  {name:{widest}s}  {text}" for name, text in rows]
        if self.acceleration is not None:
            lines.append(f"{self.acceleration.words}.")
        return [*lines, _bounds(self), *_verdict(self), *_fit(self)]

    def to_frame(self) -> pl.DataFrame:
        """Return B-lives and parameters with their bounds, and the number of specimens."""
        rows: list[tuple[str, float | None, str]] = [
            ("specimens", self.specimens, ""),
            ("failed", self.failures, ""),
        ]
        named = [(each.name, each.age, each.low, each.high, self.unit) for each in self.b_lives]
        named += [(each.name, each.value, each.low, each.high, each.unit) for each in self.parameters]
        for mode in self.modes:
            named += [(f"{mode.mode} {p.name}", p.value, p.low, p.high, p.unit) for p in mode.parameters]
        for name, value, low, high, unit in named:
            rows += [(name, value, unit), (f"{name} low", low, unit), (f"{name} high", high, unit)]
        return table_of(rows)


def _shown(parameter: LawParameter) -> str:
    unit = f" {parameter.unit}" if parameter.unit else ""
    if parameter.low == parameter.high:
        return f"{written(parameter.value)}{unit} (given)"
    return f"{written(parameter.value)} {span(parameter.low, parameter.high)}{unit}"


def _bounds(found: FailureLaw) -> str:
    levels = f"{100 * found.level:.4g} % two-sided, {100 * found.one_sided:.4g} % each alone"
    if len(found.fits) > 1:
        return f"{capital(found.named)} law of each failure mode; bounds by simulation, {levels}."
    how = "likelihood-ratio bounds, calibrated" if found.calibrated else "likelihood-ratio bounds"
    return f"{capital(found.named)} law by maximum likelihood; {how}, {levels}."


def _verdict(found: FailureLaw) -> list[str]:
    """What the shape of a Weibull law means."""
    if found.law != "weibull" or len(found.fits) > 1:
        return []
    shape = found.parameters[0]
    if shape.low == shape.high:
        return []
    if shape.low > 1:
        return ["The failure rate grows with age: specimens wear out."]
    if shape.high < 1:
        return ["The failure rate falls with age: weak specimens fail early."]
    return ["Whether the failure rate grows or falls with age is unknown."]


def _fit(found: FailureLaw) -> list[str]:
    lines = []
    if found.goodness is not None:
        p = found.goodness.p_value
        judged = "does not fit" if p < _DOUBTED else "fits"
        named = f"Anderson-Darling {found.goodness.statistic:.2f}, p = {p:.2g}"
        lines.append(f"The {found.named} law {judged} ({named}).")
    if len(found.comparison) > 1:
        rows = ", ".join(f"{DISTRIBUTIONS[each.law].title} {each.aic:.2f}" for each in found.comparison)
        lines.append(f"AIC (least is best): {rows}.")
    return lines
