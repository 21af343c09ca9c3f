"""The page of a life test in a real headless Chromium, offline."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser

from hersey.life.growth.limit_ages import rounded
from hersey.life.time_to_failure.estimate import time_to_failure
from hersey.report.life_page import render_life
from tests.browser.accessibility import open_all, violations_by_width
from tests.browser.opening import Opened
from tests.conftest import mostly_nightly
from tests.life import shipped
from tests.life.test_other_uses import by_hand
from tests.life.test_time_to_failure import RATE, indicator, linear, of, six_specimens


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
    found = shipped.followed(2).time_to_failure
    assert f"All two should reach at least {rounded(found.attention.look_again)} pages." in verdict
    assert "alf of new" not in opened.page.inner_text("body")  # two specimens are no population
    assert "B10" not in opened.page.inner_text("#ages")
    assert opened.page.inner_text("#command") == "hersey life <life.hersey>"
    titles = opened.page.locator(".part > h2").all_inner_texts()
    assert titles[:2] == ["Time to first failure, most urgent first", "Time to failure"]
    assert titles[-1] == "Reproduce this report"
    for name in ("ends", "growth_1", "maps", "film", "drift"):
        assert opened.page.locator(f"#chart-{name} svg.marks").count() == 1
    assert opened.page.locator("#chart-population").count() == 0
    assert opened.page.locator("#ages tr:first-child td").all_inner_texts()[:2] == ["U1", "Running"]


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
    assert page.locator(".use-verdict").is_hidden()
    assert page.locator("#chart-uses").is_hidden()
    assert page.inner_text(".uses .hint") == "as in the machine file"
    page.focus("#use-limit")
    page.keyboard.press("ArrowRight")
    page.focus("#use-cold")
    page.keyboard.press("ArrowLeft")
    verdict = page.inner_text(".use-verdict")
    assert verdict == "Half of new specimens fail by 104000 [83300, 135000] pages."
    assert 'motor_torque = "1.25 N*m"' in page.inner_text("#use-toml")
    assert 'coldest = "50 degC"' in page.inner_text("#use-toml")
    page.fill("#use-day", "500")
    assert "208 [167, 271] days at 500 pages a day" in page.inner_text(".use-verdict")
    page.fill("#use-day", "many")
    assert page.inner_text(".uses [role=status]") == "Type a number above 0, e.g. 500"
    assert "U1 104000 [83300, 135000]" in (page.locator("#chart-uses svg").get_attribute("aria-label") or "")
    chosen = page.evaluate("location.hash")
    assert chosen == "#use?limit=1&cold=0&day=many"
    page.click(".uses .foot >> text=Reset")
    assert page.locator(".use-verdict").is_hidden()
    page.evaluate("location.hash = '#use?limit=1&cold=0'")
    page.wait_for_function("document.querySelector('.use-verdict').textContent.includes('104000')")
    page.evaluate("location.hash = '#use?limit=9&cold=-1'")  # of another report: as the file states
    page.wait_for_function("document.querySelector('.uses .hint').textContent.startsWith('as')")


def test_the_numbers_that_matter_appear_once_and_all_agree(browser: Browser, tmp_path: Path) -> None:
    """B50 and the age to look again, on the page as it opens; the table, charts and data hold the same."""
    path = tmp_path / "life.html"
    with shipped.few():
        found = six_specimens()
    answer = replace(shipped.followed(2), time_to_failure=found, uses=None)
    path.write_text(render_life(answer, shipped.opened(2).runs(), "hersey life"), encoding="utf-8")
    page = Opened(browser, path).page
    half, again = found.b50, found.attention.look_again
    assert half is not None
    assert again is not None
    text = page.inner_text("body")
    for age in (half.age.value, again):
        assert len(re.findall(rf"\b{rounded(age)}\b", text)) == 1
    assert text.count("Half of new specimens") == 1
    assert "B50" not in text
    assert f"(90 %: {rounded(half.age.low)} to {rounded(half.age.high)} pages)" in text.replace("\u00a0", " ")
    cells = page.locator("#ages tbody tr").evaluate_all("rows => rows.map((row) => row.cells[3].innerText)")
    names = page.locator("#ages tbody tr").evaluate_all("rows => rows.map((row) => row.cells[0].innerText)")
    ends = {each.unit: each for each in found.units}
    order = [name for state in ("failed", "unclear", "running") for name in getattr(found.attention, state)]
    assert names == order
    for name, cell in zip(names, cells, strict=True):
        age = ends[name].age.age
        assert cell in (rounded(age.value), f"before {rounded(age.high)}")
    held = page.evaluate("JSON.parse(document.getElementById('document').textContent)")
    tenth = found.to_dict()["b10"]["age"]
    assert held["decision"]["b10"] == tenth
    shown = page.inner_text(".population dd").replace("\u00a0", " ")
    assert shown == f"{rounded(tenth['value'])} ({rounded(tenth['low'])} to {rounded(tenth['high'])})"
    assert page.locator("#chart-population svg.marks").count() == 1
    assert found.curve is not None
    assert np.interp(half.age.value, found.curve.age, found.curve.median) == pytest.approx(0.5, abs=0.05)


def test_the_decision_asked_for_is_answered_on_the_first_screen(browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "life.html"
    with shipped.few():
        found = time_to_failure(
            of(indicator("torque", linear(RATE), 2.0)), until="900 pages", share=0.2, cost_of_failure=10.0
        )
    answer = replace(shipped.followed(2), time_to_failure=found, uses=None)
    path.write_text(render_life(answer, shipped.opened(2).runs(), "hersey life"), encoding="utf-8")
    opened = Opened(browser, path)
    opened.assert_quiet()
    more = [each.replace("\u00a0", " ") for each in opened.page.locator("#verdict .more").all_inner_texts()]
    assert more == [found.of_new(), *found.answers()]
    assert found.followed_failing is not None
    failed = found.followed_failing.failed
    rows = opened.page.locator(".population dt").all_inner_texts()
    assert rows[1].replace("\u00a0", " ") == "Of the 6 followed, failures before 900 pages"
    ends = f" ({failed.low:g} to {failed.high:g})" if failed.low != failed.high else ""
    shown = opened.page.locator(".population dd").all_inner_texts()[1].replace("\u00a0", " ")
    assert shown == f"{failed.value:g}{ends}"
    assert opened.page.locator("#chart-replacement svg.marks").count() == 1
