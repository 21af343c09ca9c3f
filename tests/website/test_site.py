"""The built site: every link of it leads somewhere, it needs no network, and its search finds."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import quote_plus, unquote, urlsplit

import pytest

from tests.website.test_pages import AWAITED as AWAITED_PAGES
from website.navigation import navigation, reached

#: Building the site takes seconds.
pytestmark = pytest.mark.slow

#: What a reader types into the search, and the beginning of the address of a page that must be found.
SOUGHT = {
    "V*": "glossary.html#v",
    "Hersey number": "glossary.html#hersey-number",
    "tare": "glossary.html#tare",
    "stick speed": "glossary.html#stick-speed",
    "negative torque": "how-to/",
    "no units": "how-to/",
    "squeal": "how-to/",
}
#: Of these, what the pages do not say yet.
AWAITED: set[str] = set()
#: How far down a reader looks.
_FIRST = 10


class _Addresses(HTMLParser):
    """Links, what is loaded, and anchors of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        elif tag == "link" and given.get("rel") != "canonical" and "href" in given:
            self.loaded.append(given["href"])
        elif "src" in given:
            self.loaded.append(given["src"])


@pytest.fixture(scope="module")
def read(site: Path) -> dict[Path, _Addresses]:
    """Every page of the site, by file."""
    found = {}
    for page in sorted(site.rglob("*.html")):
        found[page] = _Addresses()
        found[page].feed(page.read_text(encoding="utf-8"))
    return found


def test_every_page_of_the_navigation_is_built_and_linked(site: Path, read: dict[Path, _Addresses]) -> None:
    pages = {(site / page).with_suffix(".html") for page in reached(navigation())}
    assert pages | {site / "404.html"} == set(read)
    linked = {(page.parent / link).resolve() for page, of in read.items() for link in of.links}
    linked |= {Path(str(path).partition("#")[0]) for path in linked}
    assert {page for page in pages if page.resolve() not in linked} == set()


def test_every_link_and_anchor_of_the_site_resolves(site: Path, read: dict[Path, _Addresses]) -> None:
    wrong = []
    by_path = {page.resolve(): of for page, of in read.items()}
    for page, of in read.items():
        if page.name == "404.html":
            continue
        for link in of.links:
            parts = urlsplit(link)
            if parts.scheme:
                continue
            target = (page.parent / unquote(parts.path)).resolve() if parts.path else page.resolve()
            if target == site.resolve() and "index.md" in AWAITED_PAGES:
                continue
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file() or (
                parts.fragment and unquote(parts.fragment) not in by_path[target].anchors | {"__search"}
            ):
                wrong.append(f"{page.name}: {link}")
    assert wrong == []


def test_nothing_is_loaded_from_elsewhere(site: Path, read: dict[Path, _Addresses]) -> None:
    for page, of in read.items():
        for address in of.loaded:
            assert not urlsplit(address).netloc, f"{page.name} loads {address}"
            if page.name != "404.html":
                assert (page.parent / unquote(urlsplit(address).path)).is_file(), f"{page.name}: {address}"
    for style in site.rglob("*.css"):
        assert not re.findall(r"url\(\s*[\"']?(?:https?:)?//", style.read_text(encoding="utf-8")), style


def test_names_of_python_show_what_their_fields_mean(site: Path) -> None:
    text = (site / "reference" / "python" / "stability.html").read_text(encoding="utf-8")
    assert "hersey.OperatingMap" in text
    assert "Annotated" not in text
    assert "torque to start from rest" in text.replace("&#39;", "'").lower()


@pytest.mark.parametrize("sought", SOUGHT)
def test_the_index_of_the_search_has_the_words(site: Path, sought: str) -> None:
    items = json.loads((site / "search.json").read_text(encoding="utf-8"))["items"]
    texts = {
        item["location"]: re.sub(r"<[^>]+>", "", f"{item['title']} {item['text']}").lower() for item in items
    }
    places = [place for place, text in texts.items() if all(word in text for word in sought.lower().split())]
    found = any(place.startswith(SOUGHT[sought]) for place in places)
    if sought in AWAITED:
        assert not found, f"{sought} is there now: take it off the list"
        pytest.skip(f"no page below {SOUGHT[sought]} says '{sought}' yet")
    assert found, places[:_FIRST]


class _Searched:
    """A page of the site, opened from its file in a browser without a network."""

    def __init__(self, page: Any, file: Path) -> None:
        self.page = page
        self.asked: list[str] = []
        page.on("request", lambda request: self.asked.append(request.url))
        page.goto(file.as_uri())
        page.keyboard.press("/")
        self.box = page.get_by_placeholder("Search", exact=True)

    def found(self, words: str) -> list[str]:
        """Return the addresses that the search lists for these words."""
        self.box.fill(words)
        listed = self.page.locator(f"a[href*='?h={quote_plus(words, safe='*')}']")
        listed.first.wait_for(timeout=10_000)
        return [str(each.get_attribute("href")) for each in listed.all()]


@pytest.fixture(scope="module")
def searched(site: Path) -> Iterator[_Searched]:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    api = pytest.importorskip("playwright.sync_api", reason="Playwright drives the browser")
    if not chromium:
        pytest.skip("Chromium is missing: make browser installs it")
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
        yield _Searched(browser.new_context(offline=True).new_page(), site / "glossary.html")
        browser.close()


@pytest.mark.parametrize("sought", [each for each in SOUGHT if each not in AWAITED])
def test_the_search_finds_without_a_network(searched: _Searched, sought: str) -> None:
    found = [re.sub(r"\?[^#]*", "", address) for address in searched.found(sought)]
    assert any(SOUGHT[sought] in address for address in found[:_FIRST]), found[:_FIRST]
    assert all(url.startswith(("file:", "blob:", "data:", "about:")) for url in searched.asked)
