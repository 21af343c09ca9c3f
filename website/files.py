"""The reference of the files that hersey reads: every key, from the tables that read them.

The meaning of a key is the comment ``#:`` above its field, or the words of its question in
`hersey.machine.questions`; for a recipe it is in the docstring of `hersey.Recipe`.
"""

from __future__ import annotations

import dataclasses
import inspect
import math
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from hersey.damping.recipe import Recipe
from hersey.files.toml import Quantity, Table, quoted
from hersey.log.mapping import _Roles
from hersey.machine.machine import _MachineFile
from hersey.machine.questions import BY_KEY, Question
from hersey.motion.parameters import OF_THE_BELT
from hersey.motion.scenario import _ScenarioFile
from hersey.units import KINDS
from website.navigation import ROOT
from website.said import cell, comments, listed
from website.text import joined, sections, table

TEMPLATE = Path(__file__).parent / "templates" / "files.md"
#: The files that have tables, by the heading in the template.
FILES: dict[str, Any] = {
    "Machine file": _MachineFile,
    "Mapping": _Roles,
    "Recipe": Recipe,
    "Scenario": _ScenarioFile,
}
#: A heading of a table in the template, and a key in an example, also where it is in a comment.
_TABLE = re.compile(r"^### (.+)$", re.MULTILINE)
_EXAMPLE = re.compile(r"^(?:# )?(\w+) = (\"[^\"]*\"|\[.*\]|\{.*\}|\S+)")
_HEADING = re.compile(r"^(?:# )?\[{1,2}([\w.]+)\]")


def page() -> str:
    """Return the page.

    Raises
    ------
    ValueError
        If the template lacks a table, or has one that no file has.
    """
    head, beside = sections(TEMPLATE.read_text(encoding="utf-8"))
    parts = [head]
    for title, text in beside.items():
        parts += [f"## {title}", *(_file(FILES[title], text) if title in FILES else [text])]
    return joined(parts)


def _file(kind: Any, text: str) -> Iterator[str]:
    """What the template says of a file, with a table of keys for each of its tables."""
    first, *others = _TABLE.split(text)
    said = dict(zip(others[::2], others[1::2], strict=True))
    yield first
    keys = dict(_keys(kind))
    if plain := keys.pop("", []):
        yield table(_HEADS, plain)
    for name, rows in keys.items():
        if name not in said:
            raise ValueError(f"{TEMPLATE.name} has no heading '### {name}'")
        yield f"### `{name}`"
        yield said.pop(name)
        yield table(_HEADS, rows)
    if said:
        raise ValueError(f"{TEMPLATE.name} has tables that no file has: {', '.join(said)}")


_HEADS = ("key", "example", "meaning", "default", "accepted")
_Row = tuple[str, str, str, str, str]


def _keys(kind: Any) -> Iterator[tuple[str, list[_Row]]]:
    """The tables of a file with a row for each key; those of the file itself have no name."""
    if kind is Recipe:
        yield "", [_of_recipe(each) for each in dataclasses.fields(Recipe)]
        return
    hints = get_type_hints(kind, include_extras=True)
    for name in (each.name for each in dataclasses.fields(kind)):
        if name == "uncertainty" and kind is _MachineFile:
            yield f"[{name}]", [_of_uncertainty(each) for each in OF_THE_BELT]
        elif name == "schedule" and kind is not _MachineFile:
            yield f"[[{name}]]", [(f"`{key}`", f'`"{of}"`', words, "", "") for key, of, words in _STEP]
        else:
            yield from _tables(name, _plain(hints[name]), f"[[{name}]]" if name == "points" else f"[{name}]")


def _tables(name: str, kind: Any, heading: str) -> Iterator[tuple[str, list[_Row]]]:
    """A table, and those within it."""
    hints = get_type_hints(kind, include_extras=True)
    fields = {each.name: each for each in dataclasses.fields(kind)}
    inner = {key: _plain(hints[key]) for key in fields if _is_table(_plain(hints[key]))}
    rows = [_row(name, key, hints[key], field, kind) for key, field in fields.items() if key not in inner]
    if rows:
        yield heading, rows
    for key, within in inner.items():
        yield from _tables(key, within, f"[{name}.{key}]")


def _row(name: str, key: str, hint: Any, field: dataclasses.Field[Any], kind: Any) -> _Row:
    question = BY_KEY.get(f"{name}.{key}")
    words = comments(kind).get(key) or (question.words if question is not None else "")
    if not words:
        raise ValueError(f"nothing says what [{name}] {key} means: write a comment #: above the field")
    quantity = _quantity(hint)
    at = (name, key)
    example = (
        _examples().get(at) or _OTHERS.get(at) or (question and _asked(question)) or _written(quantity, hint)
    )
    return f"`{key}`", f"`{example}`", cell(words), _default(field, quantity), _accepted(quantity)


def _asked(question: Question) -> str:
    """The example of a question, as a file has it."""
    value = question.values(question.example)[question.key]
    return quoted(value) if isinstance(value, str) else str(value)


def _of_uncertainty(key: str) -> _Row:
    example = _examples().get(("uncertainty", key), '"10 %"')
    words = key.replace("_", " ").replace("ehl", "EHL")
    return f"`{key}`", f"`{example}`", f"Uncertainty of the {words}", "", ""


def _of_recipe(field: dataclasses.Field[Any]) -> _Row:
    hint = get_type_hints(Recipe, include_extras=True)[field.name]
    quantity = _quantity(hint)
    example = _IN_RECIPE.get(field.name) or _written(quantity, hint)
    return (
        f"`{field.name}`",
        f"`{example}`",
        cell(listed(inspect.getdoc(Recipe) or "")[field.name]),
        _default(field, quantity),
        "",
    )


#: Examples of keys that no example file and no question has, by table and key.
_OTHERS = {
    ("limits", "spring_force"): '"200 N"',
    ("contact", "roll_radius"): '"15 mm"',
    ("contact", "shore_a"): "20",
    ("contact", "load"): '"300 N"',
    ("contact", "heater_radius"): '"-15 mm"',
    ("contact", "supply"): '"20 um"',
    ("contact", "sensor_side"): '"heater"',
    ("lubricant", "example"): '"cylinder oil"',
    ("names", "table"): '"runs.csv"',
    ("lubricant", "source"): '"data sheet"',
    ("lubricant", "relaxation_time"): '"1 us"',
    ("lubricant", "carreau_exponent"): "0.6",
    ("lubricant", "viscosity_left"): "0.1",
    ("points", "share"): '"60 %"',
    ("speed", "gain_error"): '"0.1 %"',
    ("rest", "temperature_slope"): '"-0.2 %/K"',
    ("torque", "no_load"): '"no-load.csv"',
    ("load", "channel"): '"Fn"',
    ("load", "unit"): '"N"',
    ("load", "values"): '["10 N", "20 N"]',
    ("radius", "channel"): '"Track radius"',
    ("radius", "unit"): '"mm"',
    ("radius", "values"): '["25 mm", "30 mm"]',
    ("position", "channel"): '"Angle"',
    ("position", "unit"): '"deg"',
    ("direction", "channel"): '"Dir"',
    ("direction", "unit"): '""',
    ("names", "pattern"): '"{speed} rpm {load} N.csv"',
    ("names", "decimal"): '"-"',
    ("run", "channel"): '"Test no"',
    ("run", "unit"): '"1"',
    ("options", "bristle_stiffness"): '"1000 N/mm"',
    ("options", "bristle_damping"): '"10 N*s/m"',
    ("options", "duration"): '"10 s"',
    ("options", "tolerance"): "1e-9",
}
#: Keys of a step of a schedule: example and meaning.
_STEP = (
    ("from", "0 s", "Begin, counted from the first row of the log."),
    ("to", "60 s", "End."),
    ("speed", "20 rpm", "Set point of the speed."),
    ("temperature", "80 degC", "Set point of the temperature."),
    ("load", "50 N", "Normal load."),
)
#: Examples of settings of a recipe.
_IN_RECIPE = {
    "logs": '["bench.csv"]',
    "mapping": '"hersey.toml"',
    "channels": '{ torque = "Drive torque" }',
    "units": '{ torque = "N*m" }',
    "signs": "{ torque = -1 }",
    "tare": '"standing"',
    "rotation": '"forward"',
    "temperature_scale": '"K"',
    "no_load": '"no-load.csv"',
    "name_pattern": '"{speed} rpm {load} N.csv"',
    "name_decimal": '"-"',
    "run_table": '"runs.csv"',
    "schedule": '"plan.csv"',
}


@cache
def _examples() -> dict[tuple[str, str], str]:
    """What the shipped examples write, by table and key."""
    found: dict[tuple[str, str], str] = {}
    for file in ("machine.toml", "scenario.toml"):
        at = ""
        for line in (ROOT / "examples" / file).read_text(encoding="utf-8").splitlines():
            if heading := _HEADING.match(line):
                at = heading[1].rpartition(".")[2]
            elif example := _EXAMPLE.match(line):
                found.setdefault((at, example[1]), example[2].rstrip(","))
    return found


def _quantity(hint: Any) -> Quantity | None:
    """The quantity that a type asks for."""
    return next((part for part in _parts(hint) if isinstance(part, Quantity)), None)


def _parts(hint: Any) -> Iterator[Any]:
    """What a type is annotated with, also within a union or a tuple."""
    if get_origin(hint) is Annotated:
        yield from _parts(hint.__origin__)
        yield from hint.__metadata__
    elif get_origin(hint) in (Union, UnionType):
        for each in get_args(hint):
            yield from _parts(each)
    elif get_origin(hint) is tuple and get_args(hint)[-1] is Ellipsis:
        yield from _parts(get_args(hint)[0])


def _plain(hint: Any) -> Any:
    """A type without annotations and without None; of a list of tables that of one."""
    while get_origin(hint) is Annotated:
        hint = hint.__origin__
    if get_origin(hint) in (Union, UnionType):
        return _plain(next(each for each in get_args(hint) if each is not type(None)))
    return _plain(get_args(hint)[0]) if get_origin(hint) is tuple else hint


def _is_table(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, Table)


def _written(quantity: Quantity | None, hint: Any) -> str:
    """An example of a value, as a file has it."""
    if get_origin(_plain(hint)) is Literal:
        return f'"{get_args(_plain(hint))[0]}"'
    if quantity is None:
        return {bool: "true", int: "-1", float: '"10 %"'}.get(_plain(hint), '"..."')
    if quantity.kind is None:
        return quantity.example or "1"
    if quantity.example:
        return f'"{quantity.example}"'
    return f'"1 {KINDS[quantity.kind][1].strip(chr(39))}"'


def _default(field: dataclasses.Field[Any], quantity: Quantity | None) -> str:
    """The default of a key; blank where what is not stated is not known."""
    default = field.default
    default = getattr(default, "default", default)
    if field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
        return "needed"
    if default in (None, (), "", 0.0) or not isinstance(default, bool | int | float | str):
        return ""
    if isinstance(default, bool):
        return str(default).lower()
    if isinstance(default, str):
        return f'`"{default}"`'
    return f"{default:g} {quantity.unit if quantity is not None else ''}".strip()


def _accepted(quantity: Quantity | None) -> str:
    """The range of values that the reader accepts, in SI."""
    if quantity is None or not math.isfinite(quantity.high):
        return ""
    return f"{quantity.low:g} to {quantity.high:g} {quantity.unit}".strip()
