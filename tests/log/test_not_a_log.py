"""What is neither a file nor a frame is refused, with how to make one of it."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import hersey
from tests.conftest import ROOT


@pytest.mark.parametrize("thing", [3, [3]])
def test_a_number_is_no_log(thing: Any) -> None:
    with pytest.raises(hersey.HerseyError, match="the number 3 is not a log"):
        hersey.read(thing)


@pytest.mark.parametrize("thing", [np.zeros((9, 4)), [np.zeros(9)], {"Time [s]": [0.0, 1.0]}])
def test_numbers_without_names_and_units_are_no_log(thing: Any) -> None:
    with pytest.raises(hersey.HerseyError, match=r"is not a log\. Make a frame .*polars\.DataFrame"):
        hersey.read(thing)


BENCH = str(ROOT / "examples" / "bench.csv")


@pytest.mark.parametrize("thing", [BENCH.encode(), Path(BENCH).open()])  # noqa: SIM115 - as users leave it
def test_a_file_in_another_guise_is_met_with_its_name(thing: Any) -> None:
    with pytest.raises(
        hersey.HerseyError, match=rf"is not a log\. Write hersey\.read\('{re.escape(BENCH)}'\)"
    ):
        hersey.read(thing)


@pytest.mark.parametrize(
    ("thing", "write"),
    [
        (io.StringIO("Time [s]"), "hersey.read(polars.read_csv(file))"),
        (pd.Series([1.0, 2.0]), "give the frame that this column is from, e.g. hersey.read(frame)"),
    ],
)
def test_a_part_of_a_log_is_met_with_the_whole(thing: Any, write: str) -> None:
    with pytest.raises(hersey.HerseyError) as caught:
        hersey.read(thing)
    assert write in caught.value.remedy
    assert hersey.read(pd.Series([BENCH])).rows == hersey.read(BENCH).rows


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: hersey.read(BENCH, BENCH), f"Write hersey.read([{BENCH!r}, {BENCH!r}])"),
        (lambda: hersey.read(BENCH, units={"torque": 1}), "units has the number 1 for 'torque'"),
        (
            lambda: hersey.read(str(ROOT / "examples" / "no-*.csv")),
            f"hersey.read(sorted(glob.glob({str(ROOT / 'examples' / 'no-*.csv')!r})))",
        ),
        (lambda: hersey.SteadyPoints.from_table([[1, 2], [3, 4]]), "Give columns by name"),
        (lambda: hersey.SteadyPoints.from_table(hersey.read(BENCH)), "Its dwells are log.steady"),
        (
            lambda: hersey.SteadyPoints.from_table({"speed [rpm]": [1, 2], "torque [mN*m]": [1, 2, 3]}),
            "'speed [rpm]' has 2, 'torque [mN*m]' has 3",
        ),
    ],
)
def test_other_mistakes_are_met_with_the_line(call: Callable[[], Any], said: str) -> None:
    with pytest.raises(hersey.HerseyError) as caught:
        call()
    assert said in str(caught.value)
