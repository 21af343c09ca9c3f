"""Lubricants: viscosity against temperature, pressure and shear rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arrays import FloatArray, pointwise
from hersey.errors import ArgumentError, ParameterError
from hersey.result import Record
from hersey.units import ZERO_CELSIUS, argument, takes_si

#: Laws of viscosity against temperature, and how many points each takes.
MODELS = {name: form.points for name, form in _core.VISCOSITY_LAWS.items()}


@takes_si(relaxation_time="time")
@dataclass(frozen=True)
class ShearThinning:
    """Carreau's law: eta/eta_0 = limit + (1 - limit) [1 + (relaxation_time rate)^2]^((exponent - 1)/2).

    ``relaxation_time`` in s; ``exponent`` is 1 for a Newtonian lubricant; ``limit`` is the fraction of
    viscosity that remains at the highest rates.
    """

    relaxation_time: float
    exponent: float
    limit: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        self.share(1.0)

    def share(self, rate: ArrayLike) -> FloatArray:
        """Return the fraction of viscosity that remains at shear rates (1/s)."""
        return pointwise(_core.carreau, rate, self.relaxation_time, self.exponent, self.limit)


@takes_si(density="density", conductivity="thermal conductivity")
@dataclass(frozen=True)
class Lubricant(Record):
    """A lubricant with viscosity fitted to points of its data sheet.

    Parameters
    ----------
    model
        ``arrhenius`` (two points, eta = A exp(Ea/(R T))), ``vogel`` (three points, Vogel-Fulcher-Tammann,
        eta = A exp(B/(T - T0))) or ``walther`` (two points, ASTM D341; needs a density).
    points
        (temperature in K, dynamic viscosity in Pa s), in ascending temperature.
    density
        Density, kg/m^3; needed only by ``walther``, a law of kinematic viscosity.
    pressure_viscosity
        (temperature in K, alpha in 1/Pa): one for all temperatures, or several, interpolated linearly and
        constant outside. Empty if unknown.
    thinning
        Shear thinning; None for a Newtonian lubricant.
    conductivity
        Thermal conductivity, W/(m K), for heating by shear.
    uncertainty
        Relative uncertainty of viscosity: 0.2 means within a factor of 1.2, at 95 %.
    source
        Source of the numbers.

    Raises
    ------
    ParameterError
        If the number of points does not match the law, or a value is impossible.
    """

    also_stated = ("coefficients",)
    not_stated = ("density", "thinning", "conductivity", "uncertainty", "_law")

    model: str
    points: tuple[tuple[float, float], ...]
    density: float | None = None
    pressure_viscosity: tuple[tuple[float, float], ...] = ()
    thinning: ShearThinning | None = None
    conductivity: float | None = None
    uncertainty: float | None = None
    name: str = "lubricant"
    source: str = ""
    _law: _core.ViscosityLaw = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Bring the values to SI if they come with units, and check the points against the law."""
        for name, kind in (("points", "viscosity"), ("pressure_viscosity", "pressure-viscosity coefficient")):
            object.__setattr__(self, name, _pairs_in_si(name, kind, getattr(self, name)))
        if self.model not in MODELS:
            raise ParameterError(f"unknown viscosity model '{self.model}'. Use {', '.join(MODELS)}")
        if len(self.points) != MODELS[self.model]:
            raise ParameterError(
                f"viscosity model '{self.model}' needs {MODELS[self.model]} points, but "
                f"{len(self.points)} are given"
            )
        if _core.VISCOSITY_LAWS[self.model].kinematic and self.density is None:
            raise ParameterError(f"viscosity model '{self.model}' uses kinematic viscosity. Give the density")
        for value in (self.density, self.conductivity, self.uncertainty):
            if value is not None and not value > 0:
                raise ParameterError(
                    f"density, conductivity and uncertainty must be greater than 0; one is {value:g}"
                )
        temperatures = [t for t, _ in self.pressure_viscosity]
        if temperatures != sorted(set(temperatures)) or any(a < 0 for _, a in self.pressure_viscosity):
            raise ParameterError(
                "pressure-viscosity coefficients must not be negative, and their temperatures must ascend"
            )
        object.__setattr__(self, "_law", self._through_points())

    def _through_points(self) -> _core.ViscosityLaw:
        try:
            return _core.ViscosityLaw.through(self.model, self.points, self.density)
        except ParameterError as error:
            raise error.within(f"viscosities of {self.name}") from None

    @property
    def law(self) -> _core.ViscosityLaw:
        """Law of viscosity at zero shear rate, as the core uses it."""
        return self._law

    @takes_si(temperature="temperature")
    def viscosity(self, temperature: ArrayLike, shear_rate: ArrayLike = 0.0) -> FloatArray:
        """Return dynamic viscosity, Pa s, at temperatures (K) and shear rates (1/s)."""
        still = self._at(temperature)[0]
        return still if self.thinning is None else np.asarray(still * self.thinning.share(shear_rate))

    @takes_si(temperature="temperature")
    def temperature_exponent(self, temperature: ArrayLike) -> FloatArray:
        """Return d ln eta/d ln T, T in K."""
        return self._at(temperature)[1]

    @takes_si(temperature="temperature")
    def activation_energy(self, temperature: ArrayLike) -> FloatArray:
        """Return the local activation energy of viscosity, J/mol: -R T^2 d ln eta/dT."""
        kelvin = np.asarray(temperature, dtype=float)
        return np.asarray(-_core.GAS_CONSTANT * kelvin * self.temperature_exponent(kelvin))

    @takes_si(temperature="temperature")
    def alpha(self, temperature: ArrayLike) -> FloatArray:
        """Return the pressure-viscosity coefficient, 1/Pa, at temperatures (K).

        Raises
        ------
        ParameterError
            If it is not known.
        """
        if not self.pressure_viscosity:
            raise ParameterError(f"the pressure-viscosity coefficient of {self.name} is missing. Give it")
        known = np.array(self.pressure_viscosity)
        return np.asarray(np.interp(np.asarray(temperature, dtype=float), known[:, 0], known[:, 1]))

    @property
    def temperature_range(self) -> tuple[float, float]:
        """Range of temperatures (K) within which viscosity is interpolated."""
        return self.points[0][0], self.points[-1][0]

    def coefficients(self) -> dict[str, float]:
        """Return the coefficients of the law, SI."""
        return dict(self._law.coefficients)

    def _at(self, temperature: ArrayLike) -> tuple[FloatArray, FloatArray]:
        try:
            state = self._law.at(np.asarray(temperature, dtype=float))
        except ParameterError as error:
            raise error.within(f"viscosity of {self.name}") from None
        return state.viscosity, state.temperature_exponent


def _pairs_in_si(name: str, kind: str, pairs: Sequence[tuple[Any, Any]]) -> tuple[tuple[Any, Any], ...]:
    """Pairs of a temperature and a quantity of ``kind``, in SI."""
    try:
        given = [(t, value) for t, value in pairs]
    except (TypeError, ValueError):
        raise ArgumentError(
            f"{name} must be pairs of a temperature and a {kind}, such as (('40 degC', ...), ...)"
        ) from None
    return tuple((argument(name, "temperature", t), argument(name, kind, value)) for t, value in given)


_BATCHELOR = "Stachowiak and Batchelor, Engineering Tribology, Table 2.3"


def _oil(name: str, viscosities: tuple[float, ...], alphas: tuple[float, ...]) -> Lubricant:
    """An oil of the table: mPa s, and alpha in 1e-9/Pa, at 30, 60 and 100 degC."""
    kelvin = tuple(ZERO_CELSIUS + t for t in (30.0, 60.0, 100.0))
    return Lubricant(
        "vogel",
        tuple(zip(kelvin, (1e-3 * eta for eta in viscosities), strict=True)),
        pressure_viscosity=tuple(zip(kelvin, (1e-9 * alpha for alpha in alphas), strict=True)),
        name=name,
        source=_BATCHELOR,
    )


#: Lubricants with published numbers, to compute with where no data sheet is at hand.
EXAMPLES: dict[str, Lubricant] = {
    "spindle oil": _oil("spindle oil", (18.6, 6.3, 2.4), (20.0, 16.0, 13.0)),
    "light machine oil": _oil("light machine oil", (45.0, 12.0, 3.9), (28.0, 20.0, 16.0)),
    "heavy machine oil": _oil("heavy machine oil", (153.0, 34.0, 9.1), (23.7, 20.5, 15.8)),
    "cylinder oil": _oil("cylinder oil", (810.0, 135.0, 26.8), (34.0, 28.0, 22.0)),
}
