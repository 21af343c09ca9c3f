"""``@kept``: a function whose results are kept on disk, by its name and all its arguments."""

from __future__ import annotations

import hashlib
import inspect
import json
import weakref
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np

from hersey.cache.encoding import Encoder, UnstorableError
from hersey.cache.entries import Entries, entries_of
from hersey.cache.origin import origin
from hersey.cache.switch import cache_folder, spoilt
from hersey.errors import way_in

P = ParamSpec("P")
T = TypeVar("T")

#: Arrays from this size on are hashed once: those of a log do not change.
_LONG = 1 << 20
#: Hashes of long arrays by their identity.
_hashes: dict[int, tuple[weakref.ref[Any], str]] = {}


def kept(
    *, apart: Sequence[str] = (), sound: Callable[..., bool] = lambda *_: True
) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Return a decorator of a function whose result follows from its arguments.

    Parameters
    ----------
    apart
        Arguments on which the result does not depend, such as ``progress``.
    sound
        Whether a result may be kept; called with it and the arguments by name.
    """

    def of(function: Callable[P, T]) -> Callable[P, T]:
        signature = inspect.signature(function)
        kinds = {each.kind: each.name for each in signature.parameters.values()}
        others = kinds.get(inspect.Parameter.VAR_KEYWORD, "")
        qualified = f"{function.__module__}:{function.__qualname__}"

        @wraps(function)
        def run(*given: P.args, **named: P.kwargs) -> T:
            folder = cache_folder()
            if folder is None:
                return function(*given, **named)
            bound = signature.bind(*given, **named)
            bound.apply_defaults()
            given_by_name = bound.arguments | bound.arguments.pop(others, {}) if others else bound.arguments
            counts = {each: value for each, value in given_by_name.items() if each not in apart}
            entries, encoder = entries_of(folder), Encoder(functions=True)
            try:
                key = _key(qualified, counts, encoder)
            except (UnstorableError, OSError):
                return function(*given, **named)
            if found := entries.read(key, encoder.objects):
                value: T = found[0]
                return value
            before = spoilt()
            value = function(*given, **named)
            if before == spoilt() and sound(value, counts):
                _keep(entries, key, value, encoder)
            return value

        return run

    return of


def _key(name: str, arguments: dict[str, Any], encoder: Encoder) -> str:
    """The hash of all that a result follows from."""
    written = [
        origin(),
        way_in(),
        name,
        [[each, encoder.encoded(value)] for each, value in arguments.items()],
    ]
    digest = hashlib.sha256(json.dumps(written).encode())
    for array in encoder.arrays:
        digest.update(_hash_of(array).encode())
    return digest.hexdigest()


def _keep(entries: Entries, key: str, value: Any, encoder: Encoder) -> None:
    """Write a result, if it is of a kind that is kept."""
    encoder.functions, encoder.arrays = False, []
    try:
        written = encoder.encoded(value)
    except UnstorableError:
        return
    entries.write(key, written, encoder.arrays)


def _hash_of(array: np.ndarray[Any, Any]) -> str:
    """The hash of the numbers of an array in the order of their places."""
    known = _hashes.get(id(array))
    if known is not None and known[0]() is array:
        return known[1]
    flat = np.ascontiguousarray(array).reshape(-1).view(np.uint8)
    found = hashlib.sha256(flat.data).hexdigest()
    if array.nbytes >= _LONG:
        number = id(array)
        _hashes[number] = weakref.ref(array, lambda _: _hashes.pop(number, None)), found
    return found
