"""The film of a nip in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.damping.estimate import Estimate
from hersey.lubrication.contact import Contact, Nip
from hersey.lubrication.film_result import Correction
from hersey.lubrication.lubricant import Lubricant
from hersey.lubrication.mixed import MixedContact, MixedFilm, MixedTransition
from hersey.schema.part import Numbers, Part
from hersey.schema.record import part_of
from hersey.schema.warning import Warning
from hersey.verdict.evidence import MeasuredFilm
from hersey.verdict.regimes import Hypothesis
from hersey.verdict.transition import ContactTransition


class FilmPoint(Part):
    """A state on the regime chart; least film in m."""

    name: str
    viscosity_parameter: float  #: g_V
    elasticity_parameter: float  #: g_E
    regime: str
    minimum_thickness: float


class NipPart(part_of(Nip)):  # type: ignore[misc]  # made as it runs
    """The contact of the roll, dry; its width by each rule."""

    layer: float = Field(description="width, m")
    hertz: float = Field(description="width, m")
    paper: float = Field(description="width, m")


class LawPart(Part):
    """A law of film thickness and the convention it belongs to."""

    law: str
    formula: str
    convention: str
    source: str


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
    corrections: dict[str, Correction]


class MeasuredFilmPart(part_of(MeasuredFilm)):  # type: ignore[misc]  # made as it runs
    """What each dwell says of the film, arrays of shape (dwells,)."""

    predicted: FilmStatesPart


class MixedPart(Part):
    """A contact whose load film and asperities share."""

    law: MixedContact
    points: MixedFilm
    transition: MixedTransition


class VerdictPart(Part):
    """Measured exponents against those predicted for this contact; energies in J/mol."""

    exponent: Estimate
    expected: float
    solved: float | None
    predictions: list[Hypothesis]
    thermal: Estimate | None
    thermal_expected: float
    activation_energy: float | None
    viscosity_activation_energy: float
    text: str


class FilmPart(Part):
    """The film that theory gives this nip, and what a log says of it if there is one."""

    contact: Contact
    lubricant: Lubricant
    nip: NipPart
    laws: list[LawPart]
    film: FilmStatesPart = Field(description="film at the points of interest")
    measured: MeasuredFilmPart | None = None
    exponents: VerdictPart | None = None
    verdict: str = ""
    contradicted: bool = Field(default=False, description="the log excludes the film of this nip")
    mixed: MixedPart | None = Field(default=None, description="load sharing at the points")
    transition: ContactTransition | None = Field(default=None, description="where torque is lowest")
    warnings: list[Warning] = Field(
        default=[],
        description="what disagrees, the largest disagreement first, then remarks and warnings of the log",
    )
    points: list[FilmPoint] = Field(default=[], description="points of interest on the regime chart")
    dwells: list[FilmPoint] = Field(default=[], description="dwells on the regime chart")

    @property
    def layer_factor(self) -> float:
        """Soft film of the layer over that of a half-space."""
        return float(self.nip.layer_factor)
