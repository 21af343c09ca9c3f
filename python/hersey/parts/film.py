"""The film of a nip in the document."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.parts.fit import HypothesisPart
from hersey.parts.mixed import MixedPart
from hersey.parts.part import Holed, Numbers, OpenInterval, Part


class FilmPoint(Part):
    """A state on the regime chart; least film in m."""

    name: str
    viscosity_parameter: float  #: g_V
    elasticity_parameter: float  #: g_E
    regime: str
    minimum_thickness: float


class ContactPart(Part):
    """The contact, SI; a flat heater has no radius (null)."""

    roll_radius: float = Field(description="m")
    rubber_thickness: float = Field(description="m")
    modulus: float = Field(description="Young's modulus of the rubber, Pa")
    poisson_ratio: float
    length: float = Field(description="m")
    load: float = Field(description="N")
    heater_radius: float | None = Field(description="m")
    roughness: float | None = Field(description="m, rms")
    nip_uncertainty: float | None
    supply: float | None = Field(default=None, description="layer on the inlet side, m")
    heat_flow: float | None = Field(default=None, description="through the film, W")
    sensor_side: str | None = Field(default=None, description="wall of the film that the sensor reads")
    effective_modulus: float = Field(description="E' = 2 E/(1 - nu^2), Pa")
    reduced_radius: float = Field(description="m")


class LubricantPart(Part):
    """The lubricant: (K, Pa s) and (K, 1/Pa); coefficients of its law in SI."""

    name: str
    model: str
    source: str
    points: list[tuple[float, float]]
    pressure_viscosity: list[tuple[float, float]]
    coefficients: dict[str, float]


class NipPart(Part):
    """The contact of the roll, dry; its width by each rule."""

    width: float = Field(description="m")
    pressure_mean: float = Field(description="Pa")
    pressure_max: float = Field(description="Pa")
    edge: float
    curvature: float
    width_over_hertz: float
    paper_width: float = Field(description="m")
    paper_in_range: bool
    strain: float
    layer_factor: float = Field(description="soft film of the layer over that of a half-space")
    layer: float = Field(description="width, m")
    hertz: float = Field(description="width, m")
    paper: float = Field(description="width, m")


class LawPart(Part):
    """A law of film thickness and the convention it belongs to."""

    law: str
    formula: str
    convention: str
    source: str


class FilmCorrectionPart(Part):
    """A factor on the film and where its rule holds, shape (points,)."""

    factor: Numbers
    valid: list[bool]


class FilmStatesPart(Part):
    """The film at operating points, arrays of shape (points,)."""

    names: list[str] = Field(default=[], description="of the points")
    speed: Numbers = Field(description="rad/s")
    temperature: Numbers = Field(description="K")
    entrainment_speed: Numbers = Field(description="mean of the surfaces, m/s")
    viscosity: Numbers = Field(description="Pa s")
    g_v: Numbers
    g_e: Numbers
    minimum: Numbers = Field(description="by the governing law, before corrections, m")
    central: Numbers = Field(description="by the governing law, before corrections, m")
    inlet_short: list[bool]
    minima: dict[str, Numbers] = Field(description="by law, m")
    centres: dict[str, Numbers] = Field(description="by law, m")
    regime: list[str]
    shear: Numbers = Field(description="part of the torque by sliding, N m")
    rolling: Numbers = Field(description="part of the torque by the gradient of pressure, N m")
    torque: Numbers = Field(description="both, N m")
    corrections: dict[str, FilmCorrectionPart]


class MeasuredFilmPart(Part):
    """What each dwell says of the film, arrays of shape (dwells,)."""

    speed: Numbers = Field(description="rad/s")
    temperature: Numbers = Field(description="K")
    torque: Numbers = Field(description="N m")
    thickness: Numbers = Field(description="m")
    low: Numbers = Field(description="m, 95 %")
    high: Numbers = Field(description="m, 95 %")
    systematic: float = Field(description="factor common to all dwells")
    friction: Numbers
    hersey_number: Numbers = Field(description="eta U/p, m")
    sommerfeld_number: Numbers
    lambda_ratio: Numbers | None
    predicted: FilmStatesPart
    predicted_torque: Numbers = Field(description="N m")
    calibration: OpenInterval = Field(description="measured over predicted torque")
    on_film: Holed = Field(description="1 on the rising branch, 0 on the falling one")
    grip: float | None


class VerdictPart(Part):
    """Measured exponents against those predicted for this contact; energies in J/mol."""

    exponent: OpenInterval
    expected: float
    solved: float | None
    predictions: list[HypothesisPart]
    thermal: OpenInterval | None
    thermal_expected: float
    activation_energy: float | None
    viscosity_activation_energy: float
    text: str


class ContactTransitionPart(Part):
    """Transition speed by film and asperities beside the log's, arrays of shape (temperatures,)."""

    temperature: Numbers = Field(description="as read, K")
    speed: Holed = Field(description="by the contact, rad/s; null where drag falls nowhere")
    measured: Holed = Field(description="of the fitted surface, rad/s; null where it shows none")
    low: Holed = Field(description="of measured, rad/s, 95 %")
    high: Holed = Field(description="of measured, rad/s, 95 %")
    ratio: Holed = Field(description="speed over measured")
    by_roughness: Holed = Field(description="d ln speed/d ln roughness")
    by_boundary: Holed = Field(description="d ln speed/d ln boundary friction; by viscosity it is -1")


class MisfitPart(Part):
    """A number of a nip that does not fit."""

    signal: Literal["watch", "act"] = Field(description="act: it cannot be")
    text: str
    size: float = Field(description="how many times its bound, or its interval, it is off; 1: just not")


class FilmPart(Part):
    """The film that theory gives this nip, and what a log says of it if there is one."""

    contact: ContactPart
    lubricant: LubricantPart
    nip: NipPart
    laws: list[LawPart]
    film: FilmStatesPart = Field(description="at the points of interest")
    measured: MeasuredFilmPart | None = None
    exponents: VerdictPart | None = None
    verdict: str = ""
    contradicted: bool = Field(default=False, description="the log excludes the film of this nip")
    mixed: MixedPart | None = Field(default=None, description="who carries what, at the points")
    transition: ContactTransitionPart | None = Field(default=None, description="where drag is least")
    misfits: list[MisfitPart] = Field(default=[], description="what does not fit, the farthest off first")
    notes: list[str] = Field(default=[], description="what else is to be known, and cautions of the log")
    points: list[FilmPoint] = Field(default=[], description="points of interest on the regime chart")
    dwells: list[FilmPoint] = Field(default=[], description="dwells on the regime chart")

    @property
    def layer_factor(self) -> float:
        """Soft film of the layer over that of a half-space."""
        return self.nip.layer_factor
