"""The no-load torque: what turning the roll takes without the film (bearings, gears, the rubber).

    torque = (constant + per_speed w) (1 + temperature_slope (T - T_ref))

at the roll, against the rotation. It is stated, or fitted to a log that was recorded without the film
(`no_load`); what remains of a measured torque is that of the film.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, estimate, quantile
from hersey.errors import InsufficientDataError, ParameterError
from hersey.motion.drag import AnyDrag, DragTable
from hersey.result import Means, Result, table_of
from hersey.schema.warning import Warning
from hersey.units import celsius, rpm, takes_si

if TYPE_CHECKING:
    import polars as pl

AnyLaw = TypeVar("AnyLaw", bound=AnyDrag)

#: Factors beyond the speeds of a no-load log up to which its line is drawn on: where it tells the slope in
#: speed, and where it does not.
REACH, REACH_OF_ONE = 2.0, 1.1
#: The numbers of the no-load torque, in the order of their covariance.
NUMBERS = ("constant", "per_speed", "temperature_slope")
#: Standard deviations that enclose 95 % of a normal distribution on either side.
_DEVIATIONS = quantile(np.inf)


@dataclass(frozen=True, repr=False)
class NoLoadTorque(Result):
    """No-load torque at the roll: ``(constant + per_speed w) (1 + temperature_slope (T - T_ref))``.

    ``constant`` is in N m, ``per_speed`` in N m s/rad, ``temperature_slope`` in 1/K about
    ``reference_temperature`` (K; None if it does not vary). A part that is unknown is zero and has an
    unbounded interval. ``source`` names file and key, ``sha256`` the files.
    """

    constant: Estimate
    per_speed: Estimate
    temperature_slope: Estimate
    reference_temperature: float | None
    covariance: Annotated[FloatArray, Means("of the three numbers", shape="(n, m)")]
    freedom: Annotated[float, Means("degrees of freedom; null if stated", open=True)]
    source: str
    sha256: tuple[str, ...] = ()
    speed_range: Annotated[tuple[float, float] | None, Means("of the no-load log", "rad/s")] = None
    temperature_range: Annotated[tuple[float, float] | None, Means("of the no-load log", "K")] = None
    warnings: Annotated[tuple[Warning, ...], Means("what is not known about it")] = ()

    @classmethod
    @takes_si(constant="torque", per_speed="rotational damping", reference_temperature="temperature")
    def stated(
        cls,
        *,
        constant: float = 0.0,
        per_speed: float = 0.0,
        temperature_slope: float = 0.0,
        reference_temperature: float | None = None,
        uncertainty: float = 0.0,
        source: str = "stated",
    ) -> NoLoadTorque:
        """Return a no-load torque from stated numbers.

        Parameters
        ----------
        constant, per_speed
            N m, and N m s/rad; not negative, and one of them positive.
        temperature_slope
            Relative change with temperature, 1/K, from ``reference_temperature`` (K).
        uncertainty
            Relative error of the whole torque, at 95 %.

        Raises
        ------
        ParameterError
            If a value is out of range, or a slope lacks its temperature.

        Examples
        --------
        >>> rest = NoLoadTorque.stated(constant="20 mN*m", per_speed="1 mN*m*s/rad", uncertainty=0.1)
        >>> float(rest.torque(10.0).round(6))
        0.03
        """
        for name, value in (("constant", constant), ("per_speed", per_speed), ("uncertainty", uncertainty)):
            if not (np.isfinite(value) and value >= 0):
                raise ParameterError(f"{name} is {value:g}: it must not be negative")
        if constant == 0 and per_speed == 0:
            raise ParameterError(
                "the no-load torque is zero. Give constant or per_speed, or omit the no-load torque"
            )
        if not np.isfinite(temperature_slope):
            raise ParameterError(f"temperature_slope is {temperature_slope}: it must be finite")
        if temperature_slope and reference_temperature is None:
            raise ParameterError(
                "temperature_slope needs reference_temperature, the temperature at which the torque holds"
            )
        values = np.array([constant, per_speed, temperature_slope], dtype=float)
        error = np.log1p(uncertainty) / _DEVIATIONS * np.array([constant, per_speed, 0.0])
        covariance = np.outer(error, error)
        exact = Warning("counts as exact", "its uncertainty is not stated, so it is treated as exact")
        level, by_speed, slope = estimates_of(values, covariance, np.full(3, np.inf), NUMBERS)
        return cls(
            constant=level,
            per_speed=by_speed,
            temperature_slope=slope,
            reference_temperature=reference_temperature,
            covariance=covariance,
            freedom=np.inf,
            source=source,
            warnings=() if uncertainty else (exact,),
        )

    @takes_si(speed="speed", temperature="temperature")
    def torque(self, speed: ArrayLike, *, temperature: ArrayLike | None = None) -> FloatArray:
        """Return the torque (N m) at speeds (rad/s), with the sign of the speed; temperature in K.

        Without a temperature, the torque at the reference temperature is returned.
        """
        speeds = np.asarray(speed, dtype=float)
        at_reference = self.constant.value + self.per_speed.value * np.abs(speeds)
        return np.asarray(np.sign(speeds) * at_reference * self._at_temperature(temperature))

    @takes_si(speed="speed", temperature="temperature")
    def errors(self, speed: ArrayLike, *, temperature: ArrayLike | None = None) -> FloatArray:
        """Return the change of torque (N m) by one standard error of each independent error.

        Shape (speeds, errors); wider than the covariance has it where few degrees of freedom stand behind it.
        """
        speeds = np.atleast_1d(np.asarray(speed, dtype=float))
        sign, factor = (
            np.sign(speeds),
            self._at_temperature(temperature) * np.ones_like(speeds),
        )
        away = np.zeros_like(speeds)
        if temperature is not None and self.reference_temperature is not None:
            away = away + (np.asarray(temperature, dtype=float) - self.reference_temperature)
        level = self.constant.value + self.per_speed.value * np.abs(speeds)
        slopes = np.column_stack([sign * factor, speeds * factor, sign * level * away])
        size = np.sqrt(np.diag(self.covariance))
        scale = np.where(size > 0, size, 1.0)  # the three numbers differ by orders of magnitude
        spread, axes = np.linalg.eigh(self.covariance / np.outer(scale, scale))
        seen = spread > 1e-12
        root = scale[:, None] * axes[:, seen] * np.sqrt(spread[seen])
        return np.asarray(slopes @ root * (quantile(self.freedom) / _DEVIATIONS))

    @takes_si(roll_radius="length", temperature="temperature")
    def at_the_belt(self, roll_radius: float, temperature: float | None = None) -> dict[str, float]:
        """Return the no-load force at the surface of a roll (radius in m), at a temperature (K).

        A part fitted below zero counts as zero. ``rest_force`` in N, ``rest_damping`` in N s/m, and
        ``rest_temperature_slope``, their relative change from that temperature on, in 1/K.
        """
        factor = float(self._at_temperature(temperature))
        return {
            "rest_temperature_slope": self.temperature_slope.value / factor if factor > 0 else 0.0,
            "rest_force": max(self.constant.value, 0.0) / roll_radius * factor,
            "rest_damping": max(self.per_speed.value, 0.0) / roll_radius**2 * factor,
        }

    @takes_si(roll_radius="length", temperature="temperature")
    def samples(
        self, count: int, seed: int, *, roll_radius: float, temperature: float | None = None
    ) -> dict[str, FloatArray]:
        """Return draws of ``rest_force`` (N) and ``rest_damping`` (N s/m), arrays of shape (count,).

        They follow Student's t with the degrees of freedom of the log it is from; a temperature slope is
        taken as known. Arguments are those of `at_the_belt`; the seed is at least 0.
        """
        rng = np.random.default_rng([seed, 3])
        drawn = rng.multivariate_normal(np.zeros(2), self.covariance[:2, :2], size=count)
        if np.isfinite(self.freedom):
            drawn *= np.sqrt(self.freedom / rng.chisquare(self.freedom, size=(count, 1)))
        level, by_speed = (np.array([self.constant.value, self.per_speed.value]) + drawn).T
        factor = float(self._at_temperature(temperature))
        return {
            "rest_force": np.maximum(level, 0.0) / roll_radius * factor,
            "rest_damping": np.maximum(by_speed, 0.0) / roll_radius**2 * factor,
        }

    def _at_temperature(self, temperature: ArrayLike | None) -> FloatArray:
        """By how much the torque is that of the reference temperature; it never turns negative."""
        if temperature is None or self.reference_temperature is None:
            return np.ones(())
        away = np.asarray(temperature, dtype=float) - self.reference_temperature
        return np.maximum(1.0 + self.temperature_slope.value * away, 0.0)

    def refuse_beyond(self, speed: FloatArray, what: str) -> None:
        """Raise for speeds (rad/s) that the no-load log does not cover; ``what`` names their log."""
        if self.speed_range is None:
            return
        low, high = self.speed_range
        reach = REACH if self.per_speed.estimable else REACH_OF_ONE
        slow, fast = float(np.min(np.abs(speed))), float(np.max(np.abs(speed)))
        if slow < low / reach or fast > high * reach:
            covered = f"{rpm(low):.3g} to {rpm(high):.3g} rpm"
            covered = covered if self.per_speed.estimable else f"{rpm(low):.3g} rpm"
            raise InsufficientDataError(
                f"{self.source} covers the no-load torque at {covered}, but {what} runs from "
                f"{rpm(slow):.3g} to {rpm(fast):.3g} rpm. Record these speeds without the lubricated "
                "contact too"
            )

    def summary(self) -> str:
        """Return the three numbers with their intervals, their source, and warnings."""
        rows = [("constant", self.constant, "N m"), ("per speed", self.per_speed, "N m s/rad")]
        if self.reference_temperature is not None:
            about = f"1/K about {celsius(self.reference_temperature):.4g} degC"
            rows.append(("temperature slope", self.temperature_slope, about))
        lines = [self.headline()]
        lines += [f"  {name:18s}{value} {unit}{_sensors(value)}" for name, value, unit in rows]
        return "\n".join([*lines, *(f"- {warning}" for warning in self.warnings)])

    def headline(self) -> str:
        """Return the law in numbers, and its source."""
        return f"no-load torque: {self}"

    def __str__(self) -> str:
        """Return the law in numbers, and its source, for a sentence."""
        parts = [f"{1e3 * self.constant.value:.3g} mN m"] if self.constant.value else []
        if self.per_speed.value:
            parts.append(f"{1e3 * self.per_speed.value:.3g} mN m s/rad times speed")
        text = " + ".join(parts)
        if self.reference_temperature is not None and self.temperature_slope.value:
            slope = 100.0 * self.temperature_slope.value
            text += f", {slope:+.2g} %/K from {celsius(self.reference_temperature):.0f} degC"
        return f"{text} ({self.source})"

    def to_frame(self) -> pl.DataFrame:
        """Return the three numbers with their units."""
        return table_of(
            [
                ("constant", self.constant.value, "N m"),
                ("per speed", self.per_speed.value, "N m s/rad"),
                ("temperature slope", self.temperature_slope.value, "1/K"),
            ]
        )


def with_rest(film: AnyLaw, rest: NoLoadTorque, roll_radius: float, temperature: float | None) -> AnyLaw:
    """Return the drag of film and rest together, the rest that of a temperature (K).

    Raises
    ------
    ParameterError
        If the rest changes with temperature, none is given, and the film's drag is a table, which does not.
    """
    at_the_belt: dict[str, Any] = rest.at_the_belt(roll_radius, temperature)
    of_one = isinstance(film, DragTable) and not film.varies_with_temperature
    if of_one and at_the_belt["rest_temperature_slope"] and temperature is None:
        raise ParameterError(
            "the no-load torque depends on temperature, but a drag table holds at one temperature. "
            "Give temperature"
        )
    return replace(film, **at_the_belt)  # type: ignore[type-var]


def estimates_of(
    values: FloatArray, covariance: FloatArray, freedoms: FloatArray, estimable: tuple[str, ...]
) -> list[Estimate]:
    """Return constant, speed and temperature part; intervals of those not ``estimable`` are unbounded."""
    out = []
    for i, name in enumerate(NUMBERS):
        error = float(np.sqrt(covariance[i, i]))
        one = estimate(float(values[i]), error, float(freedoms[i]))
        out.append(one if name in estimable else Estimate(one.value, error, -np.inf, np.inf, one.freedom))
    return out


def _sensors(value: Estimate) -> str:
    return f", sensors +/- {value.systematic:.2g}" if value.systematic else ""
