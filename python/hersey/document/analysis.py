"""The analysis document: everything a report says, as one versioned JSON document in SI units.

It is the contract between the Python package and the page: charts and text are drawn from it alone.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.damping.compare import LogComparison
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.moving.friction import Moments, MovingFriction
from hersey.decision.behaviour import StickSpeeds
from hersey.document.parts.fit import FRICTION, FitPart
from hersey.document.parts.log import InputFile, MachineFilePart, Point, Quality, RecipePart, Timeline
from hersey.document.parts.models import ModelsPart
from hersey.document.parts.posterior import PosteriorPart
from hersey.schema.noun import DRIVE, Noun
from hersey.schema.part import SCHEMA_VERSION, Part
from hersey.schema.warning import Warning
from hersey.stability.hysteresis import HysteresisBand
from hersey.stability.operating_map.result import OperatingMap
from hersey.stability.plan.result import Plan
from hersey.stability.warm_up_result import WarmUp
from hersey.study.first_screen.result import DecisionPart
from hersey.study.nip_film import FilmPart
from hersey.study.simulation import SimulationPart
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.regime import Regime


class Analysis(Part):
    """The whole document: what a report shows, and every further result that was asked for."""

    schema_version: Literal["2"] = SCHEMA_VERSION
    hersey_version: str
    title: str
    part: Noun = Field(default=DRIVE, description="what slides, as the machine file names it")
    command: str
    made: str | None = Field(default=None, description="when, UTC, ISO 8601; null if not stated")
    recipe: RecipePart | None = Field(
        default=None, description="null for dwells not made by a `hersey.Recipe`"
    )
    machine: MachineFilePart | None = None
    synthetic: bool = Field(default=False, description="whether a log says of itself that it is synthetic")
    units: dict[str, str] = Field(
        default={},
        description="units in which torque, belt_speed, roll_speed, temperature and force are shown",
    )
    decision: DecisionPart | None = None
    verdict: list[str] = Field(description="paragraphs; a disagreement comes first")
    warnings: list[Warning]
    files: list[InputFile]
    quality: Quality
    points: list[Point]
    fit: FitPart
    regime: Regime
    friction: FrictionCurve | None = Field(default=None, description=FRICTION)
    moving: MovingFriction | None = Field(default=None, description="of a log that moves all the time")
    moments: Moments | None = Field(default=None, description="some moments of such a log, to be drawn")
    film: FilmPart | None = None
    torque_budget: TorqueBudgetPart | None = None
    simulation: SimulationPart | None = Field(
        default=None, description="motion below the transition; null without a machine or a transition"
    )
    timeline: Timeline
    models: ModelsPart | None = None
    compare: LogComparison | None = Field(default=None, description="this log (B) compared with another (A)")
    against: list[InputFile] | None = Field(
        default=None, description="files of the log (A) used for comparison"
    )
    band: HysteresisBand | None = None
    map: OperatingMap | None = None
    uncertainty: dict[str, tuple[float, float]] = Field(
        default={}, description="95 % ranges of stiffness, mass and stick_speed from the machine file, SI"
    )
    stick_speed_sweep: StickSpeeds | None = None
    posterior: PosteriorPart | None = Field(
        default=None, description="result of dwells, starts and stick-slip together"
    )
    plan: Plan | None = None
    warm_up: WarmUp | None = None
