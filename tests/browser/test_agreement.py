"""One verdict for each operating point: list, panel, map, plan, sentence and JSON, over many documents.

The verdict is worked out once more here, from the draws of the posterior and the limits of the machine file.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Page, expect

import hersey
from hersey.decision import behaviour
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of
from hersey.log.means import read_means
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine, read_machine
from hersey.posterior.sampling import posterior
from hersey.report.page import render
from hersey.study import study
from tests.browser.opening import Opened
from tests.conftest import ROOT, mostly_nightly

HOT, COOL = 453.15, 403.15
#: Words of each verdict: the sentence of one speed and of several, the list, and the signal.
SENTENCE = {
    "smooth": r"runs? smoothly",
    "depends": r"needs? the start-up profile|(may stick|sticks?) from rest",
    "unknown": r"needs? the start-up profile|may not start|may stick|cannot be judged",
    "sticks": r"sticks? from any start",
    "not started": r"(does|do) not start",
    "stalls": r"stalls?",
    "too fast": r"(is|are) faster than the drive",
}
LISTED = {
    "smooth": r"^smooth from any start",
    "depends": r"^(needs the start-up profile|(may stick|sticks) from rest|may not start)",
    "unknown": r"^(needs the start-up profile|may |sticks from rest|not known)",
    "sticks": r"^sticks from any start",
    "not started": r"^does not start",
    "stalls": r"^stalls",
    "too fast": r"^faster than the drive",
}
SIGNALS = {"good": "Good:", "watch": "Watch:", "act": "Act:"}
SPEEDS = (0.012, 0.045, 0.075, 0.2, 0.5)


def _stand(**limits: float) -> Machine:
    stated = read_machine(ROOT / "tests" / "stand" / "machine.toml")
    points = [OperatingPoint(f"p{1e3 * v:.0f}", v, HOT) for v in SPEEDS]
    points += [OperatingPoint(f"cool{1e3 * v:.0f}", v, COOL) for v in SPEEDS[1:3]]
    return replace(stated, limits=Limits(**limits), points=tuple(points))


def _rising(folder: Path) -> hersey.SteadyPoints:
    """Torque that only rises among the dwells, isothermal."""
    speeds = np.repeat(np.geomspace(4.0, 140.0, 10), 3) * np.pi / 30.0
    torques = 0.3 * speeds**0.4 * np.exp(0.01 * np.random.default_rng(2).standard_normal(speeds.size))
    rows = [f"{w:.9g},{t:.9g}" for w, t in zip(speeds.tolist(), torques.tolist(), strict=True)]
    (folder / "means.csv").write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows, ""]))
    return hersey.SteadyPoints.from_table(read_means([folder / "means.csv"], isothermal=True))


MACHINES = {
    "slow drive": _stand(motor_torque=30.0, acceleration=0.5, speed=0.15),
    "weak motor": _stand(motor_torque=1.2),
    "grip in doubt": _stand(roll_friction=0.5, nip_load=300.0),
    "only rising": _stand(),
}


#: A drive that is too slow for a point is judged by its stated speed alone, which `test_judge` looks at.
JUDGED = mostly_nightly(MACHINES, *(MACHINES.keys() - {"slow drive"}))


#: Draws of each machine: the verdict is worked out of the same ones, so that a quarter will do.
FEW = 250


@pytest.fixture(scope="module", params=JUDGED)
def judged(
    request: pytest.FixtureRequest,
    points: hersey.SteadyPoints,
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[Analysis, hersey.Posterior, Machine]:
    """The document of a machine, and the draws that it was made of."""
    machine = MACHINES[request.param]
    dwells = _rising(tmp_path_factory.mktemp("rising")) if request.param == "only rising" else points
    found: list[hersey.Posterior] = []

    def drawn(*given: Any, **named: Any) -> hersey.Posterior:
        found.append(posterior(*given, **named))
        return found[-1]

    few = mock.patch.object(behaviour.Working.__init__, "__defaults__", ((), None, FEW))
    with mock.patch.object(behaviour, "posterior", drawn), few:
        document = document_of(study(dwells, machine))
    assert [len(each.drives) for each in found] == [FEW]
    return document, found[0], machine


def _verdict(found: hersey.Posterior, machine: Machine, kelvin: float | None, speed: float) -> str:
    """The verdict by hand: shares of the draws, each claim with 97.5 %."""
    edges, limits = found.edges(kelvin), machine.limits
    motor = np.inf if limits.motor_torque is None else limits.motor_torque / machine.roll_radius
    limit = min(motor, np.inf if machine.train.grip is None else machine.train.grip)
    constant, damping = found.model.no_load(kelvin)
    pull = found.model.force_at(found.drives, kelvin, speed) + constant + damping * speed
    stalls = edges.stalls
    starts, withstands = np.mean(edges.holding <= limit), np.mean(pull <= limit)
    smooth = np.mean(~stalls & (edges.fold < speed))
    sticks = np.mean(~stalls & (speed < edges.transition))
    if limits.speed is not None and speed > limits.speed:
        return "too fast"
    if starts <= 0.025:
        return "not started"
    if withstands <= 0.025:
        return "stalls"
    if min(smooth, starts, withstands) >= 0.975:
        return "smooth"
    if sticks >= 0.975:
        return "sticks"
    above = 1.0 - np.mean(stalls) - sticks
    return "depends" if above >= 0.975 and min(starts, withstands) >= 0.975 else "unknown"


def test_document_sentence_list_map_and_plan_agree(
    judged: tuple[Analysis, hersey.Posterior, Machine],
) -> None:
    document, found, machine = judged
    decision, map_ = document.decision, document.map
    assert decision is not None
    assert map_ is not None
    assert [p.name for p in decision.points] == [p.name for p in machine.points]
    for point, stated, placed in zip(decision.points, machine.points, map_.points, strict=True):
        kelvin = None if found.temperature is None else stated.temperature
        assert point.verdict == _verdict(found, machine, kelvin, stated.speed), point.name
        assert point.verdict == placed.judged
        assert re.search(LISTED[point.verdict], point.words), (point.verdict, point.words)
        if point.verdict in ("sticks", "not started", "stalls", "too fast"):
            assert point.signal == "act"
            assert point.plan is None
        if point.signal == "good":
            assert point.verdict == "smooth"
    sentences = decision.instruction.split(". ")
    starts_at_all = not re.match(r"(At .*)?(give the roll|let the roll)", decision.instruction)
    if starts_at_all:
        for point in decision.points:
            speed = f"{1e3 * point.speed:.2g}" if point.speed < 0.1 else f"{1e3 * point.speed:.0f}"
            where = f" at {point.temperature - 273.15:.0f} °C"
            mine = [s for s in sentences if re.search(rf"(^|[ ,]){speed} mm/s{where}(?!\d)", s)]
            assert len(mine) == 1, (point.name, decision.instruction)
            assert re.search(SENTENCE[point.verdict], mine[0]), (point.verdict, mine[0])


def test_the_page_says_the_same(
    judged: tuple[Analysis, hersey.Posterior, Machine], browser: Browser, tmp_path: Path
) -> None:
    document, _, _ = judged
    assert document.decision is not None
    (tmp_path / "report.html").write_text(render(document), encoding="utf-8")
    opened = Opened(browser, tmp_path / "report.html")
    page: Page = opened.page
    rows = page.locator("table.points tr")
    assert rows.count() == len(document.decision.points)
    for index, point in enumerate(document.decision.points):
        row = _plain(rows.nth(index))
        assert point.name in row
        assert point.words in row
        shift = point.temperature - 273.15
        for name, value in (("temperature", shift), ("speed", 1e3 * point.speed)):
            if page.locator(f"#try-{name}").count():
                page.fill(f"#try-{name}", f"{value:.6g}")
                page.press(f"#try-{name}", "Enter")
        assert point.words.startswith(point.brief[:8])  # the list has the probabilities and the reason
        said = f"{SIGNALS[point.signal]} {point.brief}"
        expect(page.locator(".verdict-line")).to_contain_text(said, timeout=30_000)
    assert opened.errors == []


def _plain(place: Locator) -> str:
    return " ".join((place.text_content() or "").split())
