"""Cycles of a trace and the drive behind them in the document."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.identification.cycle_record import Scatter
from hersey.identification.identified_drive import IdentifiedDrive
from hersey.schema.part import Numbers, Part
from hersey.schema.warning import Warning


class CyclesPart(Part):
    """Cycles of a trace: times in s, force in ``unit``."""

    kind: Literal["steady_sliding", "inertial", "stick_slip"]
    quantity: str
    slips: int
    falls: int | None = Field(default=None, description="falls beyond the noise, counted or not")
    drive_speed: float | None = Field(description="m/s, or rad/s for a torque")
    drive_speed_uncertainty: float | None = Field(
        default=None, description="relative, half of its 95 % interval"
    )
    loading_slope: float | None = Field(description="unit of the trace per s")
    stiffness: float | None = Field(description="unit of the trace per m, or per rad for a torque")
    free_period: float | None = Field(description="s")
    stuck_fraction: float | None
    least_drop: float | None
    noise: float | None
    drift: float | None = Field(description="unit of the trace per s")
    spikes: int
    missing: int
    slip_time: Numbers = Field(description="s, shape (slips,)")
    warnings: list[Warning]
    period: Scatter
    drop: Scatter
    force_max: Scatter
    force_min: Scatter
    fall_duration: Scatter
    unit: str = Field(default="", description="unit of the trace")
    drive: IdentifiedDrive | None = None
