"""A unit for other tools in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.schema.part import Part


class UnitVariablePart(Part):
    """A variable of a unit: its number, name, cause, unit, what it is, and its start in that unit."""

    reference: int
    name: str
    causality: str
    unit: str
    description: str
    start: float | None = Field(description="null if the motion determines it")


class TrialPart(Part):
    """What FMPy found in a unit: problems, and the greatest differences from the core, as shares."""

    problems: list[str] = Field(description="in the words of FMPy; empty if it finds none")
    differences: dict[str, float | None] = Field(description="null if there is no number")
    events: int = Field(description="changes of mode in the run")


class UnitPart(Part):
    """A drive as a unit for other tools: what it takes, gives and was made of."""

    file: str
    fmi: str = Field(description="version of the interface")
    drive: str = Field(description="speed, or torque")
    port: str | None = Field(description="for a speed: translational or rotational; null for a torque")
    start: str
    token: str = Field(description="checksum that ties library and description together")
    platforms: list[str]
    facts: dict[str, str] = Field(description="inputs from which it was made")
    variables: list[UnitVariablePart]
    check: TrialPart | None = Field(default=None, description="null if not tested")
