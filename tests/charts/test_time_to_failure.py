"""The chart of failure modes: what is drawn, and what is counted in words."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np

from hersey.charts.render import picture
from hersey.charts.time_to_failure import time_to_failure_chart
from hersey.life.growth.limit_ages import ages_at_limit
from hersey.life.indicator import OwnAges
from hersey.life.maintenance import Followed
from hersey.life.time_to_failure.first import SpecimenEnd


def mode(name: str, *medians: float, spread: float = 0.1) -> Any:
    """A failure mode of specimens that reach its limit near these ages; they were last seen at 100."""
    shares = np.linspace(1.0 - spread, 1.0 + spread, 100)[:, None]
    last = {f"U{i + 1}": 100.0 for i in range(len(medians))}
    own = OwnAges(shares * medians, np.full((100, 8), 400.0))
    return SimpleNamespace(
        name=name, sign=False, ages=ages_at_limit(name, "pages", 1.0, Followed.from_new(last), own, ())
    )


def found(*modes: Any) -> Any:
    units = tuple(
        SpecimenEnd(each.unit, each, {mode.name: 1.0 - 0.1 * i for i, mode in enumerate(modes)}, ())
        for each in modes[0].ages.units
    )
    return SimpleNamespace(modes=modes, units=units, b50=None, curve=None, age_unit="pages")


def chart(*modes: Any) -> dict[str, Any]:
    drawn: dict[str, Any] = time_to_failure_chart(found(*modes)).to_dict()
    return drawn


def rows(drawn: dict[str, Any], field: str) -> list[dict[str, Any]]:
    """The rows of the layers that have a field, once."""
    seen: list[dict[str, Any]] = []
    for layer in drawn["vconcat"][0]["layer"]:
        seen += [row for row in layer["data"]["values"] if field in row and row not in seen]
    return seen


def test_modes_that_only_come_later_are_counted_in_words() -> None:
    """Of U1 torque is on the axis; of U2 only the slip. What no run shows begins at 1.75 times 100."""
    drawn = chart(mode("torque", 150.0, 5000.0), mode("slip", 9000.0, 200.0), mode("grip", 9000.0, 9000.0))
    assert [(row["unit"], row["way"]) for row in rows(drawn, "low")] == [("U1", "torque"), ("U2", "slip")]
    later = [(row["unit"], row["words"]) for row in rows(drawn, "words")]
    assert later == [(name, "2 more modes later than 175 \N{RIGHTWARDS ARROW}") for name in ("U1", "U2")]
    assert drawn["title"]["subtitle"][1] == "later for all specimens: grip"


def test_a_mode_of_which_more_is_known_is_drawn_though_its_median_is_beyond_the_axis() -> None:
    wide = mode("slip", 400.0, spread=0.8)
    assert wide.ages.units[0].age.low < 175.0
    drawn = chart(mode("torque", 120.0), wide)
    assert [row["way"] for row in rows(drawn, "low")] == ["torque", "slip"]
    assert rows(drawn, "words") == []


def test_where_nothing_grows_words_are_all_there_is() -> None:
    drawn = chart(mode("torque", 9000.0), mode("slip", math.inf))
    assert [row["words"] for row in rows(drawn, "words")] == ["all modes later than 175 \N{RIGHTWARDS ARROW}"]
    assert picture(time_to_failure_chart(found(mode("torque", 9000.0))), ".png")
