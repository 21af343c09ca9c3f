"""Drag of a contact whose load film and asperities share, for the motion of the belt."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from hersey.lubrication.mixed import MixedContact
from hersey.motion.drag import KINDS, BesideShape, Wire
from hersey.units import fields_in_si, takes_si


@dataclass(frozen=True)
class MixedDrag(BesideShape):
    """Drag force against belt speed and temperature of a `MixedContact`; it falls and rises by itself.

    The law is smooth; its transition is the speed of least drag. With temperature its speeds, the stick
    speed among them, vary as the inverse of the viscosity, and boundary friction as the contact states it.

    Parameters
    ----------
    contact
        What shares the load, and how.
    temperature
        K, at which the stick speed and what is below are stated.
    stick_speed
        m/s, below which the ``closure`` holds, as of `Drag`.
    static_force
        N, that breaks a belt at rest away; if not given e times the drag at the stick speed (Eq. 29).
    rest_force, rest_damping, rest_temperature_slope
        The no-load torque, N, N s/m and 1/K, as of `Drag`.

    Raises
    ------
    ParameterError
        If drag nowhere falls, or the stick speed is not below the speed of least drag.
    """

    contact: MixedContact
    temperature: float
    stick_speed: float
    _: KW_ONLY
    rest_temperature_slope: float = 0.0

    def __post_init__(self) -> None:
        """Bring the values to SI if they come with units, and let the core check them."""
        fields_in_si(self, {"temperature": "temperature", **KINDS})
        self.law()

    @property
    def varies_with_temperature(self) -> bool:
        """It does: viscosity falls."""
        return True

    @takes_si(temperature="temperature")
    def transition_speed(self, temperature: float) -> float:
        """Return the belt speed of least drag of the contact, m/s, at a temperature, K."""
        return self.law_at(temperature).transition_speed

    def _shape(self) -> dict[str, Wire]:
        lubricant, friction = self.contact.lubricant, self.contact.friction
        kelvin = np.asarray(self.temperature, dtype=float)
        return {
            "law": "mixed",
            "numbers": [float(number) for number in self.contact.numbers(kelvin)],
            "viscosity": float(lubricant.viscosity(kelvin)),
            "temperature_law": lubricant.law.kind,
            "viscosity_numbers": list(lubricant.coefficients().values()),
            "reference_temperature": float(self.temperature),
            "boundary_temperature_slope": float(friction.slope / friction.at(kelvin)),
            "rest_temperature_slope": float(self.rest_temperature_slope),
        }
