"""What each command prints with ``--json``."""

from __future__ import annotations

from hersey.damping.coast_down.result import CoastDown
from hersey.damping.compare import LogComparison
from hersey.document.analysis import Analysis
from hersey.document.parts.campaign import CampaignPart
from hersey.document.parts.cycles import CyclesPart
from hersey.document.parts.exchange import UnitPart
from hersey.document.parts.fit import FitDocument
from hersey.document.parts.glossary import GlossaryPart
from hersey.document.parts.life_test import LifeTestPart
from hersey.document.parts.models import ModelsPart
from hersey.document.parts.motion import StickSlipPart, SweepPart
from hersey.document.parts.posterior import PosteriorPart
from hersey.document.parts.stability import BandPart
from hersey.inspection.inspecting import Inspection
from hersey.life.failures.answers import FailureAnswers
from hersey.life.trend.result import FrictionTrend
from hersey.stability.operating_map.result import OperatingMap
from hersey.stability.plan.result import Plan
from hersey.stability.warm_up_result import WarmUp
from hersey.study.first_screen.result import DesignPart
from hersey.study.nip_film import FilmPart

#: By command, beside version and command.
PRINTED: dict[str, type] = {
    "inspect": Inspection,
    "report": Analysis,
    "fit": FitDocument,
    "models": ModelsPart,
    "design": DesignPart,
    "coastdown": CoastDown,
    "compare": LogComparison,
    "trend": FrictionTrend,
    "campaign": CampaignPart,
    "life": LifeTestPart,
    "weibull": FailureAnswers,
    "cycles": CyclesPart,
    "film": FilmPart,
    "simulate": StickSlipPart,
    "sweep": SweepPart,
    "hysteresis": BandPart,
    "map": OperatingMap,
    "posterior": PosteriorPart,
    "plan": Plan,
    "warmup": WarmUp,
    "export": UnitPart,
    "explain": GlossaryPart,
}
