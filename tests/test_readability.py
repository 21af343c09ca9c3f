"""README, docs and messages take at most nine years of school to read."""

from __future__ import annotations

import ast
import tomllib
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.readability import grade, sentences

#: Highest grade.
HIGHEST = 9.0
PACKAGE = ROOT / "python" / "hersey"
#: A string of fewer words is a label or a part of a sentence.
FEWEST_WORDS = 6


def messages(path: Path) -> list[str]:
    """The sentences of a module that are not docstrings; what is put in at run time counts as a number."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    described = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and isinstance(node.body[0], ast.Expr)
    }
    parts = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            found.append("".join(str(p.value) if isinstance(p, ast.Constant) else "3" for p in node.values))
        elif isinstance(node, ast.Constant) and id(node) not in described | parts:
            found.append(str(node.value))
    return [text for text in found if len(text.split()) >= FEWEST_WORDS]


ROOMS = sorted({path.parent for path in PACKAGE.glob("*/__init__.py")})
#: Pages of names and fields, made from the code, are lists and no prose.
LISTS = {"python", "document.md", "files.md", "commands.md"}
DOCS = sorted(page for page in (ROOT / "docs").rglob("*.md") if not LISTS & set(page.parts))
PAGES = [ROOT / "README.md", ROOT / "SECURITY.md", *DOCS]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_a_page_is_easy_to_read(page: Path) -> None:
    assert grade(page.read_text(encoding="utf-8")) <= HIGHEST


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: room.name)
def test_the_messages_of_a_room_are_easy_to_read(room: Path) -> None:
    texts = [text for path in sorted(room.rglob("*.py")) for text in messages(path)]
    assert grade("\n\n".join(texts)) <= HIGHEST


def test_the_glossary_is_easy_to_read() -> None:
    entries = tomllib.loads((PACKAGE / "report" / "glossary.toml").read_text(encoding="utf-8"))["terms"]
    assert grade("\n\n".join(entry["text"] for entry in entries)) <= HIGHEST


def test_a_hard_text_has_a_higher_grade() -> None:
    """Two texts of which words, sentences and syllables were counted by hand."""
    easy = "The belt slips. It is hot."  # 6 words, 2 sentences, 6 syllables
    hard = "Elastohydrodynamic lubrication necessitates considerable viscosity."  # 5 words, 1 sentence, 25
    assert grade(easy) == pytest.approx(0.39 * 3 + 11.8 * 1 - 15.59)
    assert grade(hard) == pytest.approx(0.39 * 5 + 11.8 * 25 / 5 - 15.59)


def test_code_tables_and_addresses_are_no_prose() -> None:
    text = "One two three.\n\n```sh\nhersey report\n```\n\n| a | b |\n|---|---|\n\nFour `code` five."
    assert [len(words) for words in sentences(text)] == [3, 3]
