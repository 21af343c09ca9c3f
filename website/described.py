"""What the code says of a field, for the reference of the Python names.

A field of a result carries its meaning in its type, ``Annotated[float, Means("the fold", "m/s")]``, other
fields in a comment ``#:`` above or behind them. Both become the description of the field, and the type is
shown alone.
"""

from __future__ import annotations

import ast
import re
from typing import Any

import griffe

_BEHIND = re.compile(r"  #: (.+)$", re.MULTILINE)
_ABOVE = "#: "
#: What begins with a word, not with a unit or a symbol.
_WORD = re.compile(r"(?!(?:rad|mm|kg|eta|ln)\b)[a-z][a-z-]+(?![\w/^*])|a ")


class Described(griffe.Extension):
    """Give attributes the description that their type or a comment holds."""

    def on_attribute_instance(self, *, attr: griffe.Attribute, **_: Any) -> None:
        """Describe one attribute."""
        said: list[str] = []
        if attr.annotation is not None:
            attr.annotation = _alone(attr.annotation, said)
        said = said or _commented(attr)
        if attr.docstring is None and said:
            words = said[0].removesuffix(".") + "."
            words = words[:1].upper() + words[1:] if _WORD.match(words) else words
            attr.docstring = griffe.Docstring(words, parent=attr)


def _commented(attr: griffe.Attribute) -> list[str]:
    """The comment behind an attribute, or the lines above it."""
    if attr.lineno is None or isinstance(attr.filepath, list):
        return []
    lines = attr.lines_collection[attr.filepath]
    above: list[str] = []
    while (line := lines[attr.lineno - 2 - len(above)].strip()).startswith(_ABOVE):
        above.insert(0, line.removeprefix(_ABOVE))
    return [" ".join(above)] if above else _BEHIND.findall(attr.source)


def _alone(annotation: Any, said: list[str]) -> Any:
    """The type without what is said of it, which is added to ``said``."""
    if isinstance(annotation, griffe.ExprBinOp):
        annotation.left = _alone(annotation.left, said)
        annotation.right = _alone(annotation.right, said)
    if not isinstance(annotation, griffe.ExprSubscript) or str(annotation.left) != "Annotated":
        return annotation
    kind, *others = getattr(annotation.slice, "elements", [annotation.slice])
    for other in others:
        if isinstance(other, griffe.ExprCall) and str(other.function) == "Means":
            said.append(_description(ast.parse(str(other), mode="eval").body))
    return _alone(kind, said)


def _description(call: Any) -> str:
    """Meaning, unit and shape of a call of ``Means``, as `hersey.schema.record.Means` says them."""
    given = dict(zip(("text", "unit", "shape"), (_value(each) for each in call.args), strict=False))
    given |= {each.arg: _value(each.value) for each in call.keywords}
    shape = f"shape {given['shape']}" if given.get("shape") else ""
    return ", ".join(part for part in (given.get("text", ""), given.get("unit", ""), shape) if part)


def _value(node: Any) -> str:
    return str(node.value) if isinstance(node, ast.Constant) else ""
