"""A trace on even times: gaps bridged and marked, spikes removed, noise measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError

#: Fewest samples in which a cycle could be seen three times.
FEWEST = 30
#: Samples farther apart than this many sampling intervals are a gap.
GAP = 1.5
#: A grid may have this many times the samples that were given.
_SPARSEST = 5.0
#: A spike departs from the median of its surroundings by this many deviations of the noise,
_SPIKE = 6.0
#: and by this share of the range: what is smaller does no harm, and may be a corner of the force.
_VISIBLE = 0.02
#: Samples on which that median is taken: a spike lasts for two at most.
_SURROUNDINGS = 5
#: What departs more often than this is no spike.
_RARE = 0.03
#: Median absolute deviation of a normal variable of deviation 1.
_MAD = 0.6744897501960817


@dataclass(frozen=True)
class Samples:
    """A trace at equal intervals, s; ``bridged`` marks samples interpolated across a gap.

    ``noise`` is the standard deviation of what no neighbour explains, ``spikes`` the number of samples
    replaced.
    """

    start: float
    interval: float
    value: FloatArray
    bridged: NDArray[np.bool_]
    noise: float
    spikes: int
    missing: int

    @property
    def time(self) -> FloatArray:
        """Time of each sample, s."""
        return np.asarray(self.start + self.interval * np.arange(self.value.size), dtype=float)


def even_samples(time: ArrayLike, value: ArrayLike, *, name: str = "force") -> Samples:
    """Return a trace on even times.

    A ``value`` that is not a number is a missing sample. Times must ascend.

    Raises
    ------
    ParameterError
        If shapes differ or times do not ascend, with the first such sample.
    InsufficientDataError
        If there are too few samples, or gaps are most of the trace.
    """
    times, values = np.asarray(time, dtype=float), np.asarray(value, dtype=float)
    if times.ndim != 1 or times.shape != values.shape:
        raise ParameterError(
            f"time has shape {times.shape}, but {name} has {values.shape}. Give equal lengths"
        )
    if not np.all(np.isfinite(times)):
        raise ParameterError(f"time of sample {int(np.argmin(np.isfinite(times)))} is not a number")
    finite = np.isfinite(values)
    finite_times, finite_values = times[finite], values[finite]
    if finite_values.size < FEWEST:
        raise InsufficientDataError(
            f"{name} has {finite_values.size} samples; at least {FEWEST} are needed to find a cycle"
        )
    steps = np.diff(finite_times)
    if not np.all(steps > 0):
        raise ParameterError(f"time does not ascend at sample {int(np.argmin(np.diff(times) > 0)) + 1}")
    interval = float(np.median(steps))
    count = round(float(finite_times[-1] - finite_times[0]) / interval) + 1
    if count > _SPARSEST * finite_values.size:
        raise InsufficientDataError(
            f"most of the trace is missing: {finite_values.size} samples at {interval:g} s cover "
            f"{interval * finite_values.size:g} s of {finite_times[-1] - finite_times[0]:g} s"
        )
    grid = finite_times[0] + interval * np.arange(count)
    if count == finite_values.size and np.all(np.abs(finite_times - grid) < 0.05 * interval):
        even, bridged = finite_values.copy(), np.zeros(count, dtype=bool)
    else:
        even = np.interp(grid, finite_times, finite_values)
        bridged = _bridged(grid, finite_times, interval)
    even, spikes = _despiked(even, _noise(even))
    missing = max(int(np.sum(bridged)), int(np.sum(~finite)))
    return Samples(float(finite_times[0]), interval, even, bridged, _noise(even), spikes, missing)


def _bridged(grid: FloatArray, times: FloatArray, interval: float) -> NDArray[np.bool_]:
    after = np.clip(np.searchsorted(times, grid), 1, times.size - 1)
    wide = times[after] - times[after - 1] > GAP * interval
    to_nearest = np.minimum(np.abs(grid - times[after - 1]), np.abs(times[after] - grid))
    return np.asarray(wide & (to_nearest > 0.5 * interval))


def _noise(value: FloatArray) -> float:
    """Deviation of white noise, from differences of order 2 to 4: what is smooth cancels in one of them."""
    deviations: list[float] = []
    difference = np.diff(value)
    for gain in (6.0, 20.0, 70.0):  # sum of the squares of binomial coefficients
        difference = np.diff(difference)
        deviations.append(float(np.median(np.abs(difference))) / (_MAD * gain**0.5))
    return max(min(deviations), _step(value) / float(np.sqrt(12.0)))


def _step(value: FloatArray) -> float:
    """Step of a quantised trace; 0 if it is not quantised."""
    levels = np.unique(value[: 20 * FEWEST])
    if levels.size > value[: 20 * FEWEST].size // 2:
        return 0.0
    return float(np.median(np.diff(levels))) if levels.size > 1 else 0.0


def _despiked(value: FloatArray, noise: float) -> tuple[FloatArray, int]:
    middle = ndimage.median_filter(value, _SURROUNDINGS, mode="nearest")
    low, high = np.percentile(middle, (1, 99))
    spiky = np.abs(value - middle) > max(_SPIKE * noise, _VISIBLE * float(high - low))
    number = int(np.sum(spiky))
    if number > _RARE * value.size:
        return value, 0
    return np.where(spiky, middle, value), number
