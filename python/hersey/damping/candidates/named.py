"""What every law of torque has: parameters with names."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hersey.arrays import FloatArray


class Named:
    """A law whose parameters have names, and no corner if it does not say so.

    Its values have the shape (parameters,), or (parameters, draws, 1) for many draws at once: what is
    computed of them has the shape (points,) or (draws, points) then.
    """

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        raise NotImplementedError

    @property
    def broken(self) -> bool:
        """Whether there are two branches that meet in a corner."""
        return False

    def index(self, name: str) -> int:
        """Return where a parameter stands."""
        return self.names.index(name)

    def value(self, values: FloatArray, name: str) -> FloatArray:
        """Return a parameter, 0 where the law has none of that name."""
        return np.asarray(values[self.index(name)]) if name in self.names else np.zeros(())


def stacked(columns: Sequence[FloatArray | float], shape: tuple[int, ...]) -> FloatArray:
    """Return derivatives at points of a shape as one array, shape (..., points, parameters)."""
    out = np.empty((*shape, len(columns)))
    for index, column in enumerate(columns):
        out[..., index] = column
    return out
