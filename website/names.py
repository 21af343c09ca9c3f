"""The reference of the Python names: an overview, and a page per room in the order of the computation."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

import hersey
from hersey import errors
from website.said import first_sentence
from website.text import joined, table, wrapped

#: What a reader calls each room that has public names.
TITLES = {
    "errors": "Errors",
    "scale": "Sweeps in folders",
    "log": "Logs",
    "motion": "Drag and motion",
    "damping": "Dwells and the damping surface",
    "inspection": "Inspection",
    "lubrication": "Lubricant, contact and film",
    "machine": "The machine",
    "verdict": "Lubrication regime",
    "identification": "Stick-slip traces",
    "stability": "Safe speeds and profiles",
    "posterior": "Posterior",
    "study": "Study",
    "life": "Life tests",
    "exchange": "Exchange",
    "report": "Report",
}
_ALL = (
    'Numbers are in SI. An argument may also be a text with a unit, such as `"400 rpm"`. Every result has '
    "`summary()`, `to_dict()`, `to_frame()`, `to_pandas()` and `chart()`. `hersey.__version__` is the "
    "version."
)
_ROOM = re.compile(r"^(\w+)  ", re.MULTILINE)


def public() -> dict[str, dict[str, Any]]:
    """Return the public names and what they are, by room in the order of the computation.

    What serves all rooms, and stands before the first of them, comes last.
    """
    order = _ROOM.findall(hersey.__doc__ or "")
    first = order.index("log")
    rooms: dict[str, dict[str, Any]] = {name: {} for name in (*order[first:], *order[:first])}
    for name in sorted(hersey.__all__, key=lambda name: (name[0].islower(), name)):
        thing = getattr(hersey, name)
        if not isinstance(thing, str):  # the version
            rooms[thing.__module__.split(".")[1]][name] = thing
    return {room: names for room, names in rooms.items() if names}


def pages() -> Iterator[tuple[str, str]]:
    """Return each page of the folder ``reference/python``: name and text."""
    found = public()
    yield "index.md", _index(found)
    for room, names in found.items():
        yield f"{room}.md", _room(room, names)


def _index(rooms: dict[str, dict[str, Any]]) -> str:
    count = sum(map(len, rooms.values()))
    about = (
        f"`import hersey` gives {count} names. They follow the computation: from a log to dwells, from "
        "dwells to the damping surface, from the surface to the motion of the belt, and on to what to do."
    )
    parts = ["# Python", wrapped(about), wrapped(_ALL)]
    for room, names in rooms.items():
        parts += [f"## {TITLES[room]}", _table(names, f"{room}.md")]
    return joined(parts)


def _room(room: str, names: dict[str, Any]) -> str:
    parts = [f"# {TITLES[room]}", _table(names, "")]
    parts += [
        f"::: {_path(thing)}\n    options:\n      heading: hersey.{name}\n      toc_label: {name}"
        for name, thing in names.items()
    ]
    if room == "errors":
        parts += ["## Kinds of errors", _errors()]
    return joined(parts)


def _table(names: dict[str, Any], page: str) -> str:
    rows = [
        (f"[`{name}`]({page}#{_path(thing)})", first_sentence(inspect.getdoc(thing) or ""))
        for name, thing in names.items()
    ]
    return table(("name", "what it is"), rows)


def _errors() -> str:
    kinds = [each for each in vars(errors).values() if isinstance(each, type)]
    rows = []
    for kind in kinds:
        if issubclass(kind, errors.HerseyError) and kind is not errors.HerseyError:
            built_in = next(base.__name__ for base in kind.__mro__ if base.__module__ == "builtins")
            rows.append((f"`{kind.__name__}`", f"`{built_in}`", first_sentence(inspect.getdoc(kind) or "")))
    return table(("error", "also a", "when"), rows)


def _path(thing: Any) -> str:
    return f"{thing.__module__}.{thing.__qualname__}"
