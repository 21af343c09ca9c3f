"""The torque of a moving log, for a law of friction: its numbers, and how the equations follow from them.

torque(t) = J dw/dt + offset + friction(w) + G sin(q - q_0), with w the speed and q the angle a delay later
than they were read
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.friction_curve.law import (
    STRIBECK_SPEED,
    THINNING,
    UNITS,
    VISCOUS,
    FrictionLaw,
    Number,
)
from hersey.damping.moving.filtering import Filtered
from hersey.damping.moving.gravity import COSINE, SINE

INERTIA, OFFSET, DELAY = "J", "offset", "delay"
#: Units by name, of what is not friction.
OTHER_UNITS = {INERTIA: "kg m^2", OFFSET: "N m", COSINE: "N m", SINE: "N m", DELAY: "s"}


@dataclass(frozen=True)
class Equations:
    """Equations of all stretches that are used, in order."""

    filtered: tuple[Filtered, ...]
    used: tuple[np.ndarray, ...]  #: of each stretch: which of its equations

    @cached_property
    def places(self) -> list[np.ndarray]:
        """Of each stretch: numbers of the equations that are used."""
        return [np.flatnonzero(each) for each in self.used]

    def joined(self, parts: Sequence[FloatArray]) -> FloatArray:
        """Return what the stretches have for each equation, of those used."""
        return np.concatenate([part[used] for part, used in zip(parts, self.used, strict=True)])

    @cached_property
    def torque(self) -> FloatArray:
        """Torque, N m, shape (equations,)."""
        return self.joined([each.torque for each in self.filtered])

    @cached_property
    def speed(self) -> FloatArray:
        """Speed, rad/s, shape (equations,)."""
        return self.joined([each.mean_speed for each in self.filtered])

    @cached_property
    def acceleration(self) -> FloatArray:
        """Acceleration, rad/s2, shape (equations,)."""
        return self.joined([each.acceleration for each in self.filtered])

    @cached_property
    def gravity(self) -> FloatArray:
        """Cosine and sine of the angle, shape (equations, 2)."""
        return self.joined([each.weighted(each.gravity) for each in self.filtered])

    @cached_property
    def gravity_rate(self) -> FloatArray:
        """Its derivative with time, 1/s, shape (equations, 2)."""
        turned = [each.gravity[:, ::-1] * [-1.0, 1.0] * each.speed[:, None] for each in self.filtered]
        return self.joined([of.weighted(each) for of, each in zip(self.filtered, turned, strict=True)])

    @cached_property
    def temperature(self) -> FloatArray | None:
        """Temperature, K, shape (equations,)."""
        kelvin = [each.temperature for each in self.filtered]
        if any(each is None for each in kelvin):
            return None
        return self.joined(
            [f.weighted(k) for f, k in zip(self.filtered, kelvin, strict=True) if k is not None]
        )

    def __len__(self) -> int:
        """Return the number of equations."""
        return self.speed.size


@dataclass(frozen=True)
class MovingLaw:
    """A law of friction with what else takes torque while the speed changes."""

    friction: FrictionLaw
    offset: bool
    inertia: float | None = None  #: kg m^2 if it is given
    inertia_error: float = 0.0  #: its standard error, kg m^2
    gravity: bool = False

    @cached_property
    def numbers(self) -> tuple[Number, ...]:
        """All numbers that are fitted, friction first."""
        inertia = () if self.inertia is not None else (INERTIA,)
        offset, gravity = (OFFSET,) if self.offset else (), (COSINE, SINE) if self.gravity else ()
        return (*self.friction.numbers, *map(Number, (*inertia, *offset, *gravity, DELAY)))

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(each.name for each in self.numbers)

    @cached_property
    def positive(self) -> tuple[int, ...]:
        """Indices of numbers whose logarithm is fitted."""
        return tuple(self.friction.places(STRIBECK_SPEED))

    @property
    def title(self) -> str:
        """The law of friction in words."""
        of = self.friction
        name = "Stribeck, Coulomb and viscous friction" if of.stribeck else "Coulomb and viscous friction"
        apart = ", each direction separately" if of.apart else ""
        warm = ", viscosity falls with temperature" if of.reference_kelvin is not None else ""
        return name + apart + warm + ("; gravity" if self.gravity else "")

    @property
    def units(self) -> dict[str, str]:
        """Unit of each number, by name."""
        return OTHER_UNITS | {each.name: UNITS[each.kind] for each in self.friction.numbers}

    def value(self, values: FloatArray, name: str) -> float:
        """Return a number by its name; the inertia if given, and 0 for an offset that is not fitted."""
        if name in self.names:
            return float(values[self.names.index(name)])
        return float(self.inertia or 0.0) if name == INERTIA else 0.0

    def predict(self, values: FloatArray, equations: Equations) -> FloatArray:
        """Return the torque of each equation, N m."""
        own, inertia = values[: len(self.friction.names)], self.value(values, INERTIA)
        friction, late = self._joined(own, inertia, equations)
        rest = inertia * equations.acceleration + self.value(values, OFFSET)
        if self.gravity:
            terms = self._terms(values)
            rest, late = rest + equations.gravity @ terms, late + equations.gravity_rate @ terms
        return friction + rest + self.value(values, DELAY) * late

    def jacobian(self, values: FloatArray, equations: Equations) -> FloatArray:
        """Return the derivatives of `predict` by the numbers, shape (equations, numbers)."""
        own, inertia = values[: len(self.friction.names)], self.value(values, INERTIA)
        columns = equations.joined([self._columns(own, each) for each in equations.filtered])
        others = [] if self.inertia is not None else [equations.acceleration]
        if self.offset:
            others.append(np.ones(len(equations)))
        late = self._joined(own, inertia, equations)[1]
        if self.gravity:
            others.append(equations.gravity)
            late = late + equations.gravity_rate @ self._terms(values)
        return np.column_stack([columns, *others, late])

    def _terms(self, values: FloatArray) -> FloatArray:
        """Both terms of gravity, N m."""
        return np.array([self.value(values, COSINE), self.value(values, SINE)])

    def by_inertia(self, values: FloatArray, equations: Equations) -> FloatArray:
        """Return the derivative of the torque of each equation by the inertia, shape (equations,)."""
        jerk = equations.joined([each.jerk for each in equations.filtered])
        return equations.acceleration + self.value(values, DELAY) * jerk

    def _joined(self, own: FloatArray, inertia: float, equations: Equations) -> tuple[FloatArray, FloatArray]:
        """Friction of each equation, and how torque changes with the delay."""
        parts = [self._friction(own, each) for each in equations.filtered]
        friction, shifted = (equations.joined([part[i] for part in parts]) for i in range(2))
        return friction, inertia * equations.joined([each.jerk for each in equations.filtered]) + shifted

    def _friction(self, own: FloatArray, of: Filtered) -> tuple[FloatArray, FloatArray]:
        """Friction of each equation, and its change with a delay.

        Friction at the speed as read is that at the speed without noise plus the slope times the noise: exact
        where it is linear, and without the bias of noise where it is curved.
        """
        slope = self.friction.slope(own, of.speed, of.temperature)
        friction = self.friction.torque(own, of.speed, of.temperature) + slope * (of.raw - of.speed)
        return of.weighted(friction), of.weighted(slope * of.rate)

    def _columns(self, own: FloatArray, of: Filtered) -> FloatArray:
        """Derivatives of the friction of each equation; those linear in speed at the speed as read."""
        columns = self.friction.jacobian(own, of.speed, of.temperature)
        ratio = np.divide(of.raw, of.speed, out=np.ones(of.raw.size), where=of.speed != 0.0)
        linear = self.friction.places(VISCOUS, THINNING)
        columns[:, linear] *= ratio[:, None]
        return of.weighted(columns)
