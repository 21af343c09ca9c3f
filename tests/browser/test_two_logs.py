"""The page of a log beside an earlier one: chart, table and first screen say what really changed."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Browser

from hersey.document.assembly import document_of
from hersey.report.page import render
from hersey.study import study
from tests.browser.opening import Opened
from tests.browser.test_page import DESK, picture
from tests.document.test_against import dwells, written


def test_two_logs_are_compared_on_the_page(browser: Browser, tmp_path: Path) -> None:
    now, earlier = dwells(written(tmp_path, "new.csv")), dwells(written(tmp_path, "more.csv"))
    document = document_of(study(now, against=earlier))
    assert document.compare is not None
    path = tmp_path / "page.html"
    path.write_text(render(document), encoding="utf-8")
    opened = Opened(browser, path, size=DESK)
    page = opened.page
    page.locator("#flags a[href='#compare']").click()
    page.wait_for_selector("#compare svg.marks .mark-symbol path")
    picture(page, "two-logs", whole=True)
    finding = (page.locator("#compare .finding").text_content() or "").replace("\N{MINUS SIGN}", "-")
    finding = re.sub(r"[\u00a0\u202f]", " ", finding)
    assert finding == document.compare.verdict
    assert page.locator("#compare svg.marks .mark-symbol path").count() == len(document.compare.speeds)
    assert page.locator("#compare tbody tr").count() >= len(document.compare.changes)
    shown = page.locator("#compare").text_content() or ""
    assert all(change.name in shown for change in document.compare.changes)
    assert {"more.csv", "new.csv"} <= set(page.locator("#compare th").all_text_contents())
    assert opened.errors == []
    page.close()
