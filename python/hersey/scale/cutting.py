"""A grid cut into chunks, each contiguous in the order in which the grid lies (C order)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, prod

from hersey.errors import ParameterError

#: More chunks than this no folder takes gladly.
MOST_CHUNKS = 1_000_000


@dataclass(frozen=True)
class Cut:
    """A grid of ``shape`` in chunks of ``chunk``: (1, .., 1, k, whole axes); one at an end may be smaller."""

    shape: tuple[int, ...]
    chunk: tuple[int, ...]

    @classmethod
    def into(cls, shape: tuple[int, ...], sets: int) -> Cut:
        """Return the grid in chunks of at most ``sets`` points, as alike as may be.

        Raises
        ------
        ParameterError
            If that is none, more than all, or so few that there would be over a million chunks.
        """
        every = prod(shape)
        if not 1 <= sets <= every:
            raise ParameterError(f"chunk is {sets}: it must be from 1 to {every} sets")
        chunk, whole = [1] * len(shape), 1
        for axis in reversed(range(len(shape))):
            most = max(sets // whole, 1)
            if most < shape[axis]:
                chunk[axis] = ceil(shape[axis] / ceil(shape[axis] / most))
                break
            chunk[axis] = shape[axis]
            whole *= shape[axis]
        cut = cls(shape, tuple(chunk))
        if cut.count > MOST_CHUNKS:
            raise ParameterError(
                f"chunk is {sets}, which makes {cut.count} chunks of {every} sets; at most "
                f"{MOST_CHUNKS} are allowed. Use {ceil(2 * every / MOST_CHUNKS)}"
            )
        return cut

    @property
    def is_sound(self) -> bool:
        """Whether `into` could have made it; of one that was read from a file one cannot know."""
        if len(self.chunk) != len(self.shape):
            return False
        cut_before = False
        for each, length in zip(reversed(self.chunk), reversed(self.shape), strict=True):
            if type(each) is not int or not 1 <= each <= length or (cut_before and each != 1):
                return False
            cut_before = cut_before or each < length
        return self.count <= MOST_CHUNKS

    @property
    def grid(self) -> tuple[int, ...]:
        """How many chunks lie along each axis."""
        return tuple(-(-length // each) for length, each in zip(self.shape, self.chunk, strict=True))

    @property
    def count(self) -> int:
        """How many chunks there are."""
        return prod(self.grid)

    def place(self, number: int) -> tuple[int, ...]:
        """Return where a chunk lies among the chunks, one index per axis."""
        place = []
        for length in reversed(self.grid):
            number, index = divmod(number, length)
            place.append(index)
        return tuple(reversed(place))

    def number(self, place: tuple[int, ...]) -> int:
        """Return the number of the chunk that lies at a place, one index per axis."""
        number = 0
        for index, length in zip(place, self.grid, strict=True):
            number = number * length + index
        return number

    def slices(self, number: int) -> tuple[slice, ...]:
        """Return what a chunk takes of each axis."""
        bounds = zip(self.place(number), self.chunk, self.shape, strict=True)
        return tuple(slice(i * each, min((i + 1) * each, length)) for i, each, length in bounds)

    def shape_of(self, number: int) -> tuple[int, ...]:
        """Return the shape of a chunk."""
        return tuple(part.stop - part.start for part in self.slices(number))

    def size(self, number: int) -> int:
        """Return how many points a chunk has: all have as many but the last along the axis that is cut."""
        return self._last if (number + 1) % self._along == 0 else prod(self.chunk)

    @cached_property
    def _along(self) -> int:
        """How many chunks lie along the axis that is cut."""
        return next((length for length in reversed(self.grid) if length > 1), 1)

    @cached_property
    def _last(self) -> int:
        return prod(self.shape_of(self._along - 1))

    def first(self, number: int) -> int:
        """Return the index of the first point of a chunk among all, in C order."""
        index = 0
        for part, length in zip(self.slices(number), self.shape, strict=True):
            index = index * length + part.start
        return index
