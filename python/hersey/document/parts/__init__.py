"""One part per result, versioned and validated: what the document and every ``--json`` hold.

==========  ==================================================
part        what every part is
rest        the rest of the drive
log         logs and dwells
fit         the damping surface and the regime
film        the film of a nip
mixed       film and asperities that share its load
carried     what carries the torque of the drive
motion      trajectories, cycles, sweeps
stability   bands, maps, plans, warm-ups
life        ages at failure
drift       what moved with age
film_life   the film of units that age
ending      growth of indicators, and what ends units
ageing_maps the maps of a unit through its life
other_uses  the ages in other uses
life_test   a life test followed: all of these
models      candidates, comparisons of logs, designs
inspection  what a log holds
campaign    runs of many units at many ages
cycles      cycles of a trace and the drive behind them
exchange    a unit for other tools
decision    what to do, first of all
posterior   what dwells, starts and stick-slip say together
analysis    the whole document
==========  ==================================================
"""

from hersey.document.parts.ageing_maps import AgeingMapsPart
from hersey.document.parts.analysis import Analysis
from hersey.document.parts.campaign import CampaignPart
from hersey.document.parts.carried import CarriedPart
from hersey.document.parts.cycles import CyclesPart, DrivePart
from hersey.document.parts.decision import DecisionPart, FlagPart, MissingPart, PointDecisionPart
from hersey.document.parts.drift import DriftPart
from hersey.document.parts.ending import AgesPart, EndingsPart, GrowthPart
from hersey.document.parts.exchange import TrialPart, UnitPart, UnitVariablePart
from hersey.document.parts.film import (
    FilmPart,
    FilmPoint,
    FilmStatesPart,
    MeasuredFilmPart,
    MisfitPart,
    VerdictPart,
)
from hersey.document.parts.film_life import FilmLifePart
from hersey.document.parts.fit import (
    BranchPart,
    Cell,
    ClosurePart,
    Curve,
    FitDocument,
    FitPart,
    HypothesisPart,
    RegimePart,
    TransitionAt,
    TransitionPart,
)
from hersey.document.parts.inspection import InspectionPart
from hersey.document.parts.life import PopulationPart
from hersey.document.parts.life_test import LifeTestPart
from hersey.document.parts.log import (
    ChannelUse,
    InputFile,
    LogPart,
    MachineFilePart,
    Point,
    PointsPart,
    Quality,
    RejectedStretch,
    Series,
    Timeline,
)
from hersey.document.parts.mixed import MixedPart
from hersey.document.parts.models import ComparisonPart, DesignPart, ModelsPart
from hersey.document.parts.motion import SimulationPart, StickSlipPart, SweepPart, TrajectoryPart
from hersey.document.parts.other_uses import OtherUsesPart
from hersey.document.parts.part import SCHEMA_VERSION, Interval, OpenInterval, Part
from hersey.document.parts.posterior import PosteriorPart
from hersey.document.parts.rest import RestPart
from hersey.document.parts.stability import (
    BandPart,
    DisturbancePart,
    MapPart,
    PlanPart,
    StepPart,
    StickSpeedPart,
    WarmUpPart,
)

#: What each command prints with ``--json``, beside version and command.
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

__all__ = [
    "PRINTED",
    "SCHEMA_VERSION",
    "AgeingMapsPart",
    "AgesPart",
    "Analysis",
    "BandPart",
    "BranchPart",
    "CampaignPart",
    "CarriedPart",
    "Cell",
    "ChannelUse",
    "ClosurePart",
    "ComparisonPart",
    "Curve",
    "CyclesPart",
    "DecisionPart",
    "DesignPart",
    "DisturbancePart",
    "DriftPart",
    "DrivePart",
    "EndingsPart",
    "FiguresPart",
    "FilmLifePart",
    "FilmPart",
    "FilmPoint",
    "FilmStatesPart",
    "FitDocument",
    "FitPart",
    "FlagPart",
    "GrowthPart",
    "HypothesisPart",
    "InputFile",
    "InspectionPart",
    "Interval",
    "LifeTestPart",
    "LogPart",
    "MachineFilePart",
    "MapPart",
    "MeasuredFilmPart",
    "MisfitPart",
    "MissingPart",
    "MixedPart",
    "ModelsPart",
    "OpenInterval",
    "OtherUsesPart",
    "Part",
    "PlanPart",
    "Point",
    "PointDecisionPart",
    "PointsPart",
    "PopulationPart",
    "PosteriorPart",
    "Quality",
    "RegimePart",
    "RejectedStretch",
    "RestPart",
    "Series",
    "SimulationPart",
    "StepPart",
    "StickSlipPart",
    "StickSpeedPart",
    "SweepPart",
    "Timeline",
    "TrajectoryPart",
    "TransitionAt",
    "TransitionPart",
    "TrialPart",
    "UnitPart",
    "UnitVariablePart",
    "VerdictPart",
    "WarmUpPart",
]
