"""The temperature of a film through which heat flows from the heater to the roll, and which its shear warms.

With q the heat flow over the area of the nip, the film drops by q h/k from wall to wall; shear adds a
parabola, eta U^2/(8 k) at its top and eta U^2/(12 k) in the mean. So the mean of the film is that of the wall
that the sensor reads, less (heater) or plus (roll) half of the drop, plus eta U^2/(12 k). Steady conduction
across a film of constant viscosity; convection along the nip is left out, as are the belt and its contact
with the sensor.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import film_thickness, operating_points, shear_heating
from hersey.lubrication.lubricant import Lubricant
from hersey.units import celsius, takes_si

#: Mean of a parabola over its top.
_MEAN = 2.0 / 3.0
#: Half a step at a time settles for any drop or rise below a hundred kelvin: steps at the most.
_STEPS = 200
#: Step below which it has, K.
_SETTLED = 1e-6


@takes_si(speed="speed", temperature="temperature", supply="length")
def film_temperature(
    contact: Contact,
    lubricant: Lubricant,
    *,
    speed: ArrayLike,
    temperature: ArrayLike,
    supply: float | None = None,
) -> FloatArray:
    """Return the mean temperature of the film, K, from that of the wall that the sensor reads.

    Without a ``heat_flow`` of the contact the film is as warm as the reading.

    Parameters
    ----------
    contact, lubricant
        The nip, with ``heat_flow`` and ``sensor_side``, and what is in it, with its conductivity.
    speed, temperature
        Of the roll (rad/s) and as read (K), broadcast together.
    supply
        As in `film_thickness`.

    Raises
    ------
    ParameterError
        If the conductivity is not known, or the heat would chill or warm the film without end.

    Examples
    --------
    >>> from hersey.lubrication.lubricant import Lubricant
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48,
    ...                length=0.22, load=250.0, heat_flow=600.0, sensor_side="heater")
    >>> oil = Lubricant("arrhenius", ((313.15, 0.12), (453.15, 0.019)), conductivity=0.1)
    >>> film = film_temperature(roll, oil, speed=10.0, temperature=453.15)
    >>> print(f"{453.15 - film:.1f} K colder than the heater")
    7.1 K colder than the heater
    """
    speeds, read = operating_points(speed, temperature)
    if contact.heat_flow is None:
        return np.array(read)
    if lubricant.conductivity is None:
        raise ParameterError(
            f"heat_flow needs the thermal conductivity of {lubricant.name}. Give 'conductivity' in "
            "[lubricant], e.g. '0.1 W/m/K'"
        )
    flux = contact.heat_flow / (contact.nip.width * contact.length)
    side = -0.5 if contact.sensor_side == "heater" else 0.5
    kelvin: FloatArray = np.array(read)
    for _ in range(_STEPS):
        film = film_thickness(contact, lubricant, speed=speeds, temperature=kelvin, supply=supply)
        drop = flux * film.central * film.factor / lubricant.conductivity
        rise = shear_heating(lubricant, sliding_speed=2.0 * film.entrainment_speed, temperature=kelvin)
        step = read + side * drop + _MEAN * rise - kelvin
        kelvin = np.asarray(kelvin + 0.5 * step)
        if np.all(np.abs(step) < _SETTLED):
            return kelvin
        if np.any(kelvin < 0.5 * read) or np.any(kelvin > 2.0 * read):
            break
    worst = int(np.argmax(np.abs(step)))
    w, reading = float(np.ravel(speeds)[worst]), celsius(float(np.ravel(read)[worst]))
    raise ParameterError(
        f"heat_flow is {contact.heat_flow:g} W: at {w:.3g} rad/s and {reading:.4g} degC no film "
        "temperature near the reading fits. Check heat_flow, conductivity and viscosity"
    )
