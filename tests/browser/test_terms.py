"""Labels of a report say what their terms mean where the pointer rests on them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Browser

from hersey.document.analysis import Analysis
from hersey.report.glossary import meanings
from tests.browser.opening import Opened

LABELS = {
    "V*": ".key li:has(path.fold)",
    "transition": ".key li:has(path.transition)",
    "stick speed": "label[for=try-stick_speed]",
    "closure": "label[for=try-closure]",
    "dwell": "#statistics > summary",
}


def test_labels_say_what_their_terms_mean(
    browser: Browser, report: Callable[[str], tuple[Path, Analysis]]
) -> None:
    opened = Opened(browser, report("demo")[0], size=(1280, 800))
    shown = {term: opened.page.locator(place).first.get_attribute("title") for term, place in LABELS.items()}
    level = (shown["stick speed"] or "").split(": ")[0]
    opened.assert_quiet()
    opened.page.close()
    assert level.startswith("Stick speed at ")
    expected = meanings(LABELS)
    assert shown == {**expected, "stick speed": f"{level}: {expected['stick speed']}"}
