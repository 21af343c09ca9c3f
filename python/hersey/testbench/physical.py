"""The truth of a log made from physics: film and contact share the load, and the drive takes its rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.rest import RestOfDrive
from hersey.errors import ParameterError
from hersey.lubrication.mixed import MixedContact
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.result import json_record
from hersey.units import ZERO_CELSIUS


@dataclass(frozen=True)
class PhysicalTruth:
    """Torque of a `MixedContact` and of a `RestOfDrive`; without ``mixed`` of the rest alone."""

    mixed: MixedContact | None
    rest: RestOfDrive

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the speed of least torque of the contact in rad/s (NaN without one) at degC."""
        if self.mixed is None:
            return np.full_like(temperature, np.nan)
        return np.asarray(self.mixed.transition(temperature + ZERO_CELSIUS).speed)

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s; none when standing) and temperatures (degC)."""
        kelvin = np.asarray(temperature) + ZERO_CELSIUS
        rest = self.rest.torque(speed, kelvin)
        if self.mixed is None:
            return rest
        return rest + np.sign(speed) * self.mixed.at(speed=np.abs(speed), temperature=kelvin).torque

    def drag(self, temperature: float, roll_radius: float, stick_speed: float) -> MixedDrag:
        """Return the drag of the belt at a temperature in degC, radius in m and stick speed in m/s."""
        if self.mixed is None:
            raise ParameterError("without a contact no belt sticks: set stick_slip of the stand to False")
        kelvin = temperature + ZERO_CELSIUS
        rest = self.rest.at_the_belt(roll_radius, kelvin)
        return MixedDrag(self.mixed, kelvin, stick_speed, **rest)  # type: ignore[arg-type]

    def to_dict(self) -> dict[str, Any]:
        """Return what it is made of as plain data, in SI."""
        numbers = ("constant", "per_speed", "temperature_slope")
        rest = {name: getattr(self.rest, name).value for name in numbers}
        rest["reference_temperature"] = self.rest.reference_temperature
        if self.mixed is None:
            return {"rest": rest}
        names = ("contact", "lubricant", "asperities", "friction")
        parts = {
            name: {key: value for key, value in vars(getattr(self.mixed, name)).items() if key[0] != "_"}
            for name in names
        }
        return json_record({**parts, "rest": rest})
