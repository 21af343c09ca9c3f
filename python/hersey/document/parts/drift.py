"""What moved with age in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.schema.part import Holed, Numbers, Part


class MovedPart(Part):
    """A change with its 90 % interval; null where it has no value."""

    value: float | None
    low: float | None
    high: float | None


class QuantityPart(Part):
    """Something of the drag, in ``si``: when new, and its change up to the oldest age."""

    name: str
    si: str
    relative: bool = Field(
        description="whether the change is that of the ratio to the value when new, less 1, or the difference"
    )
    where: str
    new: float | None
    change: MovedPart
    units: list[MovedPart]
    curves: list[Holed] = Field(description="of each unit at the ages, shape (units, ages)")
    band: list[Holed] = Field(description="low, middle and high of all units, shape (3, ages)")


class AgeingPart(Part):
    """An ageing that a change points to; torque in N m, up to the oldest age, with its 90 % interval."""

    name: str
    grows: bool
    torque: float
    low: float
    high: float
    share: float = Field(description="of torque when new")
    speed: float = Field(description="rad/s")
    temperature: float | None = Field(description="K")


class ReadingPart(Part):
    """Sets of ageings that a change points to, the best first: more than one cannot be told apart."""

    sets: list[list[AgeingPart]]


class UnitReadingPart(ReadingPart):
    """The reading of one unit."""

    unit: str


class DriftPart(Part):
    """What moved with age, and what it points to: evidence, no proof."""

    units: list[str]
    age_unit: str
    oldest: float
    last_age: Numbers = Field(description="of each unit")
    runs: int
    dwells: int
    quantities: list[QuantityPart]
    reading: ReadingPart
    readings: list[UnitReadingPart]
    ages: Numbers
    scatter: float = Field(description="of dwells beyond their stated errors, relative")
    notes: list[str]
    headline: str
