"""A constant torque beside the film: the no-load torque, and a power law or a viscous part.

    torque = F (exp(e s(T)) (w/w_ref)^(1 + c) + (exp(rest) + exp(viscous) w/w_ref) exp(r s(T)))

With c held at 0 it is Coulomb friction and a viscous part, T_0 + k w. What rises with speed beside a film of
another exponent is there if ``viscous``. The rest does not vary with temperature unless ``rest_thermal`` lets
it, by the same shape s(T).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray
from hersey.damping.candidates.named import Named, stacked
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.thermal import Thermal

#: Exponents of the film from which a search begins, if it is free.
_EXPONENTS = (0.0, -0.3, -0.6)
#: The law of temperature of the film alone over that of the whole, from which a search begins.
_STEEPER = (1.0, 1.5, 2.5)
#: Bound of the logarithm of the constant part over the film at the reference.
_LOG_BOUND = 40.0


@dataclass(frozen=True)
class ConstantPlusLaw(Named):
    """A candidate about reference values.

    ``exponent`` holds the film's exponent of damping in speed; None leaves it free.
    """

    thermal: Thermal | None
    exponent: float | None = None
    rest_thermal: bool = False
    viscous: bool = False

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        return (
            "level",
            *(self.thermal.names if self.thermal else ()),
            *(("c",) if self.exponent is None else ()),
            "rest",
            *(("viscous",) if self.viscous else ()),
            *(("r",) if self.rest_thermal and self.thermal else ()),
        )

    def predict(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return ln torque."""
        return np.asarray(values[0] + np.logaddexp.reduce(self._logarithms(values, inputs)))

    def jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return its derivatives with respect to the parameters, shape (..., points, parameters)."""
        share, constant, viscous = self._shares(values, inputs)
        s, _, by_q = self._shape(values, inputs)
        e, r = self.value(values, "e"), self.value(values, "r")
        columns: dict[str, FloatArray | float] = {
            "level": 1.0,
            "e": share * s,
            "q": (share * e + (1.0 - share) * r) * by_q,
            "c": share * inputs.log_speed,
            "rest": constant,
            "viscous": viscous,
            "r": (1.0 - share) * s,
        }
        return stacked([columns[name] for name in self.names], share.shape)

    def slopes(self, values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        """Return its derivatives with respect to ln w and to T (1/K)."""
        share, _, viscous = self._shares(values, inputs)
        _, by_heat, _ = self._shape(values, inputs)
        e, r = self.value(values, "e"), self.value(values, "r")
        return share * (1.0 + self._exponent(values)) + viscous, (share * e + (1.0 - share) * r) * by_heat

    def film_share(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return the share of the film in the torque."""
        return np.asarray(self._shares(values, inputs)[0])

    def starts(self, inputs: Inputs, log_torque: FloatArray, weights: FloatArray) -> list[FloatArray]:
        """Return where to search from: non-negative parts at fixed exponents, the likeliest first."""
        z, root = inputs.log_speed, np.sqrt(weights)
        s, q = np.zeros_like(z), []
        if self.thermal and inputs.kelvin is not None:
            q = self.thermal.start()[1:]
            s = self.thermal.shape(inputs.kelvin, *q)[0]
        plain = np.column_stack([np.ones_like(z), s, z])
        one, *_ = np.linalg.lstsq(plain * root[:, None], log_torque * root, rcond=None)
        ranked = []
        for c in _EXPONENTS if self.exponent is None else (self.exponent,):
            for steeper in _STEEPER if self.thermal else (1.0,):
                e = steeper * float(one[1])
                film = np.exp(e * s + (1.0 + c) * z)
                beside = (np.ones_like(z), np.exp(z)) if self.viscous else (np.ones_like(z),)
                shapes = np.column_stack([film, *beside])
                relative = shapes * (root / np.exp(log_torque))[:, None]
                parts, missed = optimize.nnls(relative, root)
                parts = np.maximum(parts, 1e-3 * float(np.max(parts)))
                named = {"level": float(np.log(parts[0])), "e": e, "q": q[0] if q else 0.0, "c": c, "r": 0.0}
                for name, part in zip(("rest", "viscous"), parts[1:], strict=False):
                    named[name] = float(np.log(part / parts[0]))
                ranked.append((float(missed), np.array([named[name] for name in self.names])))
        ranked.sort(key=lambda f: f[0])
        return [values for _, values in ranked[:3]]

    def _exponent(self, values: FloatArray) -> FloatArray | float:
        return self.value(values, "c") if self.exponent is None else self.exponent

    def _shape(self, values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray, FloatArray]:
        if self.thermal is None or inputs.kelvin is None:
            nothing = np.zeros_like(inputs.log_speed)
            return nothing, nothing, nothing
        return self.thermal.shape_at(inputs, self.value(values, "q"))

    def _shares(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Shares of film, constant and viscous part in the torque, shape (3, ..., points)."""
        parts = self._logarithms(values, inputs)
        return np.asarray(np.exp(parts - np.logaddexp.reduce(parts)))

    def _logarithms(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Logarithms of film, constant and viscous part over F, shape (3, ..., points)."""
        s, z = self._shape(values, inputs)[0], inputs.log_speed
        factor = self.value(values, "r") * s
        rest = np.clip(self.value(values, "rest"), -_LOG_BOUND, _LOG_BOUND) + factor + np.zeros_like(z)
        out = np.empty((3, *rest.shape))
        out[0] = self.value(values, "e") * s + (1.0 + self._exponent(values)) * z
        out[1], out[2] = rest, -np.inf
        if self.viscous:
            out[2] = np.clip(self.value(values, "viscous"), -_LOG_BOUND, _LOG_BOUND) + factor + z
        return out
