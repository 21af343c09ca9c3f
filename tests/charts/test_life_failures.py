"""The Weibull plot of a life test: forecasts are intervals, never failures at an exact age."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hersey.charts.life_failures import failures_chart
from hersey.life.growth.limit_ages import AgeAtLimit, Interval
from hersey.life.time_to_failure.estimate import ShareEnded
from hersey.life.time_to_failure.first import SpecimenEnd


def specimen(name: str, age: tuple[float, float, float], passed: float) -> SpecimenEnd:
    return SpecimenEnd(name, AgeAtLimit(name, Interval(*age), 0.0, 170.0, passed), {"film": 1.0}, ())


def drawn_of(chart: Any) -> list[dict[str, Any]]:
    """The specimens as drawn."""
    held = [each["data"].get("values", []) for each in chart.to_dict()["layer"] if "data" in each]
    found = {row["unit"]: row for values in held for row in values if "unit" in row}
    return sorted(found.values(), key=lambda row: row["place"])


def test_each_specimen_is_an_interval_at_its_rank() -> None:
    ends = [
        specimen("failed", (150.0, 140.0, 160.0), 0.99),
        specimen("unclear", (120.0, 0.0, 196.0), 0.83),
        specimen("running", (240.0, 160.0, 300.0), 0.04),
        specimen("far", (np.inf, 400.0, np.inf), 0.0),
    ]
    age = np.linspace(0.0, 510.0, 121)
    share = np.clip((age - 50.0) / 400.0, 0.0, 1.0)
    drawn = drawn_of(
        failures_chart(ends, ShareEnded(age, share, 0.8 * share, np.minimum(1.2 * share, 1.0)), "h")
    )
    assert [row["unit"] for row in drawn] == ["unclear", "failed", "running", "far"]
    assert [row["state"] for row in drawn] == ["unclear", "failed", "running, forecast", "running, forecast"]
    assert all(row["low"] < row["high"] for row in drawn)
    assert [row["unclear"] for row in drawn] == [True, False, False, False]
    assert (drawn[1]["low"], drawn[1]["high"]) == (140.0, 160.0)
    assert drawn[2]["low"] == 170.0  # it has outlived that
    ranks = [1.0 - np.exp(-np.exp(row["place"])) for row in drawn]
    assert ranks == pytest.approx([0.159, 0.386, 0.614, 0.841], abs=1e-3)  # Johnson (1964), of four
