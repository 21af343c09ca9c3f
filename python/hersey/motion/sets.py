"""The parameter sets of a sweep: laid out only as far as they are followed."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

import numpy as np

from hersey.arrays import FloatArray, IntArray, crossed, together
from hersey.errors import ParameterError
from hersey.scale.cutting import Cut


@dataclass(frozen=True)
class Sets:
    """A number or an array for each parameter, in the order of the core, crossed or taken together."""

    given: Mapping[str, FloatArray]
    zip: bool

    @cached_property
    def _spanned(self) -> tuple[tuple[str, ...], tuple[int, ...]]:
        if self.zip:
            axes, columns = together(dict(self.given))
            return tuple(axes), next(iter(columns.values())).shape
        axes, _ = crossed({name: each[:1] if each.ndim == 1 else each for name, each in self.given.items()})
        return tuple(axes), tuple(self.given[name].size for name in axes)

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the axes that the sets span."""
        return self._spanned[0]

    @property
    def shape(self) -> tuple[int, ...]:
        """How many values lie along each."""
        return self._spanned[1]

    @property
    def count(self) -> int:
        """How many sets there are."""
        return prod(self.shape)

    def columns(self) -> dict[str, FloatArray]:
        """Return each parameter of every set, over the axes."""
        return (together if self.zip else crossed)(dict(self.given))[1]

    def part(self, slices: Sequence[slice]) -> Sets:
        """Return the sets of a part of the grid."""
        taken = dict(zip(self.axes, slices, strict=True))

        def of(name: str, values: FloatArray) -> FloatArray:
            if not values.ndim:
                return values
            if self.zip:
                return np.ascontiguousarray(np.broadcast_to(values, self.shape)[tuple(slices)])
            return values[taken[name]]

        return Sets({name: of(name, values) for name, values in self.given.items()}, self.zip)

    def numbers(self, count: int) -> IntArray:
        """Return the indices of so many sets, spread evenly over all."""
        return np.linspace(0, self.count - 1, min(count, self.count)).astype(np.intp)

    def sample(self, count: int) -> Sets:
        """Return so many sets, spread evenly over all, taken together."""
        numbers = self.numbers(count)
        indices = np.unravel_index(numbers, self.shape) if self.shape else ()
        places = dict(zip(self.axes, indices, strict=True))

        def of(name: str, values: FloatArray) -> FloatArray:
            if self.zip and values.ndim:
                return np.broadcast_to(values, self.shape)[tuple(places.values())]
            return values[places[name]] if values.ndim else np.full(numbers.size, values)

        return Sets({name: of(name, values) for name, values in self.given.items()}, zip=True)

    def described(self) -> dict[str, dict[str, Any]]:
        """Return of each parameter what tells it from others: how many values, first, last, a hash."""
        return {
            name: {
                "values": int(values.size),
                "shape": list(values.shape),
                "first": float(values.flat[0]),
                "last": float(values.flat[-1]),
                "sha256": hashlib.sha256(values.tobytes()).hexdigest(),
            }
            for name, values in self.given.items()
        }


@dataclass(frozen=True)
class Piece:
    """The sets of one chunk: its number, and the index of the first among all."""

    number: int
    first: int
    sets: Sets

    @property
    def numbers(self) -> range:
        """Indices of its sets among all."""
        return range(self.first, self.first + self.sets.count)


class Later:
    """A chunk of which the sets are taken when it travels or is worked at, not while it waits."""

    def __init__(self, sets: Sets, cut: Cut, number: int) -> None:
        self._sets, self._cut, self._number = sets, cut, number

    @property
    def size(self) -> int:
        """How many sets it has."""
        return self._cut.size(self._number)

    def piece(self) -> Piece:
        """Return the chunk with its sets."""
        cut, number = self._cut, self._number
        return Piece(number, cut.first(number), self._sets.part(cut.slices(number)))

    def __reduce__(self) -> tuple[Any, ...]:
        """Travel as the chunk alone."""
        return _Arrived, (self.piece(),)


class _Arrived(Later):
    """A chunk at a worker."""

    def __init__(self, piece: Piece) -> None:
        self._piece = piece

    def piece(self) -> Piece:
        return self._piece


def within(numbers: Sequence[int] | IntArray, error: ParameterError) -> ParameterError:
    """Return what the core says of one of these sets, with its index among all."""
    if error.index is None:
        return error
    index = int(numbers[error.index])
    again = ParameterError(str(error).replace(f"set {error.index}:", f"set {index}:", 1))
    again.__dict__.update(error.__dict__)
    again.index = index
    return again
