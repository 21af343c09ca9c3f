"""The app in a real Chromium, from drop to report."""

from __future__ import annotations

import signal
import tempfile
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from hersey.app.starting import private_folder
from hersey.machine.machine import read_machine
from tests.app.conftest import Started, end, start
from tests.app.test_mistakes import MISTAKES, log
from tests.browser.accessibility import WIDTHS, violations_by_width
from tests.browser.hostile import MARKUP
from tests.browser.test_noun import JOINT, TEXTS, foreign
from tests.damping.moving_logs import sine

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
        self.page.on(
            "console", lambda m: self.errors.append(m.text) if m.type in ("error", "warning") else None
        )
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
    expect(one.page.locator("#files li")).to_have_count(0, timeout=LONG)
    yield one
    one.context.close()


def accessible(page: Page, widths: tuple[int, ...] = (1280,)) -> None:
    """WCAG 2.2 AA and the advice of axe-core beyond it, with nothing left out."""
    assert violations_by_width(page, widths) == {}


def test_from_drop_to_report(watched: Watched, started: Started) -> None:
    """Dropped by hand, run by the keyboard alone, read, saved."""
    page = watched.page
    assert page.url.endswith("/")  # the token is gone from what a person could copy
    watched.drop("drive.csv", log())
    page.wait_for_selector("table.channels")
    assert page.locator("table.channels tbody tr").count() == 4
    assert watched.why().startswith("Ready")
    for field, value in MACHINE.items():
        page.fill(f'[data-control="field:drivetrain.{field}"]', value)
    page.locator("h1").click()
    page.wait_for_selector("text=damping, regime, operating map")
    page.evaluate("document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    accessible(page, WIDTHS)
    page.set_viewport_size({"width": 1280, "height": 800})
    page.evaluate("document.querySelectorAll('details').forEach((each) => { each.open = false; })")
    with page.expect_download() as saved:
        page.click("text=Save TOML")
    machine = read_machine(saved.value.path())
    assert (machine.stiffness, machine.mass) == (11000, 11)
    assert machine.uncertainty["stick_speed"].limits == (0.002, 0.004)
    with page.expect_download() as mapping:
        page.click("text=Save mapping")
    assert 'channel = "Torque"' in mapping.value.path().read_text()
    assert page.get_by_text("Save recipe").count() == 0  # before there is a report
    page.locator("#choose").focus()
    reached = []
    while "run" not in reached and len(reached) < 90:
        page.keyboard.press("Tab")
        reached.append(page.evaluate("document.activeElement.dataset.control ?? document.activeElement.id"))
    controls = {
        "role:Torque",
        "unit:Torque",
        "corrections",
        "mode:toml",
        "field:drivetrain.mass",
        "points",
        "more",
    }
    assert controls | {"run"} <= set(reached)
    page.keyboard.press("Enter")
    with watched.context.expect_page() as opening:
        page.click("#bar a:has-text('Open report')")
    report = opening.value
    report.wait_for_selector("body[data-ready]", timeout=LONG)
    assert report.evaluate("window.origin") == "null"
    with page.expect_download() as download:
        page.click("text=Save report")
    with page.expect_download() as recipe:
        page.click("text=Save recipe")
    assert recipe.value.path().read_text() == 'logs = ["drive.csv"]\nmapping = "hersey.toml"\n'
    kept = started.folder / "hersey-reports" / "drive.html"
    assert download.value.path().read_bytes() == kept.read_bytes()
    assert "hersey-reports/drive.html" in page.inner_text("#analyses")
    own = page.url
    assert all(url.startswith((own, "blob:" + own)) for url in watched.requests)
    assert not any(started.address.split("#")[1] in url for url in watched.requests)
    assert watched.errors == []


def test_a_dropped_joint_is_spoken_of_without_words_of_belts(watched: Watched) -> None:
    """All that the page shows of a joint and its log, as TOML and as a form, and what the pointer shows."""
    page = watched.page
    watched.drop("joint.toml", JOINT.encode())
    watched.drop("joint.csv", sine(hot=True).to_frame().drop("run").head(1500).write_csv().encode())
    page.wait_for_selector("#why:has-text('Ready')")
    assert 'part = "joint"' in page.locator("#toml").input_value()
    texts = set(page.evaluate(TEXTS))
    page.click('[data-control="mode:form"]')
    page.wait_for_selector('[data-control="field:drivetrain.mass"]')
    texts |= set(page.evaluate(TEXTS))
    assert {"stiffness", "length", "300 to 307.5"} <= texts
    assert foreign(texts) == []
    assert watched.errors == []


def test_a_fault_stands_under_its_row_and_a_button_mends_it(watched: Watched) -> None:
    page = watched.page
    watched.drop("drive3.csv", MISTAKES["kelvin without a unit"][0])
    watched.drop("notes.pdf", MISTAKES["not a log"][0])
    page.wait_for_selector("#files li:has-text('notes.pdf'):has-text('not a log')")
    page.wait_for_selector("tr.fault")
    assert page.locator(".wrong").count() == 1
    assert "unit of Heater" in watched.why()
    page.click("#theme")
    accessible(page, WIDTHS)
    page.set_viewport_size({"width": 1280, "height": 800})
    page.click("#why button:has-text('unit of Heater')")
    assert page.evaluate("document.activeElement.dataset.control") == "unit:Heater"
    page.click("button:text-is('Read as K')")
    page.wait_for_selector("tr.fault", state="detached")
    assert page.locator('[data-control="unit:Heater"]').input_value() == "K"
    page.click("#files li:has-text('notes.pdf') >> text=Remove")
    page.wait_for_selector("#why:has-text('Ready')")
    page.click('[data-control="more"]')
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    drop, list_ = (page.locator(place).bounding_box() for place in ("#drop", "#analyses"))
    assert drop is not None
    assert list_ is not None
    assert drop["y"] < 200 < list_["y"]  # on a phone a log comes first
    page.click('[data-control="mode:toml"]')
    editor = page.locator("#toml")
    assert editor.evaluate("e => { e.value = 'x'.repeat(300); return e.scrollWidth <= e.clientWidth; }")
    assert watched.errors == []


def test_a_run_is_seen_at_once_and_drafts_of_one_name_are_numbered(watched: Watched) -> None:
    page = watched.page
    for _ in range(2):
        page.click("#new")
        expect(page.locator("#files li")).to_have_count(0, timeout=LONG)
        watched.drop("twice.csv", log())
        page.wait_for_selector("#why:has-text('Ready')")
    names = page.locator("#analyses .name").all_text_contents()
    assert [name for name in names if name.startswith("twice")] == ["twice.csv", "twice.csv (2)"]
    assert page.is_visible("label:has-text('Subtract the torque at standstill (tare)')")
    shown = page.evaluate(  # before the server can have answered
        """() => { document.getElementById("run").click();
             return document.querySelector("#analyses [aria-current=true] progress") !== null; }"""
    )
    assert shown
    page.click("#bar >> text=Cancel")
    page.wait_for_selector("#why:has-text('Ready')")
    assert watched.errors == []


def test_a_run_can_be_cancelled_and_another_stops_with_its_reason(watched: Watched) -> None:
    """Of logs whose names are markup: they are shown, and do nothing."""
    page = watched.page
    names = [name for name in MARKUP if "," not in name and "[" not in name][:12]
    header = ",".join(["Time [s]", "Torque [N*m]", "Speed [rpm]", "Temperature [degC]", *names])
    rows = [f"{line},{','.join('1' for _ in names)}" for line in log().decode().splitlines()[1:]]
    watched.drop("<img src=x onerror=alert(1)>.csv", "\n".join([header, *rows, ""]).encode())
    page.wait_for_selector("table.channels")
    assert page.locator("table.channels img, table.channels iframe, table.channels script").count() == 0
    assert page.locator("table.channels tbody tr").count() >= 4 + len(names)
    page.click("#run")
    page.click("#bar >> text=Cancel")
    page.wait_for_selector("#why:has-text('Ready')")
    watched.drop("tiny.csv", b"Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n0,1,2,3\n1,1,2,3\n")
    page.wait_for_selector("#files li:has-text('tiny.csv') >> text=rows")
    page.click("#files li:has-text('img src') >> text=Remove")
    expect(page.locator("#files li")).to_have_count(1, timeout=LONG)
    page.click("#run")
    page.wait_for_selector("#analyses li[aria-current] :text('stopped')")
    assert "too few" in watched.why() or "dwell" in watched.why()
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
    again = start(tmp_path)
    later = Watched(browser, again.address)
    found = later.page.locator("#earlier li")
    expect(found).to_contain_text("hersey-reports/log.html", timeout=LONG)
    with later.context.expect_page() as opening:
        found.locator("text=Open report").click()
    opening.value.wait_for_selector("body[data-ready=true]", timeout=LONG)
    later.context.close()
    end(again)
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


def test_what_a_start_that_was_killed_has_left_goes_with_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    left = tmp_path / "hersey-app-left"
    left.mkdir()
    (left / "lock").touch()
    (tmp_path / "hersey-app-of-another-program").mkdir()
    with private_folder() as folder, private_folder() as beside:
        assert folder.is_dir()  # the second start leaves the first alone
        assert beside.is_dir()
        assert not left.exists()
    assert [path.name for path in tmp_path.iterdir()] == ["hersey-app-of-another-program"]
