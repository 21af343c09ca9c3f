"""Finding slips: falls of the force beyond noise, with a running median that suits them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from hersey.arrays import FloatArray
from hersey.identification.sampling import Samples
from hersey.identification.slip_shape import TEN_TO_NINETY
from hersey.identification.turning_points import Falls, averaged, crossing, falls, least_turn, smoothed

#: Fewer falls are no cycle.
FEWEST_SLIPS = 3
#: Fewer falls show no rhythm that chance could not make; falls greater by this are tried in each step.
FEWEST_OF_RHYTHM = 9
_STEP = 1.4
#: Running medians are taken over this share of a fall: it stays a fall, and most of the noise goes.
_RESOLVED = 0.44
#: Great falls may take a median this many times as wide as all falls do: what lasts longer is no slip.
_WIDER = 2.0
#: Widest running median with which falls are looked for first, in samples.
_WIDEST = 85


class Found(NamedTuple):
    """Falls, the least that is counted, and the width in samples of the running median that found them."""

    slips: Falls
    least: float
    window: int


def beyond_noise(samples: Samples) -> Found:
    """Return all falls beyond noise.

    They are looked for with the narrowest running median that shows any, then with one that fits.
    """
    value, size = samples.value, samples.value.size
    window, found = 1, Found(Falls(np.empty(0, np.intp), np.empty(0, np.intp)), 0.0, 1)
    widest = min(_WIDEST, max(1, size // 20))
    while window <= widest:
        least = least_turn(samples.noise, size, window)
        found = Found(falls(smoothed(value, window), least), least, window)
        if found.slips.top.size >= FEWEST_SLIPS:
            break
        window = 4 * window + 1
    return _fitted(samples, found)


def of_at_least(samples: Samples, found: Found, least_drop: float) -> Found:
    """Return the falls of at least so much; smaller ones part none."""
    slips = falls(smoothed(samples.value, found.window), least_drop)
    return _fitted(samples, Found(slips, least_drop, found.window), least_drop, _WIDER * found.window)


def of_one_rhythm(samples: Samples, found: Found, regular: Callable[[FloatArray], bool]) -> Found | None:
    """Return the least falls that follow each other regularly, of those greater than the noise's; or None.

    Noise that is slower than the sampling makes falls of its own, beyond what is white: a belt that swings
    or sticks beneath them shows in the greater ones.
    """
    smooth = smoothed(samples.value, found.window)
    least, span = _STEP * found.least, float(np.ptp(smooth))
    while 0 < least < span:
        slips = falls(smooth, least)
        if slips.top.size < FEWEST_OF_RHYTHM:
            return None
        if regular(np.diff(crossing(smooth, slips, 0.5))):
            return _with_rhythm(samples, Found(slips, least, found.window))
        least *= _STEP
    return None


def _with_rhythm(samples: Samples, found: Found) -> Found:
    """Falls of half the typical one or more, under a running median that takes their jitter off."""
    window = running_width(steep_lasts(samples.value, found.slips, found.window))
    smooth = smoothed(samples.value, window)
    least = 0.5 * float(np.median(smooth[found.slips.top] - smooth[found.slips.bottom]))
    return Found(_refined(samples.value, falls(smooth, least), window), least, window)


def _fitted(samples: Samples, found: Found, least_drop: float = 0.0, widest: float = np.inf) -> Found:
    """The same falls with a running median that fits them."""
    value = samples.value
    for _ in range(2):
        if found.slips.top.size < FEWEST_SLIPS:
            break
        window = running_width(steep_lasts(value, found.slips, found.window))
        if window > widest:
            break
        least = max(least_turn(samples.noise, value.size, window), least_drop)
        found = Found(falls(smoothed(value, window), least), least, window)
    return found._replace(slips=_refined(value, found.slips, found.window))


def _refined(value: FloatArray, slips: Falls, window: int) -> Falls:
    """Falls from where the running mean is greatest to where it is least; none that the ends cut off."""
    inside = (slips.top > window) & (slips.bottom < value.size - 1 - window)
    mean, half_window = averaged(value, window), window // 2
    nearby = np.arange(-half_window, half_window + 1)
    top, bottom = slips.top[inside], slips.bottom[inside]
    if half_window and top.size:
        top = top + nearby[np.argmax(mean[top[:, None] + nearby], axis=1)]
        bottom = bottom + nearby[np.argmin(mean[bottom[:, None] + nearby], axis=1)]
    falling = bottom > top
    return Falls(top[falling], bottom[falling])


def steep_lasts(value: FloatArray, slips: Falls, window: int) -> FloatArray:
    """How many samples each fall lasts, from its steep part; what a running mean adds to it is subtracted."""
    width = window // 2 | 1
    mean = averaged(value, width)
    lasts = (crossing(mean, slips, 0.9) - crossing(mean, slips, 0.1)) / TEN_TO_NINETY
    return np.asarray(np.sqrt(np.maximum(lasts**2 - (width**2 - 1.0) / 12.0, 1.0)))


def running_width(lasts: FloatArray) -> int:
    """Running medians for falls that last so many samples."""
    return max(0, int(_RESOLVED * float(np.median(lasts)))) | 1
