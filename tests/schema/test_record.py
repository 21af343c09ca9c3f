"""A record describes itself: JSON and its schema follow from the fields, each thing said once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeVar

import numpy as np
import pytest
from numpy.typing import NDArray
from pydantic import ValidationError
from typing_extensions import TypeAliasType

from hersey.errors import ParameterError
from hersey.result import OPEN, Means, Record, Result
from hersey.schema.part import Part
from hersey.schema.record import part_of


class Corner(NamedTuple):
    """A point of a profile."""

    time: Annotated[float, Means(unit="s")]
    speed: float = 0.5


@dataclass(frozen=True)
class Inner(Record):
    """Something inside."""

    size: Annotated[float, OPEN]


@dataclass(frozen=True, repr=False)
class Outer(Result):
    """What is found."""

    also_stated = ("double", "words")
    not_stated = ("hidden",)

    speed: Annotated[float, Means("of the belt", "m/s")]
    upper: Annotated[float, Means("V*", "m/s", open=True)]
    torque: Annotated[NDArray[np.float64], Means("steady", "N m", shape="(n, m)", open=True)]
    counts: NDArray[np.intp]
    corners: tuple[Corner, ...]
    inner: Inner | None
    ends: tuple[float, float]
    by_name: Mapping[str, float]
    why: ParameterError
    hidden: Path
    laps: int = 3
    warnings: tuple[str, ...] = field(default_factory=tuple)

    @property
    def double(self) -> Annotated[float, Means("twice the speed", "m/s")]:
        """Twice the speed."""
        return 2.0 * self.speed

    def words(self) -> str:
        """Return it in words."""
        return f"{self.speed:g} m/s"

    def summary(self) -> str:
        """Return it in words."""
        return self.words()


def outer(**changed: Any) -> Outer:
    made: dict[str, Any] = {
        "speed": 0.25,
        "upper": np.inf,
        "torque": np.array([[1.0, np.nan], [2.0, 3.0]]),
        "counts": np.array([1, 2]),
        "corners": (Corner(0.0), Corner(1.5, 0.1)),
        "inner": Inner(np.nan),
        "ends": (1.0, 2.0),
        "by_name": {"a": 1.0},
        "why": ParameterError("no speed"),
        "hidden": Path("x"),
    }
    return Outer(**made | changed)


JSON = {
    "speed": 0.25,
    "upper": None,
    "torque": [[1.0, None], [2.0, 3.0]],
    "counts": [1, 2],
    "corners": [{"time": 0.0, "speed": 0.5}, {"time": 1.5, "speed": 0.1}],
    "inner": {"size": None},
    "ends": [1.0, 2.0],
    "by_name": {"a": 1.0},
    "why": "no speed",
    "laps": 3,
    "warnings": [],
    "double": 0.5,
    "words": "0.25 m/s",
}


def test_json_holds_what_is_stated_and_nothing_else() -> None:
    assert outer().to_dict() == JSON


def test_the_schema_says_type_meaning_unit_and_shape() -> None:
    schema = part_of(Outer).model_json_schema()
    own = schema["properties"]
    assert list(own) == list(JSON)
    assert schema["description"] == "What is found."
    assert own["speed"] == {"description": "of the belt, m/s", "title": "Speed", "type": "number"}
    assert own["upper"]["anyOf"] == [{"type": "number"}, {"type": "null"}]
    assert own["torque"]["description"] == "steady, N m, shape (n, m)"
    rows = own["torque"]["items"]
    assert rows["items"]["anyOf"] == [{"type": "number"}, {"type": "null"}]
    assert own["counts"]["items"] == {"type": "integer"}
    assert own["laps"]["default"] == 3
    assert own["double"]["description"] == "twice the speed, m/s"
    assert own["why"]["type"] == own["words"]["type"] == "string"
    assert set(schema["required"]) == set(JSON) - {"laps", "warnings"}
    assert schema["$defs"]["Corner"]["properties"]["time"]["description"] == "s"


def test_what_is_read_is_checked_against_it() -> None:
    part = part_of(Outer)
    assert part.model_validate(JSON).model_dump(mode="json") == JSON
    for wrong in ({"speed": None}, {"speed": float("inf")}, {"unheard_of": 1}, {"torque": [1.0]}):
        with pytest.raises(ValidationError, match=next(iter(wrong))):
            part.model_validate(JSON | wrong)


def test_a_part_holds_the_record_itself() -> None:
    class Whole(Part):
        """A document."""

        found: Outer | None

    one = outer()
    held = Whole(found=one)
    assert held.found is one
    assert held.model_dump(mode="json") == {"found": JSON}
    assert Whole.model_validate_json(held.model_dump_json()).model_dump(mode="json") == {"found": JSON}


def test_single_numbers_are_a_table_with_units() -> None:
    table = outer().to_frame()
    assert table.rows() == [
        ("speed", 0.25, "m/s"),
        ("upper", np.inf, "m/s"),
        ("laps", 3.0, ""),
        ("double", 0.5, "m/s"),
    ]


_Item = TypeVar("_Item", bound=np.generic)
#: As NumPy 2.5 writes NDArray.
Alias = TypeAliasType("Alias", np.ndarray[Any, np.dtype[_Item]], type_params=(_Item,))


@dataclass(frozen=True)
class Aliased(Record):
    """A record with an array whose type is an alias."""

    counts: Annotated[Alias[np.intp], Means(shape="(n, m)")]


def test_an_array_may_be_typed_by_an_alias() -> None:
    """Else no report is written with NumPy 2.5, which Python 3.12 and later get."""
    schema = part_of(Aliased).model_json_schema()
    counts = schema["properties"]["counts"]
    assert counts["items"] == {"items": {"type": "integer"}, "type": "array"}
