"""Arguments and results as JSON and arrays, and back: numbers, texts and records, never code.

What comes back is the same to the bit, with the memory order of its arrays, and what was one object is one
object. A part that is an argument of the function is written as such: later it is that of the later call.
Functions count in a key by their names, and are never read.
"""

from __future__ import annotations

import enum
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass
from functools import cached_property
from pathlib import Path, PurePath
from types import FunctionType
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import polars as pl

#: Kinds of columns that are kept.
_COLUMNS = frozenset({"Float64", "Int64", "UInt32", "String", "Boolean"})
_CLASS = re.compile(r"(hersey(?:\.\w+)+):(\w+)")


class UnstorableError(Exception):
    """A value that is of no kind that is kept, or that nothing here wrote."""


@dataclass
class Encoder:
    """Writes values as JSON and arrays; what was written once is named by its number after that."""

    arrays: list[np.ndarray[Any, Any]] = field(default_factory=list)
    objects: list[Any] = field(default_factory=list)
    functions: bool = False  #: whether functions may be named, as in a key
    _numbers: dict[int, int] = field(default_factory=dict)

    def encoded(self, value: Any) -> Any:
        """Return what JSON holds of a value.

        Raises
        ------
        UnstorableError
            If it is of no kind that is kept.
        """
        kind = type(value)
        if value is None or kind in (bool, int, float, str):
            return value
        if kind is tuple:
            return ["tuple", *map(self.encoded, value)]
        if isinstance(value, tuple) and hasattr(kind, "_fields"):
            return ["named", _name_of(kind), *map(self.encoded, value)]
        if isinstance(value, PurePath):
            return ["path", str(value)]
        if isinstance(value, enum.Enum):
            return ["enum", _name_of(kind), value.name]
        if isinstance(value, np.generic):
            return ["scalar", *self._array(np.asarray(value))]
        if self.functions and kind is FunctionType and "<" not in value.__qualname__:
            return ["function", value.__module__, value.__qualname__]
        if id(value) in self._numbers:
            return ["same", self._numbers[id(value)]]
        written = self._object(value)
        self._numbers[id(value)] = len(self.objects)
        self.objects.append(value)  # so that its id stays its own
        return written

    def _object(self, value: Any) -> Any:
        kind = type(value)
        if kind is np.ndarray:
            return ["array", *self._array(value)]
        if kind is list:
            return ["list", *map(self.encoded, value)]
        if kind is dict:
            return ["dict", *([self.encoded(key), self.encoded(each)] for key, each in value.items())]
        if is_dataclass(kind):
            return ["record", _name_of(kind), *map(self.encoded, self._parts(value))]
        if kind.__name__ == "DataFrame" and kind.__module__.startswith("polars."):
            return ["frame", *map(_column, value.get_columns())]
        raise UnstorableError(str(kind))

    def _parts(self, value: Any) -> list[Any]:
        """The fields of a record, which holds nothing else but what is computed from them again."""
        every = fields(value)
        for name in vars(value).keys() - {each.name for each in every}:
            if not isinstance(getattr(type(value), name, None), cached_property):
                raise UnstorableError(f"{type(value)}.{name}")
        derived = [each for each in every if _is_derived(each)]
        if not self.functions and any(each.default_factory is MISSING for each in derived):
            raise UnstorableError(f"{type(value)} derives what only its making can")
        return [vars(value)[each.name] for each in every if not _is_derived(each)]

    def _array(self, value: np.ndarray[Any, Any]) -> Iterator[Any]:
        layout = "C" if value.flags.c_contiguous else "F" if value.flags.f_contiguous else list(value.strides)
        if not is_kept(value.dtype) or min(value.strides, default=0) < 0:
            raise UnstorableError(f"array of {value.dtype}, strides {value.strides}")
        self.arrays.append(value)
        yield from (value.dtype.str, layout, *value.shape)


@dataclass
class Decoder:
    """Reads what an `Encoder` wrote; ``objects`` are those that it knew before, ``array`` gives the next."""

    objects: list[Any]
    array: Callable[[str, str, tuple[int, ...]], np.ndarray[Any, Any]]

    def decoded(self, written: Any) -> Any:
        """Return the value.

        Raises
        ------
        UnstorableError
            If no `Encoder` wrote it.
        """
        if not isinstance(written, list):
            return written
        kind, *rest = written
        if kind == "same":
            return self.objects[rest[0]]
        if kind == "tuple":
            return tuple(map(self.decoded, rest))
        if kind == "named":
            return tuple.__new__(_class_of(rest[0], tuple), map(self.decoded, rest[1:]))
        if kind == "path":
            return Path(rest[0])
        if kind == "enum":
            return _class_of(rest[0], enum.Enum)[rest[1]]
        if kind == "scalar":
            return self.array(rest[0], rest[1], ())[()]
        value = self._object(kind, rest)
        self.objects.append(value)
        return value

    def _object(self, kind: str, rest: list[Any]) -> Any:
        if kind == "array":
            return self.array(rest[0], rest[1], tuple(rest[2:]))
        if kind == "list":
            return list(map(self.decoded, rest))
        if kind == "dict":
            return {self.decoded(key): self.decoded(each) for key, each in rest}
        if kind == "record":
            return self._record(*rest)
        if kind == "frame":
            return _frame(rest)
        raise UnstorableError(kind)

    def _record(self, name: str, *parts: Any) -> Any:
        """A record with these parts: none of its own code runs."""
        kind = _class_of(name, object)
        if not is_dataclass(kind):
            raise UnstorableError(name)
        made, left = object.__new__(kind), iter(parts)  # type: ignore[arg-type]
        for each in fields(kind):  # in the order in which the class would set them
            if not _is_derived(each):
                vars(made)[each.name] = self.decoded(next(left))
            elif each.default_factory is not MISSING:
                vars(made)[each.name] = each.default_factory()
        return made


def is_kept(dtype: np.dtype[Any]) -> bool:
    """Return whether arrays of a type are kept: of numbers, truth values or texts of one length."""
    return dtype.kind in "fiubU"


def _is_derived(of_record: Field[Any]) -> bool:
    """Whether a field follows from the others: equal records may differ in it."""
    return not of_record.init and not of_record.compare


def _name_of(kind: type) -> str:
    name = f"{kind.__module__}:{kind.__qualname__}"
    if not _CLASS.fullmatch(name):
        raise UnstorableError(name)
    return name


def _class_of(name: str, base: type) -> Any:
    """A class of ours by its name, if its module is loaded: reading loads none."""
    found = _CLASS.fullmatch(name)
    of = found and getattr(sys.modules.get(found[1]), found[2], None)
    if not (isinstance(of, type) and issubclass(of, base) and f"{of.__module__}:{of.__name__}" == name):
        raise UnstorableError(name)
    return of


def _column(series: pl.Series) -> list[Any]:
    if str(series.dtype) not in _COLUMNS:
        raise UnstorableError(f"column of {series.dtype}")
    return [series.name, str(series.dtype), series.to_list()]


def _frame(columns: list[Any]) -> pl.DataFrame:
    import polars as pl

    if not all(kind in _COLUMNS for _, kind, _ in columns):
        raise UnstorableError("frame")
    return pl.DataFrame([pl.Series(name, values, getattr(pl, kind)) for name, kind, values in columns])
