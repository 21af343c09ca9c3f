"""Torque that falls with speed as that of a motor or a brake does, and friction does not.

Friction that falls with speed levels off. A torque that falls on through zero, or whose power is the same at
all speeds, is none; nor is one that is anything at each speed, whatever the temperature.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.result import Means, Record
from hersey.units import rpm

#: Distinct speeds, and ratio of the fastest to the slowest, from which on this is judged.
_SPEEDS, _RATIO = 4, 1.5
#: Two speeds are one if they differ by less than this share.
_SAME = 0.02
#: Torque falls at each speed beyond its greatest, to less than that share of it; it would be zero below so
#: many times the fastest speed; and it does not level off: its slope at the end is that share of the mean.
_FALLEN, _ZERO, _LEVELS = 0.35, 1.35, 0.9
#: Least ratio of speeds over which a power may be called constant, and the share by which it may vary.
_OF_POWER, _VARIES = 2.0, 0.03
#: Scatter about any law, as a share of torque, and ratio of greatest to least torque at one speed, that show
#: another cause; dwells that a speed needs for that, and share of such speeds.
_SCATTERS, _APART, _DWELLS, _MOST = 0.5, 3.0, 3, 0.5


@dataclass(frozen=True)
class DrivingTorque(Record):
    """Why a torque is no friction: one of these is stated."""

    zero_speed: Annotated[float | None, Means("at which it would be zero", "rad/s")] = None
    power: Annotated[float | None, Means("the same at all speeds", "W")] = None
    ratio: Annotated[float | None, Means("typical ratio of greatest to least torque at one speed")] = None
    warm: Annotated[bool, Means("whether temperature is known, and cannot be what sets the torque")] = True

    def __str__(self) -> str:
        """Return it in words."""
        if self.ratio is not None:
            other = (
                "speed and temperature sets it, such as"
                if self.warm
                else "speed sets it, such as temperature or"
            )
            return f"Torque differs {self.ratio:.2g}-fold at one speed: something other than {other} a load"
        if self.power is not None:
            return (
                f"Torque falls as 1/speed: the power is {self.power:.4g} W at all speeds. That "
                "is the torque of a motor or a brake at constant power, not friction"
            )
        assert self.zero_speed is not None
        zero = float(f"{rpm(self.zero_speed):.3g}")
        return (
            f"Torque falls with speed and would be zero near {zero:g} rpm. That is the "
            "torque of a motor or a brake, not friction"
        )


def load_at_one_speed(
    speed: FloatArray, torque: FloatArray, scatter: float, *, warm: bool = True
) -> DrivingTorque | None:
    """Return what shows that a load sets the torque: at most speeds it differs widely; None if it does not.

    ``scatter`` is that about a law of speed and, if ``warm``, of temperature, as a share of torque.
    """
    if scatter < _SCATTERS:
        return None
    groups = [group for group in _groups(speed) if group.size >= _DWELLS]
    ratios = np.array([torque[group].max() / max(torque[group].min(), 1e-300) for group in groups])
    if ratios.size < _SPEEDS or np.mean(ratios > _APART) < _MOST:
        return None
    return DrivingTorque(ratio=float(np.median(ratios)), warm=warm)


def _groups(speed: FloatArray) -> list[IntArray]:
    """The points at each distinct speed, the slowest first."""
    order = np.argsort(speed)
    return np.split(order, np.flatnonzero(np.diff(np.log(speed[order])) > _SAME) + 1)


def driving_torque(speed: FloatArray, torque: FloatArray, error: FloatArray) -> DrivingTorque | None:
    """Return what shows that a torque is that of a motor or a brake; None if it may be friction.

    Parameters
    ----------
    speed, torque, error
        Without sign, rad/s and N m, shape (points,); ``error`` is the standard error of the torque.
    """
    groups = _groups(speed)
    w = np.array([speed[group].mean() for group in groups])
    mean = np.array([torque[group].mean() for group in groups])
    unsure = np.array([np.sqrt(np.mean(error[group] ** 2) / group.size) for group in groups])
    if w.size < _SPEEDS or w[-1] < _RATIO * w[0]:
        return None
    power = mean * w
    if w[-1] > _OF_POWER * w[0] and np.ptp(power) < _VARIES * power.mean():
        return DrivingTorque(power=float(power.mean()))
    top = int(np.argmax(mean))
    if w.size - top < 3 or mean[-1] > _FALLEN * mean[top] or np.any(np.diff(mean[top:]) > 0.0):
        return None
    slope, last = _slope(w[-3:], mean[-3:], unsure[-3:])
    overall = (mean[top] - mean[-1]) / (w[-1] - w[top])
    zero = w[-1] + mean[-1] / max(slope - 2.0 * last, 1e-300)
    if slope - 2.0 * last <= 0.0 or zero > _ZERO * w[-1] or slope < _LEVELS * overall:
        return None
    return DrivingTorque(zero_speed=float(w[-1] + mean[-1] / slope))


def _slope(w: FloatArray, mean: FloatArray, unsure: FloatArray) -> tuple[float, float]:
    """How fast torque falls over some speeds, N m s/rad, and its standard error."""
    share = (w - w.mean()) / np.sum((w - w.mean()) ** 2)
    return -float(share @ mean), float(np.sqrt(np.sum((share * unsure) ** 2)))
