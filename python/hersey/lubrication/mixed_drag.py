"""Drag of a contact whose load film and asperities share, for the motion of the belt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey import _core
from hersey.lubrication.mixed import MixedContact
from hersey.motion.drag import AnyDrag
from hersey.units import fields_in_si, takes_si


@dataclass(frozen=True)
class MixedDrag(AnyDrag):
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
        The rest of the drive, N, N s/m and 1/K, as of `Drag`.

    Raises
    ------
    ParameterError
        If drag nowhere falls, or the stick speed is not below the speed of least drag.
    """

    contact: MixedContact
    temperature: float
    stick_speed: float
    closure: str = "retained"
    bristle_stiffness: float | None = None
    bristle_damping: float | None = None
    static_force: float | None = None
    rest_force: float = 0.0
    rest_damping: float = 0.0
    rest_temperature_slope: float = 0.0

    def __post_init__(self) -> None:
        """Bring the values to SI if they come with units, and let the core check them."""
        forces = dict.fromkeys(("static_force", "rest_force"), "force")
        speeds = {"stick_speed": "belt speed", "temperature": "temperature"}
        stiff = {"bristle_stiffness": "stiffness"}
        damping = dict.fromkeys(("bristle_damping", "rest_damping"), "translational damping")
        fields_in_si(self, {**forces, **speeds, **stiff, **damping})
        self.law()

    @property
    def varies_with_temperature(self) -> bool:
        """It does: viscosity falls."""
        return True

    @takes_si(temperature="temperature")
    def transition_speed(self, temperature: float) -> float:
        """Return the belt speed of least drag of the contact, m/s, at a temperature, K."""
        return self.law_at(temperature).transition_speed

    def law(self) -> _core.Law:
        """Return the law as the core holds it."""
        lubricant, friction = self.contact.lubricant, self.contact.friction
        kelvin = np.asarray(self.temperature, dtype=float)
        numbers = [float(number) for number in self.contact.numbers(kelvin)]
        static = None if self.static_force is None else float(self.static_force)
        closure = (self.closure, self.bristle_stiffness, self.bristle_damping)
        viscosity = float(lubricant.viscosity(kelvin))
        law = _core.Law.mixed(numbers, viscosity, float(self.stick_speed), closure)
        return law.with_common((static, float(self.rest_force), float(self.rest_damping))).with_viscosity_law(
            float(self.temperature),
            lubricant.law,
            float(friction.slope / friction.at(kelvin)),
            float(self.rest_temperature_slope),
        )
