"""The truth of a log made from physics: film and contact share the load, and the drive takes its rest."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.rest import RestOfDrive
from hersey.errors import ParameterError
from hersey.lubrication.mixed import MixedContact
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.result import json_record
from hersey.units import ZERO_CELSIUS, rpm


@dataclass(frozen=True)
class PhysicalTruth:
    """Torque of a `MixedContact` and of a `RestOfDrive`; without ``mixed`` the roll is lifted."""

    mixed: MixedContact | None
    rest: RestOfDrive

    def without_film(self) -> PhysicalTruth:
        """Return the truth of a no-load log."""
        return replace(self, mixed=None)

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the speed of least torque of the contact in rad/s at temperatures in degC."""
        return np.asarray(self._contact().transition(temperature + ZERO_CELSIUS).speed)

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s; none when standing) and temperatures (degC)."""
        kelvin = np.asarray(temperature) + ZERO_CELSIUS
        rest = self.rest.torque(speed, kelvin)
        if self.mixed is None:
            return rest
        return rest + np.sign(speed) * self.mixed.at(speed=np.abs(speed), temperature=kelvin).torque

    def drag(self, temperature: float, roll_radius: float, stick_speed: float) -> MixedDrag:
        """Return the drag of the belt at a temperature in degC, radius in m and stick speed in m/s."""
        kelvin = temperature + ZERO_CELSIUS
        rest = self.rest.at_the_belt(roll_radius, kelvin)
        return MixedDrag(self._contact(), kelvin, stick_speed, **rest)  # type: ignore[arg-type]

    def to_dict(self, temperatures: tuple[float, ...]) -> dict[str, Any]:
        """Return what it is made of as plain data, in SI, and its transitions at temperatures in degC."""
        numbers = ("constant", "per_speed", "temperature_slope")
        rest = {name: getattr(self.rest, name).value for name in numbers}
        rest["reference_temperature"] = self.rest.reference_temperature
        if self.mixed is None:
            return {"rest": rest}
        made_of = (self.mixed.contact, self.mixed.lubricant, self.mixed.asperities, self.mixed.friction)
        names = ("contact", "lubricant", "asperities", "friction")
        parts = {
            name: {field.name: getattr(part, field.name) for field in fields(part) if field.init}
            for name, part in zip(names, made_of, strict=True)
        }
        speeds = self.transition_speed(np.asarray(temperatures))
        turns = [
            {"temperature_degC": level, "speed_rpm": round(float(rpm(speed)), 4)}
            for level, speed in zip(temperatures, speeds, strict=True)
        ]
        return json_record({**parts, "rest": rest, "transitions": turns})

    def _contact(self) -> MixedContact:
        if self.mixed is None:
            raise ParameterError("the roll is lifted: this truth has no contact")
        return self.mixed
