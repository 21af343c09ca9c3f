"""What a log and its machine tell together."""

from __future__ import annotations

from pydantic import Field

from hersey.parts.decision import DecisionPart
from hersey.parts.film import FilmPart
from hersey.parts.fit import FitPart, RegimePart
from hersey.parts.models import ComparisonPart
from hersey.parts.part import Part
from hersey.parts.torque_budget import TorqueBudgetPart


class StudyPart(Part):
    """Decision, verdict, fit, regime, nip and torque budget of one log and one machine."""

    decision: DecisionPart
    verdict: list[str] = Field(description="in paragraphs; a contradiction first")
    warnings: list[str]
    fit: FitPart
    regime: RegimePart
    nip: FilmPart | None = None
    torque_budget: TorqueBudgetPart | None = None
    comparison: ComparisonPart | None = Field(default=None, description="this log (B) over another (A)")
