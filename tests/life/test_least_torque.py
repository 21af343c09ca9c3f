"""The speed of least torque of runs whose truth is known: its bias and its error, against repeated runs."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.life.indicators.least_torque import LeastTorque, alike_in_all, least_torque
from hersey.life.indicators.shared_kernel import shared_kernel
from hersey.life.indicators.torque_surface import RunDwells, TorqueSurface

#: Torque falls as 1/w and rises as w^0.4: (w/w0)^-1 + (w/w0)^0.4 / 0.4 is least at w0.
LEAST = 1.7
SPEED = np.geomspace(0.5, 15.0, 9)
GRID = np.geomspace(0.5, 15.0, 44)


def runs(noise: float, count: int = 24) -> list[RunDwells]:
    """Runs of one truth that differ in noise alone."""
    ratio = SPEED / LEAST
    torque = 0.1 * (1.0 / ratio + ratio**0.4 / 0.4)
    normal = np.random.default_rng(3).standard_normal((count, SPEED.size))
    shown = torque * (1.0 + noise * normal)
    heat = np.full(SPEED.size, np.nan)
    return [RunDwells(SPEED, heat, each, each, noise * torque) for each in shown]


@pytest.fixture(scope="module")
def found() -> list[LeastTorque]:
    dwells = runs(0.02)
    kernel = shared_kernel(dwells)
    surfaces = [TorqueSurface(each, kernel) for each in dwells]
    return [least_torque(each, GRID, np.nan, each.drawn(GRID, np.nan, 32, seed=0)) for each in surfaces]


def test_the_error_of_a_run_is_that_of_repeated_runs(found: list[LeastTorque]) -> None:
    spread = np.std([each.log_speed for each in found], ddof=1)
    assert np.median([each.error for each in found]) == pytest.approx(spread, rel=0.35)
    assert np.median([each.whole for each in found]) > np.median([each.error for each in found])


@pytest.mark.parametrize("noise", [0.02, 0.04])
def test_what_is_left_of_smoothing_is_within_its_error(noise: float) -> None:
    """The mean of 240 runs is off by what smoothing moves; put back it is off by no more than is said."""
    dwells = runs(noise, 240)
    kernel = shared_kernel(dwells)
    surfaces = [TorqueSurface(each, kernel) for each in dwells]
    drawn = [each.drawn(GRID, np.nan, 32, seed=0) for each in surfaces[:24]] + [None] * 216
    least = [least_torque(each, GRID, np.nan, curves) for each, curves in zip(surfaces, drawn, strict=True)]
    away = np.nanmean([each.log_speed for each in least]) - np.log(LEAST)
    moved, left = alike_in_all(least)
    assert away > 0.0
    assert moved > 0.0
    assert abs(away - moved) < left


def test_a_least_at_an_end_is_not_known() -> None:
    dwells = runs(0.01, 6)
    surface = TorqueSurface(dwells[0], shared_kernel(dwells))
    fast, slow = (least_torque(surface, GRID[part], np.nan, None) for part in (GRID > 4.0, GRID < 1.0))
    assert (fast.below, fast.above, slow.below, slow.above) == (True, False, False, True)
    assert np.isnan([fast.log_speed, fast.error, slow.log_speed, slow.error]).all()
    assert alike_in_all([fast, slow]) == (0.0, 0.0)
