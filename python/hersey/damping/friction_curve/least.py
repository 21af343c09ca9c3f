"""Where the friction law gives the least torque between the measured speeds, with its interval."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.friction_curve.fitted import REVERSE, LeastTorque
from hersey.damping.friction_curve.law import FrictionLaw

#: Ratio of an end of an interval to the value from which on the parameter counts as not determined.
UNBOUNDED = 10.0
#: Step of a derivative, in standard errors, and points at which the least torque is looked for.
_STEP, _GRID = 0.05, 400


@dataclass(frozen=True)
class Searched:
    """The numbers of a law as they were searched for, and the parameters of the law that they make."""

    numbers: FloatArray
    covariance: FloatArray
    parameters: Callable[[FloatArray], FloatArray]
    freedom_of: Callable[[FloatArray], float]


def least_torques(
    law: FrictionLaw, searched: Searched, ends: Mapping[str, tuple[float, float]]
) -> tuple[LeastTorque, ...]:
    """Return where torque is least in each direction, where that lies between the measured speeds (rad/s)."""
    if not law.stribeck:
        return ()
    out = []
    values = searched.parameters(searched.numbers)
    for name, between in ends.items():
        side = -1.0 if name == REVERSE else 1.0
        at = _least_speed(law, values, side, between)
        if at is None:
            continue
        kelvin = None if law.reference_kelvin is None else np.array([law.reference_kelvin])
        torque = abs(float(law.torque(values, np.array([side * at]), kelvin)[0]))
        out.append(LeastTorque(name, _estimate(law, searched, side, between, at), torque))
    return tuple(out)


def _least_speed(
    law: FrictionLaw, values: FloatArray, side: float, ends: tuple[float, float]
) -> float | None:
    """The speed of least torque at the reference temperature, rad/s; None where it is an end."""
    kelvin = None if law.reference_kelvin is None else np.array([law.reference_kelvin])

    def rise(speed: float) -> float:
        return float(law.slope(values, np.array([side * speed]), kelvin)[0])

    grid = np.geomspace(*ends, _GRID)
    hot = None if kelvin is None else np.full(grid.shape, law.reference_kelvin)
    slope = law.slope(values, side * grid, hot)
    turns = np.nonzero((slope[:-1] < 0.0) & (slope[1:] >= 0.0))[0]
    if not turns.size:
        return None
    return float(optimize.brentq(rise, grid[turns[-1]], grid[turns[-1] + 1]))


def _estimate(
    law: FrictionLaw, searched: Searched, side: float, ends: tuple[float, float], at: float
) -> Estimate:
    """The speed of least torque with its interval: by the covariance of the fit, in the logarithm."""
    wide = ends[0] / UNBOUNDED, ends[1] * UNBOUNDED
    numbers = searched.numbers
    slopes = np.zeros(numbers.size)
    for i in range(numbers.size):
        step = _STEP * math.sqrt(max(float(searched.covariance[i, i]), 0.0))
        if not step > 0.0:
            continue
        moved = step * np.eye(numbers.size)[i]
        above = _least_speed(law, searched.parameters(numbers + moved), side, wide)
        below = _least_speed(law, searched.parameters(numbers - moved), side, wide)
        if above is None or below is None:
            return Estimate(at, np.inf, -np.inf, np.inf)
        slopes[i] = math.log(above / below) / (2.0 * step)
    error = math.sqrt(max(float(slopes @ searched.covariance @ slopes), 0.0))
    freedom = searched.freedom_of(slopes)
    reach = quantile(freedom) * error
    return Estimate(at, at * error, at * math.exp(-reach), at * math.exp(reach), freedom)
