"""What carries the torque of the drive, in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.parts.part import Numbers, Part


class TorqueBudgetPart(Part):
    """Parts of the torque, N m at rad/s, at one temperature by the machine's file; and the dwells."""

    temperature: float = Field(description="K, of the hottest dwells")
    speed: Numbers = Field(description="shape (speeds,)")
    rest: Numbers = Field(description="what the drive takes besides, shape (speeds,)")
    contact: Numbers = Field(description="asperities, shape (speeds,)")
    shear: Numbers = Field(description="film sheared over the nip, shape (speeds,)")
    inlet: Numbers = Field(description="inlet and pressure of the film, shape (speeds,)")
    measured_speed: Numbers = Field(description="of the dwells there")
    measured_torque: Numbers = Field(description="whole torque of the dwells there")
    ratio: tuple[float, float, float] = Field(
        description="measured over predicted torque of all dwells: least, geometric mean, largest"
    )
    text: list[str] = Field(description="in sentences")
