"""Models, comparisons and designs in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.damping.candidates.errors_in_variables import OrthogonalFit
from hersey.damping.candidates.intervals import ParameterEstimate
from hersey.damping.candidates.lack_of_fit import LackOfFit
from hersey.damping.candidates.shared_errors import SharedScatter
from hersey.damping.curves.mixture import LawWeight
from hersey.damping.estimate import Estimate
from hersey.schema.part import Holed, Part
from hersey.schema.warning import Warning


class CandidatePart(Part):
    """A model as fitted; parameters in the coordinates of the fit."""

    key: str
    name: str
    parameters: dict[str, float | None] = Field(
        description="by name, in the coordinates of the fit; null if it has no finite value"
    )
    not_identified: dict[str, str]
    aicc: float | None
    bic: float | None
    delta_aicc: float | None
    delta_bic: float | None
    akaike_weight: float | None
    cross_validation: float | None = Field(description="relative error in predicting excluded dwells")
    scatter: float | None = Field(description="relative")
    shared_scatter: list[SharedScatter]
    lack_of_fit: LackOfFit


class RefusedPart(Part):
    """A candidate that was not fitted, and why."""

    name: str
    reason: str


class BootstrapPart(Part):
    """The resampling."""

    draws: int
    seed: int


class EnergyIntervalPart(Part):
    """An energy in both units."""

    joule_per_mol: Estimate
    calorie_per_mol: Estimate


class LocalEnergyPart(Part):
    """The apparent energy of torque at a temperature (K)."""

    temperature: float
    joule_per_mol: float | None


class ActivationPart(Part):
    """Activation energies of torque, viscosity and transition."""

    torque: EnergyIntervalPart | None
    power: Estimate | None = Field(description="exponent of torque in viscosity")
    viscosity: EnergyIntervalPart | None
    transition: EnergyIntervalPart | None
    p_value: float | None
    verdict: str
    local: list[LocalEnergyPart]


class CollapsePart(Part):
    """Whether the temperatures fall on one curve of the Hersey number; deviations relative."""

    collapses: bool | None
    deviation: float | None
    scatter: float | None
    p_value: float | None
    overlap: float | None
    log_viscosity: Holed = Field(description="of each group, relative to the first")
    verdict: str


class ModelsPart(Part):
    """All candidates, the one chosen and what follows."""

    dwells: int
    clustered_by: str
    reference_speed: float = Field(description="rad/s")
    reference_temperature: float | None = Field(description="K")
    temperatures: Holed = Field(description="mean of each group, K")
    candidates: list[CandidatePart]
    refused: list[RefusedPart]
    chosen: str = Field(description="key of the chosen model")
    reasons: list[str]
    drag_curves: list[LawWeight] = Field(
        default=[], description="models of the drag curve behind the decision"
    )
    parameters: list[ParameterEstimate]
    bootstrap: BootstrapPart
    errors_in_variables: OrthogonalFit
    activation_energy: ActivationPart
    hersey_collapse: CollapsePart | None
    warnings: list[Warning] = Field(default=[], description="what to know before trusting the fit")
