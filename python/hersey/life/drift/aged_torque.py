"""The torque of a drive at an age, as a sum of parts that each ageing moves in its own way.

In the product p of viscosity and speed (logarithms, about the middle of the data):

    torque = rest (1 + k w) + film + contact
    film = e^(F + L + (1 - n) p) (1 + e^(S + g n (p - p_c)))^(1/g)
    contact = e^(F + A - K (e^(n (p - p_s) + C) - 1))
    p = ln w + (1 + b) viscosity(T)

The film is proportional to the product to the power n, and starves where the layer of oil is thinner than a
flooded film (`oil_layer`): S + g n (p - p_c) is g times ln of the flooded film over the layer. The contact
fades as the film grows over the roughness. p_c is the cold and fast corner of the data, p_s the hot and slow
one. All runs share F, n, K, k, g and the viscosity; a run has its own rest, L, b, S, A and C. In those ageing
is linear: thicker oil, say, moves L by 1 - n, S by g n and C by n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.life.oil_layer import log_film_share

#: What a run has of its own, in the order of the last axis.
OWN = ("rest", "film", "temperature law", "starvation", "contact", "cover")
REST, FILM, LAW, STARVATION, CONTACT, COVER = range(len(OWN))
#: What all runs share.
SHARED = (
    "level",
    "film exponent",
    "slope of viscosity",
    "bend of viscosity",
    "rest by speed",
    "fading",
    "sharpness",
)
LEVEL, EXPONENT, SLOPE, BEND, PER_SPEED, FADING, SHARPNESS = range(len(SHARED))
#: Activation energy of the viscosity that is expected before the data speak, J/mol, and the gas constant.
_ENERGY, _GAS = 40e3, 8.314462618
#: Range of 1/T (1/K) from which temperatures tell anything: some 5 K at 400 K.
_LEAST_RANGE = 3e-5
#: Greatest exponent that is raised to: beyond it a part is gone or has lost all sense.
_FAR = 30.0


@dataclass(frozen=True, repr=False)
class Scales:
    """The range of the data: what speeds, temperatures and torques are counted from."""

    speed: tuple[float, float]  #: slowest and fastest, rad/s
    inverse: tuple[float, float]  #: hottest and coldest, 1/K
    torque: float  #: N m

    @classmethod
    def of(cls, speed: FloatArray, temperature: FloatArray, torque: FloatArray) -> Scales:
        """Return those of dwells (rad/s, K or NaN, N m)."""
        known = temperature[np.isfinite(temperature)]
        inverse = 1.0 / known if known.size else np.array([1.0 / 400.0])
        return cls(
            (float(speed.min()), float(speed.max())),
            (float(inverse.min()), float(inverse.max())),
            float(np.median(np.abs(torque))),
        )

    @property
    def thermal(self) -> bool:
        """Whether temperatures differ enough to tell anything."""
        return self.inverse[1] - self.inverse[0] > _LEAST_RANGE

    @property
    def viscosity_range(self) -> float:
        """The range of ln viscosity that is expected from hottest to coldest."""
        return _ENERGY / _GAS * (self.inverse[1] - self.inverse[0]) if self.thermal else 0.0

    def speeds(self, speed: FloatArray) -> FloatArray:
        """Return ln speed about the middle of the range."""
        return np.asarray(np.log(speed) - 0.5 * np.log(self.speed[0] * self.speed[1]))

    def places(self, temperature: FloatArray) -> FloatArray:
        """Return where temperatures (K) stand in 1/T: from -1/2, hottest, to 1/2, coldest."""
        if not self.thermal:
            return np.zeros(np.shape(temperature))
        low, high = self.inverse
        return np.asarray((1.0 / temperature - 0.5 * (low + high)) / (high - low))

    def temperature(self, place: float) -> float | None:
        """Return the temperature (K) at a place; None where temperatures tell nothing."""
        low, high = self.inverse
        return float(1.0 / (0.5 * (low + high) + place * (high - low))) if self.thermal else None

    @property
    def reach(self) -> float:
        """Half the range of ln speed."""
        return 0.5 * float(np.log(self.speed[1] / self.speed[0]))


@dataclass(frozen=True, repr=False)
class Parts:
    """Torque of rest, film and contact in units of `Scales.torque`, and the derivatives by own and shared."""

    rest: FloatArray
    film: FloatArray
    contact: FloatArray
    own: FloatArray
    shared: FloatArray

    @property
    def torque(self) -> FloatArray:
        """The whole."""
        return self.rest + self.film + self.contact


def parts(
    scales: Scales,
    speed: FloatArray,
    place: FloatArray,
    own: FloatArray,
    shared: FloatArray,
    *,
    slopes: bool = True,
) -> Parts:
    """Return the torque of runs, and its derivatives unless no ``slopes`` are wanted.

    Parameters
    ----------
    speed, place
        rad/s, and of the temperature (`Scales.places`); shape (..., dwells).
    own
        Of each run, shape (..., `OWN`).
    shared
        Shape (`SHARED`).
    """
    rest, thick, law, starved, touch, cover = np.moveaxis(own, -1, 0)[..., None]
    level, exponent, slope, bend, per_speed, fading, log_sharp = shared
    sharp = np.exp(log_sharp)
    viscosity = slope * place + bend * place**2
    d_cold, d_hot = np.array([0.5, 0.25]), np.array([-0.5, 0.25])
    product = scales.speeds(speed) + (1.0 + law) * viscosity
    above = product - scales.reach - d_cold @ shared[[SLOPE, BEND]]
    beyond = product + scales.reach - d_hot @ shared[[SLOPE, BEND]]
    # Film, and how far it is starved.
    log_share, by_layer = log_film_share(-(starved + sharp * exponent * above) / sharp, sharp)
    film = np.exp(np.minimum(level + thick + (1.0 - exponent) * product, _FAR) - log_share)
    # Contact: fades as the film grows over the roughness.
    steep = np.exp(fading)
    covered = steep * np.exp(np.minimum(exponent * beyond + cover, _FAR))
    contact = np.exp(np.clip(level + touch + steep - covered, -_FAR, _FAR))
    still = 1.0 + per_speed * speed / scales.speed[1]
    if not slopes:
        none = np.empty(0)
        return Parts(rest * still, film, contact, none, none)
    thinned = film * by_layer / sharp  # d film / d starvation
    fall = -contact * covered  # d contact / d cover
    by_product = film * (1.0 - exponent) + thinned * sharp * exponent + fall * exponent
    d_own = np.stack([still + 0.0 * product, film, by_product * viscosity, thinned, contact, fall], axis=-1)
    d_viscosity = (
        (by_product * (1.0 + law))[..., None]
        * np.stack([place + 0.0 * product, place**2 + 0.0 * product], -1)
        - (thinned * sharp * exponent)[..., None] * d_cold
        - (fall * exponent)[..., None] * d_hot
    )
    d_shared = np.concatenate(
        [
            np.stack([film + contact, -film * product + thinned * sharp * above + fall * beyond], axis=-1),
            d_viscosity,
            np.stack(
                [
                    rest * speed / scales.speed[1],
                    contact * steep + fall,
                    thinned * sharp * exponent * above + film * log_share,
                ],
                axis=-1,
            ),
        ],
        axis=-1,
    )
    return Parts(rest * still, film, contact, d_own, d_shared)


def expected(scales: Scales) -> tuple[FloatArray, FloatArray]:
    """Return means and deviations of what is expected of the shared values before the data speak.

    Film exponent 0.6 +- 0.08; viscosity of some 40 kJ/mol within a half; the rest much alike at all speeds;
    sharpness of starvation 3, within 2 and 5.
    """
    nil = 1e-6
    mean = np.array([np.log(0.2), 0.6, scales.viscosity_range, 0.0, 0.0, np.log(3.0), np.log(3.0)])
    deviation = np.array(
        [3.0, 0.08, 0.5 * scales.viscosity_range + nil, 0.25 * scales.viscosity_range + nil, 0.2, 0.7, 0.3]
    )
    return mean, deviation


def estimable(scales: Scales) -> BoolArray:
    """Return which of `OWN` the range of the data can determine at all."""
    found = np.ones(len(OWN), dtype=bool)
    found[LAW] = scales.thermal
    return found
