"""The pages that are made from the code are those that are committed, and every page has its place."""

from __future__ import annotations

from collections import Counter

import hersey
from hersey.cli.application import VERBS, load
from hersey.life.campaign.table import _NEEDED
from tests.conftest import ROOT
from website import document, names, pages
from website.navigation import DOCS, missing, navigation, reached

#: Pages that are not written yet, as `website.navigation.missing` names them.
AWAITED: set[str] = set()


def test_the_pages_are_made_of_the_code_as_it_is() -> None:
    stale = [
        page.relative_to(DOCS).as_posix()
        for page, text in pages.made().items()
        if not page.is_file() or page.read_text(encoding="utf-8") != text
    ]
    assert stale == [], "renew them: python -m website"


def test_no_page_is_left_of_a_room_without_public_names() -> None:
    made = {page.name for page in pages.made() if page.parent.name == "python"}
    assert {page.name for page in (DOCS / "reference" / "python").glob("*.md")} == made


def test_every_command_and_option_is_in_its_page() -> None:
    text = (DOCS / "reference" / "commands.md").read_text(encoding="utf-8")
    for verb in VERBS:
        assert f"\n## hersey {verb}\n" in text
        command = load(verb)
        for each in (command, *getattr(command, "commands", {}).values()):
            for option in each.params:
                for flag in option.opts:
                    assert not flag.startswith("--") or flag == "--help" or f"`{flag}`" in text, flag


def test_every_public_name_is_in_the_pages_of_the_rooms() -> None:
    text = "".join(text for name, text in names.pages() if name != "index.md")
    for name in set(hersey.__all__) - {"__version__"}:
        assert text.count(f"heading: hersey.{name}\n") == 1, name


def test_every_field_of_the_document_is_described() -> None:
    assert document.undescribed() == [], "give them a Means(...), a comment #:, or a line in fields.toml"


def test_no_word_for_a_field_is_left_of_one_that_is_gone() -> None:
    printed, parts = document._parts()
    fields = {
        f"{each.schema['title']}.{name}"
        for each in (*printed.values(), *parts)
        for name in each.schema.get("properties", {})
    }
    words = document._words()
    assert words["parts"].keys() <= fields
    assert words["names"].keys() <= {field.split(".")[1] for field in fields}


def test_the_columns_of_a_table_of_runs_are_listed() -> None:
    text = (DOCS / "reference" / "files.md").read_text(encoding="utf-8").split("## Table of runs")[1]
    for column in _NEEDED:
        assert f"\n| `{column}` |" in text


def test_every_page_stands_in_the_navigation_once() -> None:
    found = Counter(reached(navigation()))
    pages_of_docs = {page.relative_to(DOCS).as_posix() for page in DOCS.rglob("*.md")}
    assert set(found) == pages_of_docs
    assert {page for page, times in found.items() if times > 1} == set()


def test_every_page_of_the_navigation_is_there() -> None:
    lacking = set(missing())
    assert lacking <= AWAITED, "these pages are missing"
    assert lacking >= AWAITED, "these pages are there now: take them off the list"


def test_the_order_of_the_rooms_is_that_of_the_computation() -> None:
    pages_of_rooms = [page for page in reached(navigation()) if "/python/" in page]
    assert [page.rsplit("/", 1)[1] for page in pages_of_rooms] == [name for name, _ in names.pages()]


def test_the_picture_of_a_page_is_there_and_every_picture_is_used() -> None:
    texts = [page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md")]
    texts.append((ROOT / "README.md").read_text(encoding="utf-8"))
    for picture in [*DOCS.rglob("*.png"), *DOCS.rglob("*.svg")]:
        assert any(f"{picture.name})" in text for text in texts), picture
        assert picture.stat().st_size < 150_000, f"{picture} is large: fewer colours, or less of it"
