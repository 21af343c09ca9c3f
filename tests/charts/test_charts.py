"""Charts: valid specifications with units on their axes, and files of each kind."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hersey.charts.analysis import charts, write_figures
from hersey.charts.render import specification_of
from hersey.charts.style import ramp
from hersey.document.analysis import Analysis


def test_every_result_has_its_chart(document: Analysis) -> None:
    names = list(charts(document))
    always = ["torque", "damping", "surface", "residuals", "regime", "film"]
    log = ["timeline_speed", "timeline_torque", "timeline_temperature"]
    assert names[:6] == always
    assert [name for name in names if name.startswith("timeline")] == log
    for name, part in (
        ("stick_speed", document.stick_speed_sweep),
        ("simulation_speed", document.simulation),
        ("simulation_force", document.simulation),
        ("compare", document.compare),
        ("torque_budget", document.torque_budget),
    ):
        assert (name in names) == (part is not None), name
    decided = document.decision.points if document.decision else []
    plans = [point.plan for point in decided if point.plan]
    drawn = [f"plan_{i}" for i, plan in enumerate(plans) if plan.rows]
    assert [name for name in names if name.startswith("plan_")] == drawn


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
            assert "(" in title or not title, (name, title)


def test_points_have_tooltips_and_log_axes(document: Analysis) -> None:
    for name in ("torque", "damping"):
        text = json.dumps(specification_of(charts(document)[name]))
        assert '"tooltip"' in text
        assert text.count('"type": "log"') >= 2
    assert '"bind": "scales"' in json.dumps(specification_of(charts(document)["residuals"]))


def test_the_same_document_has_the_same_charts_wherever_they_lie_in_memory(document: Analysis) -> None:
    first, second = charts(document), charts(document)
    zoomed = json.dumps(specification_of(first["residuals"]))
    assert '"views": ["view_1"]' in zoomed
    assert zoomed.count('"name": "view_1"') == 1
    for name, chart in first.items():
        assert specification_of(chart) == specification_of(second[name]), name


@pytest.mark.slow
def test_figures_are_written(document: Analysis, tmp_path: Path) -> None:
    written = write_figures(document, tmp_path / "figures")
    assert {p.suffix for p in written} == {".svg", ".png", ".pdf"}
    assert (tmp_path / "figures" / "torque.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "figures" / "torque.pdf").read_bytes().startswith(b"%PDF")
    assert "Speed (rpm)" in (tmp_path / "figures" / "torque.svg").read_text()


_CHARTS: dict[int, tuple[Analysis, dict[str, Any]]] = {}


def _made(key: int, document: Analysis) -> dict[str, Any]:
    """The charts of a document, made once."""
    if key not in _CHARTS:
        _CHARTS[key] = document, dict(charts(document))
    return _CHARTS[key][1]


def panel(document: Analysis, name: str) -> list[dict[str, Any]]:
    """The layers of a chart that hold data, in their order."""
    found: list[dict[str, Any]] = []

    def walk(part: dict[str, Any]) -> None:
        if "values" in part.get("data", {}):
            found.append(part)
        for inner in part.get("layer", []):
            walk(inner)

    walk(_made(id(document), document)[name].to_dict(validate=False))
    return found


def rows(layer: dict[str, Any]) -> list[dict[str, Any]]:
    values: list[dict[str, Any]] = layer["data"]["values"]
    return values


RPM = 2 * np.pi / 60


@pytest.mark.parametrize("name", ["torque", "damping"])
def test_dwells_are_drawn_with_two_standard_errors(document: Analysis, name: str) -> None:
    curves, bars, dots = panel(document, name)[-3:]
    assert len(rows(dots)) == len(document.points)
    unit = 1.0 if max(abs(p.torque) for p in document.points) >= 1.0 else 1e3
    for row, point in zip(rows(dots), document.points, strict=True):
        value = abs(getattr(point, name)) * unit
        error = point.torque_error / abs(point.torque)
        assert row["y"] == pytest.approx(value, rel=1e-12)
        assert row["high"] / row["y"] - 1 == pytest.approx(2 * error, rel=1e-9)
        assert 1 - row["low"] / row["y"] == pytest.approx(2 * error, rel=1e-9)
        assert row["speed"] == pytest.approx(abs(point.speed) / RPM, rel=1e-12)
        assert row["torque_shown"] == pytest.approx(abs(point.torque) * unit)
        assert row["damping_shown"] == pytest.approx(point.damping * unit)
        assert row["residual"] == pytest.approx(100 * (np.exp(point.residual) - 1))
        assert point.temperature is not None
        assert row["temperature"] == pytest.approx(point.temperature - 273.15)
        assert row["from_to"] == f"{point.start:.1f} to {point.end:.1f} s"
    assert rows(bars) == rows(dots)
    expected = [
        (v / RPM, unit * b * (v if name == "torque" else 1.0))
        for c in document.fit.curves
        for v, b in zip(c.speed, c.damping, strict=True)
    ]
    np.testing.assert_allclose([(r["speed"], r["y"]) for r in rows(curves)], expected, rtol=1e-12)


def test_the_dashed_line_has_the_slope_minus_one(document: Analysis) -> None:
    first, last = rows(panel(document, "damping")[0])
    unit = 1.0 if max(abs(p.torque) for p in document.points) >= 1.0 else 1e3
    assert first["y"] == pytest.approx(unit * max(p.damping for p in document.points))
    assert first["speed"] == pytest.approx(document.fit.speed_range[0] / RPM)
    assert np.log(last["y"] / first["y"]) / np.log(last["speed"] / first["speed"]) == pytest.approx(-1.0)


def test_the_surface_and_its_dwells_in_numbers(document: Analysis) -> None:
    cells, bend, dots = panel(document, "surface")
    unit = 1.0 if max(abs(p.torque) for p in document.points) >= 1.0 else 1e3
    for row, cell in zip(rows(cells), document.fit.cells, strict=True):
        assert row["damping"] == pytest.approx(cell.damping * unit)
        assert row["from"] == pytest.approx(cell.speed_low / RPM)
        assert row["to"] == pytest.approx(cell.speed_high / RPM, rel=5e-3)
        assert cell.temperature_low is not None
        assert row["low"] == pytest.approx(cell.temperature_low - 273.15)
    curve = document.fit.transition_curve
    np.testing.assert_allclose([r["from"] for r in rows(bend)], [t.speed / RPM for t in curve])
    np.testing.assert_allclose([r["low"] for r in rows(bend)], [t.temperature - 273.15 for t in curve])
    assert [r["from"] for r in rows(dots)] == pytest.approx([abs(p.speed) / RPM for p in document.points])


def test_residuals_are_shares_of_the_fit(document: Analysis) -> None:
    _, dots = panel(document, "residuals")
    assert [r["residual"] for r in rows(dots)] == pytest.approx(
        [100 * (np.exp(p.residual) - 1) for p in document.points]
    )
    assert [r["approach"] for r in rows(dots)] == [p.approach for p in document.points]


def test_exponents_stand_against_what_each_regime_predicts(document: Analysis) -> None:
    layers = panel(document, "regime")
    bars = next(layer for layer in layers if "where" in rows(layer)[0])
    expected = [(b.exponent.value, b.exponent.low, b.exponent.high) for b in document.regime.exponents]
    c = document.fit.coefficients["c"]
    expected.append((c.value, c.low, c.high))
    assert [(r["value"], r["low"], r["high"]) for r in rows(bars)] == expected
    named = {
        r["name"]: (r["low"], r["high"])
        for layer in layers
        for r in rows(layer)
        if "name" in r and "low" in r
    }
    axis = min([-1.3, *(low for _, low, _ in expected)]) - 0.05  # where open ones end
    for hypothesis in document.regime.hypotheses:
        low = axis if np.isinf(hypothesis.low) else hypothesis.low
        assert named[hypothesis.name] == (low, hypothesis.high)


def test_the_simulation_is_drawn_as_it_ran(document: Analysis) -> None:
    s = document.simulation
    assert s is not None
    unit = 1e3 if s.speed_unit == "m/s" else 1.0
    line, *marks = panel(document, "simulation_speed")
    assert [r["time"] for r in rows(line)] == s.time
    np.testing.assert_allclose([r["value"] for r in rows(line)], unit * np.array(s.belt_speed))
    shown = {r["name"]: r["value"] for layer in marks for r in rows(layer)}
    assert shown["transition speed"] == pytest.approx(unit * s.transition_speed)
    if s.drive_speed != s.transition_speed:
        assert shown["drive speed"] == pytest.approx(unit * s.drive_speed)
    (force,) = panel(document, "simulation_force")
    assert [r["value"] for r in rows(force)] == s.spring_force


@pytest.mark.parametrize("name", ["speed", "torque", "temperature"])
def test_timelines_shade_the_dwells(document: Analysis, name: str) -> None:
    shade, line = panel(document, f"timeline_{name}")
    starts = document.timeline.starts
    assert [(r["from"], r["to"]) for r in rows(shade)] == [
        (starts[p.run] + p.start, starts[p.run] + p.end) for p in document.points
    ]
    series = getattr(document.timeline, name)
    unit = 1.0 if max(abs(p.torque) for p in document.points) >= 1.0 else 1e3
    shown = {
        "speed": np.array(series.value) / RPM,
        "torque": unit * np.array(series.value),
        "temperature": np.array(series.value) - 273.15,
    }[name]
    np.testing.assert_allclose([r["value"] for r in rows(line)], shown, rtol=1e-4, atol=1e-9)
    assert [r["time"] for r in rows(line)] == series.time


def test_small_torques_are_shown_in_millinewton_metres(document: Analysis) -> None:
    small = document.model_copy(
        update={
            "points": [p.model_copy(update={"torque": 1e-3 * p.torque}) for p in document.points],
            "units": document.units | {"torque": "mN·m"},
        }
    )
    dots = panel(small, "torque")[-1]
    assert rows(dots)[0]["y"] == pytest.approx(1e3 * abs(small.points[0].torque))
    assert dots["encoding"]["y"]["title"] == "Torque (mN·m)"


def test_the_ramp_goes_from_cold_to_hot() -> None:
    assert ramp(1) == ["#2b4f9e"]
    assert ramp(4) == ["#2b4f9e", "#7a3f9d", "#b32c66", "#b8500c"]
    assert ramp(7)[1] == "#52" + "479d"


def test_specifications_have_six_digits(document: Analysis) -> None:
    first = panel(document, "torque")[-1]
    rounded = json.dumps(specification_of(_made(id(document), document)["torque"]))
    value = rows(first)[0]["y"]
    assert repr(value) not in rounded
    assert repr(float(f"{value:.6g}")) in rounded
