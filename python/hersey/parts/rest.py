"""The rest of the drive in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.parts.part import Interval, Part


class RestPart(Part):
    """The rest of the drive at the roll: N m, N m s/rad, and 1/K about a temperature (K)."""

    constant: Interval
    per_speed: Interval
    temperature_slope: Interval
    reference_temperature: float | None
    covariance: list[list[float]] = Field(description="of the three")
    freedom: float | None = Field(description="degrees of freedom; null if it was stated")
    source: str
    sha256: list[str]
    speed_range: tuple[float, float] | None = Field(description="rad/s, of the no-load log")
    temperature_range: tuple[float, float] | None = Field(description="K, of the no-load log")
    notes: list[str] = Field(description="what is not told")
