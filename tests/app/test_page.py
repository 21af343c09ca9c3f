"""The app in a real Chromium, from drop to report."""

from __future__ import annotations

import os
import signal
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page

from hersey.machine.machine import read_machine
from tests.app.conftest import Started, end, start
from tests.app.test_mistakes import MISTAKES, log
from tests.browser.hostile import MARKUP
from tests.conftest import ROOT

#: As long as anything may take on a machine that is busy, ms.
LONG = 180_000
MACHINE = {"stiffness": "11", "mass": "11 kg", "roll_radius": "15", "stick_speed": "2 to 4"}


class Watched:
    """A page of the app, and what happened on it."""

    def __init__(self, browser: Browser, address: str, **settings: object) -> None:
        self.context = browser.new_context(viewport={"width": 1280, "height": 800}, **settings)  # type: ignore[arg-type]
        self.page: Page = self.context.new_page()
        self.page.set_default_timeout(LONG)
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.page.on("pageerror", lambda e: self.errors.append(str(e)))
        self.page.on("console", lambda m: self.errors.append(m.text) if m.type in ("error", "warning") else None)
        self.page.on("request", lambda r: self.requests.append(r.url))
        self.page.on("dialog", lambda d: (self.errors.append(d.message), d.dismiss()))
        self.page.goto(address)
        self.page.wait_for_selector("body[data-ready]")

    def drop(self, name: str, content: bytes) -> None:
        """Drop a file as a person does."""
        self.page.evaluate(
            """([name, bytes]) => {
              const data = new DataTransfer();
              data.items.add(new File([new Uint8Array(bytes)], name));
              document.getElementById("drop").dispatchEvent(
                new DragEvent("drop", { bubbles: true, cancelable: true, dataTransfer: data }));
            }""",
            [name, list(content)],
        )

    def why(self) -> str:
        return self.page.inner_text("#why")


@pytest.fixture
def watched(browser: Browser, started: Started) -> Iterator[Watched]:
    one = Watched(browser, started.address)
    one.page.click("#new")
    one.page.wait_for_function("document.querySelectorAll('#files li').length === 0")
    yield one
    one.context.close()


def accessible(page: Page) -> None:
    found = Axe().run(page, options={"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]})
    assert found.violations_count == 0, found.generate_report()


def test_from_drop_to_report(watched: Watched, started: Started, tmp_path: Path) -> None:
    page = watched.page
    assert page.url.endswith("/")  # the token is gone from what a person could copy
    watched.drop("bench.csv", (ROOT / "examples" / "bench.csv").read_bytes())
    page.wait_for_selector("table.channels")
    assert page.locator("table.channels tbody tr").count() == 4
    assert watched.why().startswith("Ready")
    for field, value in MACHINE.items():
        page.fill(f'[data-control="field:drivetrain.{field}"]', value)
    page.locator("h1").click()
    page.wait_for_selector("text=fit, map, band")
    accessible(page)
    with page.expect_download() as saved:
        page.click("text=Save TOML")
    machine = read_machine(saved.value.path())
    assert (machine.stiffness, machine.mass, machine.uncertainty["stick_speed"].limits) == (11000, 11, (0.002, 0.004))
    with page.expect_download() as mapping:
        page.click("text=Save mapping")
    assert 'channel = "Drive torque"' in mapping.value.path().read_text()
    page.click("#run")
    with watched.context.expect_page() as opening:
        page.click("#bar a:has-text('Open report')")
    report = opening.value
    report.wait_for_selector("body[data-ready]", timeout=LONG)
    assert report.evaluate("window.origin") == "null"
    with page.expect_download() as download:
        page.click("text=Save report")
    kept = started.folder / "hersey-reports" / "bench.html"
    assert download.value.path().read_bytes() == kept.read_bytes()
    assert "hersey-reports/bench.html" in page.inner_text("#analyses")
    own = page.url
    assert all(url.startswith((own, "blob:" + own)) for url in watched.requests)
    assert not any(started.address.split("#")[1] in url for url in watched.requests)
    assert watched.errors == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_fault_stands_under_its_row_and_a_button_mends_it(browser: Browser, started: Started, scheme: str) -> None:
    watched = Watched(browser, started.address, color_scheme=scheme)
    page = watched.page
    page.click("#new")
    page.wait_for_function("document.querySelectorAll('#files li').length === 0")
    watched.drop("drive3.csv", MISTAKES["kelvin without a unit"][0])
    watched.drop("notes.pdf", MISTAKES["not a log"][0])
    page.wait_for_selector("#files li:has-text('notes.pdf'):has-text('not a log')")
    page.wait_for_selector("tr.fault")
    assert page.locator(".wrong").count() == 1
    assert "unit of Heater" in watched.why()
    accessible(page)
    page.click("#why button:has-text('unit of Heater')")
    assert page.evaluate("document.activeElement.dataset.control") == "unit:Heater"
    page.click("text=Read as K")
    page.wait_for_selector("tr.fault", state="detached")
    assert page.locator('[data-control="unit:Heater"]').input_value() == "K"
    page.click("#files li:has-text('notes.pdf') >> text=Remove")
    page.wait_for_selector("#why:has-text('Ready')")
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    accessible(page)
    assert watched.errors == []
    watched.context.close()


def test_a_run_can_be_cancelled_and_another_stops_with_its_reason(watched: Watched) -> None:
    page = watched.page
    watched.drop("short.csv", log(change=lambda t, q, n, c: (t, q, 10, c) if float(t) < 24 else (t, q, n, c)))
    page.wait_for_selector("table.channels")
    page.click("#run")
    page.click("#bar >> text=Cancel")
    page.wait_for_selector("#why:has-text('Ready')")
    watched.drop("tiny.csv", b"Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n0,1,2,3\n1,1,2,3\n")
    page.wait_for_selector("#files li:has-text('tiny.csv') >> text=rows")
    page.click("#files li:has-text('short.csv') >> text=Remove")
    page.click("#run:not([aria-disabled=true])")
    page.wait_for_selector("#analyses li[aria-current] .act")
    assert "tiny.csv" in page.inner_text("#analyses li[aria-current]")
    assert watched.errors == []


def test_the_keyboard_alone_leads_to_a_run(watched: Watched) -> None:
    page = watched.page
    watched.drop("log.csv", log())
    page.wait_for_selector("table.channels")
    page.locator("#choose").focus()
    seen = []
    for _ in range(80):
        page.keyboard.press("Tab")
        seen.append(page.evaluate("document.activeElement.dataset.control ?? document.activeElement.id"))
        if seen[-1] == "run":
            break
    assert {"role:Torque", "unit:Torque", "mode:toml", "field:drivetrain.mass", "points", "more", "run"} <= set(seen)
    page.keyboard.press("Enter")
    page.wait_for_selector("#bar >> text=Cancel")


def test_names_of_a_file_are_text(watched: Watched) -> None:
    page = watched.page
    names = [name for name in MARKUP if "," not in name and "[" not in name][:12]
    header = ",".join(["Time [s]", "Torque [N*m]", "Speed [rpm]", "Temperature [degC]", *names])
    rows = [f"{line},{','.join('1' for _ in names)}" for line in log().decode().splitlines()[1:]]
    watched.drop("<img src=x onerror=alert(1)>.csv", "\n".join([header, *rows, ""]).encode())
    page.wait_for_selector("table.channels")
    assert page.locator("table.channels img, table.channels iframe, table.channels script").count() == 0
    assert watched.errors == []


def test_without_its_token_the_page_says_what_to_do(browser: Browser, started: Started) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.goto(started.address.split("#")[0])
    page.wait_for_selector("#problem:has-text('Open the address that hersey app printed')")
    context.close()


def test_a_server_that_is_killed_loses_no_saved_file(browser: Browser, tmp_path: Path) -> None:
    one = start(tmp_path)
    watched = Watched(browser, one.address)
    page = watched.page
    watched.drop("log.csv", log())
    page.wait_for_selector("table.channels")
    page.click("#run")
    page.wait_for_selector("#bar a:has-text('Open report')")
    with page.expect_download() as download:
        page.click("text=Save mapping")
    saved = download.value.path()
    page.click("#run")
    page.wait_for_selector("#bar >> text=Cancel")
    end(one, signal.SIGKILL)
    kept = list((tmp_path / "hersey-reports").iterdir())
    assert [path.name for path in kept] == ["log.html"]
    assert kept[0].read_text().rstrip().endswith("</html>")
    assert "[torque]" in saved.read_text()
    page.click("text=New analysis")
    page.wait_for_selector("#problem:has-text('it has ended')")
    watched.context.close()


def test_ctrl_c_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    one = start(tmp_path)
    port = one.address.split(":")[2].split("/")[0]
    with pytest.raises(urllib.error.HTTPError, match="403"):  # the door is open, and nobody comes in
        urllib.request.urlopen(f"http://127.0.0.1:{port}/api/state")
    (folder,) = tmp_path.glob("hersey-app-*")
    assert oct(folder.stat().st_mode & 0o777) == "0o700"
    told = end(one)
    assert (one.process.returncode, told) == (130, "hersey: interrupted\n")
    assert list(tmp_path.iterdir()) == []
    other = start(tmp_path)
    end(other, signal.SIGKILL)
    (left,) = tmp_path.glob("hersey-app-*")
    again = start(tmp_path)  # which removes what the one that was killed had left
    assert left not in list(tmp_path.glob("hersey-app-*"))
    end(again)
    assert os.listdir(tmp_path) == []  # noqa: PTH208
