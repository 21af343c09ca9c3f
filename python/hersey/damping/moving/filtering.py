"""One low-pass for torque, speed and acceleration alike, so that no linear term is biased by it.

Each equation is the model weighted with a Hann window of standard deviation ``width``; acceleration is the
speed differenced over five rows and weighted with the same window, and friction is evaluated before it is
weighted. Power is halved at 0.13 / width.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.moving.stretches import FIRST, Stretch

#: Half the length of a Hann window in its standard deviations.
REACH = float(1.0 / np.sqrt(1.0 / 3.0 - 2.0 / np.pi**2))
#: Standard deviations between two equations.
APART = 2.0
#: Width in s times the frequency in Hz at which the power of the window is halved.
HALF_POWER = 0.1303
#: Second difference over five rows, exact up to the fourth power.
_SECOND = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / 12.0


@dataclass(frozen=True)
class LowPass:
    """A Hann window over rows of one interval."""

    width: float  #: standard deviation, s
    interval: float  #: s

    @property
    def bandwidth(self) -> float:
        """Frequency at which power is halved, Hz."""
        return HALF_POWER / self.width

    @property
    def step(self) -> int:
        """Rows between two equations."""
        return max(1, round(APART * self.width / self.interval))

    @cached_property
    def weights(self) -> FloatArray:
        """Weights of the mean; those of two rows at each end are 0."""
        inside = self.half - 2
        at = np.arange(-inside, inside + 1)
        raw = np.pad(1.0 + np.cos(np.pi * at / (inside + 1)), 2)
        return np.asarray(raw / raw.sum())

    @cached_property
    def slope(self) -> FloatArray:
        """Weights of the mean derivative."""
        return np.convolve(self.weights, FIRST, "same") / self.interval

    @cached_property
    def bend(self) -> FloatArray:
        """Weights of the mean second derivative."""
        return np.convolve(self.weights, _SECOND, "same") / self.interval**2

    @cached_property
    def smoother(self) -> FloatArray:
        """Weights of a mean that keeps parabolas and cubics as they are (twicing)."""
        twice = -np.convolve(self.weights, self.weights)
        half = self.half
        twice[half:-half] += 2.0 * self.weights
        return twice

    @property
    def length(self) -> float:
        """Time that the window spans, s."""
        return 2.0 * REACH * self.width

    @property
    def half(self) -> int:
        """Rows on each side of the middle."""
        return max(2, round(REACH * self.width / self.interval)) + 1


@dataclass(frozen=True)
class Filtered:
    """A stretch behind a low-pass: rows that lie within it, and the equations made of them.

    Rows: arrays of shape (rows,); equations: of shape (equations,).
    """

    low_pass: LowPass
    stretch: Stretch
    first: int  #: row of the stretch at which the rows here begin
    raw: FloatArray  #: speed as read, rad/s
    speed: FloatArray  #: speed without its noise, rad/s
    rate: FloatArray  #: its derivative, rad/s2

    @classmethod
    def of(cls, stretch: Stretch, low_pass: LowPass) -> Filtered | None:
        """Return the stretch behind the low-pass, or None if it is too short."""
        edge = 2 * low_pass.half
        if stretch.speed.size < 2 * edge + 2 * low_pass.half + low_pass.step:
            return None
        speed = np.convolve(stretch.speed, low_pass.smoother, "valid")
        rate = np.gradient(speed, low_pass.interval)
        return cls(low_pass, stretch, edge, stretch.speed[edge:-edge], speed, rate)

    def weighted(self, rows: FloatArray, weights: FloatArray | None = None) -> FloatArray:
        """Return rows, shape (rows, ...), weighted about the middle of each equation."""
        kernel = self.low_pass.weights if weights is None else weights
        windows = np.lib.stride_tricks.sliding_window_view(rows, kernel.size, axis=0)
        return np.asarray(windows[:: self.low_pass.step] @ kernel)

    @cached_property
    def torque(self) -> FloatArray:
        """Torque of each equation, N m."""
        return self.weighted(self._inner(self.stretch.torque))

    @cached_property
    def mean_speed(self) -> FloatArray:
        """Speed of each equation, rad/s."""
        return self.weighted(self.raw)

    @cached_property
    def acceleration(self) -> FloatArray:
        """Acceleration of each equation, rad/s2."""
        return self.weighted(self.raw, self.low_pass.slope)

    @cached_property
    def jerk(self) -> FloatArray:
        """Its derivative, of the speed without noise, rad/s3."""
        return self.weighted(self.speed, self.low_pass.bend)

    @cached_property
    def temperature(self) -> FloatArray | None:
        """Temperature of each row, K."""
        return None if self.stretch.temperature is None else self._inner(self.stretch.temperature)

    @cached_property
    def gravity(self) -> FloatArray:
        """Cosine and sine of the angle of each row, shape (rows, 2)."""
        assert self.stretch.angle is not None
        angle = self._inner(self.stretch.angle)
        return np.column_stack([np.cos(angle), np.sin(angle)])

    @cached_property
    def time(self) -> FloatArray:
        """Time of the middle of each equation, s."""
        return self._inner(self.stretch.time)[self.low_pass.half : -self.low_pass.half][:: self.low_pass.step]

    def turning(self, least: float) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Return whether the drive turns one way, faster than ``least`` (rad/s), all through an equation."""
        signs = np.where(np.abs(self.speed) >= least, np.sign(self.speed), 0.0)
        count = 2 * self.low_pass.half + 1
        summed = np.concatenate([[0.0], np.cumsum(signs)])
        through = np.abs(summed[count:] - summed[:-count]) == count
        return np.asarray(through[:: self.low_pass.step])

    def _inner(self, values: FloatArray) -> FloatArray:
        return values[self.first : -self.first]
