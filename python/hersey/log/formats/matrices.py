"""Arrays with a name, as MATLAB and HDF5 files hold them, turned into signals."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hersey.arrays import FloatArray
from hersey.log.recording import Signal, floats
from hersey.log.text.column import split_unit

#: A matrix with more columns than this is no table of channels.
_WIDEST = 256


def array_signals(
    name: str, shape: tuple[int, ...], load: Callable[[], Any], unit: str = "", group: str = ""
) -> list[Signal]:
    """Return a vector as one signal, a matrix as one for each column: ``name#1``, ``name#2``, ...

    The longer side of a matrix is the one that counts samples.
    """
    sides = [n for n in shape if n != 1]
    plain, stated = (name, unit) if unit else split_unit(name)
    if len(sides) == 1:
        return [Signal(plain, stated, sides[0], lambda: floats(load()).reshape(-1), group=group)]
    if len(sides) != 2 or not 0 < min(sides) <= _WIDEST:
        return []
    across = len(shape) == 2 and shape[1] > shape[0]

    def column(index: int) -> Callable[[], FloatArray]:
        def take() -> FloatArray:
            table = floats(load()).reshape(sides)
            return table[index] if across else table[:, index]

        return take

    return [Signal(f"{plain}#{i + 1}", stated, max(sides), column(i), group=group) for i in range(min(sides))]
