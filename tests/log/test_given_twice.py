"""A measurement that a log holds twice is refused, and the clock of a fit is that of an inspection."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.inspection import inspect
from hersey.verdict.warnings import warnings_of

NOISE = np.random.default_rng(5).normal(0.0, 1e-3, 600)


def log(torque: np.ndarray, temperature: float = 120.0, step: float = 0.1) -> pl.DataFrame:
    """A run of 600 rows at one speed."""
    return pl.DataFrame(
        {
            "Time [s]": step * np.arange(600),
            "Torque [N*m]": torque,
            "Speed [rpm]": np.full(600, 40.0),
            "Temp [degC]": np.full(600, temperature),
        }
    )


@pytest.mark.parametrize("step", [0.11, 0.2])
def test_the_same_rows_are_refused_whatever_their_times(step: float) -> None:
    with pytest.raises(hersey.HerseyError, match="the 600 rows of frame 2 and of frame 1 are the same"):
        hersey.read([log(0.2 + NOISE), log(0.2 + NOISE, step=step)])


def test_one_other_reading_makes_two_measurements() -> None:
    other = 0.2 + NOISE
    other[599] += 1e-6
    assert len(hersey.read([log(0.2 + NOISE), log(other)]).runs) == 2
    assert len(hersey.read([log(0.2 + NOISE), log(0.2 + NOISE, temperature=121.0)]).runs) == 2


def test_a_torque_that_never_changes_may_come_twice() -> None:
    assert len(hersey.read([log(np.full(600, 0.2)), log(np.full(600, 0.2), step=0.2)]).runs) == 2


def test_stamps_in_whole_seconds_miss_no_rows() -> None:
    whole = log(0.2 + NOISE).with_columns(pl.col("Time [s]").floor())
    run = hersey.read(whole).runs[0]
    assert (run.clock.gaps, run.clock.repeated, run.clock.resolution) == (0, 540, 1.0)


def test_rows_are_missing_where_an_inspection_says_so(tmp_path: Path) -> None:
    kept = log(0.2 + NOISE).filter(~pl.col("Time [s]").is_between(9.95, 14.95))  # rows 100 to 149
    kept.write_csv(tmp_path / "log.csv")
    read = hersey.read(tmp_path / "log.csv")
    (clock,) = inspect(tmp_path / "log.csv").files[0].clocks
    assert (read.runs[0].clock.gaps, clock.gaps) == (1, 1)
    assert read.runs[0].clock.lost == pytest.approx(5.0)


def test_the_share_of_the_time_that_is_missing_is_that_of_all_gaps() -> None:
    """Rows 100 to 149 and 300 to 319 of 600 at 0.1 s: 7 s of 59.9 s, and not the longest of them, 5 s."""
    rows = np.arange(600)
    kept = (rows < 100) | ((rows >= 150) & (rows < 300)) | (rows >= 320)
    points = hersey.read(log(0.2 + NOISE).filter(pl.Series(kept))).steady()
    (gaps,) = [each for each in warnings_of(points, None) if each.kind == "gaps"]
    assert gaps.number("places") == 2
    assert gaps.number("share") == pytest.approx(7.0 / 59.9)
