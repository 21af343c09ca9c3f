"""The friction law that describes the dwells, with its parameters: the numbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.observations import Observations
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.friction_curve.law import VISCOUS, FrictionLaw
from hersey.errors import ParameterError
from hersey.result import Means, Record
from hersey.units import takes_si

#: Laws by the name that JSON has for them.
COULOMB_VISCOUS, STRIBECK = "coulomb_viscous", "stribeck"
#: Points of a drawn curve.
_POINTS = 61
#: Directions by the name that JSON has for them.
BOTH, FORWARD, REVERSE = "both", "forward", "reverse"


@dataclass(frozen=True)
class FrictionParameter(Record):
    """A parameter of the friction law, with its 95 % interval."""

    name: Annotated[str, Means("T_C, T_S, w_S, k_v, or s: fall of ln k_v per kelvin")]
    direction: Annotated[str, Means("forward, reverse, or both")]
    estimate: Annotated[Estimate, Means("in SI")]
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
        float | None, Means("error of the torque zero that may look like a difference in T_C", "N m")
    ] = None


@dataclass(frozen=True)
class FrictionLine(Record):
    """The fitted curve over the measured speeds of one direction, at one temperature."""

    temperature: Annotated[float | None, Means("K; null if it does not matter")]
    speed: Annotated[FloatArray, Means("negative in reverse", "rad/s")]
    torque: Annotated[FloatArray, Means("with the sign of the speed", "N m")]
    #: null in a document of an older version
    low: Annotated[FloatArray | None, Means("95 % limits of the law", "N m")] = None
    high: Annotated[FloatArray | None, Means("", "N m")] = None


@dataclass(frozen=True, repr=False)
class FittedFriction(Record):
    """Coulomb, viscous and Stribeck friction fitted to steady points: the numbers.

    ``directions`` is None where one direction was measured, or too few dwells of one; ``least`` is empty
    where torque has no minimum between the slowest and the fastest dwell. ``reference_temperature`` is that
    of k_v. Where it was fitted to every sample of a moving log, ``points`` are windows of speed.
    """

    parameters: Annotated[tuple[FrictionParameter, ...], Means("those of the forward direction first")]
    least: Annotated[tuple[LeastTorque, ...], Means("empty if torque has no minimum at the measured speeds")]
    tried: Annotated[tuple[TriedFriction, ...], Means("the likeliest first")]
    directions: DirectionTest | None
    aicc: float
    scatter: Annotated[float, Means("relative, between dwells, beyond their errors")]
    points: Annotated[int, Means("dwells fitted")]
    falls: Annotated[bool, Means("whether torque falls with speed somewhere, by the dwells alone")]
    forward_speeds: Annotated[tuple[float, float] | None, Means("slowest and fastest dwell", "rad/s")]
    reverse_speeds: Annotated[tuple[float, float] | None, Means("slowest and fastest dwell", "rad/s")]
    temperature_range: Annotated[tuple[float, float] | None, Means("", "K")]
    reference_temperature: Annotated[float | None, Means("of k_v; null without dependence", "K")]
    law: FrictionLaw
    values: FloatArray
    covariance: FloatArray
    freedom: float
    data: Observations
    of_every_sample: Annotated[bool, Means("whether a moving log was fitted: points are windows")] = False

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

    @property
    def what(self) -> str:
        """What the points are."""
        return "windows of speed" if self.of_every_sample else "dwells"

    @property
    def slopes(self) -> list[Estimate]:
        """The viscous coefficients, N m s/rad."""
        return [each.estimate for each in self.parameters if each.name == VISCOUS]

    @property
    def rises(self) -> bool:
        """Whether torque provably rises with speed over all the measured speeds."""
        return not (self.law.stribeck or self.falls) and all(each.low > 0.0 for each in self.slopes)

    @property
    def rises_beyond_rest(self) -> bool:
        """Whether the fitted torque rises with speed over all the measured speeds."""
        return all(bool(np.all(np.diff(np.abs(line.torque)) > 0.0)) for line in self.lines)

    @cached_property
    def lines(self) -> tuple[FrictionLine, ...]:
        """The fitted curve in each direction, at each temperature of the dwells."""
        hot: list[float | None] = [None]
        if self.reference_temperature is not None:
            hot = [float(kelvin) for kelvin in self.data.temperatures]
        out = []
        for sign, ends in ((1.0, self.forward_speeds), (-1.0, self.reverse_speeds)):
            if ends is not None:
                speed = sign * np.geomspace(*ends, _POINTS)
                out += [self._line(speed, kelvin) for kelvin in hot]
        return tuple(out)

    def _line(self, speed: FloatArray, kelvin: float | None) -> FrictionLine:
        """The curve at one temperature (K) with its limits."""
        torque = self.torque(speed, temperature=kelvin)
        hot = None if kelvin is None else np.full(speed.shape, kelvin)
        slopes = self.law.jacobian(self.values, speed, hot)
        variance = np.einsum("ij,jk,ik->i", slopes, self.covariance, slopes)
        reach = quantile(self.freedom) * np.sqrt(np.maximum(variance, 0.0))
        return FrictionLine(kelvin, speed, torque, torque - reach, torque + reach)

    @cached_property
    def residuals(self) -> Annotated[FloatArray, Means("ln(measured/fitted) of each dwell")]:
        """ln(measured/fitted) of each dwell."""
        sign = 1.0 if self.data.inputs.sign is None else self.data.inputs.sign
        fitted = self.law.torque(self.values, sign * self.data.speed, self.data.inputs.kelvin)
        return np.asarray(self.data.log_torque - np.log(np.abs(fitted)))

    def parameter(self, name: str, direction: str | None = None) -> FrictionParameter:
        """Return a parameter: ``T_C``, ``T_S``, ``w_S``, ``k_v`` or ``s``.

        Parameters
        ----------
        direction
            ``forward`` or ``reverse`` where each has its own parameters.

        Raises
        ------
        ParameterError
            If the law has none of that name, or one in each direction and none is named.
        """
        named = [each for each in self.parameters if each.name == name]
        own = [each for each in named if direction in (None, each.direction)]
        if len(own) == 1:
            return own[0]
        known = ", ".join(f"{each.name} ({each.direction})" for each in self.parameters)
        raise ParameterError(f"this friction curve has no single {name}. Use one of {known}")

    @takes_si(speed="speed", temperature="temperature")
    def torque(
        self, speed: FloatArray | float, *, temperature: FloatArray | float | None = None
    ) -> FloatArray:
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
