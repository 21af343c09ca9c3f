"""Warnings of a run as JSON, and back: kind, numbers and the words as they were shown.

The words that are kept are no template: braces in a file from anywhere stand for themselves. Version 1 of the
file kept sentences alone, under ``notes`` or ``note``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, get_args

import numpy as np

from hersey.errors import ParameterError, Setting
from hersey.schema.warning import Severity, Warning, is_value

#: What is kept of a warning, beside its kind.
_KEPT = {"kind": str, "severity": str, "where": str, "values": tuple, "title": str, "text": str}
#: Kind of a warning of which only the sentence was kept.
SENTENCE = "kept sentence"


def kept_warning(warning: Warning) -> dict[str, Any]:
    """Return a warning as JSON: its values as pairs, without settings, which its words name."""
    values = [
        [name, value.item() if isinstance(value, np.generic) else value]
        for name, value in warning.values.items()
        if not isinstance(value, Setting)
    ]
    return {name: getattr(warning, name) for name in _KEPT} | {"values": values}


def warning_of(kept: dict[str, Any]) -> Warning:
    """Return the warning that was kept, lists as tuples.

    Raises
    ------
    ParameterError
        Naming the first key that is missing, unknown or of another kind.
    """
    for name in kept.keys() ^ _KEPT.keys():
        raise ParameterError(f"'Warning.{name[:40]}' {'is missing' if name in _KEPT else 'is unknown'}")
    values = kept["values"]
    sound = {name: type(kept[name]) is kind for name, kind in _KEPT.items()}
    sound["severity"] &= kept["severity"] in get_args(Severity)
    sound["values"] &= sound["values"] and all(map(_is_value, values))
    for name in (name for name, holds in sound.items() if not holds):
        raise ParameterError(f"'Warning.{name}' has a value of the wrong type")
    return Warning.said(**(kept | {"values": dict(values)}))


def with_warnings(found: dict[str, Any], kinds: Mapping[str, Any]) -> dict[str, Any]:
    """Return what was kept with its ``notes``, or its ``note``, as the warnings that it should have."""
    old = next((name for name in ("notes", "note") if name in found), "")
    if not old or old in kinds or "warnings" not in kinds:
        return found
    held = found[old]
    notes = tuple(filter(None, [held])) if old == "note" and isinstance(held, str) else held
    if not (isinstance(notes, tuple) and all(isinstance(each, str) for each in notes)):
        raise ParameterError(f"'{old}' has a value of the wrong type")
    warnings = tuple(Warning(SENTENCE, "{text}", text=each) for each in notes)
    return {name: value for name, value in found.items() if name != old} | {"warnings": warnings}


def _is_value(pair: Any) -> bool:
    """Whether a name and a value may be among those of a warning."""
    if not (isinstance(pair, tuple) and len(pair) == 2):
        return False
    return is_value(*pair)
