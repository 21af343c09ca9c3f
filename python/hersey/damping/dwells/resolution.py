"""The error that rounding to the step of a sensor leaves in the mean of a dwell.

Noise of half a step or more makes readings flip between steps, and their mean is then nearly free of
rounding. A quiet reading stays on one step however long it is averaged: its error is uniform over that step.
In between, the error is a sum of sines of the true value, each damped by the noise (Widrow and Kollar,
Quantization Noise, 2008).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import SAME_SPEED
from hersey.log.counters import quantisation_step
from hersey.log.long_arrays import let_go, variance

#: Temperatures closer than this are the same, K.
SAME_TEMPERATURE = 1.0
#: Rows of each dwell in which steps are looked for.
MOST_ROWS = 2_000
#: Dwells of one constant reading each show a step if their levels are fewer than this share of them.
SHARED_LEVELS, FEWEST_DWELLS = 0.5, 8
#: Sines of the rounding error that are summed; the rest is below 1 % of it.
_SINES = np.arange(1.0, 65.0)


@dataclass(frozen=True)
class Resolution:
    """Step of a quantity, SI, and the standard error that it leaves in each dwell, shape (points,).

    Dwells at one speed and temperature repeat their rounding error: theirs is widened so that their mean
    keeps it.
    """

    quantity: str  #: ``torque``, ``speed`` or ``temperature``
    step: float  #: the coarsest of all runs
    errors: FloatArray


def step_of(dwells: Sequence[FloatArray]) -> float:
    """Return the step in which the readings of several dwells count, 0 if they show none.

    Constant readings alone may be set points: they show a step only if many dwells read the same.
    """
    parts = []
    for each in dwells:
        if each.size:
            parts.append(each[:MOST_ROWS].copy())
            let_go(each)
    if not parts:
        return 0.0
    pooled = np.concatenate(parts)
    flips = any(np.any(part != part[0]) for part in parts)
    shared = len(parts) >= FEWEST_DWELLS and np.unique(pooled).size <= SHARED_LEVELS * len(parts)
    return (quantisation_step(pooled) or 0.0) if flips or shared else 0.0


def repeats(speed: FloatArray, temperature: FloatArray | None) -> FloatArray:
    """Return how many dwells, itself included, have the speed and temperature of each dwell."""
    log_speed = np.log(np.abs(speed))
    same = np.abs(log_speed[:, None] - log_speed[None, :]) <= SAME_SPEED
    same &= speed[:, None] * speed[None, :] > 0.0
    if temperature is not None:
        same &= np.abs(temperature[:, None] - temperature[None, :]) <= SAME_TEMPERATURE
    return np.asarray(np.count_nonzero(same, axis=1), dtype=np.float64)


def rounding_error(values: FloatArray, step: float) -> float:
    """Return the standard error that rounding to a step leaves in the mean of values."""
    if not step or not values.size:
        return 0.0
    blur = max(variance(values) / step**2 - 1.0 / 12.0, 0.0)  # variance before rounding, in steps
    damped = np.exp(-4.0 * np.pi**2 * _SINES**2 * blur) / (2.0 * np.pi**2 * _SINES**2)
    return step * float(np.sqrt(np.sum(damped)))
