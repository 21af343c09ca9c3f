"""The JSON schema of a record, from the types and meanings of its own fields."""

from __future__ import annotations

import inspect
import sys
import types
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from functools import cache, reduce
from operator import or_
from pathlib import Path
from typing import Annotated, Any, Union, get_args, get_origin

import numpy as np
from pydantic import BaseModel, GetCoreSchemaHandler, create_model
from pydantic import Field as Described
from pydantic_core import CoreSchema, core_schema

from hersey.result import Means, json_value, stated_names
from hersey.schema.part import Part

#: Items of JSON by the kind of an array.
_ITEMS: dict[str, Any] = {"f": float, "i": int, "u": int, "b": bool, "U": str}


@cache
def part_of(record: type) -> Any:
    """Return the part of the document that holds a record: its schema, and what checks JSON against it."""
    if issubclass(record, BaseModel):
        return record
    defaults = _defaults(record)
    members = {}
    for name in stated_names(record):
        kind, means = declared(record, name)
        described = {"description": means.description or None} | defaults.get(name, {})
        members[name] = (_plain(kind, means), Described(**described))
    made: Any = create_model
    return made(record.__name__, __base__=Part, __doc__=inspect.getdoc(record), **members)


def held(record: type, handler: GetCoreSchemaHandler) -> CoreSchema:
    """Return how pydantic holds a record: as it is, as its part where JSON is read, in JSON by `to_dict`."""
    part = handler.generate_schema(part_of(record))
    return core_schema.json_or_python_schema(
        json_schema=part,
        python_schema=core_schema.union_schema([core_schema.is_instance_schema(record), part]),
        serialization=core_schema.plain_serializer_function_ser_schema(
            lambda value: value.model_dump() if isinstance(value, BaseModel) else json_value(value)
        ),
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
        told = own[name] if name in own else inspect.get_annotations(getter)["return"]
        kind = eval(told, vars(sys.modules[owner.__module__])) if isinstance(told, str) else told
        means = [each for each in getattr(kind, "__metadata__", ()) if isinstance(each, Means)]
        return (get_args(kind)[0] if means else kind), (means[0] if means else Means())
    raise AttributeError(f"{record.__name__} has no {name}")


def _plain(kind: Any, means: Means) -> Any:
    """The type by which JSON holds a type of Python."""
    origin, inside = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return _plain(inside[0], next((each for each in inside if isinstance(each, Means)), means))
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
    return part_of(kind) if record and not issubclass(kind, BaseModel) else kind


def _array(inside: tuple[Any, ...], means: Means) -> Any:
    """Lists as deep as the shape of an array says."""
    held: Any = _ITEMS[np.dtype(get_args(inside[1])[0]).kind]
    if means.open:
        held |= None
    listed: Any = list
    for _ in range(means.shape.count(",") + (not means.shape.endswith(",)")) if means.shape else 1):
        held = listed[held]
    return held
