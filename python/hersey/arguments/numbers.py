"""Numbers of whatever type, and what a value is in words."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import timedelta
from numbers import Real
from typing import Any

from hersey.errors import ArgumentError, ParameterError, printable


def is_other(value: Any) -> bool:
    """Whether a value is an object that holds no numbers, such as a result or a function."""
    return isinstance(value, Mapping | set) or callable(value) or hasattr(value, "__dataclass_fields__")


def is_duration(value: Any) -> bool:
    """Whether a value is a duration with its unit, of the standard library, NumPy or pandas."""
    return isinstance(value, timedelta) or type(value).__name__ == "timedelta64"


def duration(value: Any) -> float | None:
    """Return a duration in s; None for anything else, also for months, which have no length."""
    if isinstance(value, timedelta):
        return value.total_seconds()
    if not is_duration(value):
        return None
    import numpy as np

    try:
        return float(value / np.timedelta64(1, "s"))
    except TypeError:
        return None


def with_article(name: str) -> str:
    """Return the name of a class as a noun."""
    return name if name.endswith("s") else f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"


def described(value: Any) -> str:
    """Return what a value is, in words."""
    kind = type(value).__name__
    if value is None or isinstance(value, bool):
        return str(value)
    if isinstance(value, str):
        return f"the text '{printable(value[:40])}'"
    if is_duration(value):
        return f"the duration {value}"
    if isinstance(value, Real):
        return f"the number {value}"
    if kind == "DataFrame":
        columns = [str(name) for name in value.columns]
        return f"a table with the columns {printable(', '.join(columns[:6]))}{', ...' * (len(columns) > 6)}"
    if kind == "ndarray":
        return f"an array of shape {value.shape}"
    if callable(value) and hasattr(value, "__name__"):
        return f"the {'class' if isinstance(value, type) else 'function'} {value.__name__}"
    return with_article({"dict": "dictionary"}.get(kind, kind))


def numbers(name: str, value: Any, *, one: bool) -> Any:
    """Return numbers of whatever type; an array unless they are already a number, a list or an array.

    Raises
    ------
    ArgumentError
        If they are no numbers, or more than the ``one`` that is needed.
    ParameterError
        If a single one is not a number, or some are masked.
    """
    if isinstance(value, Real) and not isinstance(value, bool) and not is_duration(value):
        if value != value:
            raise ParameterError(f"{name} is NaN: it must be a number", quantity=name)
        return value
    import numpy as np

    wanted = "one number" if one else "a number or an array of numbers"
    if type(value).__name__ == "DataFrame":
        example = printable(str(value.columns[0])) if len(value.columns) else "..."
        raise ArgumentError(
            f"{name} is {described(value)}. It must be {wanted}",
            remedy=f"give one column, e.g. table['{example}']",
        )
    if hasattr(value, "magnitude"):
        raise ArgumentError(
            f"{name} is a quantity with a unit. It must be {wanted}", remedy="give its magnitude"
        )
    if is_other(value) or isinstance(value, str | bytes | bool):
        raise ArgumentError(f"{name} is {described(value)}. It must be {wanted}")
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        masked = int(np.ma.getmaskarray(value).sum())
        raise ParameterError(
            f"{name} has {masked} masked value{'s' * (masked != 1)}. Drop them with {name}.compressed()",
            quantity=name,
        )
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} is not {wanted}, but {described(value)}") from None
    if np.asarray(value).dtype.kind in "mMc":
        raise ArgumentError(f"{name} is {described(value)}. It must be {wanted}")
    if one and array.size != 1:
        raise ArgumentError(
            f"{name} has {array.size} values. It must be one number", remedy="call once for each"
        )
    if one:
        return numbers(name, float(array.reshape(())), one=True)
    return value if isinstance(value, list | tuple | np.ndarray) else array
