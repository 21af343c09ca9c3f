"""What a trend is: the law of friction against age, its steady value, jumps and warnings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate
from hersey.errors import capital
from hersey.life.trend.shown import age_within, friction_within, greatest_rate, rate_within, shown_age
from hersey.result import Means, Record, Result
from hersey.schema.domain import Domain
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

#: Weight from which a law is named.
NAMED = 0.9
#: Weight from which a law is listed.
_LISTED = 0.01
_OF_FRICTION, _OF_AGE = "in the unit of friction", "in the unit of age"


@dataclass(frozen=True)
class TrendLaw(Record):
    """A law that was compared, without and with temperature as a cause, taken together."""

    name: str
    formula: Annotated[str, Means("friction against age, in symbols")]
    delta_aicc: Annotated[float, Means("above the likeliest law", open=True)]
    weight: Annotated[float, Means("weight of the law by AICc; all sum to 1")]


@dataclass(frozen=True)
class Jump(Record):
    """A sudden change of friction."""

    age: Annotated[float, Means(_OF_AGE)]
    change: Annotated[Estimate, Means("as a share of friction just before")]
    after_stop: Annotated[bool, Means("whether the drive had just stood still")]
    turned: Annotated[bool, Means("whether the direction of motion had just changed")]


@dataclass(frozen=True, repr=False)
class FrictionTrend(Result):
    """Friction against age at one speed; arrays of shape (blocks,), intervals at 95 %."""

    also_stated = ("law",)

    domain: Annotated[Domain, Means("what friction and speed are, with their units")]
    by: Annotated[str, Means("what age is counted in: time, distance or revolutions")]
    age_unit: Annotated[str, Means("s, m or rev")]
    speed: Annotated[float, Means("mean speed, without sign, SI")]
    last_age: Annotated[float, Means(_OF_AGE)]
    rows: Annotated[int, Means("rows used")]
    effective_rows: Annotated[float, Means("independent rows, of those that were compared")]
    correlation_time: Annotated[float, Means("how long noise lasts; 0 if it is independent", "s")]
    kind: Annotated[
        str, Means("constant, or falls, rises, one then the other, with 'and settles' if it does")
    ]
    laws: Annotated[tuple[TrendLaw, ...], Means("the likeliest first")]
    share: Annotated[float, Means("of the steady value, within which friction counts as steady")]
    first: Annotated[Estimate, Means(f"friction at the first age, {_OF_FRICTION}")]
    last: Annotated[Estimate, Means(f"friction at the last age, {_OF_FRICTION}")]
    rate: Annotated[Estimate, Means("change of friction per age over the last tenth of the log")]
    per_kelvin: Annotated[Estimate | None, Means("change of friction per K, where temperature is a cause")]
    steady: Annotated[Estimate | None, Means(f"where friction settles, {_OF_FRICTION}; null if not known")]
    steady_age: Annotated[
        Estimate | None, Means(f"age from which friction is within the share of it, {_OF_AGE}")
    ]
    time_constant: Annotated[
        Estimate | None, Means(f"after which 63 % of the change has come, {_OF_AGE}; null if none")
    ]
    jumps: Annotated[tuple[Jump, ...], Means("one for each sudden change")]
    warnings: tuple[Warning, ...]
    age: Annotated[FloatArray, Means(f"mean age of blocks of rows, {_OF_AGE}")]
    value: Annotated[FloatArray, Means(f"mean friction of each block, {_OF_FRICTION}")]
    fitted: Annotated[FloatArray, Means(f"friction by the laws, at the last temperature, {_OF_FRICTION}")]
    low: Annotated[FloatArray, Means("its 95 % limit")]
    high: Annotated[FloatArray, Means("its 95 % limit")]

    @property
    def law(self) -> Annotated[str | None, Means("the law that the data select, or null if several fit")]:
        """The law that the data select, or None if several fit."""
        if self.kind == "constant":
            return "constant"
        return self.laws[0].name if self.laws[0].weight >= NAMED else None

    def headline(self) -> str:
        """Return what friction does in one sentence."""
        what, level = capital(self.domain.quantity), friction_within(self.domain.unit, self.last)
        if self.kind == "constant":
            most = greatest_rate(self.by, self.rate, self.last.value, self.last_age)
            count = len(self.jumps)
            beside = f" beside {count} jump{'s' if count > 1 else ''}" if count else ""
            return f"{what} shows no trend{beside}: {level}; a steady drift is at most {most}"
        moves = self.kind.removesuffix(" and settles")
        if self.steady is not None and self.steady_age is not None:
            steady = friction_within(self.domain.unit, self.steady)
            when = f"within {100 * self.share:.3g} % of it after {age_within(self.by, self.steady_age)}"
            if self.steady_age.high <= self.last_age:
                return f"{what} {moves} to a steady {steady}, {when}"
            return f"{what} {moves} towards {steady}, {when}: this log may end before"
        rate = rate_within(self.by, self.rate, self.last.value, self.last_age)
        if self.rate.low * self.rate.high > 0.0:
            return f"{what} {moves}, last by {rate}; no steady value is reached"
        first = friction_within(self.domain.unit, self.first)
        return f"{what} {moves}, from {first} to {level}; whether it is steady then is not known"

    def lines(self) -> list[str]:
        """Return the conclusion, a line each: headline, values, time constant, law."""
        said = [f"{self.headline()}."]
        first, last = (friction_within(self.domain.unit, each) for each in (self.first, self.last))
        rate = rate_within(self.by, self.rate, self.last.value, self.last_age)
        facts = [("at the start, at the end", f"{first}, {last}"), ("rate over the last tenth", rate)]
        if self.kind == "constant":
            facts = [] if not self.jumps else facts[:1]
        if self.time_constant is not None:
            facts.append(("time constant", age_within(self.by, self.time_constant)))
        if self.per_kelvin is not None:
            share = [100.0 * each / self.last.value for each in self._per_kelvin_ends()]
            facts.append(("change per K", f"{share[0]:.2g} % [{share[1]:.2g}, {share[2]:.2g}]"))
        facts.append(("law", self._law()))
        said += [f"  {name}: {text}" for name, text in facts]
        for jump in self.jumps:
            change = [100.0 * each for each in (jump.change.value, jump.change.low, jump.change.high)]
            stop = ", in the other direction" if jump.turned else ", after a stop" if jump.after_stop else ""
            at = shown_age(self.by, jump.age)
            said.append(f"  jump at {at}: {change[0]:+.3g} % [{change[1]:.3g}, {change[2]:.3g}]{stop}")
        return said

    def _per_kelvin_ends(self) -> tuple[float, float, float]:
        each = self.per_kelvin
        assert each is not None
        return each.value, each.low, each.high

    def _law(self) -> str:
        near = [each for each in self.laws if each.weight >= _LISTED]
        if self.law == "constant":
            return "constant; no other is better beyond doubt"
        if self.law is not None:
            return f"{self.laws[0].name}, {self.laws[0].formula}"
        return "several fit: " + ", ".join(f"{each.name} {each.weight:.2f}" for each in near)

    def summary(self) -> str:
        """Return the trend as text."""
        noise = (
            f"noise lasts {self.correlation_time:.3g} s" if self.correlation_time else "noise is independent"
        )
        compared = [
            f"  {each.name}: {each.formula}, ΔAICc {each.delta_aicc:.1f}, weight {each.weight:.2f}"
            for each in self.laws
        ]
        return "\n".join(
            [
                *self.lines(),
                f"{self.rows} rows at {self.domain.at(self.speed)} over {shown_age(self.by, self.last_age)}; "
                f"{noise}, {self.effective_rows:.0f} independent values",
                "laws compared:",
                *compared,
                *(f"- {each.sentence}" for each in self.warnings),
            ]
        )

    def to_frame(self) -> pl.DataFrame:
        """Return mean friction of each block and the law with its interval."""
        import polars as pl

        of, unit = self.domain, self.domain.unit or "1"
        return pl.DataFrame(
            {
                f"age ({self.age_unit})": self.age,
                f"{of.quantity} ({unit})": self.value,
                f"fitted ({unit})": self.fitted,
                f"low ({unit})": self.low,
                f"high ({unit})": self.high,
            }
        )
