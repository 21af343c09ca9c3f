"""Noise of the speed as read, and how wide a low-pass must be so that it does not count.

Noise of a regressor biases least squares towards zero. Speed differenced from a position has noise that is
small at low frequencies; that of a tachometer is the same at all. Which it is, its correlation tells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.moving.filtering import Filtered, LowPass
from hersey.damping.moving.stretches import Stretch

#: Widths that are tried, in intervals, and the greatest as a share of the time in which speed changes.
WIDTHS = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0, 96.0)
MOST_OF_MOTION = 0.15
#: Share of the variance of the acceleration that its noise may be.
TOLERATED = 1e-4


@dataclass(frozen=True)
class SpeedNoise:
    """Noise of the rows of a speed: variance, and whether it is that of differences of a position."""

    variance: float
    differenced: bool

    def covariances(self, low_pass: LowPass) -> FloatArray:
        """Return those of the noise of the acceleration, at lags of 0, 1, ... equations, rad2/s4."""
        weights = low_pass.slope
        if self.differenced:
            weights = np.sqrt(0.5) * _differences(weights)
        lags = np.arange(0, weights.size, low_pass.step)
        return self.variance * np.array([weights[lag:] @ weights[: weights.size - lag] for lag in lags])

    def behind(self, weights: FloatArray) -> float:
        """Return the variance that is left behind a filter with these weights."""
        if not self.differenced:
            return self.variance * float(weights @ weights)
        steps = _differences(weights)
        return 0.5 * self.variance * float(steps @ steps)


def _differences(weights: FloatArray) -> FloatArray:
    """Weights of a position whose differences have these weights."""
    return np.diff(np.concatenate([[0.0], weights, [0.0]]))


def _neighbours(weights: FloatArray) -> float:
    """Correlation of neighbours of white noise behind these weights."""
    return float(weights[1:] @ weights[:-1] / (weights @ weights))


def speed_noise(stretches: Sequence[Stretch]) -> SpeedNoise:
    """Return the noise that the speed shows about its smooth course."""
    low_pass = LowPass(WIDTHS[1] * stretches[0].interval, stretches[0].interval)
    sums, count, extra = np.zeros(2), 0, -low_pass.smoother
    extra[extra.size // 2] += 1.0
    for stretch in stretches:
        if stretch.speed.size > 2 * extra.size:
            rough = np.convolve(stretch.speed, extra, "valid")
            sums += [float(rough @ rough), float(rough[1:] @ rough[:-1])]
            count += rough.size
    if not count or sums[0] == 0.0:
        return SpeedNoise(0.0, differenced=True)
    middle = 0.5 * (_neighbours(extra) + _neighbours(_differences(extra)))
    differenced = bool(sums[1] / sums[0] < middle)
    unit = SpeedNoise(1.0, differenced)
    return SpeedNoise(sums[0] / count / unit.behind(extra), differenced)


def low_pass_for(stretches: Sequence[Stretch], noise: SpeedNoise) -> LowPass | None:
    """Return the narrowest low-pass behind which noise does not count; None if rows are too few."""
    interval = stretches[0].interval
    best: tuple[float, LowPass] | None = None
    for width in WIDTHS:
        low_pass = LowPass(width * interval, interval)
        parts = [each for s in stretches if (each := Filtered.of(s, low_pass)) is not None]
        if not parts:
            break
        rate = np.concatenate([each.rate for each in parts])
        speed = np.concatenate([each.speed for each in parts])
        quick = float(np.std(speed) / max(float(np.std(rate)), 1e-300))
        if best is not None and low_pass.width > MOST_OF_MOTION * quick:
            break
        power = float(np.mean(np.concatenate([each.acceleration for each in parts]) ** 2))
        share = noise.behind(low_pass.slope) / max(power, 1e-300)
        if best is None or share < best[0]:
            best = (share, low_pass)
        if share <= TOLERATED:
            break
    return None if best is None else best[1]
