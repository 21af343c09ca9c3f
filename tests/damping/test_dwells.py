"""Dwells are found, trimmed and judged; every row is accounted for."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import percentile_filter

import hersey
from hersey import testbench
from hersey.damping.dwells import groups_of_temperature, mean_and_error
from hersey.damping.dwells.segments import local_noise
from hersey.errors import InsufficientDataError
from hersey.log.torque_log import LogFile, Run, TorqueLog
from tests.conftest import ROOT

RPM = np.pi / 30


def log_of(
    speed: np.ndarray, torque: np.ndarray, dt: float = 0.02, temperature: np.ndarray | None = None
) -> TorqueLog:
    time = np.arange(speed.size) * dt
    run = Run("run", time, torque, speed, temperature)
    return TorqueLog((run,), (LogFile("run", "0", 0, speed.size, 0, (), ()),))


def dwells(*rpm: float, seconds: float = 10.0, dt: float = 0.02) -> np.ndarray:
    return np.concatenate([np.full(round(seconds / dt), v * RPM) for v in rpm])


@pytest.mark.parametrize("blocks", [1, 2, 3, 24, 25, 26, 400])
def test_the_noise_of_the_speed_is_that_of_the_blocks_about(blocks: int) -> None:
    means = np.random.default_rng(blocks).normal(size=blocks)
    changes = np.abs(np.diff(means, prepend=means[:1]))
    near = percentile_filter(changes, 75, size=min(25, blocks)) / 1.627
    assert np.array_equal(local_noise(means), near)


def test_every_row_is_accounted_for(log: hersey.TorqueLog, points: hersey.SteadyPoints) -> None:
    used = points.table["rows"].sum() + points.table["settling_rows"].sum()
    assert used + sum(r.rows for r in points.rejected) == log.rows


def test_the_staircase_gives_one_point_per_dwell(points: hersey.SteadyPoints) -> None:
    stand = testbench.Stand()
    per_temperature = 2 * len(stand.speeds_rpm) - 1
    assert len(points) >= len(stand.temperatures_degC) * per_temperature - 4
    approach = points.table["approach"].to_list()
    assert approach.count("from below") > 30
    assert approach.count("from above") > 30


def test_reasons_are_named(points: hersey.SteadyPoints) -> None:
    reasons = " | ".join(r.reason for r in points.rejected)
    for words in ("drive at standstill", "speed changing", "stick-slip"):
        assert words in reasons


def test_the_tare_is_the_offset_of_the_sensor(points: hersey.SteadyPoints) -> None:
    assert points.tare == pytest.approx(testbench.Stand().torque_offset, abs=0.004)


def test_settling_is_cut() -> None:
    random = np.random.default_rng(1)
    speed = dwells(30, 60, seconds=20)
    time = np.arange(speed.size // 2) * 0.02
    settling = np.tile(1.0 + 0.5 * np.exp(-time), 2)
    points = log_of(speed, settling + 0.01 * random.standard_normal(speed.size)).steady()
    assert points.column("torque") == pytest.approx([1.0, 1.0], abs=0.01)
    assert (points.column("settling_rows") > 50).all()


def test_what_never_settles_is_rejected() -> None:
    speed = dwells(30, 60)
    torque = np.ones(speed.size)
    torque[500:] = np.linspace(1.0, 1.5, 500)
    points = log_of(speed, torque).steady()
    assert len(points) == 1
    assert "torque drifts by" in points.rejected[-1].reason


def test_drifting_temperature_is_rejected() -> None:
    speed = dwells(30, 60)
    temperature = np.append(np.full(500, 400.0), np.linspace(400.0, 410.0, 500))
    points = log_of(speed, np.ones(speed.size), temperature=temperature).steady()
    assert len(points) == 1
    assert "temperature drifts by" in points.rejected[-1].reason


def test_a_slow_sweep_is_no_dwell() -> None:
    speed = np.linspace(10, 100, 5000) * RPM
    with pytest.raises(InsufficientDataError, match="no dwell found"):
        log_of(speed, np.ones(speed.size)).steady()


def test_reverse_rotation_counts_as_such() -> None:
    speed = dwells(30, -30, -60)
    points = log_of(speed, np.sign(speed)).steady()
    assert points.column("speed") == pytest.approx(np.array([30, -30, -60]) * RPM)
    only = log_of(speed, np.sign(speed)).steady(rotation="reverse")
    assert len(only) == 2
    with pytest.raises(InsufficientDataError, match="opposite signs"):
        log_of(speed, -np.sign(speed)).steady()


def test_standard_error_of_white_noise() -> None:
    series = np.random.default_rng(2).standard_normal(10_000)
    _, error, independent = mean_and_error(series)
    assert error == pytest.approx(0.01, rel=0.1)
    assert independent == pytest.approx(10_000, rel=0.2)


def test_standard_error_respects_autocorrelation() -> None:
    # first-order autoregression with memory 0.9: (1 + 0.9)/(1 - 0.9) = 19 samples count as one
    random = np.random.default_rng(3)
    errors, means = [], []
    for _ in range(60):
        series = np.empty(4000)
        series[0] = random.standard_normal() / np.sqrt(1 - 0.81)
        for i, step in enumerate(random.standard_normal(3999), start=1):
            series[i] = 0.9 * series[i - 1] + step
        mean, error, _ = mean_and_error(series)
        means.append(mean)
        errors.append(error)
    assert np.mean(errors) == pytest.approx(np.std(means), rel=0.3)
    assert np.mean(errors) == pytest.approx(np.sqrt(19 / 4000 / (1 - 0.81)), rel=0.1)


def test_constant_series_have_no_error() -> None:
    assert mean_and_error(np.full(100, 2.5)) == (2.5, 0.0, 100.0)


def test_groups_of_temperature() -> None:
    groups = [g.tolist() for g in groups_of_temperature(np.array([420.0, 300, 301, 421, 350]))]
    assert groups == [[1, 2], [4], [0, 3]]


def test_a_duration_longer_than_the_log_is_met_with_the_usual_one() -> None:
    log = hersey.read(ROOT / "examples/bench.csv")
    with pytest.raises(
        InsufficientDataError, match=r"lasts only .* s\. Use min_dwell=2, the usual duration$"
    ):
        log.steady(min_dwell=2000)
