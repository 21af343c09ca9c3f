"""Records: data classes whose fields say what they mean, so that JSON and its schema follow from them.

Pydantic and NumPy are loaded only where a schema is asked for.
"""

from __future__ import annotations

import inspect
import math
import sys
import types
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from functools import cache, reduce
from operator import or_
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple, Union, get_args, get_origin

from hersey.arguments.frozen import explaining

#: Items of JSON by the kind of an array.
_ITEMS: dict[str, Any] = {"f": float, "i": int, "u": int, "b": bool, "U": str}


class Means(NamedTuple):
    """What the schema says of a field, as ``upper: Annotated[float, Means("the fold", "m/s", open=True)]``.

    ``shape`` is that of an array, ``(n,)`` where none is given; ``open`` numbers may be infinite or missing,
    which JSON says as null.
    """

    text: str = ""
    unit: str = ""
    shape: str = ""
    open: bool = False

    @property
    def description(self) -> str:
        """Meaning, unit and shape on one line."""
        shape = f"shape {self.shape}" if self.shape else ""
        return ", ".join(part for part in (self.text, self.unit, shape) if part)


#: A number that may be infinite or missing.
OPEN = Means(open=True)


class _Explained(type):
    """The class of records: one that is made frozen says how to get a changed one."""

    def __setattr__(cls, name: str, value: Any) -> None:
        super().__setattr__(name, explaining(value) if name == "__setattr__" else value)


class Record(metaclass=_Explained):
    """A frozen data class that describes itself: JSON, schema and documentation follow from its fields.

    ``also_stated`` names properties and methods (without arguments) that JSON holds too, ``not_stated``
    fields that it does not.
    """

    if TYPE_CHECKING:  # else they would be among the types of the fields
        also_stated: ClassVar[tuple[str, ...]]
        not_stated: ClassVar[tuple[str, ...]]
    else:
        also_stated = not_stated = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the result as JSON can hold it, in SI; None for what is infinite or missing."""
        return json_record({name: stated(self, name) for name in stated_names(type(self))})

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        """Return how a part of the document holds the record: as it is, and in JSON by its own fields."""
        return held(cls, handler)


def stated_names(record: type) -> list[str]:
    """Return the names of what JSON holds of a record, in order."""
    if not is_dataclass(record):
        return list(getattr(record, "_fields", ()))
    left_out = getattr(record, "not_stated", ())
    own = [field.name for field in fields(record) if field.name not in left_out]
    return own + list(getattr(record, "also_stated", ()))


def stated(record: Any, name: str) -> Any:
    """Return the value of what JSON holds under a name."""
    value = getattr(record, name)
    return value() if callable(value) else value


def json_value(value: Any) -> Any:
    """Return the value with arrays as lists, and None for every number that is infinite or missing.

    A record (data class or named tuple) or a part becomes a dictionary of its fields, an error its words.
    """
    if isinstance(value, Record):
        return value.to_dict()
    if hasattr(value, "model_dump"):
        return value.model_dump(mode="json")
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: json_value(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): json_value(item) for key, item in value.items()}
    if hasattr(value, "_asdict"):
        return json_value(value._asdict())
    if isinstance(value, list | tuple):
        return [json_value(item) for item in value]
    if hasattr(value, "tolist"):  # an array of NumPy, or a number of it
        return json_value(value.tolist())
    if isinstance(value, BaseException):
        return str(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def json_record(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return named values as JSON can hold them."""
    return {name: json_value(value) for name, value in values.items()}


@cache
def part_of(record: type) -> Any:
    """Return the part of the document that holds a record: its schema, and what checks JSON against it."""
    from pydantic import BaseModel, Field, create_model

    from hersey.schema.part import Part

    if issubclass(record, BaseModel):
        return record
    defaults = _defaults(record)
    members = {}
    for name in stated_names(record):
        kind, means = declared(record, name)
        described = {"description": means.description or None} | defaults.get(name, {})
        members[name] = (_plain(kind, means), Field(**described))
    made: Any = create_model
    return made(record.__name__, __base__=Part, __doc__=inspect.getdoc(record), **members)


def held(record: type, handler: Any) -> Any:
    """Return how pydantic holds a record: as it is, as its part where JSON is read, in JSON by `to_dict`."""
    from pydantic_core import core_schema

    part = handler.generate_schema(part_of(record))
    return core_schema.json_or_python_schema(
        json_schema=part,
        python_schema=core_schema.union_schema([core_schema.is_instance_schema(record), part]),
        serialization=core_schema.plain_serializer_function_ser_schema(json_value),
    )


def _defaults(record: type) -> dict[str, dict[str, Any]]:
    """The defaults of the fields that have one, by name; null for what is infinite or missing."""
    found = {
        name: {"default": json_value(value)} for name, value in getattr(record, "_field_defaults", {}).items()
    }
    for field in fields(record) if is_dataclass(record) else ():
        if field.default_factory is not MISSING:
            found[field.name] = {"default_factory": field.default_factory}
        elif field.default is not MISSING:
            found[field.name] = {"default": json_value(field.default)}
    return found


def declared(record: type, name: str) -> tuple[Any, Means]:
    """Return type and meaning of what is stated; only these are looked up, as others may not be loaded."""
    for owner in record.__mro__:
        own = inspect.get_annotations(owner)
        member = vars(owner).get(name)
        if name not in own and member is None:
            continue
        getter: Any = getattr(member, "fget", None) or getattr(member, "func", None) or member
        written = own[name] if name in own else inspect.get_annotations(getter)["return"]
        written = getattr(written, "__forward_arg__", written)  # in a named tuple
        kind = eval(written, vars(sys.modules[owner.__module__])) if isinstance(written, str) else written
        means = [each for each in getattr(kind, "__metadata__", ()) if isinstance(each, Means)]
        return (get_args(kind)[0] if means else kind), (means[0] if means else Means())
    raise AttributeError(f"{record.__name__} has no {name}")


def _plain(kind: Any, means: Means) -> Any:
    """The type by which JSON holds a type of Python."""
    import numpy as np

    origin, inside = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return _plain(inside[0], next((each for each in inside if isinstance(each, Means)), means))
    if hasattr(origin, "__value__"):  # alias by `type`, as NDArray is from NumPy 2.5 on
        return _plain(origin.__value__[inside], means)
    if kind is float:
        return float | None if means.open else float
    if origin is np.ndarray:
        return _array(inside, means)
    if origin in (Union, types.UnionType):
        return reduce(or_, (_plain(each, means) for each in inside))
    if origin is tuple and inside[-1] is not Ellipsis:
        held: Any = tuple
        return held[tuple(_plain(each, means) for each in inside)]
    if origin in (tuple, list, Sequence):
        items: Any = list
        return items[_plain(inside[0], means)]
    if origin in (dict, Mapping):
        named: Any = dict
        return named[inside[0], _plain(inside[1], means)]
    if kind is Path or (isinstance(kind, type) and issubclass(kind, BaseException)):
        return str
    record = isinstance(kind, type) and (is_dataclass(kind) or hasattr(kind, "_fields"))
    return part_of(kind) if record else kind


def _array(inside: tuple[Any, ...], means: Means) -> Any:
    """Lists as deep as the shape of an array says, or one of its shapes."""
    import numpy as np

    item: Any = _ITEMS[np.dtype(get_args(inside[1])[0]).kind]
    if means.open:
        item |= None
    return reduce(or_, (_nested(item, shape) for shape in (means.shape or "(n,)").split(" or ")))


def _nested(item: Any, shape: str) -> Any:
    listed: Any = list
    for _ in shape.strip("()").rstrip(",").split(","):
        item = listed[item]
    return item
