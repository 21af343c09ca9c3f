"""Values as JSON and arrays and back: the same to the bit, and nothing but values."""

from __future__ import annotations

import enum
import json
import math
import sys
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import polars as pl
import pytest

from hersey.cache import encoding
from hersey.cache.encoding import Decoder, Encoder, UnstorableError
from hersey.damping.estimate import Estimate


class Colour(enum.Enum):
    """One that is kept by its name."""

    RED = "red"


class Pair(NamedTuple):
    """Two."""

    first: float
    second: str


@dataclass(frozen=True)
class Reading:
    """A record with what it derives, and what it computes when it is asked."""

    value: float
    memo: dict[str, float] = field(default_factory=dict, init=False, compare=False)
    unit: str = "K"

    @cached_property
    def double(self) -> float:
        """Twice the value."""
        return 2.0 * self.value


@dataclass(frozen=True)
class Made:
    """A record of which a part comes only of its making."""

    value: float
    derived: float = field(init=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "derived", 2.0 * self.value)


def named(value: float) -> float:
    """Return the value."""
    return value


@pytest.fixture(autouse=True)
def _of_hersey(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the classes of these tests count as ours, for none of hersey has all kinds of parts."""
    monkeypatch.setattr(encoding, "_CLASS", encoding.re.compile(r"((?:hersey|tests)(?:\.\w+)+):(\w+)"))


def again(value: Any, *known: Any, functions: bool = False) -> Any:
    """A value after it was written and read, beside what was known before."""
    encoder = Encoder(functions=True)
    for each in known:
        encoder.encoded(each)
    objects, encoder.arrays, encoder.functions = [*encoder.objects], [], functions
    text = json.dumps(encoder.encoded(value))
    arrays = iter(encoder.arrays)
    return Decoder(objects, lambda *_: next(arrays)).decoded(json.loads(text))


VALUES = [
    None, True, 0, -(10**30), 0.1 + 0.2, -0.0, 5e-324, math.inf, "µ ü \ud800 \0", (), ("same", 3), [1, [2.0]],
    {"a": 1, (1, "b"): None, 2: []}, Path("a/b"), Colour.RED, np.float64(1 / 3), np.int32(7), np.bool_(True),
    Pair(1.5, "x"), Reading(1.5), Estimate(1.0, 0.1, 0.8, 1.2, 5.0),
]  # fmt: skip


@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_a_value_comes_back_as_it_was(value: Any) -> None:
    found = again(value)
    assert type(found) is type(value)
    assert repr(found) == repr(value)  # which tells -0.0 from 0.0
    assert found == value


def test_what_is_no_number_comes_back() -> None:
    found = again((math.nan, np.float32("nan")))
    assert math.isnan(found[0])
    assert np.isnan(found[1])


def test_columns_come_back_with_their_gaps() -> None:
    frame = pl.DataFrame(
        {"x": [1.0, None, math.nan], "n": [1, 2, None], "s": ["a", None, ""], "b": [True, None, False]}
    )
    found = again(frame)
    assert found.schema == frame.schema
    assert found.equals(frame)


def test_fields_keep_the_order_of_their_class() -> None:
    reading = Reading(1.0)
    _ = reading.double
    found = again(reading)
    assert list(vars(found)) == ["value", "memo", "unit"]  # what is computed is computed again
    assert found.double == 2.0
    assert found.memo is not reading.memo


def test_what_was_one_object_is_one_object() -> None:
    reading = Reading(1.0)
    first, (second, other) = again((reading, [reading, Reading(1.0)]))
    assert first is second
    assert other is not first


def test_a_part_that_is_an_argument_is_that_of_the_call() -> None:
    numbers = np.arange(3.0)
    reading = Reading(2.0)
    found = again({"of": reading, "numbers": numbers, "more": [numbers[:2]]}, [reading], numbers)
    assert found["of"] is reading
    assert found["numbers"] is numbers
    assert found["more"][0] is not numbers


class Text(str):
    """A text of another class."""


REFUSED = [
    object(), b"bytes", {1, 2}, Text("x"), lambda: None, named, np.array([object()]), np.arange(3)[::-1],
    np.ma.masked_array([1.0]), Made(1.0), Reading, pl.DataFrame({"x": [[1, 2]]}), 1j,
]  # fmt: skip


@pytest.mark.parametrize("value", REFUSED, ids=lambda value: type(value).__name__)
def test_other_kinds_are_not_written(value: Any) -> None:
    with pytest.raises(UnstorableError):
        again([value])


def test_what_a_record_holds_beside_its_fields_is_not_lost_in_silence() -> None:
    reading = Reading(1.0)
    vars(reading)["more"] = 1
    with pytest.raises(UnstorableError, match="more"):
        again(reading)


def test_a_key_names_functions_and_leaves_out_what_is_derived() -> None:
    first, second = Encoder(functions=True), Encoder(functions=True)
    made = Made(1.0)
    assert first.encoded((named, made)) == second.encoded((named, Made(1.0)))
    object.__setattr__(made, "value", 2.0)
    assert Encoder(functions=True).encoded((named, made)) != Encoder(functions=True).encoded(
        (named, Made(1.0))
    )
    with pytest.raises(UnstorableError):  # two of them can have one name
        first.encoded(lambda: None)


@pytest.mark.parametrize(
    "written",
    [
        ["record", "os:system", 1],
        ["record", "tests.cache.test_encoding:Colour", "red"],
        ["record", "tests.cache.test_encoding:named", 1.0],
        ["record", "tests.cache.test_encoding:Reading"],
        ["record", "tests.cache.test_encoding:Reading", 1.0],
        ["record", "tests.cache.test_encoding:Path", "x"],
        ["enum", "tests.cache.test_encoding:Reading", "value"],
        ["enum", "tests.cache.test_encoding:Colour", "GREEN"],
        ["named", "tests.cache.test_encoding:Reading", 1.0],
        ["function", "os", "system"],
        ["frame", ["x", "Object", [1]]],
        ["same", 0],
        ["other"],
        [],
    ],
)
def test_nothing_else_is_read(written: Any) -> None:
    with pytest.raises(
        (UnstorableError, ValueError, LookupError, StopIteration, RuntimeError, AttributeError)
    ):
        Decoder([], lambda *_: np.empty(0)).decoded(written)


def test_reading_loads_no_module() -> None:
    assert "hersey.cli.__main__" not in sys.modules
    with pytest.raises(UnstorableError):
        Decoder([], lambda *_: np.empty(0)).decoded(["record", "hersey.cli.__main__:main"])
    assert "hersey.cli.__main__" not in sys.modules
