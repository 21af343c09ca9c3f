"""What dwells, starts and stick-slip say together, in the document."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from hersey.parts.decision import SpeedPart
from hersey.parts.fit import CurveWeightPart
from hersey.parts.part import Part


class ConvergencePart(Part):
    """How two independent populations of draws compare."""

    ratio: float = Field(description="greatest ratio of their quantiles of V*")
    width: float = Field(description="ratio of the outer quantiles of all")
    accepted: float = Field(description="share of moves accepted in the last stage")
    distinct: float = Field(description="share of draws that no other equals")
    stages: int
    log_evidence: list[float]
    counted: float = Field(description="degree to which the evidence is in, 1 where all of it is")
    converged: bool


class PosteriorPart(Part):
    """Draws of drag curve, closure and drive, summarised in SI; the draws themselves are not kept."""

    temperature: float | None = Field(description="K, at which V* and the safe speed hold")
    fold: SpeedPart = Field(description="V*")
    safe_speed: float = Field(description="m/s, smooth from any start with 97.5 % probability")
    closures: dict[str, float] = Field(description="probability of each closure")
    numbers: dict[str, SpeedPart] = Field(description="medians and 95 % intervals, SI")
    laws: list[CurveWeightPart]
    evidence: list[dict[str, Any]] = Field(description="what counted beside the dwells")
    unused: list[str] = Field(description="recordings that did not count, and why")
    convergence: ConvergencePart
    draws: int
    seed: int
