"""The runs of a campaign in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.life.diagnostics.run_compared import RunCompared
from hersey.schema.part import Part
from hersey.schema.record import part_of
from hersey.schema.warning import Warning


class CampaignRun(Part):
    """One run: its unit, its age in ``age_unit`` of the campaign, its log, and its fit in short."""

    run: int
    unit: str
    age: float
    log: str
    sha256: str
    dwells: int
    exponent: float | None = Field(description="exponent c; null without a fit")
    transition_speed: float | None = Field(description="rad/s; null without a transition")
    no_fit: str = Field(description="why there is no fit; may be empty")
    version: str = Field(description="version of hersey that read the log")
    added: str = Field(description="UTC")


class CampaignEvent(Part):
    """Maintenance of a specimen at an age, in ``age_unit`` of the campaign."""

    unit: str
    age: float = Field(description="in the unit of all ages")
    kind: str = Field(description="re-greased, cleaned or replaced")
    run: int | None = Field(description="run of this age measured after it; null if none was")


class ComparedRunPart(part_of(RunCompared)):  # type: ignore[misc]  # made as it runs
    """A run compared with its specimen and the others; null where there are too few to compare it."""


class CampaignPart(Part):
    """Runs of many units at many ages; null warnings and no ``each`` where runs were not compared."""

    file: str
    age_unit: str
    runs: list[CampaignRun]
    events: list[CampaignEvent] = Field(description="maintenance, by specimen and age")
    warnings: list[Warning] | None = None
    each: list[ComparedRunPart] | None = Field(None, description="runs compared; null where they were not")
