"""Film over flooded film against the layer of oil over flooded film, by two laws."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Layer over flooded film at which the table of a starved Reynolds inlet is kept.
RATIOS = np.logspace(-2, 2, 161)
#: Flow to the sides over that through the nip, per length of the bank of oil in units of the inlet.
LEAK = 0.03


def tanh(ratio: Array) -> Array:
    """Return the film over flooded film that saturates as a hyperbolic tangent."""
    return np.tanh(ratio)


def _starved_inlet() -> Array:
    """Return the film over flooded film at `RATIOS`, of an inlet that is full only from a meniscus on.

    The gap before a soft nip is h (1 + z^1.5). The pressure at the edge of the nip is the same for each film,
    and it varies as the integral of (gap - h) / gap^3, so that f^(-4/3) I(m) = I(infinity) for a film f with
    its meniscus at m. The layer feeds the nip, and the sides of the bank of oil between meniscus and nip.
    """
    z = np.logspace(-5, 5, 6001)
    gap = 1 + z**1.5
    rate = (gap - 1) / gap**3
    integral = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(z))])
    film = (integral / integral[-1]) ** 0.75
    layer = film + LEAK * film ** (2 / 3) * z
    return np.interp(np.log(RATIOS), np.log(layer[1:]), film[1:])


@cache
def _pulsed(swing: float) -> Array:
    """Return the film of a layer that rises and falls by ``swing`` with each page."""
    steady = _starved_inlet()
    phase = np.sin((np.arange(24) + 0.5) / 24 * 2 * np.pi)
    layers = RATIOS[:, None] * (1 + swing * phase)
    # What is felt is drag, the mean of the inverse film.
    return 1 / np.mean(1 / np.interp(np.log(layers), np.log(RATIOS), steady), axis=1)


def reynolds(ratio: Array, swing: float = 0.4) -> Array:
    """Return the film over flooded film by the table of a starved Reynolds inlet, its layer pulsed."""
    return np.interp(np.log(np.clip(ratio, 1e-6, 1e6)), np.log(RATIOS), _pulsed(swing))
