"""Film thickness and drag of a nip: every law beside the others, which holds, and what else thins the film.

Conventions: ``speed`` is the angular speed of the roll (rad/s); the belt moves at U = speed roll_radius over
a heater at rest, so the entrainment speed is u = U/2 (the MEAN) and the sliding speed U. E' = 2 E/(1 - nu^2).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey import _core
from hersey.arguments.door import Words
from hersey.arrays import FloatArray, pointwise
from hersey.errors import ParameterError
from hersey.lubrication import paper
from hersey.lubrication.contact import Contact
from hersey.lubrication.film_result import REGIMES, SOFT, STARVATION, Correction, Film, torque_of
from hersey.lubrication.lubricant import Lubricant
from hersey.units import takes_si

#: Laws a film can be computed by: that which holds, one of the regimes', or Eq. 5 of the paper.
LAWS = ("governing", *REGIMES, "paper")
#: Both walls slide past each other at U while the mean speed is U/2: slide-to-roll ratio of a heater at rest.
SLIDE_TO_ROLL = 2.0
#: The inlet must be this much shorter than layer and half-width for the soft law of a layer.
_SHORT = 0.25


@takes_si(speed="speed", temperature="temperature", supply="length")
def film_thickness(
    contact: Contact,
    lubricant: Lubricant,
    *,
    speed: ArrayLike,
    temperature: ArrayLike,
    supply: float | None = None,
    starvation_sharpness: float = 3.0,
) -> Film:
    """Return the film of a nip at operating points by all laws, and the law that applies.

    Parameters
    ----------
    contact, lubricant
        Nip and lubricant. Without a pressure-viscosity coefficient, pressure does not thicken the lubricant.
    speed, temperature
        Of the roll (rad/s) and of the film (K), broadcast together.
    supply
        Thickness of the layer on the inlet side, m. Default: that of the contact, or a flooded inlet.
    starvation_sharpness
        Sharpness of the change from flooded to starved, 2 to 5.

    Raises
    ------
    ParameterError
        If a speed is zero or a value is impossible.

    Examples
    --------
    >>> from hersey.lubrication.lubricant import EXAMPLES
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48,
    ...                length=0.22, load=250.0)
    >>> film = film_thickness(roll, EXAMPLES["cylinder oil"], speed=4.0, temperature=373.15)
    >>> print(film.regime_names()[0], f"{1e6 * film.central:.1f} um")
    isoviscous-elastic 2.2 um
    """
    speeds, temperatures = operating_points(speed, temperature)
    nip = contact.nip
    viscosity = lubricant.viscosity(temperatures)
    alpha = lubricant.alpha(temperatures) if lubricant.pressure_viscosity else np.zeros_like(viscosity)
    entrainment = 0.5 * speeds * contact.roll_radius
    laws = _line_film(contact, alpha, viscosity, entrainment)
    by_paper = _by_paper(contact, alpha, viscosity, entrainment) if np.all(alpha > 0) else {}
    regime = laws.regime.astype(np.intp)
    force = _soft_traction(contact, viscosity, entrainment)
    soft = regime == SOFT
    film = Film(
        speed=speeds,
        temperature=temperatures,
        entrainment_speed=entrainment,
        viscosity=viscosity,
        g_v=laws.g_v,
        g_e=laws.g_e,
        regime=regime,
        minimum=np.choose(regime, list(laws.minimum.values())),
        central=np.choose(regime, list(laws.central.values())),
        minima=dict(laws.minimum) | by_paper,
        centres=dict(laws.central) | by_paper,
        inlet_short=_inlet_short(contact, viscosity, entrainment),
        shear_factor=np.where(soft, force.shear_factor, 1.0),
        rolling_force=np.where(soft, force.rolling, 0.0),
        contact=contact,
        lubricant=lubricant,
        nip=nip,
    )
    layer = contact.supply if supply is None else supply
    return replace(film, corrections=_corrections(film, layer, starvation_sharpness))


def operating_points(speed: ArrayLike, temperature: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return speeds (rad/s) without their sign and temperatures (K), broadcast together."""
    speeds, kelvin = np.broadcast_arrays(
        np.abs(np.asarray(speed, dtype=float)), np.asarray(temperature, dtype=float)
    )
    return speeds, kelvin


def _line_film(
    contact: Contact, alpha: ArrayLike, viscosity: FloatArray, entrainment: FloatArray
) -> _core.LineFilm:
    return pointwise(
        _core.line_film,
        alpha,
        viscosity,
        entrainment,
        contact.load_per_length,
        contact.reduced_radius,
        contact.effective_modulus,
        contact.nip.layer_factor,
    )


def _by_paper(
    contact: Contact, alpha: FloatArray, viscosity: FloatArray, entrainment: FloatArray
) -> dict[str, FloatArray]:
    """The film of Eq. 5, by name."""
    film = paper.film_thickness(
        pressure_viscosity=alpha,
        viscosity=viscosity,
        entrainment_speed=entrainment,
        load=contact.load,
        length=contact.length,
        radius=contact.reduced_radius,
        effective_modulus=contact.effective_modulus,
    )
    return {"paper": film}


def inlet_length(contact: Contact, viscosity: ArrayLike, entrainment: ArrayLike) -> FloatArray:
    """Return the length of the inlet of a soft film, m, at viscosities (Pa s) and mean speeds (m/s)."""
    nip, radius, modulus = contact.nip, contact.reduced_radius, contact.effective_modulus
    return pointwise(_core.inlet_length, viscosity, entrainment, radius, modulus, nip.edge, nip.half_width)


def _inlet_short(contact: Contact, viscosity: FloatArray, entrainment: FloatArray) -> NDArray[np.bool_]:
    least = min(contact.rubber_thickness, contact.nip.half_width)
    return np.asarray(inlet_length(contact, viscosity, entrainment) < _SHORT * least)


def soft_force_beyond(contact: Contact, product: FloatArray) -> FloatArray:
    """Return what a soft film takes beyond eta U/h_c over the nip, N: inlet shear and rolling, flooded.

    ``product`` is that of viscosity and belt speed, Pa m.
    """
    one, entrainment = np.ones_like(product), 0.5 * product
    laws = _line_film(contact, 0.0, one, entrainment)
    force = _soft_traction(contact, one, entrainment)
    plain = product / laws.central[REGIMES[SOFT]] * contact.nip.width
    return np.asarray(contact.length * (plain * (force.shear_factor - 1.0) + force.rolling))


def _soft_traction(contact: Contact, viscosity: FloatArray, entrainment: FloatArray) -> _core.Traction:
    nip = contact.nip
    return pointwise(
        _core.soft_traction,
        viscosity,
        entrainment,
        contact.reduced_radius,
        contact.effective_modulus,
        nip.edge,
        nip.curvature,
        nip.half_width,
        contact.rubber_thickness,
    )


def _corrections(film: Film, supply: float | None, sharpness: float) -> dict[str, Correction]:
    corrections, lubricant = {}, film.lubricant
    if lubricant.thinning is not None:
        carreau = lubricant.thinning
        exponent = np.asarray(_core.FILM_SPEED_EXPONENTS)[film.regime]
        answer = pointwise(
            _core.shear_thinning,
            film.central,
            2.0 * film.entrainment_speed,
            exponent,
            carreau.relaxation_time,
            carreau.exponent,
            carreau.limit,
        )
        corrections["shear thinning"] = _correction(answer)
    if lubricant.conductivity is not None:
        fall = -lubricant.temperature_exponent(film.temperature) / film.temperature
        answer = pointwise(
            _core.inlet_heating,
            film.viscosity,
            fall,
            film.entrainment_speed,
            lubricant.conductivity,
            SLIDE_TO_ROLL,
        )
        corrections["inlet heating"] = _correction(answer)
    if supply is not None:
        corrections[STARVATION] = _correction(pointwise(_core.starvation, supply, film.central, sharpness))
    return corrections


def _correction(answer: _core.Correction) -> Correction:
    return Correction(answer.factor, answer.valid)


@takes_si(speed="speed", temperature="temperature", supply="length", law=Words(LAWS))
def drag_torque(
    contact: Contact,
    lubricant: Lubricant,
    *,
    speed: ArrayLike,
    temperature: ArrayLike,
    law: str = "governing",
    supply: float | None = None,
) -> FloatArray:
    """Return the torque of the film, N m: shear (eta U/h_c) nip L R (Eq. 7), and rolling.

    In a soft film, inlet and pressure gradient add up to half of the shear; see `Film.shear`, `Film.rolling`
    and docs/theory/film.md.

    Parameters
    ----------
    contact, lubricant, speed, temperature, supply
        As in `film_thickness`.
    law
        ``governing``: film of the valid regime, on the nip of a bonded layer, with all corrections; the name
        of a regime: its film on that nip, shear only; ``paper``: Eq. 9.

    Raises
    ------
    ParameterError
        If the law is not known, or ``paper`` is used without a pressure-viscosity coefficient.

    Examples
    --------
    >>> from hersey.lubrication.lubricant import EXAMPLES
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48,
    ...                length=0.22, load=250.0)
    >>> torque = drag_torque(roll, EXAMPLES["cylinder oil"], speed=[4.0, 8.0], temperature=373.15)
    >>> print(f"torque grows as speed to the power {np.log2(torque[1] / torque[0]):.2f}")
    torque grows as speed to the power 0.42
    """
    if law not in LAWS:
        raise ParameterError(f"law '{law}' is not known: {', '.join(LAWS)}")
    if law == "paper":
        kelvin = np.asarray(temperature, dtype=float)
        return paper.torque(
            pressure_viscosity=lubricant.alpha(kelvin),
            viscosity=lubricant.viscosity(kelvin),
            entrainment_speed=0.5 * np.abs(np.asarray(speed, dtype=float)) * contact.roll_radius,
            load=contact.load,
            length=contact.length,
            rubber_thickness=contact.rubber_thickness,
            radius=contact.reduced_radius,
            effective_modulus=contact.effective_modulus,
        )
    film = film_thickness(contact, lubricant, speed=speed, temperature=temperature, supply=supply)
    if law == "governing":
        return film.torque
    if np.any(film.centres[law] <= 0):
        raise ParameterError(f"law '{law}' needs the pressure-viscosity coefficient of {lubricant.name}")
    return torque_of(film, film.centres[law], film.viscosity)


@takes_si(sliding_speed="belt speed", temperature="temperature")
def shear_heating(lubricant: Lubricant, *, sliding_speed: ArrayLike, temperature: ArrayLike) -> FloatArray:
    """Return the greatest rise of temperature in a sheared film between walls of one temperature, K.

    It is eta U^2/(8 k).

    Raises
    ------
    ParameterError
        If the conductivity of the lubricant is not known.
    """
    if lubricant.conductivity is None:
        raise ParameterError(f"the thermal conductivity of {lubricant.name} is missing. Give it")
    viscosity = lubricant.viscosity(temperature)
    return pointwise(_core.shear_heating, viscosity, sliding_speed, lubricant.conductivity).greatest
