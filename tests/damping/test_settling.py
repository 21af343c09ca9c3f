"""Settling that one dwell hides in its noise, and many dwells show together."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.damping.dwells.settling import common_settling
from hersey.log.torque_log import Run
from tests.damping.test_dwells import dwells, log_of

#: s: between samples, and of the relaxation after a change of speed; its size beside noise of one.
DT, TAIL, SIZE = 0.02, 0.4, 1.5
STEPS = (10, 20, 30, 40, 60, 80, 110, 150, 200, 280, 380, 500)
SECONDS = 6.0
NOISE = 0.03


def staircase(seed: int, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Speed, torque with noise, and the true torque of each dwell, come to from below but for the first."""
    speed = dwells(*STEPS, seconds=SECONDS, dt=DT)
    count = round(SECONDS / DT)
    level = np.geomspace(1.0, 3.0, len(STEPS))
    tail = 1.0 + size * NOISE * np.exp(-np.arange(count) * DT / TAIL)
    torque = np.concatenate([v * tail for v in level])
    torque = torque * (1.0 + NOISE * np.random.default_rng(seed).standard_normal(torque.size))
    return speed, torque, level


def all_dwells(speed: np.ndarray, torque: np.ndarray) -> list[tuple[Run, int, int, float]]:
    count = round(SECONDS / DT)
    run = Run("run", np.arange(speed.size) * DT, torque, speed, None)
    return [(run, i * count, (i + 1) * count, 0.0) for i in range(len(STEPS))]


@pytest.mark.parametrize("seed", range(4))
def test_a_tail_lost_in_the_noise_of_one_dwell_is_cut_from_all(seed: int) -> None:
    speed, torque, level = staircase(seed, SIZE)
    assert 0.4 <= common_settling(all_dwells(speed, torque)) <= 2.0
    off = log_of(speed, torque, dt=DT).steady().column("torque") / level - 1.0
    kept = [np.mean(torque[start + 10 : end - 10]) for _, start, end, _ in all_dwells(speed, torque)]
    assert abs(np.mean(off[1:])) < 0.5 * abs(np.mean(np.array(kept[1:]) / level[1:] - 1.0))


def test_noise_alone_hardly_ever_settles() -> None:
    cut = [common_settling(all_dwells(*staircase(seed, 0.0)[:2])) for seed in range(40)]
    assert sum(c > 0.0 for c in cut) <= 4
    assert max(cut) <= 0.1 * SECONDS


def test_the_tare_is_no_part_of_the_level() -> None:
    speed, torque, _ = staircase(1, SIZE)
    plain = all_dwells(speed, torque)
    off = [(run, start, end, -2.0) for run, start, end, _ in all_dwells(speed, torque - 2.0)]
    assert common_settling(off) == common_settling(plain) > 0.0


def test_a_few_dwells_have_no_settling_in_common() -> None:
    speed, torque, _ = staircase(1, 5.0)
    assert common_settling(all_dwells(speed, torque)[:4]) == 0.0
    assert common_settling([]) == 0.0


def test_a_dwell_too_short_for_the_common_cut_keeps_its_rows() -> None:
    speed, torque, _ = staircase(2, SIZE)
    short = round(2.6 / DT)
    points = log_of(
        np.append(speed, np.full(short, 20.0)), np.append(torque, np.full(short, 4.0)), dt=DT
    ).steady(min_dwell=2.0)
    assert len(points) == len(STEPS) + 1
