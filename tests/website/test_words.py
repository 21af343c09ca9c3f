"""Technical words that people read are explained: `hersey explain` and the glossary know them.

What is read is the prose of the pages, the help of the commands, and the messages of Python and of the page.
Pages of theory and validation explain their terms where they use them, and cite works of others.
"""

from __future__ import annotations

import re
import tomllib
from typing import Any

import pytest

from hersey.report.glossary import entries, find
from tests.conftest import ROOT
from tests.website.reading import helped, lower_words, prose, said, technical
from website.navigation import DOCS

WORDS: dict[str, Any] = tomllib.loads((ROOT / "tests" / "website" / "words.toml").read_text(encoding="utf-8"))
MOST_ENTRIES = 30
MOST_WORDS = 32_300


def explained() -> set[str]:
    """Every word that the glossary or a list has."""
    spellings = [spelling for each in entries() for spelling in each.spellings]
    listed = [*WORDS["technical"], *(word for words in WORDS["common"].values() for word in words)]
    return {part for word in (*spellings, *listed) for part in word.replace("-", " ").split()}


@pytest.mark.parametrize("word", WORDS["technical"])
def test_a_technical_word_is_in_the_glossary(word: str) -> None:
    assert find(word) is not None, f"add '{word}' to an entry of glossary.toml"


def test_the_glossary_stays_short() -> None:
    assert len(entries()) <= MOST_ENTRIES


@pytest.mark.parametrize("texts", [prose, helped, said], ids=["pages", "help", "messages"])
def test_no_abbreviation_or_name_stands_there_unexplained(texts: Any) -> None:
    known, small = explained(), lower_words()
    found = {word: name for name, text in texts().items() for word in technical(text, small) - known}
    assert found == {}, "explain them in glossary.toml, or list them as common in words.toml"


def test_an_unknown_abbreviation_is_seen() -> None:
    text = "The XYZ and its QRSs, of Nobodyknown, say aicc. Plain sentences begin so; [FILE.md] is none."
    assert technical(text, {"plain", "the"}) == {"XYZ", "QRS", "Nobodyknown"}


def test_the_docs_stay_short() -> None:
    """README and the pages that people write; what is generated has its length from its source."""
    generated = {"commands.md", "files.md", "document.md"}
    written = [
        page
        for page in DOCS.rglob("*.md")
        if page.name not in generated and page.parent.name not in ("python", "validation")
    ]
    pages = [ROOT / "README.md", *written]
    words = sum(len(re.findall(r"\S*\w\S*", page.read_text(encoding="utf-8"))) for page in pages)
    assert 20_000 < words <= MOST_WORDS
