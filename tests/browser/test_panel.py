"""The panel that answers, in a real Chromium: what it says is what the core says outside of a browser."""

from __future__ import annotations

import dataclasses
import re
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from playwright.sync_api import Browser, Page

from hersey.document.analysis import Analysis
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import DragTable
from hersey.motion.simulation import StickSlipCycle, stick_slip
from hersey.report.page import render
from hersey.stability.disturbance import disturbance
from hersey.stability.hysteresis import hysteresis
from hersey.stability.operating_map import OperatingMap
from tests.browser.opening import Opened
from tests.cli.command import run

#: What the verdict says of each state of the map.
WORDS = {
    "stick_slip": "Act: sticks from any start",
    "swing": "Watch: depends on start: oscillates when slowed down",
    "bistable": "Watch: depends on start: sticks from rest, slides when slowed down",
    "smooth": "Good: smooth from any start",
}


class OwnEdges(OperatingMap):
    """A map whose edges are those of its drag curve, not of a posterior."""

    given = False


@pytest.fixture(scope="module")
def native(document: Analysis) -> OperatingMap:
    """The map of a drive that starts its belt: a roll that grips, no limit of torque."""
    found = document.map
    assert found is not None
    assert found.temperature is not None
    assert isinstance(found.drag, DragTable)
    table = replace(found.drag, closure="retained", static_force=None)
    train = Drivetrain(found.train.stiffness, found.train.mass)
    bands = [hysteresis(train, table.at(t), sensitivity=False) for t in found.temperature.tolist()]
    edges = {
        name: np.array([getattr(band, name) for band in bands]) for name in ("lower", "transition", "upper")
    }
    intervals = {
        f"{name}_interval": np.array([f * edges[name] for f in (0.8, 1.3)])
        for name in ("transition", "upper")
    }
    never = np.full(found.temperature.size, np.inf)
    limits = {"torque_limit": None, "stall_below": 0.0 * found.temperature, "stall_above": never}
    return replace(found, drag=table, train=train, **edges, **intervals, **limits)


@pytest.fixture(scope="module")
def part(native: OperatingMap) -> OperatingMap:
    """The same as the document holds it."""
    return OwnEdges(**vars(native))


@pytest.fixture(scope="module")
def report(document: Analysis, part: OperatingMap, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("panel") / "report.html"
    path.write_text(render(document.model_copy(update={"map": part})), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def opened(browser: Browser, report: Path) -> Opened:
    found = Opened(browser, report)
    found.page.set_viewport_size({"width": 1280, "height": 800})
    return found


@pytest.fixture
def page(opened: Opened) -> Iterator[Page]:
    """The page at the report's own setting; nothing may have gone wrong on it in the end."""
    if opened.page.locator(".back").is_enabled():
        opened.page.click(".back")
    rested(opened.page)
    yield opened.page
    quiet(opened)


def quiet(opened: Opened) -> None:
    """No fault, and nothing left the page: its workers are made of its own text."""
    assert {each for each in opened.requests if not each.startswith("blob:")} == {opened.address}
    assert opened.violations == []
    assert opened.errors == [], opened.errors[:3]


def rested(page: Page) -> None:
    """Wait until nothing of the picture lags, three frames long: a mouse move comes with the next frame."""
    page.evaluate(
        "() => new Promise((done) => { let calm = 0; const frame = () => {"
        " const lags = document.querySelector('#map .lags:not(.interval):not(.fold-interval), #panel .lags');"
        " calm = lags ? 0 : calm + 1; if (calm === 3) done(); else requestAnimationFrame(frame); };"
        " requestAnimationFrame(frame); })"
    )


def enter(page: Page, name: str, value: str) -> None:
    page.fill(f"#try-{name}", value)
    page.press(f"#try-{name}", "Enter")
    rested(page)


def verdict(page: Page) -> str:
    return (page.text_content(".verdict-line") or "").strip()


def written(page: Page, name: str) -> str:
    """What the button Link, Command or TOML writes."""
    button = page.locator(".panel .foot button", has_text=re.compile(f"^{name}$"))
    if button.get_attribute("aria-expanded") == "true":
        button.click()
    button.click()
    return page.input_value(".panel textarea")


def cycle_of(native: OperatingMap, speed: float, kelvin: float, **changed: float) -> StickSlipCycle:
    train = Drivetrain(
        changed.get("stiffness", native.train.stiffness), native.train.mass, grip=native.train.grip
    )
    return stick_slip(train, native.drag, drive_speed=speed, temperature=kelvin)


def test_the_map_is_drawn_with_its_words(page: Page, part: OperatingMap) -> None:
    words = page.locator("#map .word").all_text_contents()
    assert {"smooth", "sticks"} <= set(words)
    assert page.locator("#map .point").count() == len(part.points)
    assert page.locator("#map .name").all_text_contents() == [point.name for point in part.points]
    boxes = [each.bounding_box() for each in page.locator("#map .name, #map .word, #map .torque-name").all()]
    for i, a in enumerate(boxes):
        for b in boxes[:i]:
            assert a is not None
            assert b is not None
            apart = a["x"] >= b["x"] + b["width"] or b["x"] >= a["x"] + a["width"]
            assert apart or a["y"] >= b["y"] + b["height"] - 4 or b["y"] >= a["y"] + a["height"] - 4


@pytest.mark.parametrize("share", [0.6, 0.98, 1.1, 2.5])
@pytest.mark.parametrize("celsius", [110, 180])
def test_the_verdict_is_that_of_the_core(
    page: Page, native: OperatingMap, share: float, celsius: int
) -> None:
    kelvin = celsius + 273.15
    transition = native.state_at(temperature=kelvin, speed=0.1).transition
    enter(page, "temperature", str(celsius))
    enter(page, "speed", f"{1e3 * share * transition:.4g}")
    speed = float(f"{share * transition:.4g}")
    state = native.state_at(temperature=kelvin, speed=speed)
    assert verdict(page).startswith(WORDS[state.state])
    assert ("extrapolated" in verdict(page)) == state.extrapolated
    cycle = cycle_of(native, speed, kelvin)
    if cycle.kind == "stick_slip":
        assert f"{cycle.frequency:.3g} Hz, at rest {100 * cycle.stuck_fraction:.2g} %" in verdict(page)
    if state.state == "bistable":
        page.wait_for_function(
            "() => document.querySelector('.verdict-line').textContent.includes('withstands')"
        )
        bears = disturbance(native.train, native.drag, drive_speed=speed, temperature=kelvin).kick
        assert (
            "withstands any sudden loss of speed" in verdict(page)
            if np.isinf(bears)
            else f"withstands a sudden loss of {1e3 * bears:.2g} mm/s" in verdict(page)
        )


def test_arrows_move_the_ring(page: Page) -> None:
    ring = page.locator("#map .ring")
    ring.focus()
    before = float(page.input_value("#try-speed"))
    ring.press("ArrowUp")
    ring.press("Shift+ArrowLeft")
    rested(page)
    assert float(page.input_value("#try-speed")) == pytest.approx(1.02 * before, rel=1e-3)
    kelvin = page.input_value("#try-temperature")
    text = ring.get_attribute("aria-valuetext") or ""
    assert re.fullmatch(rf"[\d.]+ mm/s at {kelvin} °C, (sticks|depends on start|smooth|stall)", text)
    assert page.evaluate("document.activeElement.classList.contains('ring')")


def test_a_drag_moves_the_ring_and_crosses_the_zones(page: Page, part: OperatingMap) -> None:
    box = page.locator("#map .ring .round").bounding_box()
    frame = page.locator("#map .box").bounding_box()
    assert box is not None
    assert frame is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    said = []
    before = float(page.input_value("#try-temperature"))
    page.mouse.move(x, y)
    page.mouse.down()
    for target in (frame["y"] + frame["height"] - 4, frame["y"] + 30):
        page.mouse.move(x - 40, target, steps=3)
        rested(page)
        said.append(verdict(page).split(":")[0])
    page.mouse.up()
    assert part.temperature is not None
    moved = 40 / frame["width"] * (part.temperature[-1] - part.temperature[0])
    assert float(page.input_value("#try-temperature")) == pytest.approx(before - moved, abs=0.6)
    assert said[0] == "Act"
    assert said[1] in ("Good", "Act")
    assert "◆" in (page.text_content("#panel .cap .hint") or "")
    assert page.locator("#panel .differs").count() == 2


def test_a_stiffer_drive_moves_the_edges_of_the_map(page: Page, native: OperatingMap) -> None:
    before = page.get_attribute("#map [role=img] .fold", "d")
    enter(page, "stiffness", "33")
    page.wait_for_function(
        "(old) => document.querySelector('#map [role=img] .fold')?.getAttribute('d') !== old", arg=before
    )
    assert "as reported" in (page.text_content("#map .key") or "")
    enter(page, "speed", "20")
    cycle = cycle_of(native, 0.02, float(page.input_value("#try-temperature")) + 273.15, stiffness=33e3)
    assert cycle.kind == "stick_slip"
    assert f"{cycle.frequency:.3g} Hz" in verdict(page)


def test_back_returns_to_the_report(page: Page) -> None:
    before = verdict(page)
    enter(page, "speed", "33")
    enter(page, "stick_speed", "0.5")
    page.select_option("#try-closure", "stiction")
    rested(page)
    assert page.locator("#panel .changed", has_text="◆").count() == 3
    page.click(".back")
    rested(page)
    assert page.locator("#panel .changed", has_text="◆").count() == 0
    assert verdict(page).split("·")[0] == before.split("·")[0]
    assert page.locator(".back").is_disabled()


def test_the_link_restores_the_setting(page: Page, browser: Browser) -> None:
    enter(page, "speed", "37.5")
    enter(page, "temperature", "150")
    page.select_option("#try-closure", "stiction")
    rested(page)
    address = written(page, "Link")
    there = browser.new_page()
    there.goto(address)
    there.wait_for_selector("body[data-ready]")
    rested(there)
    assert there.input_value("#try-speed") == "37.5"
    assert there.input_value("#try-temperature") == "150"
    assert there.input_value("#try-closure") == "stiction"
    assert verdict(there).split("·")[0] == verdict(page).split("·")[0]
    there.close()


def test_the_command_reproduces_the_setting(page: Page, tmp_path: Path) -> None:
    enter(page, "speed", "20")
    enter(page, "stiffness", "15")
    for name, file in (("TOML", "setting.toml"), ("Drag", "drag.csv")):
        (tmp_path / file).write_text(written(page, name), encoding="utf-8")
    words = shlex.split(written(page, "Command"))
    assert words.pop(0) == "hersey"
    ran = subprocess.run(
        [sys.executable, "-m", "hersey.cli", *words], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    numbers = dict(re.findall(r"(frequency|stuck) +([\d.]+)", ran.stdout))
    shown = re.search(r"([\d.]+) Hz, at rest ([\d.]+) %", verdict(page))
    assert shown is not None
    assert float(shown[1]) == float(f"{float(numbers['frequency']):.3g}")
    assert float(shown[2]) == float(f"{float(numbers['stuck']):.2g}")


def test_a_profile_is_followed_and_edited(page: Page, tmp_path: Path) -> None:
    page.click("#panel button:text-is('Profile')")
    page.fill("[aria-label='Row 2, time in s']", "0.4")
    page.press("[aria-label='Row 2, time in s']", "Enter")
    page.click("text=Add a row")
    page.fill("[aria-label='Row 3, speed in mm/s']", "20")
    page.press("[aria-label='Row 3, speed in mm/s']", "Enter")
    rested(page)
    assert "with this profile" in verdict(page) or "of this profile" in verdict(page)
    assert page.input_value("#try-speed") == "20"
    for name, file in (("TOML", "setting.toml"), ("Drag", "drag.csv")):
        (tmp_path / file).write_text(written(page, name), encoding="utf-8")
    words = shlex.split(written(page, "Command"))
    with page.expect_download() as download:
        page.click("#profile button:text-is('Save CSV')")
    assert download.value.suggested_filename == "profile.csv"
    download.value.save_as(tmp_path / "profile.csv")
    done = run(*words[1:], "--csv", "motion.csv", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    peak = pl.read_csv(tmp_path / "motion.csv")["belt_speed"].max()
    told = re.search(r"peak ([\d.]+) mm/s", verdict(page))
    assert told is not None
    assert 1e3 * float(peak) == pytest.approx(float(told[1]), rel=0.01)  # type: ignore[arg-type]
    page.fill("[aria-label='Row 2, time in s']", "7")
    page.press("[aria-label='Row 2, time in s']", "Enter")
    assert page.get_attribute("[aria-label='Row 2, time in s']", "aria-invalid") == "true"
    assert "Times must rise" in (page.text_content("#panel .refused") or "")
    handle = page.locator("#panel .handle").nth(1)
    handle.focus()
    handle.press("Shift+ArrowUp")
    rested(page)
    assert page.locator("#panel .handle").count() >= 3
    page.click("text=Remove profile")
    rested(page)
    assert page.locator("#profile").is_hidden()


def draw(page: Page, meanwhile: Callable[[], object] = lambda: None) -> None:
    """Draw a profile of a rise and a fall by hand, and do something while it is drawn."""
    page.click("#panel button:text-is('Profile')")
    page.click("text=Draw by hand")
    rested(page)
    sheet = page.locator("#panel .sheet").bounding_box()
    assert sheet is not None
    page.mouse.move(sheet["x"] + 4, sheet["y"] + 0.9 * sheet["height"])
    page.mouse.down()
    page.mouse.move(sheet["x"] + 0.3 * sheet["width"], sheet["y"] + 0.3 * sheet["height"], steps=12)
    meanwhile()
    page.mouse.move(sheet["x"] + 0.8 * sheet["width"], sheet["y"] + 0.6 * sheet["height"], steps=12)
    page.mouse.up()
    rested(page)


def test_a_profile_is_drawn_by_hand(page: Page) -> None:
    draw(page)
    assert 3 <= page.locator("#panel .rows input").count() / 2 <= 8
    assert "profile" in verdict(page)


def test_an_answer_that_comes_while_a_profile_is_drawn_does_not_lose_it(page: Page) -> None:
    def answered() -> None:
        page.evaluate(
            "() => { const field = document.querySelector('#try-stiffness'); field.value = '12';"
            " field.dispatchEvent(new Event('change', { bubbles: true })); }"
        )
        rested(page)

    draw(page, answered)
    assert page.input_value("#try-stiffness") == "12"
    assert 3 <= page.locator("#panel .rows input").count() / 2 <= 8


def test_a_wrong_number_is_refused_in_its_field(page: Page) -> None:
    before = verdict(page)
    page.fill("#try-stiffness", "stiff")
    page.press("#try-stiffness", "Enter")
    assert page.get_attribute("#try-stiffness", "aria-invalid") == "true"
    assert page.text_content("#panel .refused") == "Stiffness: type a number from 1.1 to 110 N/mm"
    assert verdict(page) == before
    enter(page, "stiffness", "12")
    assert page.get_attribute("#try-stiffness", "aria-invalid") == "false"
    assert page.locator("#panel .refused").count() == 0


def test_a_smooth_closure_is_drawn_by_a_worker_and_can_be_overtaken(page: Page, native: OperatingMap) -> None:
    page.select_option("#try-closure", "stribeck")
    page.select_option("#try-closure", "lugre")
    assert page.locator("#try-bristle_stiffness").count() == 1
    page.select_option("#try-closure", "stribeck")
    page.wait_for_function("() => !document.querySelector('.two').classList.contains('lags')")
    speed, kelvin = (
        float(page.input_value("#try-speed")) / 1e3,
        float(page.input_value("#try-temperature")) + 273.15,
    )
    drag = dataclasses.replace(native.drag, closure="stribeck")
    rest, above = (
        stick_slip(native.train, drag, drive_speed=speed, temperature=kelvin, start=start).kind
        == "steady_sliding"
        for start in ("rest", "steady")
    )
    assert verdict(page).startswith(WORDS["smooth" if rest else "bistable" if above else "stick_slip"])
    page.select_option("#try-closure", "retained")
    rested(page)
    assert page.locator(".back").is_disabled()


def test_an_answer_that_comes_late_is_not_shown(page: Page) -> None:
    """Of a setting that was left for one that cannot be: the reason stays, and the map stays pale."""
    page.evaluate(
        """async () => {
          const frame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)));
          const set = async (id, value) => {
            const field = document.getElementById(id);
            field.value = value;
            field.dispatchEvent(new Event("change"));
            await frame();
            await frame();
          };
          await set("try-stiffness", "12");
          await set("try-closure", "stribeck");
          location.hash = "#setting?stick_speed=1";
          await new Promise((done) => addEventListener("hashchange", done, { once: true }));
          await frame();
          await frame();
        }"""
    )
    assert "Not computed: the stick speed must be less than the transition" in verdict(page)
    page.wait_for_timeout(1500)  # in which the worker answers what was left
    assert "Not computed" in verdict(page)
    assert page.locator("#map .zone.lags").count() > 0


def test_a_closure_whose_band_is_not_computed_shows_none(page: Page) -> None:
    """No V* of another closure stands in its place: not as a line, nor as a zone, nor in key and table."""
    page.select_option("#try-closure", "stribeck")
    page.wait_for_selector("#map .key >> text=not computed for this closure")
    rested(page)
    assert page.locator("#map .zone.sticks").count() >= 1
    assert page.locator("#map .zone.smooth, #map .zone.depends").count() == 0
    lines = page.locator("#map [role=img] .fold, #map [role=img] .fold-interval")
    assert [line.get_attribute("d") for line in lines.all() if line.get_attribute("d")] == []
    assert "not computed" in (page.get_attribute("#map [role=img]", "aria-label") or "")
    page.select_option("#try-closure", "retained")
    rested(page)
    assert page.locator("#map .zone.smooth").count() >= 1


def test_torques_have_one_unit(page: Page, document: Analysis) -> None:
    """That of the sections: in the verdict with its number, and on the lines of the map."""
    per, unit = (1.0, "N·m") if max(abs(p.torque) for p in document.points) >= 1 else (1e3, "mN·m")
    enter(page, "speed", "40")
    said = re.search(r"torque ([\d.]+) (m?N·m)", verdict(page))
    assert said is not None
    on_map = " ".join(page.locator("#map .torque-name").all_text_contents())
    assert {said[2], *re.findall(r"m?N·m", on_map)} == {unit}
    drag = document.map.drag  # type: ignore[union-attr]
    kelvin = float(page.input_value("#try-temperature")) + 273.15
    radius = document.map.roll_radius  # type: ignore[union-attr]
    assert float(said[1]) == pytest.approx(per * radius * drag.force(0.04, temperature=kelvin), rel=0.006)


def test_the_numbers_behind_a_motion(page: Page) -> None:
    enter(page, "speed", "20")
    page.click("#panel .numbers summary")
    table = page.locator("#panel .numbers table")
    table.locator("tbody tr").first.wait_for()
    assert table.locator("tbody tr").count() > 200
    with page.expect_download() as download:
        page.click("#panel .numbers button:text-is('Save CSV')")
    rows = pl.read_csv(download.value.path())
    assert rows.columns == ["Time, s", "Drive, mm/s", "Sliding, mm/s", "Spring, N", "Stuck"]
    assert set(rows["Drive, mm/s"]) == {20}
    assert set(rows["Stuck"]) == {"yes", "no"}
    assert rows["Time, s"].is_sorted()
    enter(page, "speed", "25")
    page.wait_for_function(
        "() => document.querySelector('#panel .numbers td:nth-child(2)').textContent === '25'"
    )
    page.click("#panel .numbers summary")


def test_sixty_settings_in_a_row(page: Page) -> None:
    """Each is drawn; how long they take is measured by benchmarks/page.py, as a busy machine is slow."""
    seen = page.evaluate(
        """async () => {
          const slider = document.getElementById("slide-speed"), seen = new Set();
          for (let i = 0; i < 60; i += 1) {
            slider.value = 200 + 10 * i;
            slider.dispatchEvent(new Event("input", { bubbles: true }));
            await new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)));
            seen.add(document.querySelector("#panel .from-rest").getAttribute("d"));
          }
          return seen.size;
        }"""
    )
    assert seen >= 58


def test_it_prints_values_instead_of_controls(page: Page) -> None:
    page.emulate_media(media="print")
    assert page.locator(".print-values").is_visible()
    assert page.locator("#try-speed").is_hidden()
    page.emulate_media(media="screen")


def test_nothing_is_cut_on_a_phone(page: Page) -> None:
    page.set_viewport_size({"width": 360, "height": 800})
    page.wait_for_function("() => document.querySelector('#map > svg').clientWidth < 360")
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    for each in page.locator("#map > svg text, #panel svg text").all():
        box = each.bounding_box()
        assert box is None or (box["x"] >= 0 and box["x"] + box["width"] <= 361), each.text_content()
    page.set_viewport_size({"width": 1280, "height": 800})


def test_without_webassembly_the_page_stays_whole(browser: Browser, report: Path, part: OperatingMap) -> None:
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    errors: list[str] = []
    page.on("pageerror", lambda e: errors.append(str(e)))
    page.add_init_script("delete globalThis.WebAssembly")
    page.goto(report.as_uri())
    page.wait_for_selector("body[data-ready]")
    assert page.get_attribute("body", "data-ready") == "true"
    assert "has no WebAssembly" in (page.text_content("#panel") or "")
    assert page.locator("#panel input").count() == 0
    assert page.locator("#map .point").count() == len(part.points)
    assert page.locator("#map .zone").count() >= 2
    assert errors == []
    page.close()
