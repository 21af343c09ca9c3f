"""The no-load torque by itself: torque without a film, which may be nothing or have either sign.

    torque = (k + p w/w_ref) (1 + s (T - T_ref)/100 K)

Torque itself, not its logarithm, over a torque of reference: errors of a small torque are absolute.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.named import Named, stacked
from hersey.damping.candidates.observations import Inputs

#: Unit of temperature, K, in which the slope is of the size of the others.
KELVIN = 100.0


@dataclass(frozen=True)
class RestLaw(Named):
    """The parts that a log can tell: one that rises with speed, one that varies about ``reference`` (K)."""

    with_speed: bool
    reference: float | None
    thermal = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        speed = ("per_speed",) if self.with_speed else ()
        return ("constant", *speed, *(("temperature_slope",) if self.reference is not None else ()))

    def predict(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return torque over that of reference."""
        return np.asarray(self._level(values, inputs) * self._at_temperature(values, inputs))

    def jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return its derivatives with respect to the parameters, shape (..., points, parameters)."""
        level, factor = self._level(values, inputs), self._at_temperature(values, inputs)
        columns = {
            "constant": factor,
            "per_speed": np.exp(inputs.log_speed) * factor,
            "temperature_slope": level * self._away(inputs),
        }
        return stacked([columns[name] for name in self.names], level.shape)

    def slopes(self, values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        """Return its derivatives with respect to ln w and to T (1/K)."""
        by_speed = (
            self.value(values, "per_speed") * np.exp(inputs.log_speed) * self._at_temperature(values, inputs)
        )
        by_heat = self._level(values, inputs) * self.value(values, "temperature_slope") / KELVIN
        return by_speed, by_heat

    def starts(self, inputs: Inputs, torque: FloatArray, weights: FloatArray) -> list[FloatArray]:
        """Return where to search from: a line through torque, without temperature."""
        start, root = np.zeros(len(self.names)), np.sqrt(weights)
        columns = self.jacobian(start, inputs)[:, : 1 + self.with_speed]
        line, *_ = np.linalg.lstsq(columns * root[:, None], torque * root, rcond=None)
        start[: line.size] = line
        return [start]

    def _level(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        return np.asarray(values[0] + self.value(values, "per_speed") * np.exp(inputs.log_speed))

    def _at_temperature(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        return np.asarray(1.0 + self.value(values, "temperature_slope") * self._away(inputs))

    def _away(self, inputs: Inputs) -> FloatArray:
        if self.reference is None or inputs.kelvin is None:
            return np.zeros_like(inputs.log_speed)
        return np.asarray((inputs.kelvin - self.reference) / KELVIN)
