"""Torque of dwells where the film may lack oil, against viscosity, no-load torque and layer of oil.

A starved film is a share of the flooded one (`log_film_share`). Its shear is proportional to the inverse of
that share, within the power that torque has of the film. The rest of what viscosity and speed raise does not
follow the film: rolling, which in `Film` falls as the third power of the share, but also seals and gears. How
large it is, and how it varies, is free. All runs are computed at once, in arrays of shape (runs, dwells).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray, pointwise
from hersey.errors import ParameterError
from hersey.life.oil_layer import USUAL_SHARPNESS, log_fading_share, log_film_share
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.lubricant import Lubricant
from hersey.lubrication.mixed import MixedContact
from hersey.machine.machine import Machine

#: ln of the factor on viscosity at which the flooded film is computed; a cubic goes through them.
_NODES = np.array([-1.0, 0.2, 1.4, 2.6])
_TO_POWERS = np.linalg.inv(np.vander(_NODES, increasing=True))
#: Speeds, and temperatures, of the grid on which the film of many dwells is computed.
_ALONG = 24
#: ln of film over roughness at which the share of the asperities is tabled.
_TABLE = np.linspace(np.log(0.02), np.log(60.0), 600)
#: Factor on roughness at which `rubbing` is looked at: films get thinner, and faces rougher.
_ROUGHER = 2.0
#: Least part of the drag that does not follow the film, over shear: some laws of the film know of none.
_LEAST_ROLLED = 0.01
#: What is free in a run, in this order, with the index of each.
(
    VISCOSITY,
    CONSTANT,
    PER_SPEED,
    PER_KELVIN,
    ROUGHNESS,
    BOUNDARY,
    TEMPERATURE_SENSITIVITY,
    SHARPNESS,
    ROLLING,
    ROLLING_BY_FLOODED,
    ROLLING_BY_SHARE,
    FILM_POWER,
    FADING,
    LAYER,
) = range(14)
FREE = LAYER + 1


@dataclass(frozen=True)
class Flooded:
    """The film of a flooded inlet at dwells, as cubics in ln of the factor on viscosity, lowest power first.

    Each of shape (4, *dwells): ``shear`` is ln of its torque (N m), ``rolled`` rolling over shear, ``film``
    ln of its thickness (m). ``steep`` is ln viscosity there over that at the middle temperature, over that
    between the ends of the lubricant's data.
    """

    shear: FloatArray
    rolled: FloatArray
    film: FloatArray
    steep: FloatArray


def flooded(contact: Contact, lubricant: Lubricant, speed: FloatArray, kelvin: FloatArray) -> Flooded:
    """Return the flooded film at speeds of the roll (rad/s, not 0) and temperatures as read (K)."""
    inside = film_temperature(contact, lubricant, speed=speed, temperature=kelvin)
    shear, rolled, film = [], [], []
    for node in np.exp(_NODES).tolist():
        # All laws know viscosity and speed by their product alone.
        state = film_thickness(
            replace(contact, supply=None), lubricant, speed=node * speed, temperature=inside
        )
        shear.append(np.log(state.shear))
        rolled.append(np.maximum(state.rolling / state.shear, _LEAST_ROLLED))
        film.append(np.log(state.central * state.factor))
    cold, hot = lubricant.temperature_range
    middle = 2.0 * cold * hot / (cold + hot)
    viscosity = np.log(lubricant.viscosity(np.array([cold, middle, hot])))
    steep = (np.log(lubricant.viscosity(inside)) - viscosity[1]) / (viscosity[0] - viscosity[2])
    of_torque, of_rolling, of_film = (
        np.tensordot(_TO_POWERS, np.array(each), axes=1) for each in (shear, rolled, film)
    )
    return Flooded(of_torque, of_rolling, of_film, steep)


class FloodedTable:
    """The flooded film over the speeds and temperatures of many dwells, by splines through a grid of them."""

    def __init__(self, contact: Contact, lubricant: Lubricant, speed: FloatArray, kelvin: FloatArray) -> None:
        """Compute the film on a grid that spans speeds (rad/s) and temperatures (K)."""
        ends = np.log(speed.min()) - 0.01, np.log(speed.max()) + 0.01
        self._speed = np.linspace(*ends, _ALONG)
        self._kelvin = np.linspace(kelvin.min() - 0.1, kelvin.max() + 0.1, _ALONG)
        at = flooded(contact, lubricant, *np.meshgrid(np.exp(self._speed), self._kelvin, indexing="ij"))
        self._tables = np.concatenate([at.shear, at.rolled, at.film, at.steep[None]])

    def at(self, speed: FloatArray, kelvin: FloatArray) -> Flooded:
        """Return the film at dwells inside."""
        from scipy.interpolate import RectBivariateSpline

        where = np.log(speed), kelvin
        each = np.array(
            [RectBivariateSpline(self._speed, self._kelvin, table).ev(*where) for table in self._tables]
        )
        return Flooded(each[:4], each[4:8], each[8:12], each[12])


def cubic(powers: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a cubic and its slope."""
    value = powers[0] + at * (powers[1] + at * (powers[2] + at * powers[3]))
    slope = powers[1] + at * (2.0 * powers[2] + at * 3.0 * powers[3])
    return value, slope


@dataclass(frozen=True)
class SharedLoad:
    """What asperities do to torque, against ln of the film alone over the roughness."""

    table: FloatArray  #: their torque (N m), and shear of the film over that of the film alone

    @classmethod
    def of(cls, mixed: MixedContact, kelvin: float) -> SharedLoad:
        """Return the tables of a contact, its boundary friction that of a temperature, K."""
        product = mixed.reference * np.exp(_TABLE / mixed.film_exponent)
        state = pointwise(_core.mixed_contact, product, *mixed.numbers(np.asarray(kelvin)))
        alone = mixed.shear * np.exp(_TABLE * (1.0 / mixed.film_exponent - 1.0))
        return cls(np.array([np.asarray(state.boundary) * mixed.lever, np.asarray(state.shear) / alone]))

    def at(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return both and their slopes, (2, ...), linear between the points and level beyond."""
        step = float(_TABLE[1] - _TABLE[0])
        place = np.clip((ratio - _TABLE[0]) / step, 0.0, _TABLE.size - 1.001)
        index = place.astype(np.intp)
        low = self.table[:, index]
        rise = self.table[:, index + 1] - low
        return low + (place - index) * rise, rise / step


@dataclass(frozen=True)
class StarvedDrag:
    """Torque of dwells against what is free (see `VISCOSITY` and the others), and its slopes."""

    speed: FloatArray
    warm: FloatArray  #: K above the middle of the dwells
    flooded: Flooded
    reference: Flooded  #: of one point, shape (4, 1, 1): that of the layer
    thick: float  #: ln of the flooded film (m) where the powers of it are 1
    roughness: float | None
    shared: SharedLoad | None

    def rubbing(self) -> FloatArray:
        """Return what asperities would add to torque with faces rougher by `_ROUGHER`, the inlet flooded."""
        film, _ = cubic(self.flooded.film, np.zeros(()))
        if self.shared is None or self.roughness is None:
            return np.zeros_like(film)
        return np.asarray(self.shared.at(film - np.log(_ROUGHER * self.roughness))[0][0])

    def torque(self, free: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return torque (runs, dwells), N m, and its slopes (runs, free, dwells) at what is free (runs, 14).

        Free are ln of the factor on viscosity at the middle temperature; the no-load torque (N m, N m
        s/rad, N m/K); ln of the factors on roughness and on boundary friction; the change of ln viscosity
        from the hot to the cold end; ln of the factor on the sharpness of starvation; of the part that
        does not follow the film ln of the factor, the power of the flooded film on it, and that of the share
        of the film that is left; the power of the film, less 1, in shear; how far
        starvation is by the law that fades (0 to 1); and ln of the layer over the
        flooded film at the reference.
        """
        column = free.T[:, :, None]
        at = column[VISCOSITY] + column[TEMPERATURE_SENSITIVITY] * self.flooded.steep
        there = column[VISCOSITY] + column[TEMPERATURE_SENSITIVITY] * self.reference.steep
        film, by_film = cubic(self.flooded.film, at)
        least, by_least = cubic(self.reference.film, there)
        layer = column[LAYER] + least - film
        sharpness = USUAL_SHARPNESS * np.exp(column[SHARPNESS])
        slow, by_slow = log_film_share(layer, sharpness)
        soon, by_soon = log_fading_share(layer, sharpness)
        fading = column[FADING]
        log_share, by_layer = slow + fading * (soon - slow), by_slow + fading * (by_soon - by_slow)
        shear, by_shear = cubic(self.flooded.shear, at)
        rolled, by_rolled = cubic(self.flooded.rolled, at)
        over, power = film - self.thick, column[FILM_POWER]
        by_flooded, by_share = column[ROLLING_BY_FLOODED], column[ROLLING_BY_SHARE]
        sheared = np.exp(shear - power * over - (1.0 + power) * log_share)
        thinned = np.exp(shear + column[ROLLING] + by_flooded * over + by_share * log_share)
        rolling = thinned * rolled
        touching, of_ratio = np.zeros_like(film), np.zeros_like(film)
        if self.shared is not None and self.roughness is not None:
            ratio = film + log_share - (np.log(self.roughness) + column[ROUGHNESS])
            values, steps = self.shared.at(ratio)
            harder = np.exp(column[BOUNDARY])
            touching = harder * values[0]
            of_ratio = harder * steps[0] + sheared * steps[1]
            sheared = sheared * values[1]
        rest = column[CONSTANT] + column[PER_SPEED] * self.speed + column[PER_KELVIN] * self.warm
        # By ln film over roughness, ln share of the film, and ln viscosity with the layer held.
        of_share = by_share * rolling - (1.0 + power) * sheared + of_ratio
        of_layer = of_share * by_layer
        of_flooded = by_flooded * rolling - power * sheared + of_ratio
        straight = (sheared + rolling) * by_shear + thinned * by_rolled + of_flooded * by_film
        slopes = np.empty((film.shape[0], FREE, film.shape[1]))
        slopes[:, VISCOSITY] = straight + of_layer * (by_least - by_film)
        slopes[:, CONSTANT], slopes[:, PER_SPEED], slopes[:, PER_KELVIN] = 1.0, self.speed, self.warm
        slopes[:, ROUGHNESS], slopes[:, BOUNDARY] = -of_ratio, touching
        slopes[:, TEMPERATURE_SENSITIVITY] = straight * self.flooded.steep + of_layer * (
            by_least * self.reference.steep - by_film * self.flooded.steep
        )
        slopes[:, SHARPNESS] = of_share * (layer * by_layer - log_share)
        slopes[:, ROLLING] = rolling
        slopes[:, ROLLING_BY_FLOODED], slopes[:, ROLLING_BY_SHARE] = rolling * over, rolling * log_share
        slopes[:, FILM_POWER] = -sheared * (over + log_share)
        slopes[:, FADING] = of_share * (soon - slow)
        slopes[:, LAYER] = of_layer
        return sheared + rolling + touching + rest, slopes


def film_of(machine: Machine) -> tuple[Contact, Lubricant]:
    """Return contact and lubricant of a machine.

    Raises
    ------
    ParameterError
        If one is missing.
    """
    if machine.contact is None or machine.lubricant is None:
        raise ParameterError(
            "the film needs nip and lubricant. Add [contact] and [lubricant] to the machine file"
        )
    return machine.contact, machine.lubricant
