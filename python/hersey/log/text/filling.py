"""An array that is filled part by part, so that the whole is not held twice."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray

#: Room for so many times the rows that are expected.
_ROOM = 1.05


class Filling:
    """Numbers of one channel, shape (rows,), as they are read."""

    def __init__(self) -> None:
        """Begin without any."""
        self.size = 0
        self._room = np.empty(0)

    def add(self, part: FloatArray, done: float) -> None:
        """Add the numbers of a part of the file, of which the share ``done`` is read then."""
        size = self.size + part.size
        if size > self._room.size:
            room = np.empty(max(size, int(_ROOM * size / max(done, 0.01))))  # memory counts once it is filled
            room[: self.size] = self._room[: self.size]
            self._room = room
        self._room[self.size : size] = part
        self.size = size

    def whole(self) -> FloatArray:
        """Return all numbers."""
        return self._room[: self.size]
