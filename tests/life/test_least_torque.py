"""The speed of least torque of runs whose truth is known: its bias and its error, against repeated runs."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.arrays import FloatArray
from hersey.life.indicators.at_states import Curves, _put_back
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


def found_in(surface: TorqueSurface, speed: FloatArray, drawn: FloatArray | None) -> LeastTorque:
    return least_torque(surface, speed, np.nan, surface.curve(speed, np.nan), drawn)


@pytest.fixture(scope="module")
def found() -> list[LeastTorque]:
    dwells = runs(0.02)
    kernel = shared_kernel(dwells)
    surfaces = [TorqueSurface(each, kernel) for each in dwells]
    return [found_in(each, GRID, each.drawn(GRID, np.nan, 32, seed=0)) for each in surfaces]


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
    least = [found_in(each, GRID, curves) for each, curves in zip(surfaces, drawn, strict=True)]
    away = np.nanmean([each.log_speed for each in least]) - np.log(LEAST)
    moved, left = alike_in_all(least)
    assert away > 0.0
    assert moved > 0.0
    assert abs(away - moved) < left


def test_repeated_curves_spread_as_those_of_repeated_runs() -> None:
    """At every speed, also at the ends, where the trend alone holds: 240 runs against 400 draws of one."""
    dwells = runs(0.02, 240)
    kernel = shared_kernel(dwells)
    surfaces = [TorqueSurface(each, kernel) for each in dwells]
    spread = np.std([np.log(each.curve(GRID, np.nan)) for each in surfaces], axis=0, ddof=1)
    drawn = np.log(surfaces[0].repeated(GRID, np.nan, 400, seed=1)).std(axis=0, ddof=1)
    assert np.median(drawn / spread) == pytest.approx(1.0, abs=0.1)
    assert drawn == pytest.approx(spread, rel=0.3)


def test_what_is_alike_in_all_is_a_median_and_a_third_of_the_rest() -> None:
    """0.05 in all and 0.03 by noise leave 0.04 between the dwells."""
    known = [LeastTorque(1.0, 0.03, 0.05, moved, False, False) for moved in (0.01, 0.02, 0.09)]
    unasked = LeastTorque(1.0, 0.5, np.nan, np.nan, False, False)
    assert alike_in_all([*known, unasked]) == pytest.approx((0.02, 0.04 / 3.0))
    back = [each._replace(moved=-each.moved) for each in known]
    assert alike_in_all(back) == pytest.approx((0.0, 0.04 / 3.0))


def test_the_least_of_all_runs_is_put_back() -> None:
    least, rest = np.array([2.0, np.nan, 3.0]), np.zeros(3, dtype=bool)
    curves = Curves(400.0, GRID, np.ones((3, GRID.size)), least, 0.1 * least, rest, rest, {})
    found = [LeastTorque(np.log(2.0), 0.03, 0.05, 0.02, False, False)]
    moved = _put_back(curves, found)
    assert moved.least == pytest.approx(least * 0.9801987, nan_ok=True)  # exp(-0.02)
    assert moved.common == pytest.approx(0.04 / 3.0)


def test_a_least_at_an_end_is_not_known() -> None:
    dwells = runs(0.01, 6)
    surface = TorqueSurface(dwells[0], shared_kernel(dwells))
    fast, slow = (found_in(surface, GRID[part], None) for part in (GRID > 4.0, GRID < 1.0))
    assert (fast.below, fast.above, slow.below, slow.above) == (True, False, False, True)
    assert np.isnan([fast.log_speed, fast.error, slow.log_speed, slow.error]).all()
    assert alike_in_all([fast, slow]) == (0.0, 0.0)
