"""The true damping surface behind a virtual log: what a fit is to find."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.motion.drag import Drag
from hersey.units import ZERO_CELSIUS

RPM = 2.0 * np.pi / 60.0


@dataclass(frozen=True)
class Truth:
    """The lubricant: B in N m s/rad from T in degC and w in rad/s, and its transition."""

    a: float = 62.0
    b: float = -0.9
    c: float = -0.7
    mixed_exponent: float = -1.2
    transition_speed_rpm: float = 12.0  #: at the reference temperature
    reference_temperature_degC: float = 150.0  # noqa: N815 (the unit is spelt so)

    @property
    def temperature_exponent(self) -> float:
        """Exponent of the transition speed in temperature: a fixed Hersey number."""
        return -self.b / (1.0 + self.c)

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the transition speed in rad/s at temperatures in degC."""
        ratio = temperature / self.reference_temperature_degC
        return np.asarray(self.transition_speed_rpm * RPM * ratio**self.temperature_exponent)

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s) and temperatures (degC)."""
        w = np.abs(speed)
        w_t = self.transition_speed(temperature)
        level = self.a * temperature**self.b * w_t ** (1.0 + self.c)
        exponent = 1.0 + np.where(w >= w_t, self.c, self.mixed_exponent)
        ratio = np.where(w > 0, w, 1.0) / w_t
        return np.asarray(np.where(w > 0, np.sign(speed) * level * ratio**exponent, 0.0))

    def drag(self, temperature: float, roll_radius: float, stick_speed: float) -> Drag:
        """Return the drag of the belt at a temperature in degC, radius in m and stick speed in m/s."""
        w_t = float(self.transition_speed(np.array(temperature)))
        return Drag(
            transition_force=float(self.torque(np.array(w_t), np.array(temperature))) / roll_radius,
            transition_speed=w_t * roll_radius,
            ehl_exponent=self.c,
            mixed_exponent=self.mixed_exponent,
            stick_speed=stick_speed,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return its numbers as plain data."""
        return asdict(self)


@dataclass(frozen=True)
class ThermalTruth(Truth):
    """A lubricant of another law of temperature, equal to `Truth` at the reference temperature.

    Its viscosity varies as T^b in K or degC, as Arrhenius's or as Vogel's law (VFT) has it, and torque above
    the transition as viscosity to the power 1 + c.
    """

    law: str = "Arrhenius"  #: ``degC``, ``K``, ``Arrhenius`` or ``VFT``
    activation_energy: float = 39_584.0  #: J/mol, apparent, of torque at the reference temperature
    vogel_temperature: float = 200.0  #: K, of VFT
    transition_share: float = 1.0  #: the transition moves as 1/viscosity to this power; 1: one Hersey number
    exponent_drift: float = 0.0  #: change of c for each kelvin from the reference, 1/K
    pivot_speed_rpm: float = 30.0  #: where such a change leaves torque alone

    def log_torque_ratio(self, temperature: FloatArray) -> FloatArray:
        """Return ln of torque over that at the reference temperature, at temperatures in degC."""
        kelvin, reference = temperature + ZERO_CELSIUS, self.reference_temperature_degC + ZERO_CELSIUS
        slope = self.activation_energy / (_core.GAS_CONSTANT * reference**2)  # of -ln torque, 1/K, there
        if self.law == "degC":
            scale = self.reference_temperature_degC
            return np.asarray(-slope * scale * np.log(temperature / scale))
        if self.law == "K":
            return np.asarray(-slope * reference * np.log(kelvin / reference))
        if self.law not in ("Arrhenius", "VFT"):
            raise ParameterError(f"law '{self.law}' is not known: degC, K, Arrhenius or VFT")
        zero = self.vogel_temperature if self.law == "VFT" else 0.0
        shape = 1.0 / (kelvin - zero) - 1.0 / (reference - zero)
        return np.asarray(slope * (reference - zero) ** 2 * shape)

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the transition speed in rad/s at temperatures in degC."""
        viscosity = self.log_torque_ratio(temperature) / (1.0 + self.c)
        return np.asarray(self.transition_speed_rpm * RPM * np.exp(-self.transition_share * viscosity))

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s) and temperatures (degC)."""
        w = np.where(speed == 0, 1.0, np.abs(speed))
        pivot = self.pivot_speed_rpm * RPM
        c = self.c + self.exponent_drift * (temperature - self.reference_temperature_degC)
        level = self.a * self.reference_temperature_degC**self.b * pivot ** (1.0 + self.c)
        bend = np.minimum(np.log(w / self.transition_speed(temperature)), 0.0)
        log_ratio = self.log_torque_ratio(temperature) + (1.0 + c) * np.log(w / pivot)
        return np.asarray(np.sign(speed) * level * np.exp(log_ratio + (self.mixed_exponent - c) * bend))


@dataclass(frozen=True)
class StribeckTruth(ThermalTruth):
    """A Stribeck curve at its Hersey number; ``activation_energy`` is that of viscosity.

    ``transition_speed_rpm`` is the Stribeck speed, and the coefficients of the branches have no part in it.
    """

    coulomb_torque: float = 0.25  #: N m
    stribeck_peak: float = 0.8  #: over Coulomb's torque
    viscous: float = 0.12  #: torque over Coulomb's at the Stribeck speed

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the Stribeck speed in rad/s at temperatures in degC."""
        return np.asarray(self.transition_speed_rpm * RPM * np.exp(-self.log_torque_ratio(temperature)))

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s) and temperatures (degC)."""
        h = np.abs(speed) / self.transition_speed(temperature)
        size = self.coulomb_torque * (1.0 + self.stribeck_peak * np.exp(-(h**2)) + self.viscous * h)
        return np.asarray(np.sign(speed) * size)
