"""A fitted law B = a T^b w^c as it came out of a fit: its numbers, the torque it gives, and its limits."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.branches import Transition
from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.intervals import Band, band_of, of_one_dwell
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.shared_errors import Freedom, SharedScatter
from hersey.damping.candidates.thermal import CELSIUS, KELVIN, Thermal
from hersey.damping.estimate import Estimate
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.errors import ExtrapolationWarning, ParameterError, UntoldWarning
from hersey.motion.whole_torque import refuse_whole_torque
from hersey.result import Result
from hersey.schema.domain import TORQUE, Domain
from hersey.units import ZERO_CELSIUS, takes_si

#: Law of temperature by the scale of T in T^b.
SCALES = {"degC": CELSIUS, "K": KELVIN}


@dataclass(frozen=True)
class FitStatistics:
    """Goodness of fit."""

    points: int
    variables: int
    chi_square: float
    reduced_chi_square: float
    scatter: float  #: relative, between dwells, beyond the standard errors of their means
    shared: tuple[SharedScatter, ...]  #: of visits to a temperature and of runs
    dwell_error: float  #: relative, median of the errors of the dwells
    aicc: float
    r_squared_damping: float
    r_squared_torque: float


@dataclass(frozen=True, repr=False)
class FittedLaw(Result):
    """A fitted law B = a T^b w^c, and what it gives; T in ``temperature_scale``, w in rad/s, B in N m s/rad.

    ``b`` is None for isothermal data. ``covariance`` is that of ``variables``, the numbers fitted, about
    ``reference_speed`` (rad/s) and ``reference_temperature`` (K). ``torque_space`` holds a, b, c
    of the fit to torque. ``speed_range`` and ``temperature_range`` (SI) bound the data. If a no-load torque
    (``rest``) was subtracted, all of this is for the film alone; `total_torque` is that of the log.
    """

    a: Estimate
    b: Estimate | None
    c: Estimate
    transition: Transition | None
    temperature_scale: str
    reference_speed: float
    reference_temperature: float | None
    variables: tuple[str, ...]
    values: FloatArray
    covariance: FloatArray
    freedoms: Freedom
    torque_space: dict[str, Estimate]
    statistics: FitStatistics
    speed_range: tuple[float, float]
    temperature_range: tuple[float, float] | None
    residuals: FloatArray  #: ln(measured/fitted), shape (points,)
    rejected_transition: str  #: why there is no transition; empty if there is one
    data_sha256: tuple[str, ...]
    sensors: str = ""  #: sensor errors behind the systematic parts, in words
    rest: NoLoadTorque | None = None  #: no-load torque subtracted before the fit
    version: str = field(default=_core.VERSION)
    domain: Domain = TORQUE  #: what "torque" and "speed" are here: friction and sliding, if it says so

    @property
    def law(self) -> str:
        """The law in symbols; where friction was measured, that of friction and not of damping."""
        power = "" if self.b is None else " T^b"
        if self.domain.is_torque:
            return f"B = a{power} w^c"
        return f"{self.domain.symbol} = a{power} {self.domain.speed_symbol}^(1 + c)"

    @property
    def law_units(self) -> str:
        """Units of quantity and speed in the law."""
        of = self.domain
        quantity = f"B in {of.damping_unit}" if of.is_torque else f"{of.symbol} in {of.unit}" * bool(of.unit)
        scale = f"T in {self.temperature_scale}" if self.b else ""
        return ", ".join(filter(None, (quantity, scale, f"{of.speed_symbol} in {of.speed_unit}")))

    @takes_si(speed="speed", temperature="temperature")
    def damping(self, *, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return damping in N m s/rad at speeds (rad/s) and temperatures (K), broadcast together.

        Warns with `ExtrapolationWarning` outside the range of the data. Around a gradual bend, it follows the
        trend lines on either side, as do `torque` and `predict`. These lines meet below the measured torque,
        so `drag` uses the torque of the dwells at the transition instead.
        """
        speeds, inputs = self._points(speed, temperature)
        return np.asarray(np.exp(self._law.predict(self._law_values, inputs)).reshape(speeds.shape) / speeds)

    def refuse_whole_torque(self, stated: NoLoadTorque | None) -> None:
        """Raise `ParameterError` if a no-load torque is stated, but was not subtracted before the fit."""
        if stated is not None and self._is_whole:
            refuse_whole_torque(
                "surface was fitted to",
                stated,
                "write surface = hersey.fit(points.without(machine.rest))",
            )

    @property
    def _is_whole(self) -> bool:
        """Whether the torque is known to be the whole torque: without a log nobody knows."""
        return self.rest is None and bool(self.data_sha256)

    @cached_property
    def _law(self) -> Law:
        thermal = None
        if self.reference_temperature is not None:
            thermal = Thermal(SCALES[self.temperature_scale], self.reference_temperature)
        if self.transition is None:
            return Law(thermal, ONE)
        return Law(thermal, HELD if self.transition.freed is None else FREE)

    @cached_property
    def _law_values(self) -> FloatArray:
        """The values as the law has them."""
        return self._with_torque(self.values)

    def _with_torque(self, values: FloatArray) -> FloatArray:
        """Values whose level is of torque, not of damping."""
        return np.append(values[0] + np.log(self.reference_speed), values[1:])

    def _points(self, speed: ArrayLike, temperature: ArrayLike | None) -> tuple[FloatArray, Inputs]:
        """Speeds without their sign, and the points of the law at them; warns outside the data."""
        speeds = np.abs(np.asarray(speed, dtype=float))
        self._warn_outside("speed", speeds, self.speed_range)
        kelvin = None
        if self.b is not None:
            if temperature is None:
                raise ParameterError("this law depends on temperature. Give the temperature in K")
            kelvin = np.asarray(temperature, dtype=float)
            self._refuse_below_zero(kelvin)
            self._warn_outside("temperature", kelvin, self.temperature_range)
            speeds, kelvin = np.broadcast_arrays(speeds, kelvin)
        return speeds, self._inputs(speeds, kelvin)

    @property
    def temperature_zero(self) -> float:
        """Zero of the scale in which the law is a power of temperature, K."""
        return 0.0 if self.temperature_scale == "K" else ZERO_CELSIUS

    def _refuse_below_zero(self, kelvin: FloatArray) -> None:
        """Raise `ParameterError` for temperatures whose power has no value in the scale of the law."""
        scale = self.temperature_scale
        below = kelvin[kelvin <= self.temperature_zero]
        if below.size:
            raise ParameterError(
                f"temperature is {below.flat[0]:g} K, but a law in {scale} holds only above 0 {scale}. "
                "Numbers are in K. Write '180 degC' for a temperature in degC"
            )

    def _inputs(self, speed: FloatArray, kelvin: FloatArray | None) -> Inputs:
        z = np.log(speed.ravel() / self.reference_speed)
        hot = None if kelvin is None else np.ravel(kelvin)
        return Inputs(z, hot, np.zeros(z.size, dtype=np.intp))

    @takes_si(speed="speed", temperature="temperature")
    def torque(self, *, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return drag torque in N m, with the sign of the speed (rad/s); temperature in K."""
        return np.asarray(self.damping(speed=speed, temperature=temperature) * np.asarray(speed, dtype=float))

    @takes_si(speed="speed", temperature="temperature")
    def total_torque(self, *, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return the torque of the log (N m): that of the film plus any no-load torque subtracted."""
        film = self.torque(speed=speed, temperature=temperature)
        return film if self.rest is None else film + self.rest.torque(speed, temperature=temperature)

    @takes_si(speed="speed", temperature="temperature")
    def predict(self, *, speed: Any, temperature: Any = None) -> Band:
        """Return torque with 95 % limits: of the law, and of one further dwell in a separate visit.

        Parameters
        ----------
        speed
            rad/s, or strings such as ``"400 rpm"``, or pint quantities.
        temperature
            K, or strings such as ``"150 degC"``, or pint quantities; needed if the law depends on it. Both
            broadcast together.

        Examples
        --------
        >>> import hersey
        >>> surface = hersey.fit(hersey.read("examples/bench.csv").steady(tare="standing"))
        >>> surface.predict(speed="25 rpm", temperature="150 degC").torque.round(3)
        array([0.201])
        """
        _, inputs = self._points(speed, temperature)
        of_points = self.statistics
        dwell = of_one_dwell(of_points.scatter, of_points.dwell_error, of_points.shared)
        self._warn_untold()
        return band_of(self._law, self._law_values, self.freedoms, dwell, inputs)

    def _warn_untold(self) -> None:
        if self.b is not None and not self.b.estimable:
            warnings.warn(UntoldWarning(), stacklevel=4)

    @property
    def freedom(self) -> int:
        """Degrees of freedom of the fit."""
        return self.statistics.points - self.statistics.variables

    def coefficients(self) -> dict[str, Estimate]:
        """Return a, b (where thermal) and c by name."""
        return {"a": self.a, **({"b": self.b} if self.b else {}), "c": self.c}

    def log_temperature(self, kelvin: FloatArray) -> FloatArray:
        """Return the logarithm of temperatures (K) over the reference, in the scale of the law; any shape."""
        assert self._law.thermal is not None
        return self._law.thermal.shape(kelvin)[0]

    def _warn_outside(self, name: str, values: FloatArray, limits: tuple[float, float] | None) -> None:
        if limits and (np.any(values < limits[0] * 0.999) or np.any(values > limits[1] * 1.001)):
            unit = self.domain.speed_unit if name == "speed" else "K"
            warnings.warn(
                f"{name} is outside the measured range, {limits[0]:.4g} to {limits[1]:.4g} {unit}, so "
                "the result is extrapolated",
                ExtrapolationWarning,
                stacklevel=5,
            )
