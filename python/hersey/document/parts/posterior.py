"""What dwells, starts and stick-slip say together, in the document."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from hersey.damping.curves.mixture import LawWeight
from hersey.decision.edges import Edge
from hersey.posterior.result import Convergence
from hersey.schema.part import Part
from hersey.schema.warning import Warning


class PosteriorPart(Part):
    """Draws of drag curve, closure and drive, summarised in SI; the draws themselves are not kept."""

    temperature: float | None = Field(description="K, at which V* and the safe speed hold")
    fold: Edge = Field(description="V*")
    safe_speed: float = Field(description="m/s, smooth from any start with 97.5 % probability")
    closures: dict[str, float] = Field(description="probability of each closure")
    numbers: dict[str, Edge] = Field(description="medians and 95 % intervals, SI")
    laws: list[LawWeight]
    evidence: list[dict[str, Any]] = Field(description="evidence used besides the dwells")
    warnings: list[Warning] = Field(description="recordings not used, and why")
    convergence: Convergence
    draws: int
    seed: int
