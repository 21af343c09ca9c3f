"""The Stribeck law in torque: Coulomb, a Stribeck peak and a viscous part, each at its Hersey number.

    torque = T_C (1 + exp(stick - h^2) + exp(viscous) h),   ln h = z - at + e s(T)

h is the Hersey number over that of the Stribeck speed: viscosity varies as exp(e s(T)), the Arrhenius law,
and Coulomb friction not at all. Gaussian peak: Armstrong-Helouvry, Dupont and Canudas de Wit, Automatica 30
(1994) 1083.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.named import Named, stacked
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.thermal import Thermal


@dataclass(frozen=True)
class StribeckLaw(Named):
    """A candidate about reference values; isothermal without ``thermal``."""

    thermal: Thermal | None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        return ("level", *(("e",) if self.thermal else ()), "stick", "viscous", "at")

    def predict(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return ln torque."""
        total, *_ = self._parts(values, inputs)
        return np.asarray(values[0] + np.log(total))

    def jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return its derivatives with respect to the parameters, shape (..., points, parameters)."""
        total, peak, viscous, h = self._parts(values, inputs)
        by_h = (viscous - 2.0 * h**2 * peak) / total
        s = [by_h * self._shape(inputs)[0]] if self.thermal else []
        return stacked([1.0, *s, peak / total, viscous / total, -by_h], h.shape)

    def slopes(self, values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        """Return its derivatives with respect to ln w and to T (1/K)."""
        total, peak, viscous, h = self._parts(values, inputs)
        by_h = np.asarray((viscous - 2.0 * h**2 * peak) / total)
        e = values[1] if self.thermal else 0.0
        return by_h, np.asarray(by_h * e * self._shape(inputs)[1])

    def starts(self, inputs: Inputs, log_torque: FloatArray, weights: FloatArray) -> list[FloatArray]:
        """Return where to search from: Stribeck speeds across those measured, linear fits of the parts."""
        ranked = []
        for e in self._first_slopes():
            z = inputs.log_speed + e * self._shape(inputs)[0]
            for at in np.linspace(z.min(), z.max(), 7):
                h = np.exp(z - at)
                design = np.column_stack([np.ones_like(h), np.exp(-(h**2)), h])
                root = np.sqrt(weights) / np.exp(log_torque)
                parts, *_ = np.linalg.lstsq(design * root[:, None], np.sqrt(weights), rcond=None)
                parts = np.maximum(parts, 0.03 * float(np.max(np.abs(parts))))
                level = float(np.log(parts[0]))
                tail = [float(np.log(parts[1])) - level, float(np.log(parts[2])) - level, float(at)]
                values = np.array([level, *([e] if self.thermal else []), *tail])
                ranked.append(
                    (float(np.sum(weights * (log_torque - self.predict(values, inputs)) ** 2)), values)
                )
        ranked.sort(key=lambda f: f[0])
        return [values for _, values in ranked[:3]]

    def _first_slopes(self) -> tuple[float, ...]:
        """Slopes of viscosity in temperature that a search begins with: Arrhenius laws with e up to 15."""
        if self.thermal is None:
            return (0.0,)
        at = self.thermal.reference
        _, slope, _ = self.thermal.shape(np.array([at]))
        return tuple(-e / at / float(slope[0]) for e in (0.0, 5.0, 15.0))

    def _shape(self, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        if self.thermal is None or inputs.kelvin is None:
            nothing = np.zeros_like(inputs.log_speed)
            return nothing, nothing
        s, slope, _ = self.thermal.shape_at(inputs)
        return s, slope

    def _parts(
        self, values: FloatArray, inputs: Inputs
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return the torque over Coulomb's, its peak and viscous parts, and h."""
        stick, viscous, at = np.clip(values[-3:], -40.0, 40.0)
        e = values[1] if self.thermal else 0.0
        h = np.exp(np.clip(inputs.log_speed - at + e * self._shape(inputs)[0], -40.0, 40.0))
        peak, film = np.exp(stick - np.minimum(h, 25.0) ** 2), np.exp(viscous) * h
        return 1.0 + peak + film, peak, film, h
