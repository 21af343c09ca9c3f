"""Points that share a temperature or a speed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hersey.arrays import FloatArray

#: Fewest samples of a dwell.
MIN_SAMPLES = 20
#: Least duration of a dwell, s, unless another is asked for.
MIN_DWELL = 2.0
#: Speeds closer than this share count as the same.
SAME_SPEED = 0.03


def groups_of_temperature(temperature: FloatArray, width: float = 6.0) -> Iterator[NDArray[np.intp]]:
    """Yield the indices of points that share a temperature, coldest first.

    Neighbours in sorted order belong together while the whole group spans no more than ``width`` K.
    """
    order = np.argsort(temperature, kind="stable")
    start = 0
    for i in range(1, order.size + 1):
        if i == order.size or temperature[order[i]] - temperature[order[start]] > width:
            yield order[start:i]
            start = i


def levels_of_speed(log_speed: FloatArray, members: NDArray[np.intp], apart: float) -> list[NDArray[np.intp]]:
    """Return the members of each speed, the slowest first; ``apart`` in ln speed parts two of them."""
    order = members[np.argsort(log_speed[members], kind="stable")]
    return np.split(order, np.flatnonzero(np.diff(log_speed[order]) > apart) + 1)


def distinct_speeds(speed: FloatArray) -> int:
    """Return how many different speeds there are, to `SAME_SPEED`."""
    ordered = np.sort(speed)
    return int(1 + np.count_nonzero(np.diff(np.log(ordered)) > SAME_SPEED)) if ordered.size else 0
