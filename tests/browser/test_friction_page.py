"""The page of a friction curve shows one law: of a log that moves all the time, and beside a machine."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from hersey.damping.dwells import SteadyPoints
from hersey.damping.estimate import rounded
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of
from hersey.machine.machine import read_machine
from hersey.report.page import render
from hersey.study import study
from tests.browser.opening import Opened
from tests.browser.test_noun import TEXTS, foreign, words
from tests.browser.test_page import COVERED
from tests.damping.moving_logs import sine
from tests.log.test_rolling import stribeck

pytestmark = pytest.mark.usefixtures("roughly")
#: A joint without operating points.
_JOINT = """
[drivetrain]
part = "joint"
stiffness = "2.5 N*m/rad"
mass = "0.01 kg*m^2"
roll_radius = "15 mm"
stick_speed = "0.02 rad/s"
"""
#: Factor from SI to the unit of the table, by name.
_FACTORS = {"T_C": 1e3, "k_v": 1e3, "J": 1e3, "offset": 1e3, "delay": 1e3}


def opened(browser: Browser, folder: Path, machine: str = "") -> tuple[Opened, Analysis]:
    known = None
    if machine:
        (folder / "joint.toml").write_text(machine)
        known = read_machine(folder / "joint.toml")
    document = document_of(study(sine().moving().points(), known))
    (folder / "page.html").write_text(render(document), encoding="utf-8")
    return Opened(browser, folder / "page.html"), document


def test_the_page_of_a_moving_log_leads_with_its_friction_curve(browser: Browser, tmp_path: Path) -> None:
    seen, document = opened(browser, tmp_path)
    page, moving = seen.page, document.moving
    assert moving is not None
    assert (page.text_content("#decision .lead") or "").startswith("Torque rises with speed from ")
    assert page.text_content("#map h2") == "Friction torque"
    assert "pale: single moments, without inertia and offset" in (page.text_content("#map .note") or "")
    rows = page.locator("table[aria-label='Parameters of the friction curve'] tbody tr")
    shown = [row.split("|")[:3] for row in rows.evaluate_all(
        "all => all.map((e) => [...e.cells].map((cell) => cell.textContent).join('|'))"
    )]  # fmt: skip
    expected = []
    for each in moving.parameters:
        of, factor = each.estimate, _FACTORS[each.name]
        value, interval = rounded(factor * of.value, factor * of.low, factor * of.high).split(" ", 1)
        expected.append([each.name, value, interval])
    assert [[part.replace("\u2212", "-") for part in row] for row in shown] == expected
    assert moving.cost() in (page.text_content("#torque") or "").replace("\u00a0", " ")
    sections = page.locator("section").evaluate_all("all => all.map((e) => e.id)")
    assert sections == ["torque", "candidates", "data", "reproduce"]
    assert page.locator("#chart-damping, #chart-regime, #chart-surface").count() == 0
    assert "a single power of speed, as of a lubricant film, is worse by" in seen.texts()
    assert page.evaluate(COVERED) == []
    assert foreign(words(seen)) == []
    assert re.findall(r".{30}dwell.{30}", page.inner_text("#torque")) == []
    seen.assert_quiet()
    page.close()


def test_which_law_the_safe_speed_uses_is_said(browser: Browser, tmp_path: Path) -> None:
    seen, _ = opened(browser, tmp_path, _JOINT)
    text = seen.page.text_content("#torque") or ""
    assert "V*, the map and start-up profiles use drag curves by weight (" in text
    assert "what torque does below the slowest window." in text
    assert "film" not in (seen.page.text_content("#flags") or "")
    assert seen.page.locator("#chart-damping, #chart-surface").count() == 0
    seen.assert_quiet()
    seen.page.close()


def test_the_page_of_a_traction_machine_shows_its_entrainment_speed(browser: Browser, tmp_path: Path) -> None:
    points = SteadyPoints.from_table(stribeck())
    (tmp_path / "page.html").write_text(render(document_of(study(points))), encoding="utf-8")
    seen = Opened(browser, tmp_path / "page.html")
    texts = seen.page.evaluate(TEXTS)
    assert any("0.005 m/s and faster than 3 m/s" in each for each in texts)
    assert [each for each in texts if "rpm" in each] == []
    seen.assert_quiet()
    seen.page.close()
