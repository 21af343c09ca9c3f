"""Eqs. 5-10 of "Belt Fuser Torque" (NIP31, 2015), exactly as the paper has them, over arrays in SI.

Conventions: ``entrainment_speed`` is the mean ubar = (u1 + u2)/2, so the sliding speed is U = 2 ubar with the
heater at rest; ``effective_modulus`` is E' = 2/[(1-nu1^2)/E1 + (1-nu2^2)/E2]; ``load`` is the whole load N.
Eq. 5 is Dowson and Higginson's early line-contact formula, for hard piezoviscous contacts: whether it
applies to a nip is another question (`hersey.film_thickness` says). Eq. 8 is recovered from Eqs. 5, 7 and 9.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arrays import FloatArray, pointwise

#: What the core takes, in its order.
_QUANTITIES = (
    "pressure_viscosity",
    "viscosity",
    "entrainment_speed",
    "load",
    "length",
    "rubber_thickness",
    "radius",
    "effective_modulus",
)


def film_thickness(
    *,
    pressure_viscosity: ArrayLike,
    viscosity: ArrayLike,
    entrainment_speed: ArrayLike,
    load: ArrayLike,
    length: ArrayLike,
    radius: ArrayLike,
    effective_modulus: ArrayLike,
) -> FloatArray:
    """Return delta of Eq. 5, m: 1.6 alpha^0.6 R^0.43 E'^0.03 (eta ubar)^0.7 (N/L)^-0.13.

    Raises
    ------
    ParameterError
        If a value is not positive; so have all functions of this module.

    Examples
    --------
    >>> delta = film_thickness(pressure_viscosity=2.2e-8, viscosity=0.04, entrainment_speed=5.0,
    ...                        load=2e5, length=1.0, radius=0.01, effective_modulus=2.3077e11)
    >>> print(f"{1e6 * delta:.3f} um")
    0.817 um
    """
    return _equation(5, **locals())


def shear_stress(*, viscosity: ArrayLike, sliding_speed: ArrayLike, film_thickness: ArrayLike) -> FloatArray:
    """Return tau_s of Eq. 6, Pa: eta U/delta."""
    eta_u = np.asarray(viscosity, float) * np.asarray(sliding_speed, float)
    return np.asarray(eta_u / np.asarray(film_thickness, float))


def torque_of_film(
    *,
    viscosity: ArrayLike,
    sliding_speed: ArrayLike,
    film_thickness: ArrayLike,
    nip_width: ArrayLike,
    length: ArrayLike,
    radius: ArrayLike,
) -> FloatArray:
    """Return T of Eq. 7, N m: (eta U/delta) nip L R_BUR."""
    stress = shear_stress(viscosity=viscosity, sliding_speed=sliding_speed, film_thickness=film_thickness)
    arm = np.asarray(length, float) * np.asarray(radius, float)
    return np.asarray(stress * np.asarray(nip_width, float) * arm)


def nip_width(
    *,
    load: ArrayLike,
    length: ArrayLike,
    rubber_thickness: ArrayLike,
    radius: ArrayLike,
    effective_modulus: ArrayLike,
) -> FloatArray:
    """Return the nip of Eq. 8, m: 2.115 (N R/(L E'))^0.32 h^0.37; a regression, in metres.

    Examples
    --------
    >>> nip = nip_width(load=250, length=0.22, rubber_thickness=3.5e-3, radius=15e-3,
    ...                 effective_modulus=2e6 / (1 - 0.48**2))
    >>> print(f"{1e3 * nip:.2f} mm")
    5.73 mm
    """
    return _equation(8, **locals())


def torque(
    *,
    pressure_viscosity: ArrayLike,
    viscosity: ArrayLike,
    entrainment_speed: ArrayLike,
    load: ArrayLike,
    length: ArrayLike,
    rubber_thickness: ArrayLike,
    radius: ArrayLike,
    effective_modulus: ArrayLike,
) -> FloatArray:
    """Return T of Eq. 9, N m: 2.644 alpha^-0.6 (eta ubar)^0.3 N^0.45 L^0.55 h^0.37 R^0.89 E'^-0.35."""
    return _equation(9, **locals())


def damping(
    *,
    pressure_viscosity: ArrayLike,
    viscosity: ArrayLike,
    entrainment_speed: ArrayLike,
    load: ArrayLike,
    length: ArrayLike,
    rubber_thickness: ArrayLike,
    radius: ArrayLike,
    effective_modulus: ArrayLike,
) -> FloatArray:
    """Return B of Eq. 10, N s: torque over ubar (m/s), not over an angular speed.

    The measured B = tau/omega is this times R/2, as omega = 2 ubar/R.
    """
    return _equation(10, **locals())


def _equation(number: int, **given: ArrayLike) -> FloatArray:
    # What an equation does not contain is 1: it is not used.
    return pointwise(partial(_core.paper, number), *(given.get(name, 1.0) for name in _QUANTITIES))
