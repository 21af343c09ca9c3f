"""What people try first: a log, its file or a frame where steady points are needed.

The error has the line to write.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import polars as pl
import pytest

import hersey
from hersey.damping.dwells.reduced import require_points
from hersey.errors import ParameterError
from hersey.log.means import read_means
from tests.conftest import ROOT

H: Any = hersey  # calls that no type checker allows
FILE = "bench.csv"
STANDING = '.steady(tare="standing")'
READ = f'hersey.read("bench.csv"){STANDING}'
ZEROED = ', or tare="none" if the torque is zeroed already'


@pytest.fixture(scope="module")
def log() -> hersey.TorqueLog:
    return hersey.read(ROOT / "examples" / "bench.csv")


@pytest.fixture(scope="module")
def points(log: hersey.TorqueLog) -> hersey.SteadyPoints:
    return log.steady(tare="standing")


def refused(call: Callable[[], object]) -> str:
    with pytest.raises(ParameterError) as caught:
        call()
    return str(caught.value)


def test_a_fit_of_a_log_says_how_to_reduce_it(log: hersey.TorqueLog) -> None:
    assert refused(lambda: H.fit(log)) == (
        f"hersey.fit needs steady points, not a log. Write hersey.fit(log{STANDING}){ZEROED}"
    )


@pytest.mark.parametrize("name", [FILE, Path(FILE)])
def test_a_fit_of_a_file_says_how_to_read_it(name: str | Path) -> None:
    assert refused(lambda: H.fit(name)) == (
        f"hersey.fit needs steady points, not a file name. Write hersey.fit({READ}){ZEROED}"
    )


def test_the_line_works_as_it_is_written(
    points: hersey.SteadyPoints, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT / "examples")
    line = refused(lambda: H.fit(FILE)).split("Write ")[1].split(", or ")[0]
    assert eval(line, {"hersey": hersey}).c == hersey.fit(points).c


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda: H.study(FILE), f"hersey.study({READ})"),
        (lambda: H.study(FILE, "machine.toml"), f"hersey.study({READ}, machine)"),
        (lambda: H.report(FILE), f'hersey.report(hersey.study({READ}), "report.html")'),
        (lambda: H.report(FILE, "page.html"), f'hersey.report(hersey.study({READ}), "report.html")'),
        (lambda: H.compare_models(FILE), f"hersey.compare_models({READ})"),
        (lambda: H.compare(FILE, FILE), f"hersey.compare({READ}, b)"),
        (lambda: H.no_load_torque(FILE), f"hersey.no_load_torque({READ})"),
        (lambda: H.regime(FILE, None), f"hersey.regime({READ}, surface)"),
        (
            lambda: H.measured_film(FILE, None, None, None),
            f"hersey.measured_film({READ}, surface, contact, lubricant)",
        ),
        (lambda: H.posterior(FILE, None), f"hersey.posterior({READ}, machine)"),
    ],
)
def test_every_function_of_points_says_it(call: Callable[[], object], line: str) -> None:
    assert refused(call).endswith(f", not a file name. Write {line}{ZEROED}")


def test_what_needs_more_than_points_says_the_whole_way(
    log: hersey.TorqueLog, points: hersey.SteadyPoints
) -> None:
    study = f"hersey.study(log{STANDING})"
    assert refused(lambda: H.report(log, "report.html")) == (
        f'hersey.report needs a study, not a log. Write hersey.report({study}, "report.html"){ZEROED}'
    )
    assert refused(lambda: H.report(points)) == (
        "hersey.report needs a study, not steady points. Write "
        'hersey.report(hersey.study(points), "report.html")'
    )
    wanted = (
        "It must be a DampingSurface. Write hersey.operating_map(surface, machine) with surface = hersey.fit"
    )
    assert refused(lambda: H.operating_map(log, None)).endswith(f"{wanted}(log{STANDING})")
    assert refused(lambda: H.operating_map(points, None)).endswith(f"{wanted}(points)")


def test_the_other_log_is_asked_for_as_points_too(log: hersey.TorqueLog, points: hersey.SteadyPoints) -> None:
    assert f"hersey.study(points, against=log{STANDING})" in refused(lambda: H.study(points, against=log))
    assert f"hersey.compare(a, log{STANDING})" in refused(lambda: H.compare(points, log))


def test_other_things_are_named() -> None:
    means = read_means({"speed [rpm]": [10, 20, 40], "torque [mN*m]": [21.0, 22.0, 24.0]}, isothermal=True)
    given: list[tuple[object, str]] = [
        (means, "not a table of means. Write hersey.fit(hersey.SteadyPoints.from_table(table))"),
        (pl.DataFrame(), f"not a frame. Write hersey.fit(hersey.read(frame){STANDING}){ZEROED}"),
        (3.0, f"not a float. Write hersey.fit(log{STANDING}){ZEROED}"),
        (
            'a "b".csv',
            f'not a file name. Write hersey.fit(hersey.read("a \\"b\\".csv"){STANDING}){ZEROED}',
        ),
    ]
    for thing, words in given:
        with pytest.raises(ParameterError) as caught:
            require_points(thing, "hersey.fit({points})")
        assert str(caught.value) == f"hersey.fit needs steady points, {words}"


def test_a_report_is_called_as_on_the_command_line(
    points: hersey.SteadyPoints, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    hersey.report(hersey.study(points))
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]
