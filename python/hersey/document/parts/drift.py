"""What moved with age in the document."""

from __future__ import annotations

from hersey.life.drift.readings import Reading
from hersey.life.drift.result import Drift
from hersey.schema.record import part_of


class SpecimenReadingPart(part_of(Reading)):  # type: ignore[misc]  # made as it runs
    """The reading of one specimen."""

    unit: str


class DriftPart(part_of(Drift)):  # type: ignore[misc]  # made as it runs
    """What moved with age, and what it points to: evidence, no proof."""

    readings: list[SpecimenReadingPart]
