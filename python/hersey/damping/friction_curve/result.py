"""Friction against speed as robotics writes it: the law that describes the dwells, with its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate
from hersey.damping.friction_curve.law import FrictionLaw
from hersey.errors import ParameterError
from hersey.result import Means, Record, Result
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: Laws by the name that JSON has for them.
COULOMB_VISCOUS, STRIBECK = "coulomb_viscous", "stribeck"
#: Directions by the name that JSON has for them.
BOTH, FORWARD, REVERSE = "both", "forward", "reverse"


@dataclass(frozen=True)
class FrictionParameter(Record):
    """A parameter of the friction law, with its 95 % interval."""

    name: Annotated[str, Means("T_C, T_S, w_S, k_v, or s: fall of ln k_v per kelvin")]
    direction: Annotated[str, Means("forward, reverse, or both")]
    estimate: Estimate
    unit: str
    bounded: Annotated[bool, Means("whether the dwells determine it")] = True


@dataclass(frozen=True)
class LeastTorque(Record):
    """Where friction is least: below that speed torque rises as the drive slows."""

    direction: Annotated[str, Means("forward, reverse, or both")]
    speed: Annotated[Estimate, Means("rad/s")]
    torque: Annotated[float, Means("", "N m")]


@dataclass(frozen=True)
class TriedFriction(Record):
    """A friction law that was fitted to the dwells."""

    kind: Annotated[str, Means("coulomb_viscous or stribeck")]
    apart: Annotated[bool, Means("whether each direction has its own parameters")]
    parameters: Annotated[int, Means("numbers fitted, scatters included")]
    aicc: float
    weight: Annotated[float, Means("Akaike weight")]
    scatter: Annotated[float, Means("relative, between dwells, beyond their errors")]


@dataclass(frozen=True)
class DirectionTest(Record):
    """Whether both directions of rotation follow one law."""

    p_value: Annotated[float, Means("of one law for both, by an F test")]
    differ: Annotated[bool, Means("whether each direction has its own parameters")]
    #: null where a standstill measured the zero
    offset: Annotated[
        float | None, Means("error of the torque zero that would look like the difference in T_C", "N m")
    ] = None


@dataclass(frozen=True, repr=False)
class FrictionCurve(Result):
    """Coulomb, viscous and Stribeck friction fitted to steady points.

    ``directions`` is None where one direction was measured, or too few dwells of one; ``least`` is empty where
    torque has no minimum between the slowest and the fastest dwell. ``reference_temperature`` is that of k_v.
    """

    not_stated = ("law", "values")
    also_stated = ("kind", "apart")

    parameters: tuple[FrictionParameter, ...]
    least: tuple[LeastTorque, ...]
    tried: Annotated[tuple[TriedFriction, ...], Means("the likeliest first")]
    directions: DirectionTest | None
    aicc: float
    scatter: Annotated[float, Means("relative, between dwells, beyond their errors")]
    points: int
    forward_speeds: Annotated[tuple[float, float] | None, Means("slowest and fastest dwell", "rad/s")]
    reverse_speeds: Annotated[tuple[float, float] | None, Means("slowest and fastest dwell", "rad/s")]
    temperature_range: Annotated[tuple[float, float] | None, Means("", "K")]
    reference_temperature: Annotated[float | None, Means("of k_v; null without dependence", "K")]
    law: FrictionLaw
    values: FloatArray

    @property
    def kind(self) -> str:
        """The law: coulomb_viscous or stribeck."""
        return STRIBECK if self.law.stribeck else COULOMB_VISCOUS

    @property
    def apart(self) -> bool:
        """Whether each direction has its own parameters."""
        return self.law.apart

    @cached_property
    def speed_range(self) -> tuple[float, float]:
        """Slowest and fastest dwell of either direction, rad/s."""
        ends = [each for each in (self.forward_speeds, self.reverse_speeds) if each]
        return min(low for low, _ in ends), max(high for _, high in ends)

    def parameter(self, name: str, direction: str = BOTH) -> FrictionParameter:
        """Return a parameter by its name, ``T_C``, ``T_S``, ``w_S``, ``k_v`` or ``s``, and its direction.

        Raises
        ------
        ParameterError
            If the law has none of that name in that direction.
        """
        for each in self.parameters:
            if each.name == name and each.direction == direction:
                return each
        known = ", ".join(f"{each.name} ({each.direction})" for each in self.parameters)
        raise ParameterError(f"this friction curve has no {name} ({direction}). Use one of {known}")

    @takes_si(speed="speed", temperature="temperature")
    def torque(self, speed: FloatArray | float, *, temperature: FloatArray | float | None = None) -> FloatArray:
        """Return the torque at speeds and temperatures, N m, with the sign of the speed.

        Parameters
        ----------
        speed
            rad/s, negative in reverse.
        temperature
            K; needed if the law depends on it.

        Raises
        ------
        ParameterError
            If the law depends on temperature and none is given, or for a direction that was not measured.
        """
        if self.law.reference_kelvin is not None and temperature is None:
            raise ParameterError("this law depends on temperature. Give the temperature in K")
        speeds = np.atleast_1d(np.asarray(speed, dtype=np.float64))
        hot = None if temperature is None else np.asarray(temperature, dtype=np.float64)
        return self.law.torque(self.values, speeds, hot)

    def headline(self) -> str:
        """Return the law and its parameters."""
        from hersey.damping.friction_curve.words import named

        return named(self)

    def summary(self) -> str:
        """Return law, parameters and laws tried, as text."""
        from hersey.damping.friction_curve.words import summary_of

        return summary_of(self)

    def to_frame(self) -> pl.DataFrame:
        """Return one row per parameter, in SI."""
        import polars as pl

        rows: list[dict[str, Any]] = [
            {
                "parameter": each.name,
                "direction": each.direction,
                "value": each.estimate.value,
                "low": each.estimate.low,
                "high": each.estimate.high,
                "unit": each.unit,
            }
            for each in self.parameters
        ]
        return pl.DataFrame(rows)
