"""The drag of a known contact whose load film and asperities share, beside a constant torque.

    torque = R F(eta U exp(viscosity); roughness exp(roughness), friction exp(boundary)) + rest

F is the force of the core's law of mixed lubrication for the contact of the machine file; the parameters
are logarithms of factors on what is stated. Other roughness moves the product of viscosity and speed at
which film and roughness are alike, and leaves a film that carries all as it is; the shape of the summits is
held. The inlet of a film as thick as the roughness is longer for it. Viscosity varies with temperature as the
lubricant's, at the temperature that is read.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray, pointwise
from hersey.damping.candidates.named import Named, stacked
from hersey.damping.candidates.observations import Inputs

#: Logarithm of the largest factor on what is stated.
BOUND = 5.0
#: Factors on viscosity and roughness, as logarithms, from which a search begins.
_VISCOSITIES, _ROUGHNESSES = (-1.5, -0.5, 0.0, 0.5, 1.5), (-1.5, -0.7, 0.0, 0.7, 1.5)
#: Torque of the film over that measured, below which a rest below zero cannot bring it.
_LEAST = 1e-6


class SharedLoad(Protocol):
    """What a law needs of a contact whose load is shared; `MixedContact` of `hersey.lubrication` is one."""

    @property
    def film_exponent(self) -> float:
        """Exponent of the film in viscosity times speed."""

    @property
    def rolling_exponent(self) -> float:
        """Exponent of what inlet and pressure add to the shear of the nip."""

    @property
    def stated(self) -> Mapping[str, float]:
        """What the parameters multiply: ``viscosity`` (1), ``roughness`` (m) and ``boundary`` friction."""

    @property
    def lever(self) -> float:
        """Radius at which the force acts, m."""

    def numbers(self, temperature: FloatArray) -> list[Any]:
        """Return the numbers of the law, in the order of the core, at temperatures (K)."""

    def product(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return viscosity times belt speed, Pa m, at speeds (rad/s) and temperatures (K)."""

    def warming(self, temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return d ln viscosity/dT and d ln boundary friction/dT, 1/K."""


@dataclass
class _Last:
    """What was computed last: a search asks for a torque and for its derivatives at the same values."""

    inputs: Inputs | None = None
    product: FloatArray = field(default_factory=lambda: np.empty(0))
    numbers: list[FloatArray] = field(default_factory=list)
    values: FloatArray | None = None
    parts: dict[str, FloatArray] = field(default_factory=dict)


@dataclass(frozen=True)
class SharedLoadLaw(Named):
    """A candidate about a contact; ``speed`` (rad/s) and ``torque`` (N m) are those of reference."""

    contact: SharedLoad
    speed: float
    torque: float
    viscosity_known: bool = False
    _last: _Last = field(default_factory=_Last, init=False, repr=False, compare=False)
    thermal = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        return (*(() if self.viscosity_known else ("viscosity",)), "roughness", "boundary", "rest")

    def predict(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return ln torque."""
        return np.log(self._parts(values, inputs)["torque"])

    def jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return its derivatives with respect to the parameters, shape (..., points, parameters)."""
        parts, n, r = self._parts(values, inputs), self.contact.film_exponent, self.contact.rolling_exponent
        rise = parts["rise"]
        columns: dict[str, FloatArray | float] = {
            "viscosity": rise,
            "roughness": (r * parts["rolling"] + (1.0 - n) * parts["shear"] - rise) / n
            - parts["by_edge"] / 3.0,
            "boundary": parts["boundary"],
            "rest": self.torque,
        }
        torque = parts["torque"]
        return stacked([columns[name] / torque for name in self.names], torque.shape)

    def slopes(self, values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        """Return its derivatives with respect to ln w and to T (1/K)."""
        assert inputs.kelvin is not None
        parts = self._parts(values, inputs)
        of_viscosity, of_friction = self.contact.warming(inputs.kelvin)
        by_speed = parts["rise"] / parts["torque"]
        return by_speed, by_speed * of_viscosity + parts["boundary"] / parts["torque"] * of_friction

    def starts(self, inputs: Inputs, log_torque: FloatArray, weights: FloatArray) -> list[FloatArray]:
        """Return where to search from: friction and rest by linear fits at factors of the others."""
        root, measured = np.sqrt(weights), np.exp(log_torque)
        ranked = []
        for viscosity in (0.0,) if self.viscosity_known else _VISCOSITIES:
            for roughness in _ROUGHNESSES:
                named = {"viscosity": viscosity, "roughness": roughness, "boundary": 0.0, "rest": 0.0}
                parts = self._parts(np.array([named[name] for name in self.names]), inputs)
                film = parts["shear"] + parts["rolling"]
                columns = np.column_stack([parts["boundary"], np.full_like(film, self.torque)])
                relative = (root / measured)[:, None]
                (friction, rest), *_ = np.linalg.lstsq(
                    columns * relative, (measured - film) * relative[:, 0], rcond=None
                )
                named |= {"boundary": float(np.log(np.clip(friction, 0.02, 50.0))), "rest": float(rest)}
                values = np.array([named[name] for name in self.names])
                missed = root * (log_torque - self.predict(values, inputs))
                ranked.append((float(missed @ missed), values))
        ranked.sort(key=lambda f: f[0])
        return [values for _, values in ranked[:3]]

    def _parts(self, values: FloatArray, inputs: Inputs) -> dict[str, FloatArray]:
        """Torque, its parts and d torque/d ln(viscosity speed), N m, each of shape (..., points)."""
        if self._last.inputs is not inputs:
            self._last.inputs, self._last.values = inputs, None
            self._last.product, self._last.numbers = self._stated(inputs)
        if self._last.values is None or not np.array_equal(self._last.values, values):
            self._last.parts = self._computed(values)
            self._last.values = np.array(values)
        return self._last.parts

    def _stated(self, inputs: Inputs) -> tuple[FloatArray, list[FloatArray]]:
        """Viscosity times belt speed, Pa m, and the numbers of the law, by what is stated."""
        assert inputs.kelvin is not None
        product = self.contact.product(self.speed * np.exp(inputs.log_speed), inputs.kelvin)
        numbers = (np.asarray(number, dtype=np.float64) for number in self.contact.numbers(inputs.kelvin))
        return product, [np.array(np.broadcast_to(number, product.shape)) for number in numbers]

    def _computed(self, values: FloatArray) -> dict[str, FloatArray]:
        viscosity, roughness, friction = (
            np.clip(self.value(values, name), -BOUND, BOUND)
            for name in ("viscosity", "roughness", "boundary")
        )
        n, r = self.contact.film_exponent, self.contact.rolling_exponent
        factors = {
            "reference": roughness / n,
            "shear": roughness * (1.0 - n) / n,
            "rolling": roughness * r / n,
            "boundary": friction,
            "edge": -roughness / 3.0,  # over the square root of the inlet, which goes as the film to 2/3
        }
        numbers = [
            number * np.exp(factors.get(name, 0.0))
            for name, number in zip(_core.SHARING, self._last.numbers, strict=True)
        ]
        product = self._last.product * np.exp(viscosity)
        state = pointwise(_core.mixed_contact, product, *numbers)
        lever = self.contact.lever
        parts = {name: lever * getattr(state, name) for name in ("boundary", "shear", "rolling", "by_edge")}
        contact = parts["boundary"] + parts["shear"] + parts["rolling"]
        torque = np.maximum(contact + self.torque * self.value(values, "rest"), _LEAST * contact)
        return parts | {"torque": torque, "rise": lever * product * state.slope}
