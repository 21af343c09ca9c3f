"""A zero that drifts: every standing stretch counts at its time, and what it leaves open is carried."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hersey
from hersey.damping.dwells.zero import MOST_DISTURBANCES, NEGLIGIBLE, Standing, Zero
from tests.damping.test_dwells import dwells, log_of

RATE = 50


def drifting(
    seed: int, drift: str, every: int, size: float = 0.03, steps: int = 24
) -> tuple[hersey.SteadyPoints, np.ndarray]:
    """Points of a staircase with standing stretches every few dwells, and the true torques, N m."""
    random = np.random.default_rng(seed)
    held: list[float] = []
    for i, rpm in enumerate(np.geomspace(10.0, 100.0, steps)):
        held += [0.0] * (i % every == 0) + [rpm]
    speed = dwells(*held, 0.0, seconds=7.0, dt=1.0 / RATE)
    torque = np.where(speed > 0, 1.0, 0.0)
    share = np.arange(speed.size) / speed.size
    zero = {
        "none": np.zeros_like(share),
        "linear": size * share,
        "walk": size * np.cumsum(random.standard_normal(speed.size)) / speed.size**0.5,
    }[drift]
    noise = 0.01 * random.standard_normal(speed.size)
    points = log_of(speed, torque + 0.1 + zero + noise, dt=1.0 / RATE).steady(tare="standing")
    return points, np.ones(len(points))


def errors(points: hersey.SteadyPoints) -> np.ndarray:
    return np.asarray(np.hypot(points.column("torque_error"), np.linalg.norm(points.tare_errors, axis=1)))


@pytest.mark.parametrize("drift", ["none", "linear", "walk"])
@pytest.mark.parametrize("every", [3, 8])
def test_corrected_torque_is_covered(drift: str, every: int) -> None:
    inside, wider = [], []
    for seed in range(16):
        points, truth = drifting(seed, drift, every)
        inside += list(np.abs(points.column("torque") - truth) < 1.96 * errors(points))
        wider.append(np.median(errors(points) / points.column("torque_error")))
    assert np.mean(inside) >= 0.90  # errors of dwells between two stretches are one draw
    assert np.median(wider) < {"none": 1.3, "linear": 2.0, "walk": 12.0}[drift]


def test_a_zero_that_holds_costs_next_to_nothing() -> None:
    points, _ = drifting(1, "none", 4)
    assert np.median(errors(points) / points.column("torque_error")) < 1.15
    assert points.warnings == ()


def test_a_drift_is_said_with_its_size() -> None:
    points, _ = drifting(2, "linear", 4)
    (drift,) = points.warnings
    assert drift.kind == "zero drifts"
    assert drift.number("rise") == pytest.approx(0.0275, abs=0.0025)
    assert "7 standstills" in str(drift)
    assert drift.sentence in points.summary()
    tares = points.table["tare"].to_numpy()
    assert tares[-1] - tares[0] == pytest.approx(0.03 * 28 / 31, abs=0.003)
    assert points.tare == pytest.approx(np.mean(tares))


def test_one_standing_stretch_cannot_see_a_drift() -> None:
    torque = np.concatenate([np.full(350, v) for v in (0.1, 1.0, 1.1)])
    log = log_of(dwells(0, 30, 60, seconds=7.0), torque)
    (once,) = log.steady(tare="standing").warnings
    assert once.sentence.startswith("The drive stood still only once, so drift of the torque zero")
    assert log.steady().warnings == ()


def test_two_standing_stretches_show_only_a_difference() -> None:
    random = np.random.default_rng(3)
    speed = dwells(0, 30, 45, 60, 80, 0, seconds=7.0)
    zero = np.repeat([0.1, 0.1, 0.1, 0.1, 0.1, 0.2], 350)
    torque = (speed > 0) * 1.0 + zero + 0.001 * random.standard_normal(speed.size)
    points = log_of(speed, torque).steady(tare="standing")
    assert any(each.kind == "two standing stretches" for each in points.warnings)
    middle = np.linalg.norm(points.tare_errors, axis=1)[1:3]
    assert (middle > 0.015).all()  # a third of the difference either way, and no more than all of it
    assert (middle < 0.1).all()


def test_a_drift_that_is_not_subtracted_is_asked_about() -> None:
    random = np.random.default_rng(4)
    speed = dwells(0, 30, 0, 60, 0, seconds=7.0)
    torque = (speed > 0) * 1.0 + np.repeat([0.1, 0.1, 0.12, 0.12, 0.14], 350)
    points = log_of(speed, torque + 0.001 * random.standard_normal(speed.size)).steady()
    (drift,) = points.warnings
    assert drift.kind == "zero drifts, not subtracted"
    assert "and is not subtracted" in str(drift)
    assert points.tare_errors.shape == (2, 0)


def test_disturbances_make_up_the_covariance() -> None:
    random = np.random.default_rng(5)
    stretches = tuple(Standing(0, t, 0.02 * random.standard_normal(), 0.001) for t in range(0, 101, 20))
    zero = Zero(stretches, 100.0)
    times = np.linspace(2.0, 98.0, 60)
    whole = zero._covariance(times)
    modes, left = zero.disturbances(times, np.zeros(60))
    assert modes.shape == (60, MOST_DISTURBANCES)
    assert np.sum(modes**2, axis=1) + left**2 == pytest.approx(np.diag(whole), rel=1e-6)
    assert np.abs(modes @ modes.T - whole).max() < 0.25 * whole.max()
    few, more_left = zero.disturbances(times, np.full(60, 0.05))
    assert few.shape[1] < modes.shape[1]
    assert (more_left <= NEGLIGIBLE * 0.05 + 1e-12).all()


def test_one_stretch_is_one_disturbance_of_all_dwells() -> None:
    modes, left = Zero((Standing(0, 5.0, 0.1, 0.002),), 50.0).disturbances(
        np.array([10.0, 20.0, 40.0]), np.full(3, 0.001)
    )
    assert modes == pytest.approx(np.full((3, 1), 0.002))
    assert left == pytest.approx(np.zeros(3), abs=1e-9)


def test_runs_follow_one_another() -> None:
    """The standing stretch of the second run stands later than all of the first."""
    from hersey.log.torque_log import LogFile, Run, TorqueLog

    random = np.random.default_rng(6)
    runs = []
    for index, zero in enumerate((0.1, 0.2, 0.3)):
        speed = dwells(0, 30, 60, seconds=7.0)
        torque = (speed > 0) * 1.0 + zero + 0.001 * random.standard_normal(speed.size)
        runs.append(Run(f"run {index}", 1e4 + np.arange(speed.size) / RATE, torque, speed, None))
    points = TorqueLog(tuple(runs), (LogFile("runs", "0", 0, 3150, 0, (), ()),)).steady(tare="standing")
    tares = points.table["tare"].to_numpy()
    assert (np.diff(tares) > 0).all()
    assert tares[0] > 0.1


@pytest.mark.filterwarnings("error")
def test_a_drive_that_stands_may_read_one_number_all_the_time() -> None:
    random = np.random.default_rng(3)
    speed = dwells(0, 10, 20, 40, 80, 60, 30, 0, seconds=7.0)
    torque = np.where(speed > 0, 1.0 + 0.01 * random.standard_normal(speed.size), 0.25)
    points = log_of(speed, torque).steady(tare="standing")
    assert points.tare == pytest.approx(0.25)
    assert points.tare_error < 1e-4


def test_the_chance_of_one_zero_is_that_of_one_freedom_less_than_stretches() -> None:
    """Chi-square in closed form: erfc(sqrt(x/2)) of one freedom, exp(-x/2) of two."""
    stretches = tuple(Standing(0, 60.0 * i, 0.10 + 0.01 * i, 0.01) for i in range(3))
    assert Zero(stretches[:2], 60.0).p_value == pytest.approx(math.erfc(math.sqrt(0.5 / 2)), rel=1e-12)
    assert Zero(stretches, 120.0).p_value == pytest.approx(math.exp(-1.0), rel=1e-12)
