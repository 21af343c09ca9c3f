"""Noise within a dwell: the standard error of a mean where neighbours are correlated."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.long_arrays import blocks, mean

#: Samples to which a dwell is averaged before its drift and autocorrelation are computed.
THINNED = 10_000
#: Samples that are averaged at once.
AT_ONCE = 1 << 17


def thinned(values: FloatArray) -> FloatArray:
    """Means over blocks, so many that a dwell has at most about `THINNED` of them."""
    return means_of_whole(values, max(1, values.size // THINNED))


def means_of_whole(values: FloatArray, size: int) -> FloatArray:
    """Means of so many samples each; those at the end that are fewer are left out."""
    rows = values.size // size * size
    if size == 1 or not rows:
        return values[:rows]
    parts = blocks(rows, values, size=max(1, AT_ONCE // size) * size)
    return np.concatenate([values[part].reshape(-1, size).mean(axis=1) for part in parts])


def mean_and_error(values: FloatArray) -> tuple[float, float, float]:
    """Return mean, standard error of the mean and number of independent samples of a stationary series.

    The integrated autocorrelation time is summed up to the first lag of five times itself (Sokal).
    """
    series = thinned(values)
    count = series.size
    centred = series - series.mean()
    variance = float(np.sum(centred * centred)) / max(count - 1, 1)
    if variance <= 1e-30 * mean(values) ** 2:
        return mean(values), 0.0, float(count)
    length = 1 << (2 * count - 1).bit_length()
    spectrum = np.fft.rfft(centred, length)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2, length)[:count]
    times = 2.0 * np.cumsum(correlation / correlation[0]) - 1.0
    window = int(np.argmax(np.arange(count) >= 5.0 * np.maximum(times, 1.0)))
    # a finite series underestimates: Wolff, Comput. Phys. Commun. 156 (2004) 143, and its variance too
    time = min(max(1.0, float(times[window])) * (1.0 + (2.0 * window + 1.0) / count), count / 2)
    error = float(np.sqrt(variance * time / (count - time)))
    return mean(values), error, count / time
