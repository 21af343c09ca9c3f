"""Finding slips: falls of the force beyond noise, with a running median that suits them."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.identification.sampling import Samples
from hersey.identification.slip_shape import TEN_TO_NINETY
from hersey.identification.turning_points import Falls, averaged, crossing, falls, least_turn, smoothed

#: Fewer falls are no cycle.
FEWEST_SLIPS = 3
#: Running medians are taken over this share of a fall: it stays a fall, and most of the noise goes.
_RESOLVED = 0.44
#: Widest running median with which falls are looked for first, in samples.
_WIDEST = 85


def found_falls(samples: Samples, least_drop: float | None) -> tuple[Falls, float, int]:
    """Falls beyond noise, found with the narrowest running median that shows any, then with one that fits.

    Also the least fall counted, and the width of that running median in samples.
    """
    value, size = samples.value, samples.value.size
    window, slips, least = 1, Falls(np.empty(0, np.intp), np.empty(0, np.intp)), 0.0
    widest = min(_WIDEST, max(1, size // 20))
    while window <= widest:
        least = max(least_turn(samples.noise, size, window), least_drop or 0.0)
        slips = falls(smoothed(value, window), least)
        if slips.top.size >= FEWEST_SLIPS:
            break
        window = 4 * window + 1
    for _ in range(2):
        if slips.top.size < FEWEST_SLIPS:
            break
        window = running_width(steep_lasts(value, slips, window))
        least = max(least_turn(samples.noise, size, window), least_drop or 0.0)
        slips = falls(smoothed(value, window), least)
    return _refined(value, slips, window), least, window


def _refined(value: FloatArray, slips: Falls, window: int) -> Falls:
    """Falls from where the running mean is greatest to where it is least; none that the ends cut off."""
    inside = (slips.top > window) & (slips.bottom < value.size - 1 - window)
    mean, reach = averaged(value, window), window // 2
    nearby = np.arange(-reach, reach + 1)
    top, bottom = slips.top[inside], slips.bottom[inside]
    if reach and top.size:
        top = top + nearby[np.argmax(mean[top[:, None] + nearby], axis=1)]
        bottom = bottom + nearby[np.argmin(mean[bottom[:, None] + nearby], axis=1)]
    falling = bottom > top
    return Falls(top[falling], bottom[falling])


def steep_lasts(value: FloatArray, slips: Falls, window: int) -> FloatArray:
    """How many samples each fall lasts, from its steep part; what a running mean adds to it is taken off."""
    width = window // 2 | 1
    mean = averaged(value, width)
    lasts = (crossing(mean, slips, 0.9) - crossing(mean, slips, 0.1)) / TEN_TO_NINETY
    return np.asarray(np.sqrt(np.maximum(lasts**2 - (width**2 - 1.0) / 12.0, 1.0)))


def running_width(lasts: FloatArray) -> int:
    """Running medians for falls that last so many samples."""
    return max(0, int(_RESOLVED * float(np.median(lasts)))) | 1
