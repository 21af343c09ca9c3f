"""Whether anything ages: of all failure modes together."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from hersey.life.time_to_failure.ageing import ageing_of


def of(*modes: tuple[str, bool, float]) -> list[Any]:
    """Failure modes by name, whether they grow, and the age before which none reaches its limit."""
    return [
        SimpleNamespace(mode=SimpleNamespace(name=name, grows=grows, none_before=age))
        for name, grows, age in modes
    ]


@pytest.mark.parametrize(
    ("grows", "shown", "unchanged"),
    [
        ((True, True), "all", ()),
        ((False, True), "some", ("torque",)),
        ((False, False), "none", ("torque", "stick-slip")),
    ],
)
def test_the_earliest_age_of_all_modes_counts(
    grows: tuple[bool, bool], shown: str, unchanged: tuple[str, ...]
) -> None:
    modes = of(("torque", grows[0], 500.0), ("stick-slip", grows[1], 300.0))
    found = ageing_of(modes, 1000.0, 2000.0)
    assert (found.shown, found.unchanged) == (shown, unchanged)
    assert (found.none_before, found.followed, found.goal) == (300.0, 1000.0, 2000.0)
    alone = shown == "none"
    assert found.doubled == (600.0 if alone else None)
    assert found.until == (pytest.approx(1000.0 * 2000.0 / 300.0) if alone else None)
    assert found.enough is False


def test_an_age_that_runs_do_not_bound_is_not_known() -> None:
    found = ageing_of(of(("torque", False, math.inf)), 1000.0, 2000.0)
    assert (found.none_before, found.doubled, found.until, found.enough) == (None, None, None, None)
