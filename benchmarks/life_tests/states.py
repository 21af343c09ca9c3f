"""What ages in a drive: each an array of specimens and ages, relative to new unless a unit is named."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """State of specimens (rows) at ages (columns)."""

    viscosity: Array
    #: Layer of oil on the inlet side over that of a new specimen.
    layer: Array
    roughness: Array
    friction: Array
    #: Growth of boundary friction at 180 degC beyond ``friction``, falling to cold.
    hot: Array
    #: Drag of debris over load.
    debris: Array
    #: Width of the nip.
    width: Array
    #: No-load torque.
    rest: Array

    @classmethod
    def new(cls, shape: tuple[int, ...], **changed: Array) -> State:
        """Return new specimens, but for what is given."""
        one, zero = np.ones(shape), np.zeros(shape)
        start = {"viscosity": one, "layer": one, "roughness": one, "friction": one, "width": one, "rest": one}
        return cls(**{**start, "hot": zero, "debris": zero, **changed})

    def at(self, rows: slice | Array, columns: slice | Array = slice(None)) -> State:
        """Return the state of some specimens at some ages."""
        return State(**{name: value[rows][:, columns] for name, value in vars(self).items()})
