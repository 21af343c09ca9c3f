"""The law B = a T^b w^c in logarithms about a reference point, and the data it is fitted to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.estimation import Solution, solve
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import convert, rpm

#: Speeds closer than this share count as the same.
SAME_SPEED = 0.03


@dataclass(frozen=True)
class FitData:
    """Logarithms about the reference point: y of damping, x of temperature (None: isothermal), z of speed."""

    y: FloatArray
    x: FloatArray | None
    z: FloatArray
    error: FloatArray
    torque: FloatArray
    torque_error: FloatArray
    tare_error: float
    speed: FloatArray
    scale: str
    reference_speed: float
    reference_temperature: float | None

    @classmethod
    def of(cls, points: SteadyPoints, scale: str) -> FitData:
        """Return the data of steady points; refuse those that cannot determine the law."""
        if scale not in ("degC", "K"):
            raise ParameterError(f"temperature scale '{scale}' is not known: degC or K")
        speed, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
        _require_speeds(speed)
        x, reference = None, None
        if points.log.has_temperature:
            kelvin = points.column("temperature")
            _require_temperatures(kelvin)
            temperature = scaled_temperature(kelvin, scale)
            if np.any(temperature <= 0):
                raise InsufficientDataError(
                    "T^b has no meaning at or below 0 degC: fit with --temperature-scale K"
                )
            reference = float(np.exp(np.mean(np.log(temperature))))
            x = np.log(temperature / reference)
        count = speed.size
        needed = 3 + (x is not None)
        if count <= needed:
            raise InsufficientDataError(
                f"{count} steady points cannot determine {needed - 1} coefficients and their errors: "
                f"at least {needed + 1} are needed"
            )
        reference_speed = float(np.exp(np.mean(np.log(speed))))
        torque_error = points.column("torque_error")
        y, z = np.log(torque / speed), np.log(speed / reference_speed)
        error = np.hypot(torque_error / torque, points.column("speed_error") / speed)
        if x is not None:
            (_, b, _), *_ = np.linalg.lstsq(np.column_stack([np.ones_like(z), x, z]), y, rcond=None)
            error = np.hypot(error, b * points.column("temperature_error") / temperature)
        return cls(
            y=y,
            x=x,
            z=z,
            error=error,
            torque=torque,
            torque_error=torque_error,
            tare_error=points.tare_error,
            speed=speed,
            scale=scale,
            reference_speed=reference_speed,
            reference_temperature=reference,
        )

    @property
    def thermal(self) -> bool:
        """Whether temperature is in the law."""
        return self.x is not None

    @property
    def temperatures(self) -> FloatArray:
        """Logarithm of temperature about the reference; zeros if isothermal."""
        return np.zeros_like(self.z) if self.x is None else self.x

    def solve(self, residual: Callable[[FloatArray], FloatArray], start: FloatArray) -> Solution:
        """Least squares in ln B."""
        return solve(residual, start, self.error, self.tare_error / self.torque)

    def exponents(self, solution: Solution) -> tuple[float, float]:
        """Exponents b (0 if isothermal) and c."""
        if self.thermal:
            return float(solution.values[1]), float(solution.values[2])
        return 0.0, float(solution.values[1])

    def scaled_speed(self, solution: Solution) -> FloatArray:
        """Logarithm of speed at the same Hersey number at the reference temperature."""
        return np.asarray(self.z - hersey_exponent(*self.exponents(solution)) * self.temperatures)

    def pick(self, **share: float) -> FloatArray:
        """Weights of a combination of a solution's values (``level``, ``b``, ``c``, ``change``, ``at``)."""
        names = variables(self.thermal)
        return np.array([share.get(name, 0.0) for name in names])


def _require_speeds(speed: FloatArray) -> None:
    count = distinct_speeds(speed)
    if count < 3:
        held = " and ".join(f"{rpm(float(v)):.4g} rpm" for v in np.unique(np.round(speed, 2))[:2])
        raise InsufficientDataError(
            f"the steady points are all at {held}: no exponent of speed can be claimed; "
            "record dwells at three speeds or more"
        )


def _require_temperatures(kelvin: FloatArray) -> None:
    if sum(1 for _ in groups_of_temperature(kelvin)) < 2:
        low, high = (convert(float(t), "K", "degC") for t in (kelvin.min(), kelvin.max()))
        raise InsufficientDataError(
            f"all steady points are at one temperature ({low:.1f} to {high:.1f} degC): no exponent b can be "
            "claimed; record other temperatures, or say --isothermal to fit B = a w^c at this one"
        )


def distinct_speeds(speed: FloatArray) -> int:
    """Return how many different speeds there are, to `SAME_SPEED`."""
    ordered = np.sort(speed)
    return int(1 + np.count_nonzero(np.diff(np.log(ordered)) > SAME_SPEED)) if ordered.size else 0


def scaled_temperature(kelvin: FloatArray, scale: str) -> FloatArray:
    """Return temperatures in K in the scale of a law."""
    return kelvin if scale == "K" else np.asarray(kelvin - 273.15)


def variables(thermal: bool, branched: bool = True) -> tuple[str, ...]:
    """Return the names of a solution's values: ln B_ref, [b], c and, with two branches, c_mixed - c, z_t."""
    return ("level", *(("b",) if thermal else ()), "c", *(("change", "at") if branched else ()))


def hersey_exponent(b: float, c: float) -> float:
    """Return the exponent of the transition speed in temperature at a fixed Hersey number.

    B varies as viscosity^(1+c), so viscosity as T^(b/(1+c)) and the transition speed as its inverse. Near
    c = -1 damping tells nothing of viscosity, and the denominator is bounded.
    """
    return -b / max(1.0 + c, 0.05)


def log_damping(
    values: FloatArray, x: FloatArray, z: FloatArray, thermal: bool, width: float = 0.0
) -> FloatArray:
    """Return ln B for values as `variables` names them, x of temperature and z of speed.

    Two branches meet in a corner, or in a bend of the given width in z.
    """
    level, b, c = (values[0], values[1], values[2]) if thermal else (values[0], 0.0, values[1])
    law = level + b * x + c * z
    if values.size > 2 + thermal:
        change, at = values[-2:]
        reach = z - at - hersey_exponent(b, c) * x
        law = law + change * (-width * np.logaddexp(0.0, -reach / width) if width else np.minimum(reach, 0.0))
    return np.asarray(law)


def corner_residual(data: FitData) -> Callable[[FloatArray], FloatArray]:
    """Return the residuals of ln B as a function of the values."""
    return lambda values: data.y - log_damping(values, data.temperatures, data.z, data.thermal)


def fit_single(data: FitData) -> Solution:
    """Return the fit of a single power law."""
    columns = [np.ones_like(data.z), *([data.x] if data.x is not None else []), data.z]
    start, *_ = np.linalg.lstsq(np.column_stack(columns), data.y, rcond=None)
    return data.solve(corner_residual(data), np.asarray(start))
