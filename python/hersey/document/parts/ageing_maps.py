"""The maps of a unit through its life in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.schema.part import Holed, Numbers, Part


class MapPoint(Part):
    """An operating point: belt speed in m/s, temperature in K."""

    name: str
    speed: float
    temperature: float
    share: float | None = Field(description="of the use; null where none is stated")


class AgeingMapsPart(Part):
    """The map of a unit when new, now and at its end: temperatures in K, speeds in m/s at the belt."""

    unit: str
    age_unit: str
    ages: Numbers
    when: list[str] = Field(description="what each age is, in a word")
    temperature: Numbers
    speed: Numbers
    torque: list[list[Holed]] = Field(description="N m at the roll, shape (ages, temperatures, speeds)")
    transition: list[Numbers] = Field(description="shape (ages, temperatures); 0 where torque falls nowhere")
    upper: list[Holed] = Field(description="V*, below which the past decides; null beyond the search")
    torque_limit: float | None
    points: list[MapPoint]
    roll_radius: float = Field(description="m")
    notes: list[str]
