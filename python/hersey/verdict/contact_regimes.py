"""The table of regimes for a contact that is known: its soft film has a band of its own over the dwells.

The exponent of a soft film is no constant: inlet and rolling part take a share that grows with viscosity and
speed, and a film with little supply thins less than it should as it speeds up. What a log of one contact can
show is the range of the local exponent over its dwells, by the film's formula (docs/theory/film.md).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells import SteadyPoints
from hersey.damping.surface import DampingSurface
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_result import REGIMES as FILMS
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.lubricant import Lubricant
from hersey.verdict.explanations import FilmLaw
from hersey.verdict.regimes import REGIMES, SOFT, STARVED, RegimeRow

#: The film of theory that the band belongs to.
_SOFT_FILM = FILMS[2]
#: Share of the flooded film below which a film counts as starved.
_FLOODED = 0.99
#: Half of the step in the logarithm of speed or temperature over which a local exponent is taken.
_STEP = 1e-3


def contact_regimes(
    contact: Contact, lubricant: Lubricant, *, speed: FloatArray, temperature: FloatArray
) -> tuple[RegimeRow, ...]:
    """Return the table with the soft film's exponents of this contact, flooded and as it is supplied.

    The fixed band stays where theory gives the contact no soft film at any dwell.

    Parameters
    ----------
    speed, temperature
        Of the dwells on the film, rad/s and K (as read), of one shape.
    """
    kelvin = film_temperature(contact, lubricant, speed=speed, temperature=temperature)
    film = film_thickness(contact, lubricant, speed=speed, temperature=kelvin)
    soft = film.regime == FILMS.index(_SOFT_FILM)
    if not soft.any():
        return REGIMES
    at = speed[soft], temperature[soft]
    starved = "starvation" in film.corrections and film.corrections["starvation"].factor.min() < _FLOODED
    band = damping_exponent(replace(contact, supply=None), lubricant, *at)
    rows = [
        row._replace(
            low=float(band.min()),
            high=float(band.max()),
            film="" if starved else row.film,
            meaning="isoviscous film in a soft nip, flooded: range of the local exponent in this contact",
        )
        if row.name == SOFT
        else row
        for row in REGIMES
    ]
    if starved:
        thin = damping_exponent(contact, lubricant, *at)
        meaning = "soft film of this contact, starved by its supply: range of the local exponent"
        row = RegimeRow(STARVED, float(thin.min()), float(thin.max()), _SOFT_FILM, meaning)
        rows.insert([r.name for r in rows].index(SOFT), row)
    return tuple(rows)


def log_regimes(
    points: SteadyPoints,
    surface: DampingSurface,
    contact: Contact,
    lubricant: Lubricant,
    temperature: float | None = None,
) -> tuple[RegimeRow, ...]:
    """Return the table for the dwells of a log that are on the rising branch, or all where none is.

    Without temperatures in the log, nor one stated (K), it is the general one.
    """
    speed = np.abs(points.column("speed"))
    kelvin = np.asarray(points.column("temperature"), dtype=float)
    if temperature is not None and not np.isfinite(kelvin).all():
        kelvin = np.full(speed.size, temperature)
    if not np.isfinite(kelvin).all():
        return REGIMES
    rises = on_rising_branch(surface, speed, kelvin)
    if rises.any():
        speed, kelvin = speed[rises], kelvin[rises]
    return contact_regimes(contact, lubricant, speed=speed, temperature=kelvin)


def film_law(
    contact: Contact, lubricant: Lubricant, table: tuple[RegimeRow, ...], temperature: float | None = None
) -> FilmLaw | None:
    """Return the law of the soft film of a contact, None where its table has no band of its own."""
    names = [row.name for row in table]
    if table == REGIMES:
        return None

    def torque(speed: FloatArray, kelvin: FloatArray | None) -> FloatArray:
        read = np.full(speed.shape, temperature) if kelvin is None else kelvin
        inside = film_temperature(contact, lubricant, speed=speed, temperature=read)
        return film_thickness(contact, lubricant, speed=speed, temperature=inside).torque

    return FilmLaw(STARVED if STARVED in names else SOFT, torque)


def on_rising_branch(surface: DampingSurface, speed: FloatArray, temperature: FloatArray) -> FloatArray:
    """Return whether each dwell (rad/s, K as read) is above the transition; all where there is none."""
    at = [
        surface.transition_speed(kelvin if surface.b is not None else None) for kelvin in temperature.tolist()
    ]
    return np.asarray(np.isnan(at) | (speed >= np.asarray(at)))


def damping_exponent(
    contact: Contact, lubricant: Lubricant, speed: FloatArray, temperature: FloatArray
) -> FloatArray:
    """Return the local exponent of damping in speed; speed in rad/s, temperature in K as read.

    Heat and shear of the film move with speed, where the contact has a heat flow.
    """
    return _slope(contact, lubricant, speed, temperature, 1.0, 0.0) - 1.0


def thermal_exponent(
    contact: Contact, lubricant: Lubricant, speed: FloatArray, temperature: FloatArray
) -> FloatArray:
    """Return the local exponent of torque, hence of damping, in absolute temperature."""
    return _slope(contact, lubricant, speed, temperature, 0.0, 1.0)


def _slope(
    contact: Contact,
    lubricant: Lubricant,
    speed: FloatArray,
    temperature: FloatArray,
    by_speed: float,
    by_heat: float,
) -> FloatArray:
    logs = []
    for step in (-_STEP, _STEP):
        w, read = speed * np.exp(by_speed * step), temperature * np.exp(by_heat * step)
        kelvin = film_temperature(contact, lubricant, speed=w, temperature=read)
        logs.append(np.log(film_thickness(contact, lubricant, speed=w, temperature=kelvin).torque))
    return np.asarray((logs[1] - logs[0]) / (2.0 * _STEP))
