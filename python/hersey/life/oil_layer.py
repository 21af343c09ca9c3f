"""The layer of oil that feeds the film: how it thins with age, and the share of the flooded film it leaves.

Loss. The layer flows aside out of the track in proportion to its cube, and evaporates in proportion to
itself::

    dh/dt = -K h^3/2 - e h,   so that   h^-2 = h0^-2 exp(2 e t) + K (exp(2 e t) - 1)/(2 e).

K alone is the side flow of van Zoelen, Venner and Lugt (Proc. IMechE J 223 (2009) 541). Where oil comes back
from beside the track, or grease feeds it, the loss falls with another power, p + 1 for 3 and p for 2. A pure
liquid would evaporate at a steady rate until the track is dry. Oil is a blend: its vapour pressure falls as
the volatile part leaves (Raoult's law), so the loss is proportional to what is left.

Starvation. A layer r times as thick as the film of a flooded inlet leaves r/(1 + r^g)^(1/g) of that film
(Damiens, Venner, Cann, Lubrecht, J. Tribol. 126 (2004) 105). `hersey._core.starvation` computes the same
share for the published sharpness g of 2 to 5. A fit also needs the slope, and may try values outside that
range.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray

#: Sharpness g of starvation where nothing else is known, as `film_thickness` has it.
USUAL_SHARPNESS = 3.0
#: Power p of side flow by theory.
BY_THEORY = 2.0
#: Film over flooded below which it is starved: by the usual sharpness, where the layer is the flooded film.
STARVED = 2.0 ** (-1.0 / USUAL_SHARPNESS)
#: Steps to the layer at which that is left.
_NEWTON = 8
#: Greatest p e t: a layer beyond exp(-50) of the new one is gone, whatever the number.
_MOST_LOST = 100.0
#: Least p e t, by which expm1 of it can be divided: nothing has evaporated.
_LEAST_LOST = 1e-300
#: Least r^g, as a logarithm: keeps its inverse finite.
_THINNEST = -60.0
#: Greatest r^k, as a logarithm: its exponential is nothing.
_THICKEST = 6.0
#: Power of the law that fades over the sharpness of the other: both agree where the layer is the film.
_FADES = float(np.log1p(-np.exp(-1.0)) / -np.log(2.0))


def log_layer(
    new: FloatArray,
    side_flow: FloatArray,
    evaporation: FloatArray,
    age: FloatArray,
    power: float | FloatArray = BY_THEORY,
) -> FloatArray:
    """Return ln of the layer at ages.

    Parameters
    ----------
    new
        The new layer to the power -p, 1/m^p.
    side_flow, evaporation
        K in 1/(m^p age) and e in 1/age. Any unit of length will do that ``new`` shares.
    power
        p.
    """
    lost = np.asarray(np.clip(power * evaporation * age, _LEAST_LOST, _MOST_LOST))
    more = np.expm1(lost)
    # SciPy's exprel takes twenty times as long as this division; arrays may be large, so their room is reused
    layer = side_flow * age * np.divide(more, lost, out=lost)
    more += 1.0
    layer = new * more + layer
    return np.asarray(np.log(layer) / -power)


def age_of_layer(
    new: FloatArray, side_flow: FloatArray, evaporation: FloatArray, layer: FloatArray
) -> FloatArray:
    """Return the age at which the layer, given as its logarithm, is reached; arguments as `log_layer`."""
    thinned = (np.exp(-2.0 * layer) - new) / (2.0 * evaporation * new + side_flow)
    return np.asarray(np.log1p(2.0 * evaporation * thinned) / (2.0 * evaporation))


def log_film_share(log_layer: FloatArray, sharpness: float | FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return ln of the film over the flooded film, and its slope, from ln of the layer over that film."""
    odds = np.exp(-np.maximum(sharpness * log_layer, _THINNEST))
    return np.asarray(-np.log1p(odds) / sharpness), np.asarray(odds / (1.0 + odds))


def log_fading_share(log_layer: FloatArray, sharpness: float | FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the same by a law that comes to the flooded film sooner, 1 less an exponential.

    (1 - exp(-r^k))^(1/k), with k so that both laws agree at r = 1.
    """
    power = _FADES * sharpness
    left = np.exp(np.clip(power * log_layer, _THINNEST, _THICKEST))
    fallen = -np.expm1(-left)
    return np.asarray(np.log(fallen) / power), np.asarray(left * (1.0 - fallen) / fallen)


def log_share_between(
    log_layer: FloatArray, sharpness: float | FloatArray, fading: float | FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the same by a law between both: the first where ``fading`` is 0, the second where it is 1."""
    slow, by_slow = log_film_share(log_layer, sharpness)
    soon, by_soon = log_fading_share(log_layer, sharpness)
    return slow + fading * (soon - slow), by_slow + fading * (by_soon - by_slow)


def starved_layer(sharpness: float | FloatArray, fading: float | FloatArray) -> FloatArray:
    """Return ln of the layer over the flooded film at which `STARVED` of that film is left."""
    layer = np.zeros(np.broadcast_shapes(np.shape(sharpness), np.shape(fading)))
    for _ in range(_NEWTON):
        share, slope = log_share_between(layer, sharpness, fading)
        layer = layer + (np.log(STARVED) - share) / slope
    return layer
