"""The analysis document: everything a report says, as one versioned JSON document in SI units.

It is the contract between the Python package and the page: charts and text are drawn from it alone.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.parts.campaign import CampaignPart
from hersey.parts.cycles import CyclesPart
from hersey.parts.decision import DecisionPart
from hersey.parts.exchange import UnitPart
from hersey.parts.film import FilmPart
from hersey.parts.fit import FitPart, RegimePart
from hersey.parts.inspection import InspectionPart
from hersey.parts.life_test import LifeTestPart
from hersey.parts.log import InputFile, MachineFilePart, Point, Quality, Timeline
from hersey.parts.models import ComparisonPart, DesignPart, ModelsPart
from hersey.parts.motion import SimulationPart, StickSlipPart, SweepPart
from hersey.parts.part import SCHEMA_VERSION, Part
from hersey.parts.posterior import PosteriorPart
from hersey.parts.stability import BandPart, MapPart, PlanPart, StickSpeedPart, WarmUpPart
from hersey.parts.torque_budget import TorqueBudgetPart


class Analysis(Part):
    """The whole document: what a report shows, and every further result that was asked for."""

    schema_version: Literal["2"] = SCHEMA_VERSION
    hersey_version: str
    title: str
    command: str
    made: str | None = Field(default=None, description="when, UTC, ISO 8601; null where nobody said so")
    machine: MachineFilePart | None = None
    synthetic: bool = Field(default=False, description="a log says of itself that it is no measurement")
    units: dict[str, str] = Field(
        default={}, description="in which torque, belt_speed, roll_speed, temperature and force are shown"
    )
    decision: DecisionPart | None = None
    verdict: list[str] = Field(description="in paragraphs; a contradiction first")
    warnings: list[str]
    files: list[InputFile]
    quality: Quality
    points: list[Point]
    fit: FitPart
    regime: RegimePart
    film: FilmPart | None = None
    torque_budget: TorqueBudgetPart | None = None
    simulation: SimulationPart | None = Field(
        default=None, description="below the transition; null without a machine or a transition"
    )
    timeline: Timeline
    inspection: InspectionPart | None = None
    models: ModelsPart | None = None
    compare: ComparisonPart | None = Field(default=None, description="this log (B) over another (A)")
    against: list[InputFile] | None = Field(default=None, description="files of the log compared with")
    campaign: CampaignPart | None = None
    life: LifeTestPart | None = None
    design: DesignPart | None = None
    cycles: CyclesPart | None = None
    motion: StickSlipPart | None = None
    sweep: SweepPart | None = None
    band: BandPart | None = None
    map: MapPart | None = None
    uncertainty: dict[str, tuple[float, float]] = Field(
        default={}, description="95 % ranges of stiffness, mass and stick_speed by the machine's file, SI"
    )
    stick_speed_sweep: StickSpeedPart | None = None
    posterior: PosteriorPart | None = Field(
        default=None, description="what dwells, starts and stick-slip say together"
    )
    plan: PlanPart | None = None
    warm_up: WarmUpPart | None = None
    unit: UnitPart | None = None
