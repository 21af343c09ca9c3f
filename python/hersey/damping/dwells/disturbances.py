"""What spoils a dwell that would be steady without it: spikes of the sensor, or a periodic ripple.

Nothing is subtracted here: a dwell that is lost stays lost, and the reason names the cause.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hersey.arrays import FloatArray
from hersey.damping.dwells.noise import thinned
from hersey.log.long_arrays import blocks

#: Rows over which the median of the neighbourhood is taken: a spike lasts two of them at most.
_SURROUNDINGS = 5
#: A spike departs from that median by so many deviations of the noise, and by this share of the mean.
_BEYOND, _NOTABLE = 8.0, 0.1
#: What departs in a larger share of the rows is no spike.
_RARE = 0.03
#: Median absolute deviation of a normal variable of deviation 1.
_MAD = 0.6744897501960817
#: A ripple has so many periods in a dwell at least, and so many rows in a period.
_PERIODS, _ROWS = 2.0, 4.0
#: Harmonics of a ripple that are fitted, and the share of the scatter that these must explain.
_HARMONICS, _EXPLAINED = 4, 0.5


@dataclass(frozen=True)
class Spikes:
    """Samples that lie apart: how many, and their median distance, N m."""

    count: int
    size: float


@dataclass(frozen=True)
class Wave:
    """A ripple: its frequency, Hz, and its amplitude, half of what it spans, N m."""

    frequency: float
    amplitude: float


def without_spikes(torque: FloatArray) -> tuple[FloatArray, Spikes] | None:
    """Return torque with the median in the place of its spikes, and what they were; None without any."""
    if torque.size < _SURROUNDINGS:
        return None
    around = np.pad(torque, _SURROUNDINGS // 2, mode="symmetric")
    windows = sliding_window_view(around, _SURROUNDINGS)
    middle = np.concatenate([np.median(windows[rows], axis=1) for rows in blocks(torque.size)])
    away = np.abs(torque - middle)
    noise = float(np.median(away[away > 0])) / _MAD if np.any(away > 0) else 0.0
    spiky = away > max(_BEYOND * noise, _NOTABLE * abs(float(np.median(torque))))
    count = int(np.count_nonzero(spiky))
    if not 0 < count <= _RARE * torque.size:
        return None
    return np.where(spiky, middle, torque), Spikes(count, float(np.median(away[spiky])))


def without_wave(time: FloatArray, torque: FloatArray) -> tuple[FloatArray, Wave] | None:
    """Return torque without its strongest ripple, mean and line kept, and what it was; None without one."""
    lasts = float(time[-1] - time[0])
    if torque.size < _PERIODS * _ROWS or lasts <= 0.0:
        return None
    since = time - time[0]
    at, means = thinned(since), thinned(torque)
    frequency = _strongest(means, float(at[-1] - at[0]) / (at.size - 1), lasts)
    if frequency is None:
        return None
    frequency = _refined(at, means, frequency, 1.0 / lasts)
    fitted, left = _fitted(since, torque, frequency)
    plain = torque - np.polyval(np.polyfit(since, torque, 1), since)
    if float(np.sum(left**2)) > (1.0 - _EXPLAINED) * float(np.sum(plain**2)):
        return None
    return torque - fitted, Wave(frequency, 0.5 * float(np.ptp(fitted)))


def _strongest(torque: FloatArray, interval: float, lasts: float) -> float | None:
    """The frequency with the most power, Hz, of those that a dwell shows."""
    steps = np.arange(torque.size)
    plain = torque - np.polyval(np.polyfit(steps, torque, 1), steps)
    length = 4 * (1 << (torque.size - 1).bit_length())
    power = np.abs(np.fft.rfft(plain * np.hanning(plain.size), length)) ** 2
    frequencies = np.fft.rfftfreq(length, interval)
    shown = (frequencies >= _PERIODS / lasts) & (frequencies <= 1.0 / (_ROWS * interval))
    if not shown.any() or not power[shown].any():
        return None
    return float(frequencies[shown][np.argmax(power[shown])])


def _refined(since: FloatArray, torque: FloatArray, frequency: float, width: float) -> float:
    """The frequency at which the ripple fits best, within a quarter of what the dwell resolves."""
    tried = frequency + 0.25 * width * np.linspace(-1.0, 1.0, 9)
    left = [float(np.sum(_fitted(since, torque, float(f))[1] ** 2)) for f in tried]
    return float(tried[int(np.argmin(left))])


def _fitted(since: FloatArray, torque: FloatArray, frequency: float) -> tuple[FloatArray, FloatArray]:
    """The ripple of a frequency with its harmonics, and what it and a line leave."""
    angle = 2.0 * np.pi * frequency * since
    waves = [wave(k * angle) for k in range(1, _HARMONICS + 1) for wave in (np.cos, np.sin)]
    columns = np.column_stack([np.ones_like(since), since, *waves])
    sizes = np.linalg.lstsq(columns, torque, rcond=None)[0]
    ripple = columns[:, 2:] @ sizes[2:]
    return np.asarray(ripple), np.asarray(torque - columns @ sizes)
