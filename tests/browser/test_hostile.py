"""Pages made of files full of hostile names, in a real browser: nothing runs, nothing leaves, all is text."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from playwright.sync_api import Browser

import hersey
from hersey.charts.inspection import inspection_chart
from hersey.charts.render import picture
from hersey.document.analysis import Analysis
from hersey.document.parts.log import RecipePart
from hersey.errors import printable
from hersey.machine.machine import read_machine
from hersey.report.page import render
from hersey.schema.warning import Warning
from hersey.stability.operating_map import OperatingMap
from tests.browser.hostile import NAMES, ON_A_LINE
from tests.browser.opening import Opened
from tests.conftest import ROOT
from tests.machines import map_of

#: Signs of a name that a picture shows as what cannot be shown, or a line of text breaks at.
_SIGNS = {ord("\x1b"): "\ufffd", ord("\x07"): "\ufffd", 0xD83D: "\ufffd"}


def opened_page(browser: Browser, content: str | bytes, path: Path) -> Opened:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return Opened(browser, path)


def start(name: str) -> str:
    """As much of a name as a picture has room for, its signs as they are shown."""
    return name.translate(_SIGNS)[:100].strip()


def assert_shown(opened: Opened, names: tuple[str, ...]) -> None:
    shown = " ".join(opened.texts().translate(_SIGNS).split())
    for name in names:
        assert " ".join(start(name).split()) in shown, f"not shown: {name[:60]!a}"


def assert_harmless(svg: bytes) -> None:
    """A drawing that opens as XML, runs nothing and refers to nothing outside itself."""
    for element in ElementTree.fromstring(svg).iter():
        assert element.tag.rsplit("}", 1)[-1] not in {"script", "image", "a", "foreignObject", "use", "style"}
        for name, value in element.attrib.items():
            assert not name.startswith("on")
            assert "href" not in name
            assert name == "aria-label" or "url(" not in value.replace("url(#", "")


def test_there_are_sixty_names() -> None:
    assert len(set(NAMES)) == 60


@pytest.fixture(scope="module")
def hostile_document(document: Analysis) -> Analysis:
    """A document in which every text that a file or a user can set is hostile."""
    (file,) = document.files
    changed = file.model_copy(
        update={
            "name": NAMES[0],
            "comments": list(NAMES),
            "channels": [replace(file.channels[0], name=name, unit=name) for name in NAMES],
        }
    )
    rejected = [
        stretch.model_copy(update={"label": name, "reason": name})
        for stretch, name in zip(document.quality.rejected * 60, NAMES, strict=False)
    ]
    film, simulation = document.film, document.simulation
    assert film is not None
    assert simulation is not None
    hostile = [Warning("hostile", "{name}", title="{name}", where=name, name=name) for name in NAMES]
    update = {
        "title": NAMES[1],
        "files": [changed],
        "warnings": hostile,
        "command": " ".join(NAMES),
        "recipe": RecipePart(settings={}, toml="\n".join(NAMES)),
        "quality": document.quality.model_copy(update={"rejected": rejected}),
        "simulation": simulation.model_copy(update={"title": NAMES[3], "force_unit": NAMES[28]}),
        "film": film.model_copy(
            update={
                "verdict": NAMES[5],
                "warnings": hostile,
            }
        ),
    }
    return document.model_copy(update=update)


def test_a_report(browser: Browser, hostile_document: Analysis, tmp_path: Path) -> None:
    opened = opened_page(browser, render(hostile_document), tmp_path / "report.html")
    opened.assert_quiet()
    assert opened.page.text_content("h1") == NAMES[1]
    assert_shown(opened, NAMES)
    for number, shown in enumerate(map(printable, NAMES)):
        text = opened.page.locator("#warnings li").nth(number).text_content()
        assert text is not None
        assert text.lower() == f"{shown}: {shown}: {shown}.".lower()  # a sentence begins with a capital
    assert opened.page.locator("main img, main a[href^=http], main iframe, main script").count() == 0
    assert opened.page.evaluate("document.documentElement.scrollWidth") <= 1000


@pytest.fixture(scope="module")
def hostile_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log with hostile channels, units, comments and a hostile name of its own."""
    path = tmp_path_factory.mktemp("logs") / "<img src=x onerror=alert(1)>{{7*7}};'\"\\.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {name[:200]}\n" for name in ON_A_LINE)
        writer = csv.writer(file)
        heads = [name if i % 2 else f"c{i} [{name[:60]}]" for i, name in enumerate(ON_A_LINE)]
        writer.writerow(["Time [s]", "Torque [N*m]", "Speed [rpm]", *heads])
        for i in range(40):
            writer.writerow(
                [i * 0.1, 0.5 + i % 2, 100 + i % 3, *(i % (k % 7 + 2) for k in range(len(heads)))]
            )
    return path


@pytest.fixture(scope="module")
def inspection(hostile_log: Path) -> hersey.Inspection:
    return hersey.inspect(hostile_log)


@pytest.mark.parametrize("kind", ["findings", "channels"])
def test_a_log_inspected(
    browser: Browser, inspection: hersey.Inspection, hostile_log: Path, tmp_path: Path, kind: str
) -> None:
    """Every channel by its name as the reader understands it, and the file's own name."""
    chart = inspection.chart() if kind == "findings" else inspection_chart([hostile_log], inspection)
    opened = opened_page(browser, picture(chart, ".html"), tmp_path / "figure.html")
    opened.assert_quiet()
    channels = tuple(channel.name for channel in inspection.files[0].channels)
    assert len(channels) > 50
    assert_shown(opened, (hostile_log.name, *(channels if kind == "findings" else channels[1:10])))
    for place in opened.page.locator("svg .role-axis-label text, svg .role-title text").all()[:20]:
        place.hover(force=True)
    opened.assert_quiet()
    assert_harmless(picture(chart, ".svg"))


#: Names that a machine file may hold.
IN_A_FILE = tuple(name for name in ON_A_LINE if len(name) <= 1000)


@pytest.fixture(scope="module")
def drawn_map(points: hersey.SteadyPoints, tmp_path_factory: pytest.TempPathFactory) -> OperatingMap:
    """A map of a machine file whose points have hostile names."""
    text = (ROOT / "tests" / "stand" / "machine.toml").read_text()
    path = tmp_path_factory.mktemp("machine") / "machine.toml"
    names = "".join(
        f'[[points]]\nname = {json.dumps(name, ensure_ascii=False)}\nspeed = "{40 + 2 * i} mm/s"\n'
        f'temperature = "{100 + i} degC"\n'
        for i, name in enumerate(IN_A_FILE)
    )
    path.write_text(f"{text}\n{names}", encoding="utf-8")
    machine = read_machine(path)
    surface = hersey.fit(points)
    options = {"limits": machine.limits, "points": machine.points, "uncertainty": {}}
    return map_of(
        surface,
        machine.train,
        roll_radius=machine.roll_radius,
        stick_speed=machine.stick_speed,
        threads=1,
        **options,
    )


def test_a_map(browser: Browser, drawn_map: OperatingMap, tmp_path: Path) -> None:
    """The points by their names, on the map and under the pointer."""
    others = [name for name in NAMES if name not in IN_A_FILE]
    more = (replace(drawn_map.points[-1], name=name) for name in others)
    result = replace(drawn_map, points=(*drawn_map.points, *more))
    opened = opened_page(browser, picture(result.chart(), ".html"), tmp_path / "map.html")
    opened.assert_quiet()
    assert_shown(opened, NAMES)
    marks = opened.page.locator("svg .mark-symbol path[aria-label*=point]")
    for number in range(2, 30, 3):
        box = marks.nth(number).bounding_box()
        assert box is not None
        opened.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        opened.page.wait_for_selector("#vg-tooltip-element.visible")
        assert opened.page.locator("#vg-tooltip-element :is(img, a, script, svg, iframe)").count() == 0
    opened.assert_quiet()
    assert_harmless(picture(result.chart(), ".svg"))


def test_the_policy_holds_back_what_it_is_there_for(
    browser: Browser, points: hersey.SteadyPoints, tmp_path: Path
) -> None:
    """Were a name ever to get through as markup: its script does not run, its picture is not asked for."""
    page = picture(points.chart(), ".html").decode()
    planted = '<script>alert(1)</script><img src="https://example.invalid/x.png" onerror="alert(2)">'
    with_markup = page.replace('<div id="chart"></div>', f'<div id="chart">{planted}</div><p>{planted}</p>')
    assert with_markup != page
    opened = opened_page(browser, with_markup, tmp_path / "planted.html")
    assert opened.dialogs == []
    assert set(opened.requests[1:]) == set(opened.held_back)
    assert len(opened.violations) >= 4
    opened.page.evaluate("setTimeout('alert(3)', 0)")
    opened.page.wait_for_function("window.violations.some((text) => text.includes('eval'))")
    assert opened.dialogs == []
