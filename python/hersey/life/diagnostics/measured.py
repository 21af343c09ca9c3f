"""The runs of a life test as their diagnostics take them: specimen, age, and the dwells of each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class MeasuredRuns:
    """Runs by specimen and age, and their dwells, those of one run one after the other.

    ``number``, ``unit`` and ``age`` (in ``age_unit``) are those of each run. ``of_run`` is the place of the run of
    each dwell; ``speed`` in rad/s, ``kelvin`` (NaN where none was recorded) and ``torque`` of the whole drive in N m.
    """

    number: tuple[int, ...]
    unit: tuple[str, ...]
    age: FloatArray
    age_unit: str
    of_run: IntArray
    speed: FloatArray
    kelvin: FloatArray
    torque: FloatArray

    @cached_property
    def specimen(self) -> IntArray:
        """Place of the specimen of each run, in the order of the runs."""
        places = {name: i for i, name in enumerate(dict.fromkeys(self.unit))}
        return np.array([places[name] for name in self.unit], dtype=np.intp)

    @cached_property
    def units(self) -> tuple[str, ...]:
        """Names of the specimens, each once, in the order of the runs."""
        return tuple(dict.fromkeys(self.unit))
