"""A page in the browser, and all that happens on it."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from playwright.sync_api import Browser, Page

#: Runs before the page: notes what its policy forbids, wherever it happens.
_SPY = """
window.violations = [];
document.addEventListener("securitypolicyviolation", (event) =>
  window.violations.push(`${event.effectiveDirective} ${event.blockedURI} ${event.sample}`));
"""


def _leaves(address: str) -> bool:
    """Whether a request leaves the page: its workers and the files it saves are its own."""
    return not address.startswith("blob:")


class Opened:
    """A page and what happened on it."""

    def __init__(
        self,
        browser: Browser,
        path: Path,
        *,
        size: tuple[int, int] = (1000, 900),
        scheme: Literal["light", "dark"] = "light",
    ) -> None:
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.held_back: list[str] = []
        self.dialogs: list[str] = []
        width, height = size
        self.page: Page = browser.new_page(
            viewport={"width": width, "height": height}, color_scheme=scheme, accept_downloads=True
        )
        self.page.add_init_script(_SPY)
        self.page.on("pageerror", lambda e: self.errors.append(str(e)))
        self.page.on(
            "console", lambda m: self.errors.append(m.text) if m.type in ("error", "warning") else None
        )
        self.page.on("request", lambda r: self.requests.append(r.url) if _leaves(r.url) else None)
        self.page.on("requestfailed", lambda r: self.held_back.append(r.url) if r.failure == "csp" else None)
        self.page.on("dialog", lambda d: (self.dialogs.append(d.message), d.dismiss()))
        self.page.goto(path.as_uri())
        self.page.wait_for_selector("body[data-ready]", timeout=60_000)
        self.address = path.as_uri()

    @property
    def violations(self) -> list[str]:
        """What the policy of the page forbade."""
        forbidden: list[str] = self.page.evaluate("window.violations")
        return forbidden

    def texts(self) -> str:
        """All that the page shows: its text, that of its drawings, and what a reader for the blind says."""
        shown: str = self.page.evaluate(
            """() => [
              ...[...document.querySelectorAll("[aria-label]")].map((e) => e.getAttribute("aria-label")),
              ...[...document.querySelectorAll("text")].map((e) => e.textContent),
              document.body.innerText,
              ...[...document.querySelectorAll("td, li, p, pre, h1")].map((e) => e.textContent),
            ].join("\\n")"""
        )
        return shown

    def assert_quiet(self) -> None:
        """Nothing of a stranger ran, nothing left the page, nothing of ours was forbidden."""
        assert self.page.get_attribute("body", "data-ready") == "true"
        assert self.dialogs == []
        assert self.requests == [self.address]
        assert self.violations == []
        assert self.errors == [], self.errors[:3]
