"""The runs of a life test as they are compared: specimen, age, and the dwells of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.maintenance import OF_FRICTION, Event, Segments, segments

if TYPE_CHECKING:
    from hersey.damping.no_load_torque import NoLoadTorque


@dataclass(frozen=True)
class MeasuredRuns:
    """Runs by specimen and age, and their dwells.

    ``number``, ``unit`` and ``age`` (in ``age_unit``) are those of each run, ``events`` the maintenance of
    specimens.
    ``of_run`` is the place of the run of each dwell; ``speed`` in rad/s and ``kelvin`` (NaN where none was
    recorded) are its state, ``torque`` (N m) is that of the whole drive in the sense of rotation.
    """

    number: tuple[int, ...]
    unit: tuple[str, ...]
    age: FloatArray
    age_unit: str
    of_run: IntArray
    speed: FloatArray
    kelvin: FloatArray
    torque: FloatArray
    events: tuple[Event, ...] = ()

    @cached_property
    def _segments(self) -> Segments:
        return segments(self.number, self.unit, self.age, self.events, OF_FRICTION)

    @cached_property
    def specimen(self) -> IntArray:
        """Place of the specimen of each run; after maintenance it counts as another one."""
        places = {name: i for i, name in enumerate(dict.fromkeys(self._segments.name))}
        return np.array([places[name] for name in self._segments.name], dtype=np.intp)

    @property
    def since(self) -> FloatArray:
        """Age of each run since its specimen was new or maintained."""
        return self._segments.age


def drive_torque(of_run: IntArray, table: FloatArray, rests: Mapping[int, NoLoadTorque | None]) -> FloatArray:
    """Return the torque of the whole drive at each dwell in the sense of rotation, N m.

    Parameters
    ----------
    of_run, table
        Number of the run, shape (dwells,); speed, temperature, torque and its error, (dwells, 4).
    rests
        No-load torque that was subtracted from each run, by its number.
    """
    speed, kelvin, torque = table[:, 0], table[:, 1], table[:, 2].copy()
    same: dict[int, list[int]] = {}
    for number, rest in rests.items():
        if rest is not None:
            same.setdefault(id(rest), []).append(number)
    thermal = np.isfinite(kelvin)
    for numbers in same.values():
        rest, some = rests[numbers[0]], np.isin(of_run, numbers)
        for dwells, at in ((some & thermal, kelvin), (some & ~thermal, None)):
            heat = None if at is None else at[dwells]
            torque[dwells] += rest.torque(speed[dwells], temperature=heat)  # type: ignore[union-attr]
    return np.asarray(torque * np.sign(speed))
