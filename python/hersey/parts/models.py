"""Models, comparisons and designs in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.parts.decision import MeasurementPart, SpeedPart
from hersey.parts.fit import CurveWeightPart, LackOfFitPart, SharedScatterPart
from hersey.parts.part import Holed, Numbers, OpenInterval, Part


class CandidatePart(Part):
    """A candidate law as fitted; parameters in the coordinates of the fit."""

    key: str
    name: str
    parameters: dict[str, float | None]
    not_identified: dict[str, str]
    aicc: float | None
    bic: float | None
    delta_aicc: float | None
    delta_bic: float | None
    akaike_weight: float | None
    cross_validation: float | None = Field(description="relative error of dwells left out")
    scatter: float | None = Field(description="relative")
    shared_scatter: list[SharedScatterPart]
    lack_of_fit: LackOfFitPart


class RefusedPart(Part):
    """A candidate that was not fitted, and why."""

    name: str
    reason: str


class ParameterPart(Part):
    """A parameter of the law chosen, in its unit, with 95 % intervals by method."""

    name: str
    unit: str
    value: float | None
    error: float | None
    intervals: dict[str, tuple[float | None, float | None]]
    not_identified: str


class BootstrapPart(Part):
    """The resampling."""

    draws: int
    seed: int


class OrthogonalPart(Part):
    """What errors of speed and temperature do to the fit."""

    share: float | None
    largest_shift: float | None
    converged: bool
    verdict: str


class EnergyIntervalPart(Part):
    """An energy in both units."""

    joule_per_mol: OpenInterval
    calorie_per_mol: OpenInterval


class LocalEnergyPart(Part):
    """The apparent energy of torque at a temperature (K)."""

    temperature: float
    joule_per_mol: float | None


class ActivationPart(Part):
    """Activation energies of torque, viscosity and transition."""

    torque: EnergyIntervalPart | None
    power: OpenInterval | None = Field(description="exponent of torque in viscosity")
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
    log_viscosity: Holed = Field(description="of each group over the first")
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
    chosen: str = Field(description="key of a candidate")
    reasons: list[str]
    drag_curves: list[CurveWeightPart] = Field(
        default=[], description="laws of drag curves, of which decisions are made"
    )
    parameters: list[ParameterPart]
    bootstrap: BootstrapPart
    errors_in_variables: OrthogonalPart
    activation_energy: ActivationPart
    hersey_collapse: CollapsePart | None
    warnings: list[str] = Field(default=[], description="what must be known before a fit is trusted")


class ChangePart(Part):
    """How a quantity differs between two logs; real at the 5 % level."""

    name: str
    of_a: float | None
    of_b: float | None
    change: OpenInterval
    is_ratio: bool
    p_value: float | None
    real: bool


class ComparisonPart(Part):
    """Damping of B over that of A, shape (temperatures, speeds), with simultaneous 95 % limits."""

    a: str
    b: str
    candidate: str
    verdict: str
    notes: list[str]
    mean_ratio: OpenInterval
    speeds: Numbers = Field(description="rad/s")
    temperatures: Numbers = Field(description="K")
    ratio: list[Holed]
    low: list[Holed]
    high: list[Holed]
    changes: list[ChangePart]


class DesignPointPart(Part):
    """A dwell to record, and what is known after it."""

    speed: float = Field(description="rad/s")
    kelvin: float | None = Field(description="K")
    error: float | None = Field(description="of the quantity, in its unit")
    volume: float | None = Field(description="of the confidence region over that of today")


class DesignPart(Part):
    """The next dwells, or measurements that narrow V*, in the order of their worth."""

    quantity: str
    unit: str
    error_now: float | None
    points: list[DesignPointPart]
    law: str
    seed: int
    fold: SpeedPart | None = Field(default=None, description="V* of the machine that was named, m/s")
    measurements: list[MeasurementPart] = Field(default=[], description="what would narrow it")
