"""Records of a run as JSON, and back: every digit is kept, each value is of the kind that its field has."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Set
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from functools import cache
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells import Rejection
from hersey.damping.dwells.reasons import Reason
from hersey.damping.estimate import Estimate
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.errors import ParameterError
from hersey.life.campaign.kept_warnings import kept_warning, warning_of, with_warnings
from hersey.log.impossible import Impossible
from hersey.log.sensors import Sensors
from hersey.log.torque_log import Channel, Correction, Effect, LogFile
from hersey.schema.domain import Domain
from hersey.schema.warning import Warning

#: Records that are written and read back, by name.
_RECORDS = {
    kind.__name__: kind
    for kind in (
        *(Channel, Correction, Domain, Effect, Estimate, Impossible, LogFile),
        *(NoLoadTorque, Reason, Rejection, Sensors),
    )
}
#: The name of a record stands under "kind", a field of that name under this.
_OWN_KIND = "its kind"
#: Numbers that may be infinite or missing.
_UNBOUNDED = {
    ("Estimate", "low"),
    ("Estimate", "high"),
    ("Estimate", "freedom"),
    ("NoLoadTorque", "freedom"),
    ("Impossible", "values"),
    ("Impossible", "low"),
    ("Impossible", "high"),
    ("Rejection", "speed"),
}


def plain(value: Any) -> Any:
    """Return a value as JSON, records by their names, so that `restored` gives it back with every digit."""
    if is_dataclass(value) and not isinstance(value, type):
        if isinstance(value, Warning):
            own = kept_warning(value)
        else:
            own = {f.name: plain(getattr(value, f.name)) for f in fields(value)}
        if "kind" in own:
            own[_OWN_KIND] = own.pop("kind")
        return {"kind": type(value).__name__} | own
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        return {"array": value.tolist(), "shape": list(value.shape)}
    if isinstance(value, tuple | list):
        return [plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def read_json(text: str) -> dict[str, Any]:
    """Return a JSON object.

    Raises
    ------
    ParameterError
        If it is none, or nested too deep.
    """
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ParameterError(f"not valid JSON ({error})") from None
    if not isinstance(found, dict):
        raise ParameterError("not a JSON object")
    return found


def restored(value: Any, kinds: Mapping[str, Any]) -> dict[str, Any]:
    """Return what `plain` was given: a table with exactly the keys of ``kinds``, each of its kind.

    Raises
    ------
    ParameterError
        Naming the first key that is missing, unknown or of another kind.
    """
    found = _restored(value)
    if not isinstance(found, dict):
        raise ParameterError("not a JSON object")
    found = with_warnings(found, kinds)
    refuse_others(found, kinds)
    return found


def _restored(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(_restored(item) for item in value)
    if not isinstance(value, dict):
        return value
    if "shape" in value:
        return _array(value)
    inside = {name: _restored(item) for name, item in value.items()}
    if "kind" not in inside:
        return inside
    name = inside.pop("kind")
    if _OWN_KIND in inside:
        inside["kind"] = inside.pop(_OWN_KIND)
    if name == Warning.__name__:
        return warning_of(inside)
    record = _RECORDS.get(name) if isinstance(name, str) else None
    if record is None:
        raise ParameterError("'kind' is not a known record")
    inside = with_warnings(inside, _kinds_of(record))
    defaults = {f.name for f in fields(record) if f.name not in inside and _has_default(f)}
    kinds = {name: kind for name, kind in _kinds_of(record).items() if name not in defaults}
    refuse_others(inside, kinds, f"{name}.", {field for of, field in _UNBOUNDED if of == name})
    made: Any = record(**{name: _member(value, kinds.get(name)) for name, value in inside.items()})
    return made


def _member(value: Any, kind: Any) -> Any:
    """The member of an enumeration, of which its value is kept."""
    return kind(value) if isinstance(kind, type) and issubclass(kind, Enum) else value


def _has_default(field: Any) -> bool:
    return field.default is not MISSING or field.default_factory is not MISSING


@cache
def _kinds_of(record: type) -> dict[str, Any]:
    return get_type_hints(record)


def _array(value: dict[str, Any]) -> FloatArray:
    """An array whose numbers are finite and as many as its shape says."""
    try:
        shape = tuple(value["shape"])
        if not all(type(length) is int and length >= 0 for length in shape):
            raise ValueError
        found = np.array(value["array"], dtype=float)
        if found.size != math.prod(shape) or not np.all(np.isfinite(found)):
            raise ValueError
        return found.reshape(shape)
    except (KeyError, TypeError, ValueError, OverflowError):
        raise ParameterError("an 'array' does not contain finite numbers of the stated 'shape'") from None


def refuse_others(
    found: dict[str, Any], kinds: Mapping[str, Any], place: str = "", unbounded: Set[str] = frozenset()
) -> None:
    """Refuse keys that are missing or unknown, and values of another kind; ``place`` leads their names.

    Raises
    ------
    ParameterError
        Naming the first.
    """
    for name in found.keys() ^ kinds.keys():
        what = "is missing" if name in kinds else "is unknown"
        raise ParameterError(f"'{place}{name[:40]}' {what}")
    for name, kind in kinds.items():
        if not _is(found[name], kind, finite=name not in unbounded):
            raise ParameterError(f"'{place}{name}' has a value of the wrong type")


def _is(value: Any, kind: Any, *, finite: bool) -> bool:
    """Whether a value is of an annotated kind; an array is of any shape."""
    origin, inside = get_origin(kind), get_args(kind)
    if hasattr(origin, "__value__"):  # alias by `type`, as NDArray is from NumPy 2.5 on
        return _is(value, origin.__value__[inside], finite=finite)
    if origin in (Union, UnionType):
        return any(_is(value, each, finite=finite) for each in inside)
    if origin is Literal:
        return isinstance(value, str) and value in inside
    if isinstance(kind, type) and issubclass(kind, Enum):
        return value in [each.value for each in kind]
    if origin is tuple:
        each = [inside[0]] * len(value) if inside[-1:] == (...,) and isinstance(value, tuple) else inside
        return (
            isinstance(value, tuple)
            and len(value) == len(each)
            and all(_is(item, of, finite=finite) for item, of in zip(value, each, strict=True))
        )
    if kind is float:
        return type(value) in (int, float) and (not finite or (abs(value) <= 1e300))
    if kind is int:
        return type(value) is int and abs(value) < 1 << 62
    if kind is dict or origin is dict:
        return isinstance(value, dict)
    if origin is np.ndarray or kind is np.ndarray:
        return isinstance(value, np.ndarray)
    return type(value) is kind
