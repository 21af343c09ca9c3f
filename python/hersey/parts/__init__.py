"""One part per result: what the document and every ``--json`` hold, validated.

===============  ===============================================
part             what every part is
rest             the rest of the drive
log              logs and dwells
fit              the damping surface and the regime
film             the film of a nip
mixed            film and asperities that share its load
torque_budget    what carries the torque of the drive
motion           trajectories, cycles, sweeps
stability        bands, maps, plans, warm-ups
life             ages at failure
drift            what moved with age
film_life        the film of units that age
time_to_failure  growth of indicators, and what ends units
ageing_maps      the maps of a unit through its life
other_uses       the ages in other uses
life_test        a life test followed: all of these
models           candidates, comparisons of logs, designs
inspection       what a log holds
campaign         runs of many units at many ages
cycles           cycles of a trace and the drive behind them
exchange         a unit for other tools
decision         what to do, first of all
posterior        what dwells, starts and stick-slip say together
study            what a log and its machine tell together
===============  ===============================================
"""

from hersey.parts.ageing_maps import AgeingMapsPart
from hersey.parts.campaign import CampaignPart
from hersey.parts.cycles import CyclesPart, DrivePart
from hersey.parts.decision import DecisionPart, FlagPart, MissingPart, PointDecisionPart
from hersey.parts.drift import DriftPart
from hersey.parts.exchange import TrialPart, UnitPart, UnitVariablePart
from hersey.parts.film import (
    FilmPart,
    FilmPoint,
    FilmStatesPart,
    MeasuredFilmPart,
    MisfitPart,
    VerdictPart,
)
from hersey.parts.film_life import FilmLifePart
from hersey.parts.fit import (
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
from hersey.parts.inspection import InspectionPart
from hersey.parts.life import PopulationPart
from hersey.parts.life_test import LifeTestPart
from hersey.parts.log import (
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
from hersey.parts.mixed import MixedPart
from hersey.parts.models import ComparisonPart, DesignPart, ModelsPart
from hersey.parts.motion import SimulationPart, StickSlipPart, SweepPart, TrajectoryPart
from hersey.parts.other_uses import OtherUsesPart
from hersey.parts.part import SCHEMA_VERSION, Interval, OpenInterval, Part
from hersey.parts.posterior import PosteriorPart
from hersey.parts.rest import RestPart
from hersey.parts.stability import (
    BandPart,
    DisturbancePart,
    MapPart,
    PlanPart,
    StepPart,
    StickSpeedPart,
    WarmUpPart,
)
from hersey.parts.study import StudyPart
from hersey.parts.time_to_failure import AgesPart, GrowthPart, TimeToFailurePart
from hersey.parts.torque_budget import TorqueBudgetPart

__all__ = [
    "SCHEMA_VERSION",
    "AgeingMapsPart",
    "AgesPart",
    "BandPart",
    "BranchPart",
    "CampaignPart",
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
    "StudyPart",
    "SweepPart",
    "TimeToFailurePart",
    "Timeline",
    "TorqueBudgetPart",
    "TrajectoryPart",
    "TransitionAt",
    "TransitionPart",
    "TrialPart",
    "UnitPart",
    "UnitVariablePart",
    "VerdictPart",
    "WarmUpPart",
]
