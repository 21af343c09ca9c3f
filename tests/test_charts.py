"""Charts: valid specifications with units on their axes, and files of each kind."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hersey.charts import charts, specification_of, write_figures
from hersey.document import Analysis


def test_every_result_has_its_chart(document: Analysis) -> None:
    assert list(charts(document)) == [
        "torque",
        "damping",
        "surface",
        "residuals",
        "regime",
        "film",
        "simulation_speed",
        "simulation_force",
        "timeline_speed",
        "timeline_torque",
        "timeline_temperature",
    ]


def titles(specification: object) -> set[str]:
    """Titles of the axes."""
    found: set[str] = set()
    if isinstance(specification, dict):
        for axis in ("x", "y"):
            encoded = specification.get("encoding", {}).get(axis, {})
            if isinstance(encoded, dict) and encoded.get("title"):
                found.add(str(encoded["title"]))
        for value in specification.values():
            found |= titles(value)
    elif isinstance(specification, list):
        for value in specification:
            found |= titles(value)
    return found


def test_axes_carry_units(document: Analysis) -> None:
    for name, chart in charts(document).items():
        for title in titles(specification_of(chart)):
            assert "(" in title or title == "exponent of damping in speed", (name, title)


def test_points_have_tooltips_and_log_axes(document: Analysis) -> None:
    for name in ("torque", "damping"):
        text = json.dumps(specification_of(charts(document)[name]))
        assert '"tooltip"' in text
        assert text.count('"type": "log"') >= 2
        assert '"bind": "scales"' in text


@pytest.mark.slow
def test_figures_are_written(document: Analysis, tmp_path: Path) -> None:
    written = write_figures(document, tmp_path / "figures")
    assert {p.suffix for p in written} == {".svg", ".png", ".pdf"}
    assert (tmp_path / "figures" / "torque.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "figures" / "torque.pdf").read_bytes().startswith(b"%PDF")
    assert "Drive speed (rpm)" in (tmp_path / "figures" / "torque.svg").read_text()
