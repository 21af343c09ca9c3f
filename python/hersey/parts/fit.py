"""The damping surface and the regime in the document."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.parts.log import InputFile, Point
from hersey.parts.part import Interval, Part
from hersey.parts.rest import RestPart


class ClosurePart(Part):
    """The law with a corner at the minimum of a gradual bend, in the variables of the fit."""

    values: list[float]
    covariance: list[list[float]]


class TransitionPart(Part):
    """Where torque is least, between the branches: speeds in rad/s at the reference temperature."""

    speed: Interval
    meeting_speed: float = Field(description="where the lines of the branches meet; speed if in a corner")
    mixed_exponent: Interval
    temperature_exponent: float
    evidence: float = Field(description="gain in AICc over a single power law")
    closure: ClosurePart | None = Field(
        description="what motion is given of a gradual bend, its branches trend lines; null for a corner"
    )
    freed: float | None = Field(
        default=None,
        description="where one Hersey number does not hold: by how much its AICc is worse",
    )


class CurveWeightPart(Part):
    """A law of drag curves and its weight."""

    name: str
    words: str
    weight: float
    delta_aicc: float
    p_value: float = Field(description="probability of so large a misfit by chance")
    rejected: bool


class TrendPart(Part):
    """What torque does as speed rises, tested on the dwells themselves."""

    rises: bool
    falls: bool
    least: float = Field(description="speed of least mean torque, rad/s")
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


class SharedScatterPart(Part):
    """Relative scatter that the dwells of a visit to a temperature, or of a run, share."""

    name: str
    deviation: float
    p_value: float = Field(description="of none, by an F test")
    told: bool = Field(description="whether the dwells say anything of it")


class FitPart(Part):
    """B = a T^b w^c: B in N m s/rad, w in rad/s, T in the scale named."""

    law: str
    temperature_scale: Literal["degC", "K"]
    reference_speed: float = Field(description="rad/s")
    reference_temperature: float | None = Field(description="K")
    coefficients: dict[str, Interval]
    torque_space: dict[str, Interval]
    transition: TransitionPart | None
    no_transition: str
    variables: list[str]
    values: list[float]
    covariance: list[list[float]]
    variance_parts: list[list[list[float]]] = Field(
        default=[], description="how the covariance rises with each variance that was estimated"
    )
    variance_uncertainty: list[list[float]] = Field(
        default=[], description="covariance of these variances: of dwells, then as in shared"
    )
    points: int
    chi_square: float
    reduced_chi_square: float
    scatter: float = Field(description="relative, between dwells, beyond their errors")
    shared: list[SharedScatterPart] = Field(default=[])
    dwell_error: float = Field(description="relative, median of the errors of the dwells")
    aicc: float
    r_squared_damping: float
    r_squared_torque: float
    speed_range: tuple[float, float] = Field(description="rad/s")
    temperature_range: tuple[float, float] | None = Field(description="K")
    sensors: str = Field(default="", description="errors that the systematic parts stand for, in words")
    rest: RestPart | None = Field(
        default=None, description="taken off the torque before the fit, which is that of the film"
    )
    summary: str
    laws: list[CurveWeightPart] = Field(default=[], description="drag curves, of which decisions are made")
    trend: TrendPart | None = None
    curves: list[Curve] = Field(default=[], description="those by weight at the temperatures measured")
    cells: list[Cell] = Field(default=[], description="the law over the range measured")
    transition_curve: list[TransitionAt] = Field(default=[], description="over the range measured")


class HypothesisPart(Part):
    """A named exponent (low is null where unbounded) and its p-value."""

    name: str
    low: float | None
    high: float
    meaning: str
    film: str = Field(description="regime of film theory that predicts it, or empty")
    p_value: float
    holds_here: bool | None = Field(
        default=None, description="whether film theory puts this contact there; null without a contact"
    )
    consistent: bool = Field(description="at the 5 % level")


class BranchPart(Part):
    """Exponent at one temperature (K) on one branch, over speeds in rad/s."""

    temperature: float | None
    branch: Literal["ehl", "mixed", "all"]
    points: int
    speed_low: float
    speed_high: float
    exponent: Interval


class ExplanationPart(Part):
    """What the data do not exclude."""

    key: str
    name: str
    constant_share: float | None = Field(description="of torque at the middle speed; null if there is none")
    p_value: float | None


class TriedPart(Part):
    """A law fitted to the rising branch; parameters in the coordinates of the fit."""

    name: str
    parameters: dict[str, float | None]
    constant_share: float | None = Field(description="of torque at the middle speed; null if there is none")
    aicc: float
    curvature: float | None = Field(description="p-value of the law's bend with speed")
    verdict: str


class LackOfFitPart(Part):
    """p-values of a law that holds; null where too few speeds or temperatures can say."""

    curvature: float | None
    exponent_with_temperature: float | None
    temperature: float | None
    local_exponents: tuple[float, float] = Field(description="of damping, at the slow and the fast end")
    by_temperature: tuple[float, float] = Field(description="at the coldest and the hottest temperature")


class RegimePart(Part):
    """Evidence and verdict; ``named`` is null where no regime may be named."""

    verdict: str
    named: str | None
    why_unnamed: str
    explanations: list[ExplanationPart]
    lack_of_fit: LackOfFitPart | None
    hypotheses: list[HypothesisPart]
    tried: list[TriedPart] = Field(default=[], description="the likeliest first")
    exponents: list[BranchPart]


class FitDocument(Part):
    """What ``hersey fit --json`` prints: all that a fit needs to be read back."""

    warnings: list[str]
    files: list[InputFile]
    points: list[Point]
    fit: FitPart
    regime: RegimePart
