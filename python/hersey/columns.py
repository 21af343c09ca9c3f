"""Calling the core over arrays that broadcast as in NumPy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from hersey.log.torque_log import FloatArray

R = TypeVar("R")


def pointwise(function: Callable[[Sequence[FloatArray]], R], *given: ArrayLike) -> R:
    """Return what a core function makes of arrays, each spread to the shape that the arguments span together.

    Raises
    ------
    ParameterError
        With the core's words, which name the quantity.
    """
    return function(np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in given)))
