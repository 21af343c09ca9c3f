"""Ages at failure in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.life.population import BLife
from hersey.schema.part import Holed, Numbers, Part
from hersey.schema.warning import Warning


class PopulationPart(Part):
    """The Weibull law of ages at failure, in ``unit``; null where too few units have failed."""

    ages: Numbers = Field(description="ascending, shape (units,)")
    failed: list[bool] = Field(description="which of them are ages at failure, shape (units,)")
    shape: float | None
    scale: float | None
    shape_interval: Holed | None = Field(description="low and high")
    scale_interval: Holed | None = Field(description="low and high")
    level: float = Field(description="of the intervals")
    unit: str = Field(description="unit of the ages; may be empty")
    warnings: list[Warning]
    seed: int
    b10: BLife | None
    b50: BLife | None
    median_ranks: Numbers = Field(description="fractions failed at the ages at failure, ascending")
    verdict: str
