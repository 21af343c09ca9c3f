"""Calling the core over arrays that broadcast as in NumPy."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from hersey.errors import ParameterError
from hersey.log.torque_log import FloatArray


def rows(function: Callable[[Sequence[FloatArray]], FloatArray], *given: ArrayLike) -> FloatArray:
    """Return the rows of a core function of columns, each of the shape that the arguments span together.

    Raises
    ------
    ParameterError
        With the core's words, which name the quantity.
    """
    arrays = np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in given))
    try:
        found = function([np.ascontiguousarray(array).ravel() for array in arrays])
    except ValueError as error:
        raise ParameterError(str(error)) from None
    return np.asarray(found.reshape(-1, *arrays[0].shape))
