"""The page in a real headless Chromium, offline."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from hersey.charts.analysis import charts
from hersey.document.parts import Analysis
from hersey.report.page import render
from tests.browser.opening import Opened


@pytest.fixture(scope="module")
def opened(browser: Browser, document: Analysis, tmp_path_factory: pytest.TempPathFactory) -> Opened:
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(render(document), encoding="utf-8")
    return Opened(browser, path)


def test_it_draws_without_errors_and_without_network(opened: Opened) -> None:
    opened.assert_quiet()


def test_the_verdict_comes_first(opened: Opened, document: Analysis) -> None:
    assert opened.page.locator("#verdict p").all_text_contents() == document.verdict
    verdict = opened.page.locator("#verdict").bounding_box()
    assert verdict is not None
    assert verdict["y"] < 300
    assert opened.page.locator("#warnings li").all_text_contents() == document.warnings


def test_every_chart_is_drawn(opened: Opened, document: Analysis) -> None:
    for name in charts(document):
        box = opened.page.locator(f"#chart-{name} svg").first.bounding_box()
        assert box is not None, name
        assert box["width"] > 500
        assert box["height"] > 90
    marks = opened.page.locator("#chart-torque svg .mark-symbol path")
    assert marks.count() >= len(document.points)


def test_nothing_is_wider_than_the_page(opened: Opened) -> None:
    for width in (1000, 700):
        opened.page.set_viewport_size({"width": width, "height": 900})
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
    opened.page.set_viewport_size({"width": 1000, "height": 900})


def test_numbers_match_the_document(opened: Opened, document: Analysis) -> None:
    assert opened.page.text_content("#summary") == document.fit.summary
    assert opened.page.text_content("#command") == document.command
    cards = " ".join(opened.page.locator(".card b").all_text_contents())
    assert f"{document.fit.coefficients['c'].value:.3g}" in cards


def test_a_tooltip_shows_the_numbers_of_a_dwell(opened: Opened) -> None:
    mark = opened.page.locator("#chart-torque svg .mark-symbol path").nth(5)
    mark.scroll_into_view_if_needed()
    box = mark.bounding_box()
    assert box is not None
    opened.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    opened.page.wait_for_selector("#vg-tooltip-element.visible")
    text = opened.page.text_content("#vg-tooltip-element") or ""
    assert "speed (rpm)" in text
    assert "torque (" in text


def test_shift_and_wheel_zoom(opened: Opened) -> None:
    """By an expression of Vega, interpreted: the page forbids to compile it."""
    place = opened.page.locator("#chart-torque svg.marks")
    place.scroll_into_view_if_needed()
    before = place.locator(".role-axis-label text").all_text_contents()
    box = place.bounding_box()
    assert box is not None
    opened.page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"])
    opened.page.keyboard.down("Shift")
    opened.page.mouse.wheel(0, -600)
    opened.page.wait_for_function(
        """(before) => before !== [
          ...document.querySelectorAll("#chart-torque svg.marks .role-axis-label text")]
          .map((e) => e.textContent).join("|")""",
        arg="|".join(before),
    )
    opened.page.keyboard.up("Shift")
    opened.assert_quiet()


@pytest.mark.parametrize(("number", "start"), [(0, b"<svg"), (1, b"\x89PNG")])
def test_a_chart_can_be_saved(opened: Opened, number: int, start: bytes) -> None:
    menu = opened.page.locator("#chart-regime details")
    if menu.get_attribute("open") is None:
        menu.locator("summary").click()
    with opened.page.expect_download() as download:
        menu.locator("a").nth(number).click()
    assert download.value.path().read_bytes().startswith(start)
    assert opened.violations == []


def test_it_prints(opened: Opened, tmp_path: Path) -> None:
    pdf = opened.page.pdf(format="A4", path=str(tmp_path / "report.pdf"))
    assert pdf.startswith(b"%PDF")
    assert len(pdf) > 50_000
