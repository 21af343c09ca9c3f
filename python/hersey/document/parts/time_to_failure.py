"""Growth of indicators, the ages at their limits, and what ends each unit, in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.document.parts.life import PopulationPart
from hersey.schema.part import Numbers, Part


class SpanPart(Part):
    """A number with its 90 % interval; null where it is never reached."""

    value: float | None
    low: float | None
    high: float | None


class AgePart(Part):
    """The age at a limit of a unit, or of a share of the population."""

    unit: str
    age: SpanPart
    never: float = Field(description="share of draws that never reach it")
    last: float | None = Field(description="age last seen; null for the population")
    passed: float = Field(description="share of draws that have reached it by then")


class AgesPart(Part):
    """The ages at which units and population reach a limit, in ``age_unit``."""

    quantity: str
    age_unit: str
    limit: float
    units: list[AgePart]
    b10: AgePart
    b50: AgePart
    notes: list[str]
    accumulates: bool = Field(description="the limit is that of the integral over age")


class GrowthPart(Part):
    """The growth of an indicator over units, in the units given."""

    quantity: str
    age_unit: str
    units: list[str]
    runs: list[int] = Field(description="of each unit")
    last_age: Numbers = Field(description="of each unit")
    weights: dict[str, float] = Field(description="of the laws, sum 1")
    parameters: dict[str, dict[str, SpanPart]] = Field(description="of each law")
    effective: float = Field(description="how many independent draws the posterior is worth")
    notes: list[str]
    seed: int
    law: str | None = Field(description="the law that the data name, or null")


class ModePart(Part):
    """One failure mode."""

    name: str
    kind: str
    si: str
    limit: float
    sign: bool = Field(description="a precursor, which ends no unit")
    notes: list[str]
    growth: GrowthPart
    ages: AgesPart


class UnitEndPart(Part):
    """What ends a unit, and when."""

    unit: str
    age: AgePart = Field(description="of the first of all ways")
    first: dict[str, float] = Field(description="probability of each way to be the first")
    near: list[str] = Field(description="ways whose own age is up to 25 % later than the first")
    named: list[str] = Field(description="the ways that must be named, the likeliest first")


class NextRunPart(Part):
    """What could be measured, and how far it is expected to narrow an interval."""

    unit: str | None = Field(description="null: one more unit, followed to its end")
    age: float
    before: float = Field(description="width of the interval of the end of the unit, or of B10, in age")
    after: float
    narrowing: float = Field(description="share of the interval that goes")


class ShareEndedPart(Part):
    """Share of new units that have ended at an age, with its 90 % band."""

    age: Numbers
    median: Numbers
    low: Numbers
    high: Numbers


class TimeToFailurePart(Part):
    """What ends each unit and the population, and when; ages in ``age_unit``."""

    age_unit: str
    modes: list[ModePart]
    units: list[UnitEndPart]
    b10: AgePart = Field(description="a tenth of new units has ended, by whichever way")
    b50: AgePart
    shares: dict[str, SpanPart] = Field(description="of new units that each way ends")
    curve: ShareEndedPart
    population: PopulationPart = Field(description="the units that have ended, the others as not failed")
    next_runs: list[NextRunPart] = Field(description="what narrows most first")
    advice: list[str]
    together: list[str] = Field(description="ways whose runs scatter together")
    notes: list[str] = Field(description="what cannot be told, and what rests on priors")
    unsaid: list[str] = Field(description="ways that are not judged, and why")
    seed: int
