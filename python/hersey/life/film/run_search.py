"""What is most likely in each run of what is free in its torque: a damped search of all runs at once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.film.filled_dwells import FilledDwells
from hersey.life.film.starved_drag import (
    FREE,
    LAYER,
    ROUGHNESS,
    TEMPERATURE_SENSITIVITY,
    VISCOSITY,
    StarvedDrag,
)
from hersey.life.oil_layer import USUAL_SHARPNESS

#: ln of the layer over the flooded film at the reference from which on nothing starves, and the least.
FLOODED, DRY = 3.0, -4.0
#: What belongs to the machine and its oil, common to all runs: viscosity against temperature, sharpness, how
#: large rolling is and its two powers, and the power of the film. Its ends; films of rolling contacts had a
#: sharpness of 2 to 5, but the wider a contact, the more of the oil before it passes through.
COMMON = slice(TEMPERATURE_SENSITIVITY, LAYER)
COMMON_ENDS = np.array(
    [
        [-0.5, np.log(1.5 / USUAL_SHARPNESS), -3.0, -1.2, 0.0, -0.05, -0.2],
        [0.5, np.log(20.0 / USUAL_SHARPNESS), 4.0, 0.6, 6.0, 0.05, 1.2],
    ]
)
#: What is free: all, all but the layer, and what each run has of its own.
ALL = np.arange(FREE)
ALL_BUT_LAYER = ALL[:LAYER]
OWN = np.delete(ALL, COMMON)
#: Layers from which the search begins, and its steps.
_STARTS = (2.5, 1.0, 0.2, -0.5, -1.1, -1.8, -2.6)
_STEPS = 12
#: No torque is taken as known better than these shares of it, and of the greatest of its run.
_RESOLUTION = (0.003, 0.001)
#: Share of the torque of asperities by which their law may be off.
_OF_RUBBING = 0.6


@dataclass(frozen=True)
class Search:
    """Least squares over the dwells and what is known beforehand, by damped steps (Levenberg 1944)."""

    drag: StarvedDrag
    dwells: FilledDwells
    mean: FloatArray
    prior: FloatArray

    @property
    def freedom(self) -> FloatArray:
        """Degrees of freedom of each run."""
        # What is common to all runs costs none of one.
        return np.asarray(np.maximum(self.dwells.given.sum(axis=1) - OWN.size, 1.0))

    def searched(self, steps: int = _STEPS, of: IntArray = ALL) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what is most likely from any start, its squares and their curvature."""
        free = self.start(0.0)
        cost = np.full(len(free), np.inf)
        for layer in _STARTS:
            trial, found, _ = self.settled(self.start(layer), steps=3, of=of[of != LAYER])
            free = np.where((found < cost)[:, None], trial, free)
            cost = np.minimum(found, cost)
        return self.settled(free, steps=steps, of=of)

    @cached_property
    def _weight(self) -> FloatArray:
        dwells = self.dwells
        greatest = np.where(dwells.given, dwells.torque, 0.0).max(axis=1, keepdims=True)
        of_own, of_greatest = _RESOLUTION
        rubbing = _OF_RUBBING * self.drag.rubbing()
        square = dwells.error**2 + (of_own * dwells.torque) ** 2 + (of_greatest * greatest) ** 2
        error = np.sqrt(square + rubbing**2)
        return np.where(dwells.given, 1.0 / error, 0.0)

    def without_common(self) -> Search:
        """Return it with nothing known beforehand of what is common to all runs."""
        prior = self.prior.copy()
        prior[:, COMMON, COMMON] = 0.0
        return replace(self, prior=prior)

    def with_common(self, common: FloatArray) -> Search:
        """Return it with starts that have in common what is given."""
        mean = self.mean.copy()
        mean[:, COMMON] = common
        return replace(self, mean=mean)

    def start(self, layer: float) -> FloatArray:
        """Return what is known beforehand, with a layer."""
        free = self.mean.copy()
        free[:, LAYER] = layer
        return free

    def moved(self, free: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return squares, their slope downwards and curvature at what is free."""
        torque, slopes = self.drag.torque(free)
        weight = self._weight
        left = weight * (self.dwells.torque - torque)
        slopes *= weight[:, None]
        away = self.mean - free
        pulled = np.matmul(self.prior, away[..., None])[..., 0]
        square = (left**2).sum(axis=1) + (away * pulled).sum(axis=1)
        gradient = np.matmul(slopes, left[..., None])[..., 0] + pulled
        return square, gradient, np.matmul(slopes, slopes.transpose(0, 2, 1)) + self.prior

    def settled(
        self, free: FloatArray, *, steps: int, of: IntArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what is most likely from a start on, some of it free; squares and curvature."""
        inner, block = np.arange(of.size), np.ix_(np.arange(len(free)), of, of)
        best = free
        least, gradient, curvature = self.moved(free)
        damping = np.full(len(free), 1e-4)
        for _ in range(steps):
            damped = curvature[block]
            damped[:, inner, inner] *= 1.0 + damping[:, None]
            step = np.zeros_like(best)
            step[:, of] = np.linalg.solve(damped, gradient[:, of, None])[..., 0]
            trial = within(best, step)
            square, *moved = self.moved(trial)
            better = square < least
            best = np.where(better[:, None], trial, best)
            least = np.minimum(square, least)
            gradient = np.where(better[:, None], moved[0], gradient)
            curvature = np.where(better[:, None, None], moved[1], curvature)
            damping = np.clip(np.where(better, 0.1 * damping, 100.0 * damping), 1e-9, 1e6)
        return best, least, curvature


def within(free: FloatArray, step: FloatArray) -> FloatArray:
    """Return what is free after a step, which is not too long and keeps to the ends."""
    trial = free + step
    trial[:, VISCOSITY] = np.clip(trial[:, VISCOSITY], *_near(free[:, VISCOSITY], 0.7, -3.0, 5.0))
    trial[:, LAYER] = np.clip(trial[:, LAYER], *_near(free[:, LAYER], 0.5, DRY, FLOODED))
    inner = slice(ROUGHNESS, TEMPERATURE_SENSITIVITY)
    trial[:, inner] = np.clip(trial[:, inner], -2.0, 2.0)
    trial[:, COMMON] = np.clip(trial[:, COMMON], *COMMON_ENDS)
    return trial


def _near(at: FloatArray, stride: float, low: float, high: float) -> tuple[FloatArray, FloatArray]:
    """Ends of one step."""
    return np.maximum(at - stride, low), np.minimum(at + stride, high)
