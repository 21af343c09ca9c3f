"""The glossary: short entries, links that lead somewhere, and the page of the docs made from it.

``python -m tests.report.test_glossary`` renews that page.
"""

from __future__ import annotations

import pytest

from hersey.report.glossary import entries, find, key, markdown, nearest
from tests.conftest import ROOT
from tests.vocabulary import RETIRED, count

PAGE = ROOT / "docs" / "glossary.md"
MOST_ENTRIES, MOST_SENTENCES = 30, 3


def test_the_page_of_the_docs_is_that_of_the_table() -> None:
    renew = "renew it: python -m tests.report.test_glossary"
    assert PAGE.read_text(encoding="utf-8") == markdown(), renew


def test_entries_are_few_and_short() -> None:
    assert len(entries()) <= MOST_ENTRIES
    for each in entries():
        assert 1 <= len(each.sentences) <= MOST_SENTENCES, each.term
        assert each.text.endswith("."), each.term


def test_no_spelling_is_there_twice() -> None:
    keys = [key(spelling) for each in entries() for spelling in each.spellings]
    assert sorted(keys) == sorted(set(keys))


def test_every_link_leads_to_another_entry() -> None:
    terms = {each.term for each in entries()}
    for each in entries():
        assert each.see, each.term
        assert set(each.see) <= terms - {each.term}, each.term


def test_links_of_the_page_are_its_headings() -> None:
    # a heading's anchor, as GitHub makes it: small letters, blanks as hyphens, no other signs
    anchors = {
        "".join(sign for sign in line[3:].lower().replace(" ", "-") if sign.isalnum() or sign in "-_")
        for line in markdown().splitlines()
        if line.startswith("## ")
    }
    linked = {part.split(")")[0] for part in markdown().split("](#")[1:]}
    assert len(anchors) == len(entries())
    assert linked <= anchors


def test_entries_use_no_retired_word() -> None:
    for each in entries():
        assert not [phrase for phrase in RETIRED if count(phrase, each.text)], each.term


@pytest.mark.parametrize(
    ("typed", "term"),
    [
        ("V*", "V*"),
        ("v-star", "V*"),
        ("Safe Speed", "V*"),
        ("STICK SLIP", "stick-slip"),
        ("stickslip", "stick-slip"),
        ("\N{GREEK SMALL LETTER LAMDA} ratio", "lambda ratio"),
        ("\N{GREEK CAPITAL LETTER DELTA}AICc", "AICc"),
        ("draws", "posterior"),
        ("standing torque", "tare"),
    ],
)
def test_spellings(typed: str, term: str) -> None:
    found = find(typed)
    assert found is not None
    assert found.term == term


@pytest.mark.parametrize(
    ("typed", "close"),
    [
        ("stik sped", ("stick speed",)),
        ("Hersy-number", ("Hersey number",)),
        ("startng torque", ("starting torque",)),
        ("Stribek", ("Stribeck curve", "stribeck")),
    ],
)
def test_a_near_miss(typed: str, close: tuple[str, ...]) -> None:
    assert find(typed) is None
    assert nearest(typed) == close


def test_nothing_is_near_to_what_is_no_word() -> None:
    assert nearest("zzz") == ()
    assert nearest("") == ()
    assert find("") is None


if __name__ == "__main__":
    PAGE.write_text(markdown(), encoding="utf-8")
