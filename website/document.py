"""The reference of the JSON document: every field of what a command prints with ``--json``.

What a field means is what its record says of it, or ``fields.toml``: words for names that recur, such as
``seed``, and for fields of which their record says nothing.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from hersey.document.printed import PRINTED
from hersey.schema.part import Part
from hersey.schema.record import Record, part_of
from website.said import cell, comments, computed, first_sentence, listed
from website.text import joined, sections, table, wrapped

TEMPLATE = Path(__file__).parent / "templates" / "document.md"
FIELDS = Path(__file__).parent / "fields.toml"
_TYPES = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}
#: Parts that are a number with its interval: what they say is true of any.
_NUMBERS = ("Edge", "Estimate", "Interval")
#: Where a docstring begins its sections.
_SECTIONS = re.compile(r"\n\n\w+\n-+\n")


@dataclass
class Shown:
    """A part of the document: its heading, and its schema with the names of the parts within it."""

    heading: str
    schema: dict[str, Any]
    inside: dict[str, Shown] = field(default_factory=dict)  #: the parts within, by reference

    @property
    def anchor(self) -> str:
        """Its address within the page."""
        return re.sub(r"[^\w-]", "", self.heading.lower().replace(" ", "-"))


def page() -> str:
    """Return the page."""
    head, beside = sections(TEMPLATE.read_text(encoding="utf-8"))
    printed, parts = _parts()
    rows = [
        (f"[`hersey {verb} --json`](#{each.anchor})", cell(first_sentence(each.schema["description"])))
        for verb, each in printed.items()
    ]
    text = [head, table(("command", "what it prints"), rows)]
    for title, words in beside.items():
        text += [f"## {title}", words]
    text.append("## What each command prints")
    for each in printed.values():
        text += _section(each)
    text += ["## Parts", "Parts that the tables above name, in alphabetical order."]
    for each in sorted(parts, key=lambda part: part.heading.lower()):
        text += _section(each)
    return joined(text)


def undescribed() -> list[str]:
    """Return the fields of which nothing says what they mean."""
    printed, parts = _parts()
    return [
        f"{each.heading}.{name}"
        for each in (*printed.values(), *parts)
        for name, schema in each.schema.get("properties", {}).items()
        if not _meaning(each, name, schema)
    ]


@cache
def _parts() -> tuple[dict[str, Shown], list[Shown]]:
    """What each command prints, and the parts within; parts of one name that differ have two headings."""
    found: dict[str, list[Shown]] = {}
    printed = {}
    for verb, kind in PRINTED.items():
        schema = part_of(kind).model_json_schema()
        own = {}
        for name, inner in schema.get("$defs", {}).items():
            title = inner.get("title", name)
            alike = found.setdefault(title, [])
            same = next((each for each in alike if each.schema == inner), None)
            if same is None:
                heading = f"{title} of hersey {verb}" if alike else title
                same = Shown(heading, inner)
                alike.append(same)
            own[name] = same
        for each in own.values():
            each.inside.update(own)
        printed[verb] = Shown(f"hersey {verb}", schema, own)
    return printed, [each for alike in found.values() for each in alike]


def _section(part: Shown) -> list[str]:
    about = _SECTIONS.split(part.schema.get("description", ""))[0]
    paragraphs = [re.sub(r"``(.+?)``", r"`\1`", " ".join(each.split())) for each in about.split("\n\n")]
    rows = [
        (f"`{name}`", _type(part, schema), cell(_meaning(part, name, schema)))
        for name, schema in part.schema.get("properties", {}).items()
    ]
    text = [re.sub(r"(?<![`\\])\*", r"\\*", wrapped(each)) for each in paragraphs]
    return [f"### {part.heading}", *text, table(("field", "type", "meaning"), rows)]


def _type(part: Shown, schema: dict[str, Any]) -> str:
    """The type of a field, in words, with a link where it is a part."""
    if reference := schema.get("$ref"):
        held = part.inside[reference.rsplit("/", 1)[1]]
        return f"[{held.heading}](#{held.anchor})"
    if several := schema.get("anyOf"):
        return " or ".join(dict.fromkeys(_type(part, each) for each in several))
    if "const" in schema:
        return f'`"{schema["const"]}"`'
    if "enum" in schema:
        return ", ".join(f'`"{each}"`' for each in schema["enum"])
    if schema.get("type") == "array":
        items = schema.get("items") or (schema.get("prefixItems") or [{}])[0]
        return f"list of {_type(part, items)}" if items else "list"
    if schema.get("type") == "object":
        values = schema.get("additionalProperties")
        return f"by name: {_type(part, values)}" if isinstance(values, dict) and values else "object"
    return _TYPES.get(schema.get("type", ""), schema.get("type", "any"))


def _meaning(part: Shown, name: str, schema: dict[str, Any]) -> str:
    """What is said of a field: by its record, by ``fields.toml``, or by the part that it holds."""
    title = part.schema["title"]
    said = str(schema.get("description") or "")
    for kind in _records().get(title, []) + _records().get(title.removesuffix("Part"), []):
        said = said or comments(kind).get(name, "")
        said = said or (computed(kind, name) if name in getattr(kind, "also_stated", ()) else "")
    said = said or listed(part.schema.get("description", "")).get(name, "")
    words = _words()
    return (
        said
        or words["parts"].get(f"{title}.{name}", "")
        or _within(part, schema)
        or words["names"].get(name, "")
    )


def _within(part: Shown, schema: dict[str, Any]) -> str:
    """The first sentence about the part that a field holds."""
    for each in (schema, *schema.get("anyOf", ())):
        if reference := each.get("$ref"):
            held = part.inside[reference.rsplit("/", 1)[1]].schema
            if held["title"] not in _NUMBERS:
                return first_sentence(held.get("description", ""))
    return ""


@cache
def _words() -> dict[str, dict[str, str]]:
    return tomllib.loads(FIELDS.read_text(encoding="utf-8"))


@cache
def _records() -> dict[str, list[type]]:
    """The records and parts by name."""
    found: dict[str, list[type]] = {}
    waiting: list[type] = [Record, Part]
    while waiting:
        kind = waiting.pop()
        waiting += kind.__subclasses__()
        found.setdefault(kind.__name__, []).append(kind)
    return found
