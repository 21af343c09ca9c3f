"""What each command prints with ``--json``."""

from __future__ import annotations

from hersey.document.analysis import Analysis
from hersey.parts import (
    BandPart,
    CampaignPart,
    ComparisonPart,
    CyclesPart,
    DesignPart,
    FilmPart,
    FitDocument,
    InspectionPart,
    LifeTestPart,
    MapPart,
    ModelsPart,
    Part,
    PlanPart,
    PosteriorPart,
    StickSlipPart,
    SweepPart,
    UnitPart,
    WarmUpPart,
)

#: By command, beside version and command.
PRINTED: dict[str, type[Part]] = {
    "inspect": InspectionPart,
    "report": Analysis,
    "fit": FitDocument,
    "models": ModelsPart,
    "design": DesignPart,
    "compare": ComparisonPart,
    "campaign": CampaignPart,
    "life": LifeTestPart,
    "cycles": CyclesPart,
    "film": FilmPart,
    "simulate": StickSlipPart,
    "sweep": SweepPart,
    "hysteresis": BandPart,
    "map": MapPart,
    "posterior": PosteriorPart,
    "plan": PlanPart,
    "warmup": WarmUpPart,
    "export": UnitPart,
}
