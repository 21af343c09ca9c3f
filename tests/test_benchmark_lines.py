"""The lines of the table of ratios, what is asked of each and whether it is met; slopes of growth."""

from __future__ import annotations

import pytest
from benchmarks.growth_of_time import slope
from benchmarks.lines import HEAD, Line, in_turn, table


@pytest.mark.parametrize(
    ("line", "ratio", "asked", "met"),
    [
        (Line("W1", 2.0, "numba", 8.0, faster=4), "4 x as fast", "at least 4 x", "yes"),
        (Line("W1", 2.0, "numba", 7.9, faster=4), "3.95 x as fast", "at least 4 x", "no"),
        (Line("help", 0.25, "typer", 0.1, slower=2.5), "2.50 x its time", "at most 2.5 x", "yes"),
        (Line("help", 0.26, "typer", 0.1, slower=2.5), "2.60 x its time", "at most 2.5 x", "no"),
        (Line("fit", 0.7, limit=0.7), "", "at most 0.7 s", "yes"),
        (Line("W3", 0.2, "numba", 20.0, limit=0.15), "100 x as fast", "at most 0.15 s", "no"),
        (Line("film", 0.2, "scipy", 0.4), "2 x as fast", "", ""),
        (Line("fit", 0.9, "imports", 0.6, limit=0.7), "1.50 x its time", "at most 0.7 s", "no"),
    ],
)
def test_a_line_says_what_is_asked_and_whether_it_is_met(
    line: Line, ratio: str, asked: str, met: str
) -> None:
    cells = dict(zip(HEAD, line.cells(), strict=True))
    assert (cells["ratio"], cells["asked"], cells["met"]) == (ratio, asked, met)
    assert table([line])[-1].split(" | ")[0] == f"| {line.work}"


def test_works_are_run_in_turn_and_medians_taken() -> None:
    order: list[str] = []
    times = {"own": iter([3.0, 1.0, 2.0]), "peer": iter([5.0, 9.0, 6.0])}

    def run(name: str) -> float:
        order.append(name)
        return next(times[name])

    found = in_turn({"own": lambda: run("own"), "peer": lambda: run("peer")}, 3)
    assert found == {"own": 2.0, "peer": 6.0}
    assert order == ["own", "peer"] * 3


def test_a_slope_is_that_of_the_upper_half() -> None:
    assert slope([(10, 7.0), (100, 7.0), (1000, 2.0), (10_000, 20.0), (100_000, 200.0)]) == pytest.approx(1.0)
