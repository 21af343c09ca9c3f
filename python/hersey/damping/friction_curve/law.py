"""Coulomb, viscous and Stribeck friction against speed, as robotics writes them.

    torque = sign(w) (T_C + (T_S - T_C) exp(-(w/w_S)^2)) + k_v w exp(-s (T - T_ref))

Coulomb plus viscous friction is that without its second term. The exponent 2 is that of Armstrong-Hélouvry
(Control of Machines with Friction, 1991); the viscous term follows the viscosity of the lubricant, whose
logarithm falls by ``s`` per kelvin. Both directions may have numbers of their own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray

#: The parameters of one direction, in order: N m, N m, rad/s, N m s/rad.
COULOMB, STATIC, STRIBECK_SPEED, VISCOUS = "T_C", "T_S", "w_S", "k_v"
#: How fast the logarithm of the viscous coefficient falls with temperature, 1/K; one for both directions.
THINNING = "s"
#: What parts the names of the two directions.
FORWARD, REVERSE = "+", "-"
#: Units by parameter.
UNITS = {COULOMB: "N m", STATIC: "N m", STRIBECK_SPEED: "rad/s", VISCOUS: "N m s/rad", THINNING: "1/K"}


@dataclass(frozen=True)
class Number:
    """A number of a law: which parameter, and of which direction (``+`` or ``-``; empty if of both)."""

    kind: str
    way: str = ""

    @property
    def name(self) -> str:
        """Its name among all numbers of the law."""
        return self.kind + self.way


@dataclass(frozen=True)
class FrictionLaw:
    """One law of friction, before it is fitted.

    ``stribeck`` adds the higher friction near standstill, ``apart`` gives each direction numbers of its own,
    ``reference_kelvin`` makes the viscous term depend on temperature about that one.
    """

    stribeck: bool = False
    apart: bool = False
    reference_kelvin: float | None = None

    @property
    def kinds(self) -> tuple[str, ...]:
        """The parameters of one direction, in order."""
        return (COULOMB, STATIC, STRIBECK_SPEED, VISCOUS) if self.stribeck else (COULOMB, VISCOUS)

    @property
    def ways(self) -> tuple[str, ...]:
        """The directions that have numbers of their own; an empty one stands for both."""
        return (FORWARD, REVERSE) if self.apart else ("",)

    @cached_property
    def numbers(self) -> tuple[Number, ...]:
        """The parameters, in order; those of the forward direction come first."""
        each = [Number(kind, way) for way in self.ways for kind in self.kinds]
        return (*each, *((Number(THINNING),) if self.reference_kelvin is not None else ()))

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        return tuple(each.name for each in self.numbers)

    def places(self, *kinds: str) -> list[int]:
        """Return the indices of the parameters of some kinds."""
        return [i for i, each in enumerate(self.numbers) if each.kind in kinds]

    def of_way(self, values: FloatArray, way: str) -> dict[str, float]:
        """Return the parameters of one direction by their kind."""
        own = zip(self.numbers, values.tolist(), strict=True)
        return {each.kind: value for each, value in own if each.way == way}

    def torque(self, values: FloatArray, speed: FloatArray, kelvin: FloatArray | None = None) -> FloatArray:
        """Return the torque (N m) at speeds (rad/s) and temperatures (K), shape (points,)."""
        return self._evaluate(values, speed, kelvin)[0]

    def jacobian(self, values: FloatArray, speed: FloatArray, kelvin: FloatArray | None = None) -> FloatArray:
        """Return the derivatives of the torque by the parameters, shape (points, parameters)."""
        return self._evaluate(values, speed, kelvin)[1]

    def slope(self, values: FloatArray, speed: FloatArray, kelvin: FloatArray | None = None) -> FloatArray:
        """Return the derivative of the torque by speed, N m s/rad, shape (points,)."""
        return self._evaluate(values, speed, kelvin)[2]

    def _evaluate(
        self, values: FloatArray, speed: FloatArray, kelvin: FloatArray | None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        w = np.asarray(speed, dtype=np.float64)
        thinned, warmer = np.ones(w.shape), np.zeros(w.shape)
        if self.reference_kelvin is not None:
            if kelvin is None:
                raise ValueError("a law that depends on temperature needs temperatures")
            warmer = np.asarray(kelvin) - self.reference_kelvin
            thinned = np.exp(-values[-1] * warmer)
        torque, slope, columns = np.zeros(w.shape), np.zeros(w.shape), []
        size = 4 if self.stribeck else 2
        ways = (w > 0, w < 0) if self.apart else (np.ones(w.shape, dtype=bool),)
        viscous = np.zeros(w.shape)
        for i, of in enumerate(ways):
            own = values[i * size : (i + 1) * size]
            sign = np.sign(w) * of
            coulomb, k = own[0], own[-1]
            share = np.zeros(w.shape)
            if self.stribeck:
                share = np.exp(-((w / own[2]) ** 2))
                rise = own[1] - coulomb
                torque += sign * rise * share
                slope += sign * rise * share * (-2.0 * w / own[2] ** 2)
                columns += [sign * (1.0 - share), sign * share]
                columns.append(sign * rise * share * 2.0 * w**2 / own[2] ** 3)
            else:
                columns.append(sign)
            columns.append(w * of * thinned)
            torque += sign * coulomb
            viscous += k * w * of * thinned
            slope += k * of * thinned
        if self.reference_kelvin is not None:
            columns.append(-warmer * viscous)
        return torque + viscous, np.stack(columns, axis=-1), slope
