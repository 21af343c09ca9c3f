"""Reports of earlier starts: found again with their decision, and nothing that is no report."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from hersey.app.kept import kept_reports, small_map
from hersey.document.analysis import Analysis
from hersey.report.page import render
from tests.app.asking import Asked


@pytest.fixture(scope="module")
def folder(document: Analysis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of reports, with files that are none, or none of hersey's."""
    path = tmp_path_factory.mktemp("hersey-reports")
    (path / "drive.html").write_text(render(document), encoding="utf-8")
    (path / "empty.html").touch()
    (path / "page.html").write_text("<!doctype html><script>alert(1)</script>", encoding="utf-8")
    (path / "torn.html").write_text('<script type="application/json" id="document">{"title": 1', "utf-8")
    block = '<script type="application/json" id="document">{}</script>'
    (path / "list.html").write_text(block.format("[1]"), encoding="utf-8")
    (path / "deep.html").write_text(block.format("[" * 100_000), encoding="utf-8")
    (path / "bytes.html").write_bytes(b"\xff\xfe")
    (path / "folder.html").mkdir()
    (path / "link.html").symlink_to(path / "drive.html")
    return path


def test_a_report_is_found_with_its_decision_and_map(folder: Path, document: Analysis) -> None:
    (found,) = kept_reports(folder)
    assert document.decision is not None
    assert (found.name, found.saved) == (document.title, f"{folder.name}/drive.html")
    assert (found.signal, found.words) == (document.decision.signal, document.decision.instruction)
    assert found.map is not None
    assert document.map is not None
    assert found.map["speed"] == pytest.approx([document.map.speed[0], document.map.speed[-1]], rel=1e-3)
    assert [point[1] for point in found.map["points"]] == [point.speed for point in document.decision.points]
    assert len(json.dumps(found.line())) < 4000


def test_a_folder_that_is_not_there_holds_none(tmp_path: Path) -> None:
    assert kept_reports(tmp_path / "none") == []


def test_the_newest_twenty_are_listed(tmp_path: Path) -> None:
    block = '<script type="application/json" id="document">{"title": "%d"}</script>'
    for number in range(25):
        path = tmp_path / f"{number}.html"
        path.write_text(block % number)
        os.utime(path, (1e9 + number, 1e9 + number))
    assert [each.name for each in kept_reports(tmp_path)] == [str(number) for number in range(24, 4, -1)]


def test_the_page_is_told_of_them_and_opens_them(folder: Path, tmp_path: Path) -> None:
    asked = Asked(tmp_path)
    asked.session.reports = folder
    (line,) = asked.ask("GET", "/api/state").json["earlier"]
    assert line["saved"].endswith("drive.html")
    opened = asked.ask("GET", f"/report/{line['report']}", origin=None)
    assert opened.status == 200
    assert asked.session.shown[line["report"]] == folder / "drive.html"
    assert opened.headers["content-security-policy"].startswith("sandbox")
    again = asked.ask("GET", "/api/state").json["earlier"]
    assert again == [line]  # looked for once: an address stays


def test_a_small_map_keeps_both_ends_and_holes() -> None:
    part: dict[str, Any] = {
        "temperature": [300.0 + i for i in range(61)], "speed": [0.001, 0.01, 0.5],
        "lower": [0.01] * 61, "transition": [0.02] * 61, "upper": [None] * 60 + [0.123456],
    }  # fmt: skip
    point = {"temperature": 350.0, "speed": 0.2, "signal": "good"}
    found = small_map(part, [point])
    assert (found["temperature"][0], found["temperature"][-1]) == (300.0, 360.0)
    assert len(found["temperature"]) <= 25
    assert (found["upper"][0], found["upper"][-1]) == (None, 0.1235)
    assert found["points"] == [[350.0, 0.2, "good"]]
    assert small_map({**part, "temperature": None, "lower": [1], "transition": [1], "upper": [1]}, [])[
        "temperature"
    ] == [0.0]
