"""What a log and its machine tell together."""

from __future__ import annotations

from pydantic import Field

from hersey.damping.compare import LogComparison
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.document.parts.fit import FRICTION, FitPart
from hersey.schema.part import Part
from hersey.schema.warning import Warning
from hersey.study.first_screen.result import DecisionPart
from hersey.study.nip_film import FilmPart
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.regime import Regime


class StudyPart(Part):
    """Decision, verdict, fit, regime, nip and torque budget of one log and one machine."""

    decision: DecisionPart
    verdict: list[str] = Field(description="paragraphs; a disagreement comes first")
    warnings: list[Warning]
    fit: FitPart
    regime: Regime
    friction: FrictionCurve | None = Field(default=None, description=FRICTION)
    nip: FilmPart | None = None
    torque_budget: TorqueBudgetPart | None = None
    comparison: LogComparison | None = Field(
        default=None, description="this log (B) compared with another (A)"
    )
