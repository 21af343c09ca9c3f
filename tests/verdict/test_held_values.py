"""A sensor at the end of its range, and one that is stuck, are named before a fit is trusted."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.study.findings import Findings
from hersey.study.first_screen.flags import flags
from hersey.verdict.held_values import held_values
from hersey.verdict.regime import regime

ROWS = 1200
RNG = np.random.default_rng(8)
SPEED = np.repeat([20.0, 60.0, 180.0], ROWS // 3)
TORQUE = 0.02 * SPEED**0.3 * (1.0 + 0.02 * RNG.standard_normal(ROWS))
HEAT = 90.0 + 0.2 * RNG.standard_normal(ROWS)


def log(folder: Path, torque: np.ndarray, heat: np.ndarray) -> hersey.TorqueLog:
    rows = zip(torque.tolist(), SPEED.tolist(), heat.tolist(), strict=True)
    body = "".join(f"{0.1 * i:.1f},{q:.5f},{w:g},{t:.3f}\n" for i, (q, w, t) in enumerate(rows))
    (folder / "log.csv").write_text("Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n" + body)
    return hersey.read(folder / "log.csv")


def test_a_live_log_has_none(tmp_path: Path) -> None:
    assert held_values(log(tmp_path, TORQUE, HEAT).steady()) == []


def test_a_torque_at_the_end_of_its_range(tmp_path: Path) -> None:
    end = 0.095  # the fastest dwell lies about it
    clipped = np.minimum(TORQUE, end)
    points = log(tmp_path, clipped, HEAT).steady()
    [said] = held_values(points)
    plateaus = np.diff(np.flatnonzero(np.diff(np.r_[0, clipped == end, 0])))[::2]
    rows = plateaus[plateaus >= 3].sum()
    start, last = points.table.row(2, named=True)["start"], points.table.row(2, named=True)["end"]
    which = f"180 rpm at {start:.6g} to {last:.6g} s"
    assert said.severity == "act"
    assert said.values == {
        "channel": "torque",
        "fault": "clipped above",
        "value": end,
        "rows": rows,
        "dwells": 1,
        "first": which,
        "others": 0,
    }
    assert said.sentence == (
        f"log.csv: torque is clipped above at 0.095 N m in {rows} rows, where the range of sensor or "
        f"logger ends. 1 dwell reaches this value and is wrong: {which}. Record it again with a wider "
        "range, or delete its rows."
    )


def bench(folder: Path, root: Path, end: float) -> tuple[Path, pl.DataFrame]:
    """The shipped log by a torque sensor whose range ends there."""
    table = pl.read_csv(root / "examples" / "bench.csv", comment_prefix="#")
    clipped = table.with_columns(pl.col("Drive torque [N*m]").clip(upper_bound=end))
    clipped.write_csv(folder / "clipped.csv")
    return folder / "clipped.csv", clipped


@pytest.mark.parametrize("end", [0.225, 0.23, 0.24, 0.25])
def test_a_range_that_ends_within_the_noise_of_the_highest_dwells(
    end: float, tmp_path: Path, root: Path
) -> None:
    """The dwells are those of which the sensor with the wider range reads more in 1 % of the rows."""
    file = bench(tmp_path, root, end)[0]
    points, true = hersey.read(file).steady(), hersey.read(root / "examples" / "bench.csv").runs[0]
    beyond = [
        np.mean(true.torque[(true.time >= start) & (true.time <= last)] >= end) >= 0.01
        for start, last in points.table.select("start", "end").iter_rows()
    ]
    [said] = held_values(points)
    assert (said.kind, said.severity, said.values["value"]) == ("clipped above", "act", end)
    assert said.values["dwells"] == sum(beyond) > 0


def test_the_first_screen_shows_a_clipped_torque_first(tmp_path: Path, root: Path) -> None:
    points = hersey.read(bench(tmp_path, root, 0.225)[0]).steady()
    surface = hersey.fit(points)
    first = flags(Findings(points=points, surface=surface, regime=regime(points, surface)))[0]
    assert (first.kind, first.severity, first.title) == ("clipped above", "act", "Torque is clipped above")
    assert "Record them again with a wider range" in first.text


def test_dwells_whose_rows_are_deleted_are_wrong_no_more(tmp_path: Path, root: Path) -> None:
    file, table = bench(tmp_path, root, 0.25)
    [said] = held_values(hersey.read(file).steady())
    for start, last in re.findall(r"at (\S+) to (\S+) s", str(said.values["first"])):
        table = table.filter(~pl.col("Time [s]").is_between(float(start), float(last)))
    table.write_csv(file)
    left = held_values(hersey.read(file).steady())
    assert [each.severity for each in left] in ([], ["watch"])


def test_a_temperature_that_is_stuck(tmp_path: Path) -> None:
    frozen = HEAT.copy()
    frozen[800:] = frozen[800]
    [said] = held_values(log(tmp_path, TORQUE, frozen).steady())
    assert (said.kind, said.where, said.number("rows")) == ("stuck", "log.csv", 400)
    assert said.sentence == (
        f"log.csv: temperature is stuck at {frozen[800]:.4g} degC for 400 rows, "
        "so its true value there is unknown."
    )
