"""Slow dwells of an encoder that reads 0 or one count in each row."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.damping.dwells.counted_speed import counting_error, with_counts_spread
from hersey.log.torque_log import Run

RPM = np.pi / 30
SPEEDS = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0)


def encoder(
    counts: int, interval: float, speeds: tuple[float, ...] = SPEEDS, held: float = 20.0
) -> pl.DataFrame:
    """A staircase as an encoder of so many counts per turn reads it: whole counts in each row."""
    rows = round(held / interval)
    turns = np.append(0.0, np.cumsum(np.repeat(speeds, rows) / 60.0 * interval))
    rpm = np.diff(np.floor(turns * counts + 0.3)) / counts / interval * 60.0
    noise = np.random.default_rng(1).normal(0.0, 2e-4, rpm.size)
    torque = 0.02 * (np.repeat(speeds, rows) / 20.0) ** 0.4 + noise
    time = np.arange(rpm.size) * interval
    return pl.DataFrame({"Time [s]": time, "Torque [N*m]": torque, "Speed [rpm]": rpm})


@pytest.mark.parametrize(
    ("counts", "interval"), [(1000, 0.01), (60, 0.01), (1000, 0.05), (400, 0.002), (24, 0.02)]
)
def test_slow_dwells_are_judged_by_their_mean_speed(counts: int, interval: float) -> None:
    points = hersey.read(encoder(counts, interval), isothermal=True).steady()
    speed, error = points.column("speed") / RPM, points.column("speed_error") / RPM
    assert len(points) == len(SPEEDS)
    assert np.all(np.abs(speed - SPEEDS) < np.maximum(3.0 * error, 1e-3 * speed))
    assert error[0] < 60.0 / counts / 15.0  # one count over the dwell
    np.testing.assert_allclose(points.column("torque"), 0.02 * (np.array(SPEEDS) / 20.0) ** 0.4, rtol=5e-3)


def run_of(speed: np.ndarray) -> Run:
    return Run("a", np.arange(speed.size) * 0.01, np.ones(speed.size), speed, None)


def test_the_angle_turned_stays_and_a_standstill_too() -> None:
    slow = np.where(np.arange(1000) % 40 == 39, 1.0, 0.0)
    speed = np.concatenate([slow, np.zeros(500), slow])
    spread, step = with_counts_spread(run_of(speed))
    assert step == 1.0
    np.testing.assert_allclose(spread.speed.sum(), speed.sum(), rtol=1e-12)
    np.testing.assert_allclose(spread.speed[:1000], 1 / 40)
    assert not spread.speed[1000:1500].any()


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_readings_that_are_no_counts_stay_as_they_are(sign: float) -> None:
    held = sign * np.repeat([0.0, 30.0, 60.0, 0.0, 60.0], 300)
    noisy = sign * np.abs(np.random.default_rng(2).normal(1.0, 0.3, 1000)) * (np.arange(1000) % 3 > 0)
    for speed in (held, noisy):
        run = run_of(speed)
        assert with_counts_spread(run) == (run, 0.0)


def test_the_error_of_counts_is_one_count_over_the_dwell() -> None:
    counts = np.diff(np.floor(0.137 * np.arange(1001)))
    assert counting_error(counts, 1.0) == pytest.approx(1e-3 / np.sqrt(6.0))
    assert counting_error(np.random.default_rng(3).permutation(counts), 1.0) is None
