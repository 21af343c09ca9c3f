"""Laws of temperature: the logarithm of torque is e s(T), with s(T_ref) = 0.

==========  ============================  ===================================================
law         s(T)                          e
==========  ============================  ===================================================
power       ln(T/T_ref), degC or K        the exponent b
Arrhenius   T_ref/T - 1                   E/(R T_ref), E the apparent activation energy
VFT         -t/(1 + q t T_ref)            D q^2 T_ref of exp(D/(T - T0)), T0 = T_ref - 1/q
==========  ============================  ===================================================

with t = T/T_ref - 1 and T in K. In this form of VFT (Vogel, Fulcher, Tammann) e is the slope at the
reference, hardly correlated with q, and q = 1/T_ref is Arrhenius.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.candidates.observations import Inputs
from hersey.units import ZERO_CELSIUS

#: Molar gas constant, J/(mol K) (exact since 2019).
GAS_CONSTANT = _core.GAS_CONSTANT
#: Least value of 1 + q t T_ref: a temperature at or below T0 has no viscosity.
_NEAR_T0 = 0.02

# Kinds of laws of temperature, as they are called in words.
CELSIUS = "power law in degC"
KELVIN = "power law in K"
ARRHENIUS = "Arrhenius"
VFT = "VFT"


@dataclass(frozen=True)
class Thermal:
    """A law of temperature about a reference, K."""

    kind: str
    reference: float

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its parameters."""
        return ("e", "q") if self.kind == VFT else ("e",)

    def start(self) -> list[float]:
        """Return where a search for the parameters may begin."""
        return [0.0, 1.2 / self.reference] if self.kind == VFT else [0.0]

    def shape(
        self, kelvin: FloatArray, q: FloatArray | float = 0.0
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return s, ds/dT (1/K) and ds/dq at temperatures, K."""
        nothing = np.zeros_like(kelvin)
        if self.kind in (CELSIUS, KELVIN):
            scale = "K" if self.kind == KELVIN else "degC"
            scaled = scaled_temperature(kelvin, scale)
            reference = scaled_temperature(np.array(self.reference), scale)
            return np.log(scaled / reference), 1.0 / scaled, nothing
        t = kelvin / self.reference - 1.0
        if self.kind == ARRHENIUS:
            return -t / (1.0 + t), -1.0 / (self.reference * (1.0 + t) ** 2), nothing
        below = 1.0 + q * t * self.reference
        held = below < _NEAR_T0
        below = np.maximum(below, _NEAR_T0)
        by_heat = -1.0 / self.reference / below / np.where(held, 1.0, below)
        by_q = np.where(held, 0.0, t / below) ** 2 * self.reference
        return -t / below, by_heat, by_q

    def shape_at(
        self, inputs: Inputs, q: FloatArray | float = 0.0
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the same at the temperatures of inputs, computed once where no parameter moves it."""
        assert inputs.kelvin is not None
        if self.kind == VFT:
            return self.shape(inputs.kelvin, q)
        if self not in inputs.shapes:
            inputs.shapes[self] = found = self.shape(inputs.kelvin)
            for each in found:
                each.flags.writeable = False
        return inputs.shapes[self]

    def energy(self, kelvin: float, q: float = 0.0) -> float:
        """Return the apparent activation energy, J/mol, at a temperature (K) for e = 1."""
        _, slope, _ = self.shape(np.array([kelvin]), q)
        return float(-GAS_CONSTANT * kelvin**2 * slope[0])


def scaled_temperature(kelvin: FloatArray, scale: str) -> FloatArray:
    """Return temperatures in K in the scale of a law."""
    return kelvin if scale == "K" else np.asarray(kelvin - ZERO_CELSIUS)
