"""The damping surface and the regime in the document."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.damping.branches import Transition
from hersey.damping.candidates.shared_errors import SharedScatter
from hersey.damping.curves.mixture import LawWeight
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.moving.result import MovingFit
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.document.parts.log import InputFile, Point
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.part import Interval, Part
from hersey.schema.warning import Warning
from hersey.verdict.regime import Regime

#: Of the friction curve in a document.
FRICTION = "Coulomb, viscous and Stribeck friction; null where the power law describes the dwells better"


class TrendPart(Part):
    """What torque does as speed rises, tested on the dwells themselves."""

    rises: bool
    falls: bool
    least: float = Field(description="speed of lowest mean torque, rad/s")
    spread: float = Field(description="half the range of mean torques at one temperature, relative")


class Curve(Part):
    """Drag curves by weight at a temperature (K; null if none): speeds in rad/s, damping in N m s/rad."""

    temperature: float | None
    speed: list[float]
    damping: list[float]


class Cell(Part):
    """The fitted law at the middle of a cell of speed (rad/s) and temperature (K)."""

    speed_low: float
    speed_high: float
    temperature_low: float | None
    temperature_high: float | None
    damping: float


class TransitionAt(Part):
    """Transition speed (rad/s) at a temperature (K)."""

    temperature: float
    speed: float


class FitPart(Part):
    """B = a T^b w^c: B in N m s/rad, w in rad/s, T in the scale named."""

    law: str
    temperature_scale: Literal["degC", "K"]
    reference_speed: float = Field(description="rad/s")
    reference_temperature: float | None = Field(description="K")
    coefficients: dict[str, Interval]
    torque_space: dict[str, Interval]
    transition: Transition | None
    no_transition: str
    variables: list[str]
    values: list[float]
    covariance: list[list[float]]
    variance_parts: list[list[list[float]]] = Field(
        default=[], description="change of the covariance with each estimated variance"
    )
    variance_uncertainty: list[list[float]] = Field(
        default=[], description="covariance of these variances, for dwells and then as in shared"
    )
    points: int
    chi_square: float
    reduced_chi_square: float
    scatter: float = Field(description="relative, between dwells, beyond their errors")
    shared: list[SharedScatter] = Field(default=[])
    dwell_error: float = Field(description="relative, median of the errors of the dwells")
    aicc: float
    r_squared_damping: float
    r_squared_torque: float
    speed_range: tuple[float, float] = Field(description="rad/s")
    temperature_range: tuple[float, float] | None = Field(description="K")
    sensors: str = Field(default="", description="sensor errors behind the systematic parts, in words")
    rest: NoLoadTorque | None = Field(
        default=None, description="no-load torque subtracted before the fit, which is of the film alone"
    )
    domain: Domain = Field(default=TORQUE, description="what torque and speed are: friction, if it says so")
    summary: str
    laws: list[LawWeight] = Field(default=[], description="models of the drag curve behind the decision")
    trend: TrendPart | None = None
    curves: list[Curve] = Field(default=[], description="drag curves by weight at the measured temperatures")
    cells: list[Cell] = Field(default=[], description="fitted law over the measured range")
    transition_curve: list[TransitionAt] = Field(default=[], description="over the measured range")


class FitDocument(Part):
    """What ``hersey fit --json`` prints: all that a fit needs to be read back."""

    warnings: list[Warning]
    files: list[InputFile]
    points: list[Point]
    fit: FitPart
    regime: Regime
    friction: FrictionCurve | None = Field(default=None, description=FRICTION)
    moving: MovingFit | None = Field(default=None, description="of a log that moves all the time")
