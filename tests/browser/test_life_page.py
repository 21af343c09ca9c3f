"""The page of a life test in a real headless Chromium, offline."""

from __future__ import annotations

from dataclasses import replace

import pytest
from playwright.sync_api import Browser

from hersey.report.life_page import render_life
from tests.browser.accessibility import open_all, violations_by_width
from tests.browser.opening import Opened
from tests.conftest import mostly_nightly
from tests.life import shipped
from tests.life.test_other_uses import by_hand


@pytest.fixture(scope="module")
def opened(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Opened:
    path = tmp_path_factory.mktemp("life") / "life.html"
    answer = replace(shipped.followed(2), uses=by_hand())
    page = render_life(answer, shipped.opened(2).runs(), "hersey life <life.hersey>")
    path.write_text(page, encoding="utf-8")
    return Opened(browser, path)


def test_it_draws_without_errors_and_without_network(opened: Opened) -> None:
    opened.assert_quiet()


def test_it_says_what_ends_the_units(opened: Opened) -> None:
    verdict = opened.page.inner_text("#verdict")
    assert verdict.startswith("No specimen needs attention.")
    assert "The first to fail is probably U1, at 241000 [" in verdict
    assert "alf of new" not in verdict  # two specimens do not tell
    assert "Do next: Measure U1 again at" in verdict
    assert opened.page.inner_text("#command") == "hersey life <life.hersey>"
    titles = opened.page.locator(".part > h2").all_inner_texts()
    assert titles[:2] == ["Specimens, most urgent first", "Time to failure"]
    assert titles[-1] == "Reproduce this report"
    for name in ("ends", "growth_1", "maps", "film", "drift", "population"):
        assert opened.page.locator(f"#chart-{name} svg.marks").count() == 1
    assert opened.page.locator("#ages tr:first-child td").all_inner_texts()[:2] == ["Running", "U1"]


@pytest.mark.parametrize("scheme", mostly_nightly(["light", "dark"], "light"))
def test_it_is_accessible(opened: Opened, scheme: str) -> None:
    """WCAG 2.2 AA by axe-core, with folds open and nothing left out: no violation at any width."""
    page = opened.page
    if page.get_attribute("html", "data-theme") != scheme:
        page.click("#theme")
    open_all(page)
    assert violations_by_width(page) == {}
    page.set_viewport_size({"width": 1000, "height": 900})


def test_nothing_is_wider_than_the_page(opened: Opened) -> None:
    width = opened.page.evaluate("document.documentElement.scrollWidth - window.innerWidth")
    assert width <= 0


def test_it_can_be_asked_for_another_use(opened: Opened) -> None:
    page = opened.page
    assert "by 100000 [80000, 130000] pages." in page.inner_text(".use-verdict")
    assert page.inner_text("#uses .hint") == "as in the machine file"
    page.focus("#use-limit")
    page.keyboard.press("ArrowRight")
    page.focus("#use-cold")
    page.keyboard.press("ArrowLeft")
    told = page.inner_text(".use-verdict")
    assert told.startswith("Half of new specimens fail by 104000 [83300, 135000] pages, instead of")
    assert "100000" in told
    assert 'motor_torque = "1.25 N*m"' in page.inner_text("#use-toml")
    assert 'coldest = "50 degC"' in page.inner_text("#use-toml")
    page.fill("#use-day", "500")
    assert "208 days at 500 a day" in page.inner_text(".use-verdict")
    page.fill("#use-day", "many")
    assert page.inner_text("#uses [role=status]") == "Type a number above 0, e.g. 500"
    assert "U1 104000 [83300, 135000]" in (page.locator("#chart-uses svg").get_attribute("aria-label") or "")
    chosen = page.evaluate("location.hash")
    assert chosen == "#use?limit=1&cold=0&day=many"
    page.click("#uses .foot >> text=Reset")
    assert page.inner_text(".use-verdict").endswith("by 100000 [80000, 130000] pages.")
    page.evaluate("location.hash = '#use?limit=1&cold=0'")
    page.wait_for_function("document.querySelector('.use-verdict').textContent.includes('104000')")
    page.evaluate("location.hash = '#use?limit=9&cold=-1'")  # of another report: as the file states
    page.wait_for_function("document.querySelector('#uses .hint').textContent.startsWith('as')")
