"""The paper's figures, drawn anew, in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.document.parts.part import Holed, Part


class ClaimPart(Part):
    """One claim, the criterion it is judged by, the verdict, and the numbers behind it."""

    source: str
    statement: str
    criterion: str
    verdict: str
    evidence: str
    numbers: dict[str, float | None]


class FigurePart(Part):
    """A figure with its claims and the data of its curves by column: Figs. 1 to 8 in SI with units."""

    name: str
    number: int | None = Field(description="in the paper; null for a figure that it does not have")
    title: str
    claims: list[ClaimPart]
    data: dict[str, Holed]


class FiguresPart(Part):
    """The paper's figures drawn anew: claims judged, and the data of the curves."""

    units: dict[str, str] = Field(description="of Figs. 9 to 14 and those beyond the paper")
    figures: list[FigurePart]
