"""Pages of a drive that is no belt hold no belt, in all that they show and say."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser

import hersey
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of
from hersey.machine.machine import read_machine
from hersey.report.page import render
from hersey.study import study
from tests.browser.opening import Opened
from tests.test_noun import FOREIGN

JOINT = """
[drivetrain]
part = "joint"
stiffness = "2.5 N*m/rad"
mass = "2.5e-3 kg*m^2"
roll_radius = "15 mm"
stick_speed = "0.02 rad/s"
[limits]
motor_torque = "8 N*m"
[[points]]
name = "slow"
speed = "30 rpm"
temperature = "180 degC"
"""
#: All text of a page, in folds too, and what shows where the pointer rests or a reader for the blind reads.
TEXTS = """() => {
  document.querySelectorAll("details").forEach((fold) => { fold.open = true; });
  const texts = [], walk = document.createTreeWalker(document.documentElement, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const { parentElement, textContent } = walk.currentNode;
    if (!/^(script|style)$/i.test(parentElement.tagName)) texts.push(textContent);
  }
  for (const name of ["title", "aria-label", "placeholder"])
    document.querySelectorAll(`[${name}]`).forEach((each) => texts.push(each.getAttribute(name)));
  return texts;
}"""


def words(opened: Opened) -> set[str]:
    """The texts of a page, and those in its data that are shown where it is used."""
    data = re.findall(
        r'<script type="application/json" id="(?:document|charts|glossary)">(.*?)</script>',
        Path(opened.address.removeprefix("file://")).read_text(encoding="utf-8"),
        re.DOTALL,
    )
    assert data
    return {*opened.page.evaluate(TEXTS), *(text for each in data for text in _strings(json.loads(each)))}


def _strings(value: Any) -> Iterator[str]:
    """The strings of a document, but for identifiers of warnings."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        each = value.items() if isinstance(value, dict) else enumerate(value)
        yield from (text for key, inner in each if key != "kind" for text in _strings(inner))


def foreign(texts: set[str]) -> list[str]:
    return sorted(text for text in texts if FOREIGN.search(text))


@pytest.mark.usefixtures("roughly")
def test_the_page_of_a_joint_speaks_of_the_joint(
    browser: Browser, points: hersey.SteadyPoints, tmp_path: Path
) -> None:
    (tmp_path / "joint.toml").write_text(JOINT)
    machine = read_machine(tmp_path / "joint.toml")
    document = document_of(study(points, machine, machine_file=tmp_path / "joint.toml"))
    (tmp_path / "joint.html").write_text(render(document), encoding="utf-8")
    opened = Opened(browser, tmp_path / "joint.html")
    texts = words(opened)
    opened.assert_quiet()
    opened.page.close()
    assert foreign(texts) == []
    assert document.decision is not None
    assert document.decision.otherwise.startswith("The joint slides from any start above ")
    assert any(text.startswith("Operating map: the joint sticks below ") for text in texts)


@pytest.mark.parametrize("name", ["plain", "against"])
def test_pages_without_a_machine_speak_of_the_drive(
    browser: Browser, report: Callable[[str], tuple[Path, Analysis]], name: str
) -> None:
    opened = Opened(browser, report(name)[0])
    assert foreign(words(opened)) == []
    opened.page.close()


def test_the_page_of_a_belt_speaks_of_the_belt(
    browser: Browser, report: Callable[[str], tuple[Path, Analysis]]
) -> None:
    opened = Opened(browser, report("demo")[0])
    texts = words(opened)
    opened.page.close()
    assert any("belt slides from any start above" in text for text in texts)
    assert any("the belt sticks below" in text for text in texts)
