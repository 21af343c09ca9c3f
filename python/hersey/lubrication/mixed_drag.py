"""Drag of a contact whose load film and asperities share, for the motion of the belt."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from hersey.lubrication.mixed import MixedContact
from hersey.motion.drag import KINDS, BesideShape, Wire
from hersey.units import takes_si


@takes_si(temperature="temperature", **KINDS)
@dataclass(frozen=True)
class MixedDrag(BesideShape):
    """Drag force of a `MixedContact` against belt speed and temperature.

    The law is smooth; its transition is the speed of least drag. All its speeds, including the stick speed,
    vary with temperature as 1/viscosity; boundary friction varies as in the contact.

    Parameters
    ----------
    contact
        The mixed contact.
    temperature
        Temperature of the stick speed and of the parameters below, K.
    stick_speed
        Speed below which the ``closure`` applies, m/s, as for `Drag`.
    static_force
        Break-away force, N. Default: e times the drag at the stick speed (Eq. 29).
    rest_force, rest_damping, rest_temperature_slope
        No-load torque, N, N s/m and 1/K, as for `Drag`.

    Raises
    ------
    ParameterError
        If drag never falls with speed, or the stick speed is not below the speed of least drag.
    """

    contact: MixedContact
    temperature: float
    stick_speed: float
    _: KW_ONLY
    rest_temperature_slope: float = 0.0

    def __post_init__(self) -> None:
        """Let the core check the values."""
        self.law()

    @property
    def varies_with_temperature(self) -> bool:
        """Always true, because viscosity depends on temperature."""
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
