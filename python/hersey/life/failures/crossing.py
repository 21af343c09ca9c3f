"""Where functions pass 0, many at once: the Illinois method (Dowell and Jarratt, BIT 11, 1971)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hersey.arrays import FloatArray

#: Evaluations at the most, and how near two ends may be.
_MOST, _SETTLED = 60, 1e-10


def crossing(of: Callable[[FloatArray], FloatArray], near: FloatArray, far: FloatArray) -> FloatArray:
    """Return the crossings between ``near``, where the function is not below 0, and ``far``."""
    at_near, at_far = of(near), of(far)
    last = np.zeros(near.size)
    for _ in range(_MOST):
        span = np.where(at_near == at_far, 1.0, at_near - at_far)
        between = np.where(at_near == at_far, 0.5 * (near + far), near + (far - near) * at_near / span)
        found = of(between)
        moves_near = found >= 0
        at_far = np.where(moves_near & (last > 0), 0.5 * at_far, at_far)
        at_near = np.where(~moves_near & (last < 0), 0.5 * at_near, at_near)
        near, at_near = np.where(moves_near, between, near), np.where(moves_near, found, at_near)
        far, at_far = np.where(moves_near, far, between), np.where(moves_near, at_far, found)
        last = np.where(moves_near, 1.0, -1.0)
        if (np.minimum(np.abs(far - near), np.abs(found)) < _SETTLED).all():
            return between
    return between
