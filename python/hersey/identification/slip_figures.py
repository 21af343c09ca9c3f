"""Figures of each slip: where it lies, how deep and how long it is, the lap to the next, the rise between."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hersey.arrays import FloatArray
from hersey.identification.detection import Found, steep_lasts
from hersey.identification.sampling import Samples
from hersey.identification.slip_shape import SHARE
from hersey.identification.turning_points import Falls, crossing, curved, smoothed
from hersey.log.neighbours import runs_of_true

#: Rises of which the slope is taken, at most, spread over the trace.
_RISES = 4000


class SlipFigures(NamedTuple):
    """One value per slip; ``period`` one per pair with no gap between, ``slope`` of so many rises at most.

    ``middle`` (from the first sample), ``duration``, ``steep`` and ``period`` in s, ``slope`` per s.
    """

    middle: FloatArray
    high: FloatArray
    low: FloatArray
    duration: FloatArray
    steep: FloatArray
    period: FloatArray
    slope: FloatArray

    @property
    def drop(self) -> FloatArray:
        """Fall of the force in each slip."""
        return self.high - self.low


def slip_figures(samples: Samples, found: Found) -> SlipFigures:
    """Return the figures of all falls that no gap hides part of."""
    value, slips, window = samples.value, found.slips, found.window
    bridged = np.concatenate([[0], np.cumsum(_long(samples.bridged, window))])
    complete = bridged[slips.bottom] == bridged[slips.top]
    top, bottom = slips.top[complete], slips.bottom[complete]
    kept = Falls(top, bottom)
    middle = crossing(smoothed(value, window), kept, 0.5) if top.size else np.empty(0)
    lasts = steep_lasts(value, kept, window) if top.size else np.empty(0)
    pair = (bridged[bottom[1:]] == bridged[top[:-1]]) & (top[1:] > bottom[:-1] + 1)
    pair &= np.searchsorted(slips.top, top[1:]) - np.searchsorted(slips.top, top[:-1]) == 1
    crown = curved(value, window)
    return SlipFigures(
        samples.interval * middle,
        crown[top],
        crown[bottom],
        (bottom - top) * samples.interval,
        lasts * samples.interval,
        np.diff(middle)[pair] * samples.interval,
        _rise_slopes(samples, bottom[:-1][pair], top[1:][pair]),
    )


def _long(bridged: NDArray[np.bool_], window: int) -> NDArray[np.bool_]:
    """Gaps longer than what resolves a fall; a straight line across a shorter one does no harm."""
    long_gaps = np.zeros(bridged.size, dtype=bool)
    for first, last in runs_of_true(bridged):
        long_gaps[first:last] = last - first > window
    return long_gaps


def _rise_slopes(samples: Samples, bottom: np.ndarray, top: np.ndarray) -> FloatArray:
    """Slope of the steepest part of each rise, per s: the greatest of lines through `SHARE` of it."""
    if bottom.size > _RISES:
        spread = np.linspace(0, bottom.size - 1, _RISES).astype(int)
        bottom, top = bottom[spread], top[spread]
    slopes = [_steepest(samples.value[i : j + 1]) for i, j in zip(bottom.tolist(), top.tolist(), strict=True)]
    return np.array(slopes) / samples.interval


def _steepest(rise: FloatArray) -> float:
    width = max(2, int(SHARE * rise.size))
    lever = np.arange(width) - 0.5 * (width - 1)
    if rise.size * width < 20_000:
        fitted = np.correlate(rise, lever, "valid") / float(lever @ lever)
        return float(np.max(fitted))
    shifted = rise - rise[0]
    sums = np.concatenate([[0.0], np.cumsum(shifted)])
    moments = np.concatenate([[0.0], np.cumsum(shifted * np.arange(rise.size))])
    first = np.arange(rise.size - width + 1)
    total, moment = sums[first + width] - sums[first], moments[first + width] - moments[first]
    return float(np.max((moment - (first + 0.5 * (width - 1)) * total) / float(lever @ lever)))
