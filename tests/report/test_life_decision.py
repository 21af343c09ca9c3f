"""The first screen of a life test as data: states, expected ages, what to do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hersey.life.growth.limit_ages import AgeAtLimit, Interval, rounded
from hersey.life.time_to_failure.estimate import TimeToFailure, time_to_failure
from hersey.life.time_to_failure.first import SpecimenEnd
from hersey.report.life_decision import _row, decision
from tests.life.shipped import fewer
from tests.life.test_time_to_failure import AGE, indicator, of


@pytest.fixture(autouse=True)
def fewer_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    fewer(monkeypatch)


def row(age: tuple[float, float, float], passed: float) -> dict[str, Any]:
    """Of a specimen last seen at 170."""
    first = {"film": 0.83, "torque": 0.17}
    return _row(
        SpecimenEnd("U", AgeAtLimit("U", Interval(*age), 0.0, 170.0, passed, followed=170.0), first, ())
    )


@pytest.mark.parametrize(
    ("age", "passed", "signal", "state", "expected"),
    [
        ((150.0, 140.0, 160.0), 0.97, "act", "Failed, 97 %", "150"),
        ((150.0, 140.0, 160.0), 1.0, "act", "Failed, over 99 %", "150"),
        ((120.0, 0.0, 196.0), 0.83, "watch", "Unclear, 83 %", "before 196"),
        ((240.0, 225.0, 260.0), 0.05, "good", "Running", "240"),
        ((900.0, 300.0, 2000.0), 0.0, "good", "Running", "after 300"),
        ((np.inf, 800.0, np.inf), 0.0, "good", "Running", "after 800"),
    ],
)
def test_a_row(age: Any, passed: float, signal: str, state: str, expected: str) -> None:
    shown = row(age, passed)
    assert (shown["signal"], shown["state"], shown["expected"]) == (signal, state, expected)
    assert shown["modes"] == ("film" if np.isfinite(age[0]) else "none shows growth")


def found(value: np.ndarray, **more: Any) -> TimeToFailure:
    return time_to_failure(of(indicator("torque", value, 2.0)), **more)


def test_where_nothing_ages_the_page_says_how_long_nothing_fails() -> None:
    still = found(np.ones(AGE.size))
    shown = decision(still)
    assert shown["signal"] == "good"
    assert shown["lead"][0].startswith("No specimen shows growth. At 90 % confidence none fails before ")
    assert shown["more"] == []  # no half of new specimens fails
    assert shown["next"][0].startswith("Follow the specimens to ")
    assert {each["modes"] for each in shown["rows"]} == {"none shows growth"}
    assert all(each["expected"].startswith("after ") for each in shown["rows"])
    assert "never" not in str(shown["lead"])


def test_the_most_urgent_come_first_and_the_numbers_are_those_of_the_result() -> None:
    rate = np.array([0.0008, 0.0030, 0.0010, 0.0009, 0.0040, 0.0012])
    grown = found((1.0 + rate[:, None] * np.linspace(0.0, 600.0, 7)).ravel())
    shown = decision(grown)
    assert [each["specimen"] for each in shown["rows"][:3]] == ["F5", "F2", "F6"]
    assert [each["signal"] for each in shown["rows"]] == ["act"] * 2 + ["good"] * 4
    assert grown.b50 is not None
    assert shown["more"] == [grown.of_new()]
    assert f"by {rounded(grown.b50.age.value)} pages" in grown.of_new()
    assert shown["lead"][1].endswith(
        f"at least {rounded(min(e.age.age.low for e in grown.units if e.state == 'running'))} pages."
    )
    assert shown["end"] >= max(each["age"]["high"] for each in shown["rows"] if each["age"]["high"] <= 1800.0)
    assert shown["next"][:2] == ["Inspect F5 for torque.", "Inspect F2 for torque."]
