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
from hersey.damping.moving.stretches import FIRST, Stretch

#: Widths that are tried, in intervals, and the greatest as a share of the time in which speed changes.
WIDTHS = (1.5, *(share * 2.0**n for n in range(1, 10) for share in (1.0, 1.5)))
MOST_OF_MOTION = 0.15
#: Share of the variance of the acceleration that its noise may be, and below which that is a motion.
TOLERATED, _BELIEVED = 1e-4, 0.1


#: How white noise makes that of a speed: it is the same; that of a position, differenced by a drive, or by
#: `stretches`.
_WHITE, _DIFFERENCED, _OF_ANGLE = (k / np.linalg.norm(k) for k in (np.ones(1), np.array([-1.0, 1.0]), FIRST))
#: Counts of a position that pass within a window, at the least, and the share of the typical speed at which
#: they may: a count that lasts longer is no noise that a mean lessens.
COUNTS, _SLOWEST = 3.0, 0.1


@dataclass(frozen=True)
class SpeedNoise:
    """Noise of the rows of a speed: variance, and the kernel that makes it of white noise (of norm 1)."""

    variance: float
    kernel: FloatArray
    step: float = 0.0  #: in which the position counts, rad

    def covariances(self, low_pass: LowPass) -> FloatArray:
        """Return those of the noise of the acceleration, at lags of 0, 1, ... equations, rad2/s4."""
        weights = np.convolve(low_pass.slope, self.kernel)
        lags = np.arange(0, weights.size, low_pass.step)
        return self.variance * np.array([weights[lag:] @ weights[: weights.size - lag] for lag in lags])

    def behind(self, weights: FloatArray) -> float:
        """Return the variance that is left behind a filter with these weights."""
        made = np.convolve(weights, self.kernel)
        return self.variance * float(made @ made)

    def least_counted(self, low_pass: LowPass) -> float:
        """Return the speed at which enough counts pass within a window, rad/s."""
        return COUNTS * self.step / low_pass.length


def _neighbours(weights: FloatArray) -> float:
    """Correlation of neighbours of white noise behind these weights."""
    return float(weights[1:] @ weights[:-1] / (weights @ weights))


def speed_noise(stretches: Sequence[Stretch], step: float = 0.0) -> SpeedNoise:
    """Return the noise that the speed shows about its smooth course; ``step`` is that of a recorded angle."""
    low_pass = LowPass(WIDTHS[1] * stretches[0].interval, stretches[0].interval)
    sums, count, extra = np.zeros(2), 0, -low_pass.smoother
    extra[extra.size // 2] += 1.0
    for stretch in stretches:
        if stretch.speed.size > 2 * extra.size:
            rough = np.convolve(stretch.speed, extra, "valid")
            sums += [float(rough @ rough), float(rough[1:] @ rough[:-1])]
            count += rough.size
    of_angle = all(each.angle is not None for each in stretches)
    if not count or sums[0] == 0.0:
        return SpeedNoise(0.0, _OF_ANGLE if of_angle else _DIFFERENCED, step)
    likely = [_neighbours(np.convolve(extra, kernel)) for kernel in (_WHITE, _DIFFERENCED)]
    kernel = _DIFFERENCED if sums[1] / sums[0] < np.mean(likely) else _WHITE
    unit = SpeedNoise(1.0, _OF_ANGLE if of_angle else kernel)
    return SpeedNoise(sums[0] / count / unit.behind(extra), unit.kernel, step)


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
        power = float(np.mean(np.concatenate([each.acceleration for each in parts]) ** 2))
        share = noise.behind(low_pass.slope) / max(power, 1e-300)
        if best is not None and low_pass.width > MOST_OF_MOTION * quick and share < _BELIEVED:
            break
        slow = noise.least_counted(low_pass) / max(_SLOWEST * float(np.std(speed)), 1e-300)
        lacking = max(share / TOLERATED, slow)
        if best is None or lacking < best[0]:
            best = (lacking, low_pass)
        if lacking <= 1.0:
            break
    return None if best is None else best[1]
