"""Every number that the pages show has its unit: in their words as they open, and in all their tables."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from hersey.document.analysis import Analysis
from hersey.report.life_page import render_life
from tests.bare_numbers import bare, bare_columns
from tests.browser.accessibility import open_all
from tests.browser.opening import Opened
from tests.life import shipped

Report = Callable[[str], tuple[Path, Analysis]]
_TABLES = """() => [...document.querySelectorAll("table")].filter((each) => each.checkVisibility())
  .map((each) => [...each.rows].map((row) => [...row.cells].map((cell) => cell.innerText)))"""
_WORDS = "document.querySelectorAll('svg, table').forEach((each) => each.remove())"


@pytest.fixture(params=["demo", "life"])
def opened(request: pytest.FixtureRequest, browser: Browser, report: Report, tmp_path: Path) -> Opened:
    if request.param == "demo":
        path = report("demo")[0]
    else:
        path = tmp_path / "life.html"
        text = render_life(shipped.followed(2), shipped.opened(2).runs(), "hersey life <life.hersey>")
        path.write_text(text, encoding="utf-8")
    return Opened(browser, path, size=(1280, 800))


def plain(text: str) -> str:
    """A text with blanks of one kind."""
    return text.replace("\u00a0", " ").replace("\u202f", "")


def test_numbers_have_units(opened: Opened) -> None:
    page = opened.page
    page.wait_for_timeout(700)  # the panel has answered
    page.add_style_tag(content="#report section { content-visibility: visible !important; }")
    page.evaluate(_WORDS)
    text = plain(page.inner_text("body"))
    assert len(text.split()) > 300
    assert bare(text) == []


def test_columns_of_tables_have_units(opened: Opened) -> None:
    open_all(opened.page)
    tables = opened.page.evaluate(_TABLES)
    assert len(tables) > 10
    found = [bare_columns([[plain(cell) for cell in row] for row in table]) for table in tables]
    assert [heads for heads in found if heads] == []


def test_a_missing_unit_is_found() -> None:
    assert bare("Watch\tthick paper\t45\tneeds a profile") == ["Watch\tthick paper\t45\tneeds a profile"]
    assert bare_columns([["Speed", "Drag (N)"], ["20", "3"]]) == ["Speed"]
    assert bare_columns([["age (pages)", "Step, mm/s", "°C"], ["20", "45 to 200", "7"]]) == []
