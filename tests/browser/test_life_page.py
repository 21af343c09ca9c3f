"""The page of a life test in a real headless Chromium, offline."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser

from hersey.report.life_page import render_life
from tests.browser.opening import Opened
from tests.life import shipped


@pytest.fixture(scope="module")
def opened(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Opened:
    path = tmp_path_factory.mktemp("life") / "life.html"
    page = render_life(shipped.followed(2), shipped.opened(2).runs(), "hersey life <life.hersey>")
    path.write_text(page, encoding="utf-8")
    return Opened(browser, path)


def test_it_draws_without_errors_and_without_network(opened: Opened) -> None:
    opened.assert_quiet()


def test_it_says_what_ends_the_units(opened: Opened) -> None:
    verdict = opened.page.inner_text("#verdict")
    assert "U1 ends at" in verdict  # two units do not tell what half of new ones do
    assert "Next: U1 at" in verdict
    assert opened.page.inner_text("#command") == "hersey life <life.hersey>"
    titles = opened.page.locator("h2").all_inner_texts()
    assert titles[0] == "What ends each unit, and when"
    assert titles[-1] == "How to reproduce this report"
    for name in ("ends", "growth_1", "maps", "film", "drift", "population"):
        assert opened.page.locator(f"#chart-{name} svg.marks").count() == 1
    assert opened.page.locator("#chart-ends ~ .wide td").first.inner_text() == "U1"


def test_nothing_is_wider_than_the_page(opened: Opened) -> None:
    width = opened.page.evaluate("document.documentElement.scrollWidth - window.innerWidth")
    assert width <= 0
