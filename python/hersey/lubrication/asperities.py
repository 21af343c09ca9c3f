"""The two faces that slide where film and contact share the load: their summits, and their friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.result import Means, Record
from hersey.units import celsius, takes_si


@takes_si(modulus="pressure")
@dataclass(frozen=True)
class Asperities(Record):
    """Asperities of two hard surfaces, after Greenwood and Tripp (1970).

    Parameters
    ----------
    modulus
        Contact modulus E* of the two surfaces that touch, Pa: 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2. Use the
        surfaces of belt and heater, not the rubber behind them.
    sigma_beta_density
        Roughness x summit radius x number of summits per area.
    sigma_over_beta
        Roughness divided by summit radius.

    Raises
    ------
    ParameterError
        If a value is not positive.
    """

    modulus: Annotated[float, Means("contact modulus of the faces", "Pa")]
    sigma_beta_density: float = 0.05
    sigma_over_beta: float = 0.01

    def __post_init__(self) -> None:
        """Check the values."""
        for name, value in vars(self).items():
            if not 0 < value < np.inf:
                raise ParameterError(f"{name} is {value:g}: it must be greater than 0")

    @property
    def pressure(self) -> float:
        """Mean pressure of the asperities divided by F(lambda), Pa."""
        slope: float = self.sigma_beta_density**2 * self.sigma_over_beta**0.5
        return _core.GREENWOOD_TRIPP * slope * self.modulus


@takes_si(temperature="temperature")
@dataclass(frozen=True)
class BoundaryFriction(Record):
    """Friction if asperities carry the whole load: coefficient + slope (T - temperature).

    ``coefficient`` has no unit, ``slope`` is in 1/K, ``temperature`` (K) is that of the coefficient, needed
    if the slope is not 0.
    """

    coefficient: float
    slope: Annotated[float, Means("1/K")] = 0.0
    temperature: Annotated[float | None, Means("of the coefficient", "K")] = None

    def __post_init__(self) -> None:
        """Check the values."""
        if not 0 < self.coefficient < np.inf:
            raise ParameterError(f"boundary friction is {self.coefficient:g}: it must be greater than 0")
        if self.slope and self.temperature is None:
            raise ParameterError("boundary friction has a slope. Give the temperature of its coefficient")

    @takes_si(temperature="temperature")
    def at(self, temperature: ArrayLike) -> FloatArray:
        """Return the coefficient at temperatures (K).

        Raises
        ------
        ParameterError
            If it falls to 0 or below.
        """
        kelvin = np.asarray(temperature, dtype=float)
        rise = np.zeros_like(kelvin) if self.temperature is None else kelvin - self.temperature
        coefficient = np.asarray(self.coefficient + self.slope * rise)
        if not np.all(coefficient > 0):
            worst = float(kelvin.ravel()[np.argmin(coefficient)])
            raise ParameterError(
                f"boundary friction would be {np.min(coefficient):.3g} at {celsius(worst):.1f} degC: "
                f"its slope of {self.slope:g} per K does not hold that far"
            )
        return coefficient
