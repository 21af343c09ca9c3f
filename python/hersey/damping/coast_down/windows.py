"""Friction in windows of speed: points that share no row, so that their errors are independent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.coast_down.departures import deceleration
from hersey.damping.coast_down.fitting import CoastFit, Trace, whole

#: Error of the torque of a window that is enough, and the most that is of use, as shares.
_ENOUGH, _MOST = 0.02, 0.3
#: Ratio of the speeds at the ends of a window, at least and where rows are few at the most.
_NARROWEST, _WIDEST = 1.12, 2.5
#: Rows of a window at the least.
_FEWEST = 8
#: Rows by which the variance of the whole counts beside that of a window.
_WHOLE = 10.0


@dataclass(frozen=True)
class Window:
    """Rows of a coast: speed, rad/s, and deceleration, rad/s^2, with its standard error."""

    coast: int
    start: int
    end: int
    speed: float
    speed_error: float
    rate: float
    rate_error: float


def windows_of(fit: CoastFit) -> list[Window]:
    """Return the friction in windows of speed of each coast, fastest first."""
    found = []
    for index, trace in enumerate(fit.traces):
        speed = fit.predicted(index, trace.time)
        start = 0
        while start < speed.size - _FEWEST:
            end, window = start + _FEWEST, None
            narrow = int(np.searchsorted(-speed, -speed[start] / _NARROWEST))
            end = max(end, narrow)
            while end <= speed.size:
                window = _measured(fit, index, trace, speed, start, end)
                if window.rate_error <= _ENOUGH * window.rate or speed[start] > _WIDEST * speed[end - 1]:
                    break
                if end == speed.size:
                    break
                end = min(speed.size, end + max(1, (end - start) // 8))
            if window is None:
                break
            if window.rate_error <= _MOST * window.rate:
                found.append(window)
            start = window.end
    return found


def _measured(fit: CoastFit, index: int, trace: Trace, speed: FloatArray, start: int, end: int) -> Window:
    """How much more or less a window is slowed than by the law of all."""
    rows = slice(start, end)
    rate = deceleration(fit.law, speed[rows])
    time = trace.time[rows]
    middle = float(time.mean())
    part = Trace(time, trace.speed[rows])
    columns = np.stack([rate, -rate * (time - middle)], axis=-1)
    left = (trace.speed[rows] - speed[rows])[:, None]
    if fit.of_angle:
        summed = whole(np.hstack([columns, left]), part, of_angle=True)
        columns, left = summed[:, :2], summed[:, 2:]
    information = np.linalg.pinv(columns.T @ columns, hermitian=True)
    shift = information @ columns.T @ left[:, 0]
    rest = left[:, 0] - columns @ shift
    noise = fit.noise
    variance = (float(rest @ rest) + _WHOLE * noise.variance) / (max(end - start - 3, 0) + _WHOLE)
    spread = max(1.0, noise.rows / noise.effective_rows)
    error = float(np.sqrt(variance * spread * information[1, 1]))
    mean = float(speed[rows].mean() + shift[0] * rate.mean())
    level = float(deceleration(fit.law, np.full(1, mean))[0])
    of_speed = float(np.sqrt(variance * spread / (end - start))) if not fit.of_angle else 0.0
    return Window(index, start, end, mean, of_speed, level * (1.0 + float(shift[1])), level * error)
