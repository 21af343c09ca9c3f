"""What ends each specimen, in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.document.parts.life import PopulationPart
from hersey.life.time_to_failure.estimate import TimeToFailure
from hersey.schema.record import part_of


class TimeToFailurePart(part_of(TimeToFailure)):  # type: ignore[misc]  # made as it runs
    """What ends each specimen and the population, and when; ages in ``age_unit``."""

    population: PopulationPart = Field(
        description="the specimens that have failed; the others count as not failed"
    )
