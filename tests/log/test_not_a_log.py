"""What is neither a file nor a frame is refused, with how to make one of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hersey


@pytest.mark.parametrize("thing", [3, [3]])
def test_a_number_is_no_log(thing: Any) -> None:
    with pytest.raises(hersey.HerseyError, match="the number 3 is not a log"):
        hersey.read(thing)


@pytest.mark.parametrize("thing", [np.zeros((9, 4)), [np.zeros(9)], {"Time [s]": [0.0, 1.0]}])
def test_numbers_without_names_and_units_are_no_log(thing: Any) -> None:
    with pytest.raises(hersey.HerseyError, match=r"is not a log\. Make a frame .*polars\.DataFrame"):
        hersey.read(thing)
