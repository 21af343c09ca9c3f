"""The truth of a log made from physics: film and contact share the load, and the drive takes its rest."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.no_load_torque import NUMBERS, NoLoadTorque
from hersey.errors import ParameterError
from hersey.lubrication.mixed import MixedContact
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.motion.drag import DragTable
from hersey.result import json_record
from hersey.testbench.full_contact import FullContact, full_contact
from hersey.units import ZERO_CELSIUS


@dataclass(frozen=True)
class PhysicalTruth:
    """Torque of a `MixedContact` and of a `NoLoadTorque`; without ``mixed`` of the rest alone."""

    mixed: MixedContact | None
    rest: NoLoadTorque

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the speed of least torque of the contact in rad/s (NaN without one) at degC."""
        if self.mixed is None:
            return np.full_like(temperature, np.nan)
        return np.asarray(self.mixed.transition(temperature + ZERO_CELSIUS).speed)

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s; none when standing) and temperatures (degC)."""
        kelvin = np.asarray(temperature) + ZERO_CELSIUS
        rest = self.rest.torque(speed, temperature=kelvin)
        if self.mixed is None:
            return rest
        return rest + np.sign(speed) * self.mixed.at(speed=np.abs(speed), temperature=kelvin).torque

    def drag(self, temperature: float, roll_radius: float, stick_speed: float) -> MixedDrag | DragTable:
        """Return the drag of the belt at a temperature in degC, radius in m and stick speed in m/s."""
        if self.mixed is None:
            raise ParameterError("a drive without contact cannot stick. Set stick_slip of the stand to False")
        kelvin = temperature + ZERO_CELSIUS
        rest = self.rest.at_the_belt(roll_radius, kelvin)
        return MixedDrag(self.mixed, kelvin, stick_speed, **rest)  # type: ignore[arg-type]

    def to_dict(self) -> dict[str, Any]:
        """Return what it is made of as plain data, in SI."""
        rest = {name: getattr(self.rest, name).value for name in NUMBERS}
        rest["reference_temperature"] = self.rest.reference_temperature
        if self.mixed is None:
            return {"rest": rest}
        made_of = {
            name: getattr(self.mixed, name) for name in ("contact", "lubricant", "asperities", "friction")
        }
        parts = {
            name: {each.name: getattr(part, each.name) for each in fields(part) if each.name[0] != "_"}
            for name, part in made_of.items()
        }
        return json_record({**parts, "rest": rest})


#: Viscosity times belt speed (Pa m) among which the torque is least, and points of a drag table.
_PRODUCTS = np.geomspace(1e-5, 3e-2, 4001)
_POINTS = 200


@dataclass(frozen=True)
class FullTruth(PhysicalTruth):
    """`PhysicalTruth` whose contact is not that of a law, but of a full numerical solution.

    It is that of examples/machine.toml, which ``mixed`` must be: its lubricant, boundary friction, load and
    length are those of the torque, its film and share are not.
    """

    @property
    def full(self) -> FullContact:
        """The numerical solution."""
        return full_contact()

    def contact_force(self, product: FloatArray, kelvin: FloatArray) -> FloatArray:
        """Return the force of film and asperities on the belt, N, at viscosity times belt speed (Pa m)."""
        assert self.mixed is not None
        contact = self.mixed.contact
        return self.full.force(product, self.mixed.friction.at(kelvin), contact.load, contact.length)

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the speed of least torque of the contact in rad/s at degC."""
        assert self.mixed is not None
        kelvin = np.asarray(temperature, dtype=float) + ZERO_CELSIUS
        force = self.contact_force(_PRODUCTS, kelvin[..., None])
        least = _PRODUCTS[np.argmin(force, axis=-1)]
        return np.asarray(least / self.mixed.lubricant.viscosity(kelvin) / self.mixed.lever)

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s; none when standing) and temperatures (degC)."""
        assert self.mixed is not None
        kelvin = np.asarray(temperature) + ZERO_CELSIUS
        product = self.mixed.product(np.abs(speed), kelvin)
        force = self.contact_force(np.maximum(product, 1e-12), kelvin)
        return np.asarray(
            self.rest.torque(speed, temperature=kelvin) + np.sign(speed) * force * self.mixed.lever
        )

    def drag(self, temperature: float, roll_radius: float, stick_speed: float) -> DragTable:
        """Return the drag of the belt at a temperature in degC, radius in m and stick speed in m/s."""
        assert self.mixed is not None
        kelvin = temperature + ZERO_CELSIUS
        viscosity = float(self.mixed.lubricant.viscosity(kelvin))
        speeds = np.geomspace(0.5 * stick_speed, 3.0, _POINTS)
        forces = self.contact_force(viscosity * speeds, np.asarray(kelvin))
        rest = self.rest.at_the_belt(roll_radius, kelvin)
        return DragTable(
            tuple(speeds),
            tuple(forces),
            stick_speed,
            rest_force=rest["rest_force"],
            rest_damping=rest["rest_damping"],
        )

    def to_dict(self) -> dict[str, Any]:
        """Return what it is made of as plain data, in SI."""
        return {**super().to_dict(), "film_and_share": "full numerical solution, benchmarks/MIXED.md"}
