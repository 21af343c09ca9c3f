"""The film through life in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.document.parts.time_to_failure import AgesPart, SpanPart
from hersey.schema.part import Holed, Numbers, Part


class RunsPart(Part):
    """The runs of a campaign, by unit and age."""

    run: list[int]
    unit: list[str]
    age: Numbers
    age_unit: str


class FilmPointPart(Part):
    """A state at which the film is told: rad/s at the roll, K."""

    name: str
    speed: float
    temperature: float


class ToldPart(Part):
    """Something with its 90 % interval, shape (runs,) or (units, ages); null where it is not told."""

    value: Holed | list[Holed]
    low: Holed | list[Holed]
    high: Holed | list[Holed]


class OilLeftPart(Part):
    """Oil in the layer of a unit, m^3: new, when last seen, and what the film then needs."""

    unit: str
    new: SpanPart
    last: SpanPart
    needed: SpanPart


class FilmLifePart(Part):
    """Film and layer of oil of each run and unit through life."""

    runs: RunsPart
    points: list[FilmPointPart] = Field(description="fastest operating point, cold corner")
    film: list[ToldPart] = Field(description="over that of a flooded inlet, at each point, shape (runs,)")
    thickness: list[ToldPart] = Field(description="of the film at each point, m, shape (runs,)")
    layer: ToldPart = Field(description="of oil on the inlet side, m, shape (runs,)")
    viscosity: ToldPart = Field(description="over that of the lubricant, shape (runs,)")
    systematic: float = Field(description="factor by which all layers may be off together")
    scatter: Holed = Field(description="of the dwells about the law, over their errors, shape (runs,)")
    ages: Numbers
    curves: list[ToldPart] = Field(description="film over flooded at each point, shape (units, ages)")
    layers: ToldPart = Field(description="m, shape (units, ages)")
    needs: list[list[Numbers]] = Field(description="flooded film at each point, m, shape (units, ages)")
    starves: list[AgesPart]
    starved: list[bool] = Field(description="at the fastest operating point, shape (runs,)")
    law: dict[str, SpanPart] = Field(description="K in 1/(m^2 age), e and g in 1/age")
    oil: list[OilLeftPart]
    track: float
    notes: list[str]
