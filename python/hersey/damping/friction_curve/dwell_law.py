"""The friction law as the fit of dwells takes it: the logarithm of torque against that of speed.

The Stribeck speed is searched for by its logarithm, which keeps it positive; all else as the law has it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from scipy import optimize

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.damping.candidates.named import Named
from hersey.damping.candidates.observations import Inputs
from hersey.damping.friction_curve.law import STRIBECK_SPEED, VISCOUS, FrictionLaw

#: Share of the least torque below which a law has none: a logarithm has no place for it.
_FLOOR = 1e-3
#: Falls of ln k_v with temperature from which a search begins, 1/K: none, oil, grease when cold.
_THINNINGS = (0.0, 0.02, 0.05)
#: Stribeck speeds from which a search begins, and how far beyond the measured speeds they lie.
_TRIED, _BEYOND = 9, 2.0
#: Starts that are kept.
_KEPT = 3


@dataclass(frozen=True)
class DwellFriction(Named):
    """A friction law about a reference speed (rad/s); ``least`` is the least torque of the dwells, N m."""

    friction: FrictionLaw
    reference_speed: float
    least: float
    #: of the damping itself; that of the viscous part is in the law
    thermal: None = None

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        return self.friction.names

    def of(self, values: FloatArray) -> FloatArray:
        """Return the parameters of the law, SI, from the values that are searched for."""
        out = np.array(values, dtype=np.float64)
        out[self._speeds] = np.exp(np.clip(out[self._speeds], -40.0, 40.0))
        return out

    def predict(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return ln torque."""
        if values.ndim > 1:
            return np.stack([self.predict(each, inputs) for each in values[:, :, 0].T])
        return np.asarray(np.log(self._torque(values, inputs)))

    def jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return its derivatives with respect to the parameters, shape (..., points, parameters)."""
        if values.ndim > 1:
            return np.stack([self.jacobian(each, inputs) for each in values[:, :, 0].T])
        own, speed = self.of(values), self._speed(inputs)
        slopes = self.friction.jacobian(own, speed, inputs.kelvin) * np.sign(speed)[:, None]
        slopes[:, self._speeds] *= own[self._speeds]
        return np.asarray(slopes / self._torque(values, inputs)[:, None])

    def slopes(self, values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        """Return its derivatives with respect to ln w and to T (1/K)."""
        own, speed, torque = self.of(values), self._speed(inputs), self._torque(values, inputs)
        by_speed = self.friction.slope(own, speed, inputs.kelvin) * np.abs(speed) / torque
        if self.friction.reference_kelvin is None:
            return by_speed, np.zeros_like(by_speed)
        by = self.friction.jacobian(own, speed, inputs.kelvin) * np.sign(speed)[:, None]
        viscous = by[:, self._at(VISCOUS)] @ own[self._at(VISCOUS)]
        return by_speed, np.asarray(-own[-1] * viscous / torque)

    def starts(self, inputs: Inputs, log_torque: FloatArray, weights: FloatArray) -> list[FloatArray]:
        """Return where to search from: linear fits over Stribeck speeds and thinnings, likeliest first."""
        speed, root = self._speed(inputs), np.sqrt(weights)
        ways = [speed > 0, speed < 0] if self.friction.apart else [np.ones(speed.shape, dtype=bool)]
        ranked: list[tuple[float, FloatArray]] = []
        for thinning in (0.0,) if self.friction.reference_kelvin is None else _THINNINGS:
            each = [self._of_one_way(way, thinning, inputs, log_torque, root) for way in ways]
            for chosen in product(*(found[:_KEPT] for found in each)):
                missed = sum(one for one, _ in chosen)
                tail = [] if self.friction.reference_kelvin is None else [thinning]
                ranked.append((missed, np.array([*np.concatenate([own for _, own in chosen]), *tail])))
        ranked.sort(key=lambda found: found[0])
        return [values for _, values in ranked[:_KEPT]]

    def _of_one_way(
        self, way: BoolArray, thinning: float, inputs: Inputs, log_torque: FloatArray, root: FloatArray
    ) -> list[tuple[float, FloatArray]]:
        """Squares left and the values of one direction, by Stribeck speed, the likeliest first."""
        speed = np.abs(self._speed(inputs)[way])
        thinned = np.ones(speed.shape)
        if self.friction.reference_kelvin is not None:
            thinned = np.exp(-thinning * (np.asarray(inputs.kelvin)[way] - self.friction.reference_kelvin))
        relative = (root[way] / np.exp(log_torque[way]))[:, None]
        found = []
        for at in self._stribeck_speeds(speed):
            share = [] if at is None else [np.exp(-((speed / at) ** 2))]
            shapes = np.column_stack([np.ones_like(speed), *share, speed * thinned])
            parts, missed = optimize.nnls(shapes * relative, root[way])
            middle = [] if at is None else [parts[0] + max(parts[1], 0.02 * self.least), float(np.log(at))]
            values = np.array([max(parts[0], _FLOOR * self.least), *middle, parts[-1]])
            found.append((float(missed) ** 2, values))
        return sorted(found, key=lambda one: one[0])

    def _stribeck_speeds(self, speed: FloatArray) -> list[float | None]:
        if not self.friction.stribeck:
            return [None]
        return [float(at) for at in np.geomspace(speed.min() / _BEYOND, speed.max(), _TRIED)]

    def _at(self, name: str) -> IntArray:
        """Where the parameter of that name stands in each direction."""
        return np.array(self.friction.places(name), dtype=np.intp)

    @cached_property
    def _speeds(self) -> IntArray:
        return self._at(STRIBECK_SPEED)

    def _speed(self, inputs: Inputs) -> FloatArray:
        sign = np.ones_like(inputs.log_speed) if inputs.sign is None else inputs.sign
        return np.asarray(sign * self.reference_speed * np.exp(inputs.log_speed))

    def _torque(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """The size of the torque, N m."""
        speed = self._speed(inputs)
        torque = self.friction.torque(self.of(values), speed, inputs.kelvin) * np.sign(speed)
        return np.maximum(torque, _FLOOR * self.least)
