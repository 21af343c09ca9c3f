"""Arguments in SI, whatever way they are given."""

from __future__ import annotations

import inspect
import math
import sys
import warnings
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, TypeVar, cast

from hersey.arguments.door import ROLL_RADIUS, Door, Keys, Words
from hersey.arguments.frozen import explained
from hersey.arguments.numbers import duration, numbers
from hersey.errors import ParameterError, PlausibilityWarning, UnitError, WrongKindError
from hersey.units.into_si import celsius, conversion
from hersey.units.quantity import parse

F = TypeVar("F", bound=Callable[..., Any])
#: A key of `hersey.units.kinds.KINDS`, or several where an argument may be one of them.
Kind = str | tuple[str, ...]
#: A plain number below this is no temperature of a drive in K, but one in degC.
_COLDEST = 250.0
#: A roll of a greater radius, m, is none of a drive, but one in mm.
_LARGEST_ROLL = 2.0
#: Frames from the warning of an argument to the call of the user.
_USER = 6


def si(kind: str, value: Any) -> Any:
    """Return an argument in SI, whatever way it was given.

    Parameters
    ----------
    kind
        A key of `KINDS`.
    value
        Number or array in SI, returned as it is; string with its unit (``"400 rpm"``); pint quantity; or a
        list, tuple or column of strings or quantities, which becomes an array.

    Raises
    ------
    UnitError
        If a string or a quantity has no unit, or one of another kind.

    Examples
    --------
    >>> si("temperature", "150 degC"), si("belt speed", 0.1)
    (423.15, 0.1)
    """
    if isinstance(value, str):
        return parse(kind, value)
    if (items := _with_units(value)) is not None:
        import numpy as np

        return np.array([si(kind, item) for item in items], dtype=float)
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        line = conversion(kind, f"{value.units:~C}" or str(value.units))
        return line.scale * value.magnitude + line.offset
    return value


def _with_units(value: Any) -> list[Any] | None:
    """The items of a list or a column of strings or quantities; None for anything else."""
    if isinstance(value, list | tuple):
        held = any(isinstance(v, str | list | tuple) or hasattr(v, "magnitude") for v in value)
        return list(value) if held else None
    if hasattr(value, "dtype") and not hasattr(value, "magnitude") and getattr(value, "ndim", 1) == 1:
        import numpy as np

        return list(value) if np.asarray(value).dtype.kind in "OU" else None
    return None


def argument(name: str, kind: Kind, value: Any, *, one: bool = False) -> Any:
    """Return an argument in SI as `si` does, of the first of several kinds that its unit is one of.

    Raises
    ------
    UnitError
        With the name of the argument.
    ArgumentError, ParameterError
        If it is no number or array, not the ``one`` that is needed, or a temperature in K that can only be
        one in degC.
    """
    if value is None:
        return None
    kinds = (kind,) if isinstance(kind, str) else kind
    if "time" in kinds and (seconds := duration(value)) is not None:
        return seconds
    if not isinstance(value, str) and not hasattr(value, "magnitude"):
        if (items := _with_units(value)) is None:
            found = numbers(name, value, one=one)
            if name == ROLL_RADIUS:
                _doubt_radius(found)
            if kinds == ("temperature",) and name != "temperature_zero":
                _refuse_celsius(name, found)
            return found
        import numpy as np

        value = np.array([argument(name, kind, item) for item in items], dtype=float)
        return numbers(name, value, one=one)
    for each in kinds:
        try:
            return numbers(name, si(each, value), one=one)
        except UnitError as error:
            if each == kinds[-1] or not isinstance(error, WrongKindError):
                raise type(error)(f"{name}: {error}") from None
    return value


def _refuse_celsius(name: str, value: Any) -> None:
    """Refuse plain numbers in K that a user can only have meant in degC."""
    coldest = value
    if not isinstance(value, float | int):
        import numpy as np

        coldest = float(np.nanmin(value)) if np.size(value) and not np.all(np.isnan(value)) else _COLDEST
    if coldest < _COLDEST and not _called_from_inside():
        kelvin = f", or '{coldest:g} K' if that is meant" if coldest > 0 else ""
        raise ParameterError(
            f"{name} is {coldest:g} without a unit, which means {coldest:g} K ({celsius(coldest):.4g} degC)",
            quantity=name,
            value=float(coldest),
            unit="K",
            remedy=f"write '{coldest:g} degC'{kelvin}",
        )


def _doubt_radius(value: Any) -> None:
    """Warn of a plain number in m that a user can only have meant in mm."""
    if isinstance(value, float | int) and _LARGEST_ROLL < value < math.inf and not _called_from_inside():
        said = f"roll_radius is {value:g} without a unit, which means {value:g} m. If it is in mm, write"
        warnings.warn(PlausibilityWarning(f"{said} '{value:g} mm'"), stacklevel=_USER)


def _called_from_inside() -> bool:
    """Whether the package itself called what checks its arguments here: its plain numbers are in SI."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_globals["__name__"] in (__name__, Door.__module__):
        frame = frame.f_back
    return str(frame.f_globals["__name__"]).startswith("hersey.")


def takes_si(**kinds: Kind | Words | Keys) -> Callable[[F], F]:
    """Check what a function or a record is called with; take the arguments named as `argument` does.

    Names and types follow from the signature (`hersey.arguments`). Quantities, each of its kind, may be
    parameters of the function, or keywords that it takes by ``**``.
    """

    def decorate(function: F) -> F:
        if isinstance(function, type):
            _check_fields(function, kinds)
            return function
        title = function.__name__
        if title == "__init__":
            title = function.__qualname__.split(".")[-2]
        door = Door(inspect.signature(function), title, kinds, _read)

        @wraps(function)
        def called(*args: Any, **kwargs: Any) -> Any:
            return function(**door.admit(args, kwargs))

        return cast("F", called)

    return decorate


def _check_fields(record: Any, kinds: Mapping[str, Kind | Words | Keys]) -> None:
    """Let a record check the fields that it is made with."""
    door, made = Door(inspect.signature(record), record.__name__, kinds, _read), record.__init__

    @wraps(made)
    def called(self: Any, *args: Any, **kwargs: Any) -> None:
        made(self, **door.admit(args, kwargs))

    record.__init__ = called
    if record.__dataclass_params__.frozen:
        explained(record)


def _read(name: str, kind: Kind | None, value: Any, *, one: bool) -> Any:
    """Return a quantity in SI, or plain numbers if no kind is given; refuse what cannot be."""
    if kind is None:
        return numbers(name, value, one=one)
    return argument(name, kind, value, one=one)
