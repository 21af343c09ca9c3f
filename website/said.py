"""What the code says of a field: comments ``#:``, sections of docstrings, docstrings of properties."""

from __future__ import annotations

import ast
import inspect
import re
import sys
from functools import cache
from pathlib import Path

_ABOVE = re.compile(r"((?:^ +#: .+\n)+) +(\w+):", re.MULTILINE)
_BEHIND = re.compile(r"^ +(\w+):.*  #: (.+)$", re.MULTILINE)
_LISTED = re.compile(r"^(?:Attributes|Parameters)\n-+\n((?:.*\n?)+?)(?=^\S+\n-+$|\Z)", re.MULTILINE)
_ENTRY = re.compile(r"^(\S.*)\n((?:(?:    .*)?\n?)+)", re.MULTILINE)


@cache
def _classes(file: str) -> dict[str, str]:
    """The source of each class of a module, by name; `inspect` would parse the file for each."""
    if not file.endswith(".py"):
        return {}
    text = Path(file).read_text(encoding="utf-8")
    lines = text.splitlines(keepends=True)
    return {
        node.name: "".join(lines[node.lineno - 1 : node.end_lineno])
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.ClassDef)
    }


@cache
def comments(kind: type) -> dict[str, str]:
    """Return the comments ``#:`` above or behind the fields of a class and its bases, by field."""
    found: dict[str, str] = {}
    for each in kind.__mro__[:-1]:
        module = sys.modules.get(each.__module__)
        source = _classes(getattr(module, "__file__", None) or "").get(each.__name__, "")
        for words, field in _ABOVE.findall(source):
            found.setdefault(field, " ".join(line.strip(" #:") for line in words.splitlines()))
        for field, words in _BEHIND.findall(source):
            found.setdefault(field, words)
    return found


def listed(docstring: str) -> dict[str, str]:
    """Return what the sections Attributes and Parameters of a docstring say, by name."""
    found: dict[str, str] = {}
    for section in _LISTED.findall(docstring):
        for names, words in _ENTRY.findall(section):
            found |= dict.fromkeys(names.split(", "), " ".join(words.split()))
    return found


def computed(kind: type, name: str) -> str:
    """Return what the docstring of a property or method says that it returns, or nothing."""
    member = inspect.getattr_static(kind, name, None)
    getter = getattr(member, "fget", None) or getattr(member, "func", None) or member
    words = inspect.getdoc(getter) if inspect.isfunction(getter) else ""
    return re.sub(r"^Return ", "", first_sentence(words or ""))


def first_sentence(docstring: str) -> str:
    """Return the first sentence of a docstring on one line, its code as Markdown has it."""
    first = " ".join(docstring.split("\n\n")[0].split())
    return re.sub(r"``(.+?)``", r"`\1`", re.split(r"(?<=\.) (?=[A-Z`])", first)[0])


#: What begins with a word, not with a unit or a symbol: these stay as they are.
_WORD = re.compile(r"(?!(?:rad|mm|kg|eta|ln)\b)[a-z][a-z-]+(?![\w/^*])|a ")


def cell(words: str) -> str:
    """Return words as a cell of a table has them: a capital first, no full stop at the end."""
    plain = re.sub(r"``(.+?)``", r"`\1`", " ".join(words.split()).removesuffix("."))
    if _WORD.match(plain):
        plain = plain[:1].upper() + plain[1:]
    return re.sub(r"(?<![`\\])\*", r"\\*", plain)
