"""The numbers of a steady point: mean, standard errors, tare and approach, each against a sum by hand."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.damping.dwells import mean_and_error
from hersey.log.torque_log import LogFile, Run, TorqueLog
from tests.damping.test_dwells import RPM, dwells, log_of

#: Samples a second of `log_of`, and those of the edges that are cut: a block of 0.2 s.
RATE, EDGE = 50, 10
DWELL = slice(EDGE, 500 - EDGE)


def by_hand(series: np.ndarray) -> tuple[float, float, float]:
    """Mean, error and independent samples by plain sums: Sokal's window, Wolff's correction."""
    n = series.size
    r = series - sum(series) / n
    sums = [float(np.dot(r[: n - lag], r[lag:])) for lag in range(n)]
    tau, window = 1.0, 0
    for window in range(n):
        tau = 1.0 + 2.0 * sum(sums[1 : window + 1]) / sums[0]
        if window >= 5.0 * max(tau, 1.0):
            break
    time = max(1.0, tau) * (1.0 + (2.0 * window + 1.0) / n)
    variance = sums[0] / (n - 1)
    return sum(series) / n, (variance * time / (n - time)) ** 0.5, n / time


def noise(seed: int, count: int = 500, memory: float = 0.0) -> np.ndarray:
    """Noise of unit deviation that remembers its last value."""
    white = np.random.default_rng(seed).standard_normal(count)
    out = np.array(white)
    for i in range(1, count):
        out[i] = memory * out[i - 1] + (1 - memory**2) ** 0.5 * white[i]
    return out


def runs_of(*rpm: tuple[float, ...]) -> TorqueLog:
    """A log of several runs, torque 1 N m with the sign of the speed."""
    runs = []
    for index, steps in enumerate(rpm):
        speed = dwells(*steps)
        runs.append(Run(f"run {index}", np.arange(speed.size) / RATE, np.sign(speed), speed, None))
    rows = sum(run.time.size for run in runs)
    return TorqueLog(tuple(runs), (LogFile("runs", "0", 0, rows, 0, (), ()),))


def test_a_point_is_what_lies_between_the_edges_of_its_dwell() -> None:
    points = log_of(dwells(30, 60), np.append(np.full(500, 1.0), np.full(500, 2.0))).steady()
    first, second = points.table.rows(named=True)
    assert (first["run"], first["rows"], first["settling_rows"]) == (0, 480, 20)
    assert (first["start"], first["end"]) == pytest.approx((0.20, 9.78))
    assert (second["start"], second["end"]) == pytest.approx((10.20, 19.78))
    assert first["speed"] == pytest.approx(30 * RPM)
    assert (first["torque"], second["torque"]) == (1.0, 2.0)
    assert (first["torque_error"], first["speed_error"], first["effective_rows"]) == (0.0, 0.0, 480.0)
    assert (first["temperature"], first["temperature_error"]) == (None, None)


@pytest.mark.parametrize("memory", [0.0, 0.6, 0.9])
def test_mean_and_error_by_hand(memory: float) -> None:
    series = 3.0 + noise(4, 400, memory)
    assert mean_and_error(series) == pytest.approx(by_hand(series), rel=1e-9)


def test_a_long_series_is_averaged_without_changing_its_error() -> None:
    series = 5.0 + noise(5, 95_000)
    mean, error, independent = mean_and_error(series)
    assert mean == pytest.approx(float(np.mean(series)), rel=1e-12)
    assert error == pytest.approx(95_000**-0.5, rel=0.05)
    assert independent == pytest.approx(95_000 // 9, rel=0.01)  # blocks of nine samples, white as they were


def test_each_channel_has_the_error_of_its_own_mean() -> None:
    speed = dwells(30) * (1 + 0.01 * noise(1))
    torque, temperature = 2.0 + 0.05 * noise(2, memory=0.5), 400.0 + 0.3 * noise(3, memory=0.3)
    points = log_of(speed, torque, temperature=temperature).steady()
    (row,) = points.table.rows(named=True)
    assert row["rows"] == 480
    for name, series in (("speed", speed), ("torque", torque), ("temperature", temperature)):
        mean, error, independent = by_hand(series[DWELL])
        assert row[name] == pytest.approx(mean, rel=1e-9)
        assert row[f"{name}_error"] == pytest.approx(error, rel=1e-9)
        if name == "torque":
            assert row["effective_rows"] == pytest.approx(independent)


def test_a_drift_that_is_kept_is_part_of_the_error() -> None:
    torque = 1.0 + np.linspace(-0.01, 0.01, 500) + 0.01 * noise(6)
    (row,) = log_of(dwells(30), torque).steady().table.rows(named=True)
    kept = torque[DWELL]
    slope = float(np.polyfit(np.arange(480.0), kept, 1)[0])
    of_mean = by_hand(kept)[1]
    assert row["torque_error"] == pytest.approx(np.hypot(of_mean, slope * 479 / 12**0.5), rel=1e-6)
    assert row["torque_error"] > 1.5 * of_mean


def test_a_drift_within_chance_adds_nothing() -> None:
    torque = 1.0 + np.linspace(-0.001, 0.001, 500) + 0.01 * noise(6)
    (row,) = log_of(dwells(30), torque).steady().table.rows(named=True)
    assert row["torque_error"] == pytest.approx(by_hand(torque[DWELL])[1], rel=1e-9)


def test_the_tare_is_the_middle_of_what_was_recorded_standing() -> None:
    standing = 0.25 + 0.02 * noise(7)
    standing[:48] = standing[-48:] = 9.0  # a tenth at either end may not stand yet
    torque = np.concatenate([standing, np.full(500, 1.25), np.full(500, -0.75)])
    log = log_of(dwells(0, 30, -30), torque)
    points = log.steady(tare="standing")
    mean, error, _ = by_hand(standing[50:-50])
    assert points.tare == pytest.approx(mean, rel=1e-9)
    assert points.tare_error == pytest.approx(error, rel=1e-9)
    assert points.standing_torque == points.tare
    assert points.column("torque") == pytest.approx([1.25 - mean, -0.75 - mean], rel=1e-9)
    untouched = log.steady()
    assert (untouched.tare, untouched.tare_error) == (0.0, 0.0)
    assert untouched.standing_torque == points.tare
    assert untouched.column("torque") == pytest.approx([1.25, -0.75])


def test_every_stretch_that_stands_counts_for_the_tare() -> None:
    torque = np.concatenate([np.full(500, v) for v in (0.1, 1.0, 0.1, 1.0)])
    points = log_of(dwells(0, 30, 0, 60), torque).steady(tare="standing")
    assert points.tare == pytest.approx(0.1)
    assert points.column("torque") == pytest.approx([0.9, 0.9], rel=1e-5)


def test_a_drive_that_never_stands_has_no_tare() -> None:
    assert log_of(dwells(30, 60), np.ones(1000)).steady().standing_torque is None


def test_approach_is_by_the_size_of_the_speed() -> None:
    speed = dwells(-30, -60, -45, 50)
    points = log_of(speed, np.sign(speed)).steady()
    assert points.table["approach"].to_list() == ["start", "from below", "from above", "from below"]


def test_a_dwell_that_is_not_used_still_says_from_where_the_next_came() -> None:
    speed, torque = dwells(30, 60, 45), np.ones(1500)
    torque[500:1000] = np.linspace(1.0, 1.5, 500)
    points = log_of(speed, torque).steady()
    assert points.table["approach"].to_list() == ["start", "from above"]


def test_a_new_run_starts_anew() -> None:
    points = runs_of((30.0, 60.0), (20.0, 10.0)).steady()
    assert points.column("run").tolist() == [0, 0, 1, 1]
    assert points.table["approach"].to_list() == ["start", "from below", "start", "from above"]
    assert points.column("start") == pytest.approx([0.2, 10.2, 0.2, 10.2])


def test_a_rejected_stretch_is_placed_in_its_run() -> None:
    points = runs_of((30.0, 60.0), (0.0, 20.0)).steady()
    (standing,) = points.rejected
    assert (standing.run, standing.rows, standing.reason) == (1, 500, "drive at standstill")
    assert (standing.start, standing.end) == pytest.approx((0.0, 9.98))


def test_settling_is_cut_where_the_error_of_the_rest_is_least() -> None:
    settling = 0.5 * np.exp(-np.arange(500) / RATE / 1.5)
    steady = 0.01 * noise(8)
    for torque, temperature in (
        (1.0 + settling + steady, np.full(500, 400.0)),
        (np.ones(500), 400.0 + 10.0 * (settling + steady)),
    ):
        blocks = ((temperature - 400.0) / 10.0 + torque - 1.0).reshape(250, 2).mean(axis=1)[5:-5]
        errors = [np.std(blocks[cut:]) / (blocks.size - cut) ** 0.5 for cut in range(blocks.size // 2)]
        cut = 5 + int(np.argmin(errors))
        assert cut > 20
        (row,) = log_of(dwells(30), torque, temperature=temperature).steady().table.rows(named=True)
        assert row["start"] == pytest.approx(cut * 2 / RATE)
        assert row["settling_rows"] == cut * 2 + EDGE
        assert row["end"] == pytest.approx(9.78)


def test_settling_that_hardly_matters_is_left() -> None:
    """Cutting it would lower the error by less than a fifth."""
    torque = 1.0 + 0.01 * noise(9)
    torque[:40] += 0.008
    (row,) = log_of(dwells(30), torque).steady().table.rows(named=True)
    assert row["settling_rows"] == 2 * EDGE
