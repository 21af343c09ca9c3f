"""What axe-core finds on a page, with nothing left out of the check."""

from __future__ import annotations

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page

#: What WCAG 2.2 AA asks, and what axe-core recommends beyond: headings in order, landmarks.
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
#: Widths of a desk, a tablet and a phone.
WIDTHS = (1280, 820, 390)

_OPEN = """() => {
  document.querySelectorAll("details").forEach((each) => { each.open = true; });
  return document.querySelectorAll("details:not([open])").length;
}"""


def open_all(page: Page) -> None:
    """Open all folds, those inside others too, until each chart of the page is drawn.

    Rows of a table after the twelfth are like those before, and go. Sections out of view are laid out too.
    """
    page.add_style_tag(content="#report section { content-visibility: visible !important; }")
    page.evaluate(_OPEN)
    page.wait_for_function(
        "() => document.querySelectorAll('figure .chart').length > 0"
        " && [...document.querySelectorAll('figure .chart')].every((each) => each.querySelector('svg'))"
    )
    page.evaluate(_OPEN)
    page.evaluate("document.querySelectorAll('tbody tr:nth-child(n + 13)').forEach((each) => each.remove())")


def violations(page: Page) -> list[tuple[str, str, str]]:
    """Return the rules that the page breaks, each with an element and the reason."""
    options = {"runOnly": RULES, "resultTypes": ["violations"]}
    found = Axe().run(page, options=options).response
    return [
        (violation["id"], node["html"][:150], node["failureSummary"][:200])
        for violation in found["violations"]
        for node in violation["nodes"][:3]
    ]


def violations_by_width(
    page: Page, widths: tuple[int, ...] = WIDTHS
) -> dict[int, list[tuple[str, str, str]]]:
    """Return what the page breaks at each width, where it breaks anything."""
    found = {}
    for width in widths:
        page.set_viewport_size({"width": width, "height": 800})
        page.wait_for_timeout(200)
        if broken := violations(page):
            found[width] = broken
    return found
