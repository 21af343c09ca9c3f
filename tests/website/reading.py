"""The words that people read: in pages, in help, in messages."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from typing import Any

from hersey.cli.application import VERBS, load
from tests.conftest import ROOT
from website.navigation import DOCS

PACKAGE = ROOT / "python" / "hersey"
#: What of Markdown is no prose: code, formulas, targets of links, comments.
_NO_PROSE = re.compile(
    r"^```.*?^```|`[^`\n]*`|(?<!\*)\*[A-Z][^*]{10,200}\*|\"[A-Z][^\"]{10,}\"|(?<=\])\([^)\s]*\)|<!--.*?-->|\$[^$\n]+\$|^:::.*$|https?://\S+",
    re.DOTALL | re.MULTILINE,
)
#: A string of a script that has a blank, as a sentence has.
_STRING = re.compile(r"\"((?:[^\"\\\n]|\\.)*)\"|'((?:[^'\\\n]|\\.)*)'|`((?:[^`\\]|\\.)*)`")
#: Folders of the docs that are not read here.
_CITING = (("theory",), ("validation",))
#: Words in capitals, with a capital inside, or with a number behind capitals: AICc, EHL, B10, PyPI.
_SHORT = re.compile(r"(?<![\w/.-])[A-Za-z]*[A-Z][A-Z0-9][A-Za-z0-9]*(?![\w(]|\.\w)")
#: Where a sentence may begin without a full stop before it: paragraphs, items, cells.
_PARTS = re.compile(r"\n\s*\n|\n(?=\s*(?:[#*-]|\d+\.) )|\||\n(?=#)")
#: What is numbered: a specimen, a point of a path, a coefficient, a format of paper.
_NUMBERED = re.compile(r"[A-Z]\d+")
_QUERY = re.compile(r"\s*(?:SELECT|INSERT|DELETE|UPDATE|CREATE|PRAGMA|FROM|WHERE|WITH)\b")
#: Words in capitals from which on a string is a licence or a query.
_LOUD = re.compile(r"(?:\b[A-Z]{2,}\b[^A-Z]*){4}")
#: A word with a capital in the middle of a sentence.
_NAMED = re.compile(r"(?<=[a-z,;)] )[A-Z][a-z]{2,}(?:'s)?\b(?!\.\w)")


def prose() -> dict[str, str]:
    """Return the prose of every page, but for those that explain their terms and cite works of others."""
    pages = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
    pages = [page for page in pages if page.relative_to(ROOT).parts[1:2] not in _CITING]
    return {
        page.relative_to(ROOT).as_posix(): _NO_PROSE.sub(" ", page.read_text(encoding="utf-8"))
        for page in pages
    }


def helped() -> dict[str, str]:
    """Return the help of every command with its options, without the examples."""
    found = {}
    for verb in VERBS:
        command = load(verb)
        for each in (command, *getattr(command, "commands", {}).values()):
            words = [each.help or "", *(option.help or "" for option in each.params)]
            text = re.sub(r"\[bold\].*?\[/bold\]", "", "\n\n".join(words), flags=re.DOTALL)
            found[f"hersey {verb} {each.name}"] = re.sub(r"'[^'\n]*'", "", text)
    return found


@cache
def said() -> dict[str, str]:
    """Return the messages and words of results: strings of the package that read like a sentence."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        found[path.relative_to(ROOT).as_posix()] = "\n\n".join(_sentences(tree))
    for path in sorted(PACKAGE.rglob("static/*.js")):
        texts = ("".join(match) for match in _STRING.findall(path.read_text(encoding="utf-8")))
        lines = (re.sub(r"\$\{[^}]*\}|<[^>]*>", " ", text) for text in texts if " " in text)
        found[path.relative_to(ROOT).as_posix()] = "\n\n".join(lines)
    return found


def _sentences(tree: ast.AST) -> Iterator[str]:
    docstrings = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        text: Any = node.value if isinstance(node, ast.Constant) else ""
        if isinstance(text, str) and id(node) not in docstrings and _is_sentence(text):
            yield re.sub(r"'[^'\n]*'|\"[^\"\n]*\"|`[^`\n]*`", " ", text)


def _is_sentence(text: str) -> bool:
    return len(text.split()) > 3 and not _QUERY.match(text) and not _LOUD.search(text)


@cache
def lower_words() -> set[str]:
    """Return every word that some text has in small letters: with a capital it is no name."""
    pages = [page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md")]
    texts = [*pages, *helped().values(), *said().values()]
    return {word for text in texts for word in re.findall(r"\b[a-z]{2,}\b", text)}


def technical(text: str, known: set[str]) -> set[str]:
    """Return the abbreviations and names of a text, but for ``known`` words with a capital."""
    words = {re.sub(r"(?<=[A-Z])s$", "", word) for word in _SHORT.findall(text)}
    for part in _PARTS.split(text):
        words |= {word.removesuffix("'s") for word in _NAMED.findall(" ".join(part.split()))}
    return {word for word in words if word.lower() not in known and not _NUMBERED.fullmatch(word)}
