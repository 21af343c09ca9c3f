"""A measurement that a log holds twice is refused, and the clock of a fit is that of an inspection."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import TimeOrderError
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


def pasted(table: pl.DataFrame, first: int, end: int, at: int) -> list[str]:
    """The lines of a table in which some rows come once more, at another row."""
    head, *rows = table.write_csv().splitlines()
    return [head, *rows[:at], *rows[first:end], *rows[at:]]


@pytest.mark.parametrize(
    ("first", "end", "at"), [(0, 300, 300), (200, 400, 400), (200, 400, 500), (0, 100, 600)]
)
def test_rows_that_are_pasted_twice_are_named_and_can_be_deleted(
    first: int, end: int, at: int, tmp_path: Path
) -> None:
    lines, file = pasted(log(0.2 + NOISE), first, end, at), tmp_path / "log.csv"
    file.write_text("\n".join(lines))
    again = f"from line {at + 2} to line {at + end - first + 1}"
    with pytest.raises(TimeOrderError) as refused:
        hersey.read(file)
    assert str(refused.value) == (
        f"log.csv: the rows {again} repeat those from line {first + 2} to line {end + 1}. "
        f"Delete the rows {again}"
    )
    file.write_text("\n".join(lines[: at + 1] + lines[at + 1 + end - first :]))
    assert hersey.read(file).rows == 600


def test_rows_of_other_readings_at_the_same_times_are_another_run() -> None:
    start, torque = log(0.2 + NOISE)[:300], 0.2 + NOISE
    assert len(hersey.read(pl.concat([start, log(torque[::-1])])).runs) == 2
    held = pl.concat([log(np.full(600, 0.2))[:300], log(np.full(600, 0.2))])
    assert len(hersey.read(held).runs) == 2


@pytest.mark.parametrize("turned", [False, True])
def test_rows_that_two_files_share_are_refused(turned: bool, tmp_path: Path) -> None:
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]
    whole = log(0.2 + NOISE)
    whole[:400].write_csv(files[0])
    whole[350:].write_csv(files[1])
    with pytest.raises(hersey.HerseyError) as refused:
        hersey.read(files[::-1] if turned else files)
    assert str(refused.value) == (
        "the first 50 rows of b.csv, 35 to 39.9 s, are also in a.csv. Delete them in b.csv"
    )
    whole[400:].write_csv(files[1])
    assert hersey.read(files).rows == 600


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
