"""Cycles of a trace and the drive behind them in the document."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.parts.part import Numbers, OpenInterval, Part


class ScatterPart(Part):
    """A figure that each cycle has."""

    median: float | None
    mean: float | None
    deviation: float | None
    error: float | None = Field(description="of the mean")


class ClosurePart(Part):
    """The best drive with one closure; the misfit is a share of the drop."""

    closure: str
    chi_square: float | None
    misfit: float | None


class DrivePart(Part):
    """A drive identified from a record; SI if the trace was in newtons."""

    closure: str
    closure_decided: bool
    closures: list[ClosurePart]
    estimates: dict[str, OpenInterval] = Field(description="what the record tells")
    known: dict[str, float]
    best_fit: dict[str, float | None]
    derived: dict[str, OpenInterval]
    systematic: dict[str, float] = Field(
        default_factory=dict,
        description="half width that the uncertainty of the drive speed adds to an interval",
    )
    not_told: list[str]
    misfit: float
    drive_speed: float = Field(description="m/s")
    drive_speed_uncertainty: float | None = Field(
        default=None, description="share, half of its 95 % interval"
    )
    notes: list[str]


class CyclesPart(Part):
    """Cycles of a trace: times in s, force in ``unit``."""

    kind: Literal["steady_sliding", "inertial", "stick_slip"]
    quantity: str
    slips: int
    falls: int | None = Field(default=None, description="beyond the noise, counted or not")
    drive_speed: float | None = Field(description="m/s; rad/s with a torque")
    drive_speed_uncertainty: float | None = Field(
        default=None, description="share, half of its 95 % interval"
    )
    loading_slope: float | None = Field(description="unit of the trace per s")
    stiffness: float | None = Field(description="unit of the trace per m; per rad with a torque")
    free_period: float | None = Field(description="s")
    stuck_fraction: float | None
    least_drop: float | None
    noise: float | None
    drift: float | None = Field(description="unit of the trace per s")
    spikes: int
    missing: int
    slip_time: Numbers = Field(description="s, shape (slips,)")
    notes: list[str]
    period: ScatterPart
    drop: ScatterPart
    force_max: ScatterPart
    force_min: ScatterPart
    fall_duration: ScatterPart
    unit: str = Field(default="", description="of the trace")
    drive: DrivePart | None = None
