"""Fields of records, which cannot be set: the error names the call that makes another record."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import FrozenInstanceError, fields
from functools import wraps
from numbers import Real
from typing import Any, TypeVar, cast

from hersey.arguments.door import nearest_argument
from hersey.errors import printable

T = TypeVar("T")
#: Characters of a value that an example call shows.
_SHORT = 60


def explaining(refuse: Callable[[Any, str, Any], None]) -> Callable[[Any, str, Any], None]:
    """Return what a frozen data class refuses assignments by, with how to get a changed record."""
    if hasattr(refuse, "__wrapped__"):
        return refuse

    @wraps(refuse)
    def explained(self: Any, name: str, value: Any) -> None:
        try:
            refuse(self, name, value)
        except FrozenInstanceError:
            raise FrozenInstanceError(_of_frozen(type(self), name, value)) from None

    return explained


def explained(record: type[T]) -> type[T]:
    """Let a frozen data class say, when a field is set, how to get a changed one."""
    changed: Any = record
    changed.__setattr__ = explaining(changed.__setattr__)
    return record


def _of_frozen(record: type, name: str, value: Any) -> str:
    """That a record cannot be changed, and the call that makes another one."""
    known = [each.name for each in fields(cast("Any", record)) if each.init]
    if name not in known:
        near = nearest_argument(name, known)
        did = f"Did you mean {near}?" if near else f"Its fields are {', '.join(known)}"
        return f"{record.__name__} has no field '{printable(name)}' to set. {did}"
    variable = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", record.__name__).lower()
    new = repr(value) if isinstance(value, str | Real) and len(repr(value)) <= _SHORT else "..."
    return (
        f"{record.__name__} cannot be changed. Make another one: "
        f"{variable} = dataclasses.replace({variable}, {name}={new})"
    )
