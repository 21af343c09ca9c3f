"""Phrases that the texts of hersey no longer use, and how often each is left."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from tests.conftest import ROOT

#: Wrong wherever they stand.
RETIRED = (
    "a belt at rest bears",
    "candidate law",
    "cautions",
    "contradict each other",
    "dwells stand off",
    "early sign",
    "hangs on",
    "is told",
    "keeps its creep",
    "left alone",
    "machine's file",
    "made anew",
    "misfits",
    "not told",
    "set anew",
    "small swing",
    "stops dead",
    "taken off",
    "the rest of the drive",
    "told apart",
    "warmth",
)


def count(phrase: str, text: str) -> int:
    """How often a phrase is in a text, whatever its case and wherever its line breaks."""
    words = r"\s+".join(map(re.escape, phrase.split()))
    return len(re.findall(rf"\b{words}\b", text, re.IGNORECASE))


def strings(path: Path) -> str:
    """The strings of a module, docstrings among them."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    values = (node.value for node in nodes if isinstance(node, ast.Constant))
    return "\n".join(value for value in values if isinstance(value, str))


def texts() -> dict[str, str]:
    """What people read, by place."""
    package = ROOT / "python" / "hersey"
    return {
        "README.md": (ROOT / "README.md").read_text(encoding="utf-8"),
        "docs": _joined(ROOT / "docs", "*.md"),
        "page": _joined(package / "report" / "static", "*.js"),
        "app": _joined(package / "app" / "static", "*.[jh][st]*"),
        "python": "\n".join(map(strings, sorted(package.rglob("*.py")))),
    }


def counts() -> dict[tuple[str, str], int]:
    """How often each retired phrase is in each place, where it is."""
    found = {(place, phrase): count(phrase, text) for place, text in texts().items() for phrase in RETIRED}
    return {where: times for where, times in found.items() if times}


def _joined(folder: Path, pattern: str) -> str:
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted(folder.rglob(pattern)))
