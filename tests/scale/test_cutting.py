"""Grids in chunks: each point in one, contiguous as the grid lies, absurd sizes refused."""

from __future__ import annotations

from math import prod

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hersey.errors import ParameterError
from hersey.scale.cutting import Cut

SHAPES = st.lists(st.integers(1, 7), max_size=4).map(tuple)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(shape=SHAPES, asked=st.integers(1, 2000))
def test_chunks_hold_each_point_once_in_the_order_of_the_grid(shape: tuple[int, ...], asked: int) -> None:
    every = prod(shape)
    cut = Cut.into(shape, min(asked, every))
    indices = np.arange(every).reshape(shape)
    seen = []
    for number in range(cut.count):
        part = indices[cut.slices(number)].ravel()
        assert part.size == cut.size(number) <= asked
        assert part[0] == cut.first(number)
        np.testing.assert_array_equal(part, np.arange(part[0], part[0] + part.size))
        seen += part.tolist()
    assert sorted(seen) == list(range(every))


def test_chunks_are_about_as_large_as_asked() -> None:
    assert Cut.into((10, 1000, 300), 100_000).chunk == (1, 250, 300)
    assert Cut.into((10**9,), 50_000).count == 20_000
    assert Cut.into((), 1).count == 1


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (0, "chunk is 0: it must be from 1 to 1000000000 sets"),
        (-3, "chunk is -3"),
        (10**9 + 1, "chunk is 1000000001"),
        (999, "1001002 chunks of 1000000000 sets; at most 1000000 are allowed. Use 2000"),
    ],
)
def test_absurd_sizes_are_refused(asked: int, says: str) -> None:
    with pytest.raises(ParameterError, match=says):
        Cut.into((10**9,), asked)
