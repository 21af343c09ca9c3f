"""The analysis document: everything a report says, as one versioned JSON document in SI units.

It is the contract between the Python package and the page: charts and text are drawn from it alone.
"""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

SCHEMA_VERSION: Literal["1"] = "1"


class Part(BaseModel):
    """A frozen part of the document that refuses unknown fields and numbers that are none."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Interval(Part):
    """A number with standard error and 95 % interval."""

    value: float
    error: float
    low: float
    high: float


class ChannelUse(Part):
    """A column used for a role, name and unit as written in the file."""

    role: str
    name: str
    unit: str


class InputFile(Part):
    """A file that went in; the sampling interval is the median, in s."""

    name: str
    sha256: str
    bytes: int
    rows: int
    missing_rows: int
    duration: float = Field(description="s")
    sampling_interval: float = Field(description="s")
    gaps: int = Field(description="times that rows are missing")
    channels: list[ChannelUse]
    comments: list[str] = Field(description="comment lines above the header")


class Point(Part):
    """A dwell: times in s, speed in rad/s, torque in N m, temperature in K, damping in N m s/rad."""

    run: int
    start: float
    end: float
    speed: float
    speed_error: float
    torque: float
    torque_error: float
    temperature: float | None
    temperature_error: float | None
    group_temperature: float | None = Field(description="K, mean of the dwells at about this temperature")
    rows: int
    effective_rows: float
    settling_rows: int
    approach: Literal["from below", "from above", "start"]
    damping: float
    damping_fitted: float
    residual: float = Field(description="ln(measured/fitted)")


class RejectedStretch(Part):
    """A stretch that is not used; times in s."""

    run: int
    start: float
    end: float
    rows: int
    reason: str


class Quality(Part):
    """How the rows of the log were used; torques in N m."""

    rows: int
    rows_used: int
    rows_settling: int
    rows_rejected: int
    standing_torque: float | None
    tare: float
    rejected: list[RejectedStretch]


class TransitionPart(Part):
    """Where falling and rising branch meet: speeds in rad/s at the reference temperature."""

    speed: Interval
    least_torque_speed: float
    mixed_exponent: Interval
    temperature_exponent: float
    evidence: float = Field(description="gain in AICc over a single power law")
    gradual: bool = Field(description="branches are trend lines on either side of a gradual bend")


class Curve(Part):
    """The fitted law at one temperature (K; null if none): speeds in rad/s, damping in N m s/rad."""

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
    transition: TransitionPart | None
    no_transition: str
    variables: list[str]
    values: list[float]
    covariance: list[list[float]]
    points: int
    chi_square: float
    reduced_chi_square: float
    scatter: float
    dwell_error: float = Field(description="relative, median of the errors of the dwells")
    aicc: float
    r_squared_damping: float
    r_squared_torque: float
    speed_range: tuple[float, float]
    temperature_range: tuple[float, float] | None = Field(description="K")
    summary: str
    curves: list[Curve]
    cells: list[Cell]
    transition_curve: list[TransitionAt]


class HypothesisPart(Part):
    """A named exponent (low is null where unbounded) and its p-value."""

    name: str
    low: float | None
    high: float
    meaning: str
    film: str = Field(description="regime of film theory that predicts it, or empty")
    p_value: float
    consistent: bool


class BranchPart(Part):
    """Exponent at one temperature (K) on one branch, over speeds in rad/s."""

    temperature: float | None
    branch: Literal["ehl", "mixed", "all"]
    points: int
    speed_low: float
    speed_high: float
    exponent: Interval


class RegimePart(Part):
    """Evidence and verdict."""

    verdict: str
    hypotheses: list[HypothesisPart]
    exponents: list[BranchPart]


class Series(Part):
    """Samples for display: time in s, values in the unit of the chart."""

    time: list[float]
    value: list[float]


class Timeline(Part):
    """The log thinned for display, runs one after another: rad/s, N m, K."""

    speed: Series
    torque: Series
    temperature: Series | None
    starts: list[float] = Field(description="s, start of each run")


class SimulationPart(Part):
    """A simulation from rest at a low drive speed."""

    title: str
    source: Literal["paper", "fit"]
    units: str
    speed_unit: str
    force_unit: str
    parameters: dict[str, float | str]
    kind: str
    frequency: float = Field(description="Hz")
    stuck_fraction: float
    speed_max: float
    time: list[float]
    belt_speed: list[float]
    spring_force: list[float]
    transition_speed: float
    drive_speed: float


class FilmPoint(Part):
    """A state on the regime chart; least film in m."""

    name: str
    viscosity_parameter: float  #: g_V
    elasticity_parameter: float  #: g_E
    regime: str
    minimum_thickness: float


class FilmPart(Part):
    """The film that theory gives this nip, and what the measured exponents say of it."""

    verdict: str
    notes: list[str]
    points: list[FilmPoint]
    dwells: list[FilmPoint]
    layer_factor: float


class Analysis(Part):
    """The whole document."""

    schema_version: Literal["1"] = SCHEMA_VERSION
    hersey_version: str
    title: str
    command: str
    warnings: list[str]
    files: list[InputFile]
    quality: Quality
    points: list[Point]
    fit: FitPart
    regime: RegimePart
    film: FilmPart | None = None
    simulation: SimulationPart
    timeline: Timeline
