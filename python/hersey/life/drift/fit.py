"""The joint fit of all runs of all specimens: one law, values of runs, their change with age, and spreads."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.life.drift.aged_torque import OWN, Scales, estimable, expected, parts
from hersey.life.drift.dwells import Dwells
from hersey.life.drift.mixed_effects import Information, Solved, Spread, solve

#: No torque is taken as known better than this, relative.
_RESOLUTION = 2e-3
#: More specimens than these begin where a fit to half as many ends.
_MANY = 60
#: First steps, in which the spreads stay.
_FIRST = 5
#: Steps at the most, and the change of ln of a spread or of a value (in its deviation) at which they end.
_STEPS, _SETTLED = 150, 2e-3
#: Factor on the logarithm of a step of the spreads, which are slow by themselves.
_HASTE = 1.7
#: Longest step of a run's values, and how many deviations of the prior a shared value may stray: where one
#: law cannot hold for all specimens, steps would lead out of all sense.
_LONGEST, _FURTHEST = 1.0, 4.0
_NIL = 1e-6
#: Prior of the population's start: means and deviations, in the order of `OWN`.
_START = np.array([0.5, 0.0, 0.0, -1.5, -1.0, 0.0])
_START_DEVIATION = np.array([1.0, _NIL, _NIL, 1.5, 1.5, _NIL])
#: Deviation of the prior of its change up to the oldest run.
_CHANGE_DEVIATION = np.array([1.0, 1.0, 0.3, 3.0, 2.0, 1.0])
#: Usual spreads of specimens in start and in change, and of runs.
_OF_START = np.array([0.01, 0.02, 0.01, 0.1, 0.1, 0.02])
_OF_CHANGE = np.array([0.01, 0.02, 0.01, 0.1, 0.1, 0.02])
_OF_RUNS = np.array([0.002, 0.005, 0.003, 0.03, 0.03, 0.005])


@dataclass(frozen=True, repr=False)
class Fitted:
    """The fit: posterior, scales, and the scatter of dwells beyond their errors (relative)."""

    solved: Solved
    scales: Scales
    spread: Spread
    scatter: float
    settled: bool
    steps: int


def fit(dwells: Dwells) -> Fitted:
    """Return the joint fit; that of many specimens begins where that of some of them ends."""
    scales, specimens = _scales(dwells), int(dwells.specimen[-1]) + 1
    if specimens <= _MANY:
        return _fitted(dwells, scales, None)
    some = np.linspace(0, specimens - 1, _MANY // 2).round().astype(int)
    chosen = np.isin(dwells.specimen, some)
    part = Dwells(*(getattr(dwells, each.name)[chosen] for each in fields(Dwells)))
    return _fitted(
        dwells, scales, _fitted(replace(part, specimen=np.searchsorted(some, part.specimen)), scales, None)
    )


def _fitted(dwells: Dwells, scales: Scales, begun: Fitted | None) -> Fitted:
    """The joint fit, by Gauss-Newton steps that also renew the spreads."""
    place = scales.places(np.where(dwells.given, dwells.temperature, dwells.temperature[:, :1]))
    target = dwells.torque / scales.torque
    size = np.where(dwells.given, np.abs(target), 1.0)
    error = np.hypot(dwells.error / scales.torque, _RESOLUTION * size)
    free = estimable(scales)
    prior = _prior(scales, free)
    common = prior[0].copy() if begun is None else begun.solved.common.copy()
    usual = Spread(
        np.where(np.tile(free, 2), np.concatenate([_OF_START, _OF_CHANGE]), _NIL) ** 2,
        np.where(free, _OF_RUNS, _NIL) ** 2,
    )
    spread = Spread(9.0 * usual.specimens, 9.0 * usual.runs) if begun is None else begun.spread
    own = len(OWN)
    values = common[:own] + dwells.age[:, None] * common[own : 2 * own]
    shared_at = slice(2 * own, None)
    bounds = [prior[0][shared_at] + sign * _FURTHEST * prior[1][shared_at] for sign in (-1.0, 1.0)]
    longest = np.maximum(np.minimum(0.5 * prior[1], _LONGEST), _NIL)
    settled = False
    for step in range(1, _STEPS + 1):
        now = parts(scales, dwells.speed, place, values, common[shared_at])
        residual = np.where(dwells.given, target - now.torque, 0.0)
        scatter = _scatter(residual, error, size, dwells)
        weight = dwells.given / (error**2 + (scatter * size) ** 2)
        slopes = np.concatenate([now.own, now.shared], axis=-1)
        pseudo = residual + np.einsum("rdj,rj->rd", now.own, values) + now.shared @ common[shared_at]
        weighted = slopes * weight[..., None]
        information = Information(
            weighted.swapaxes(1, 2) @ slopes, (weighted.swapaxes(1, 2) @ pseudo[..., None])[..., 0]
        )
        solved = solve(information, dwells.age, dwells.specimen, spread, usual, prior)
        # One length for all: runs follow the shared values with which they were solved.
        ahead = solved.common - common
        length = min(1.0, 0.3 + 0.1 * step, float(np.min(longest / np.maximum(np.abs(ahead), longest))))
        moved = np.abs(solved.run - values) / _CHANGE_DEVIATION
        values = _within(values + length * np.clip(solved.run - values, -_LONGEST, _LONGEST))
        common = common + length * ahead
        common[shared_at] = np.clip(common[shared_at], *bounds)
        if step > _FIRST or begun is not None:  # before that residuals are those of the start
            renewed = solved.spread
            spread = Spread(
                spread.specimens * (renewed.specimens / spread.specimens) ** _HASTE,
                spread.runs * (renewed.runs / spread.runs) ** _HASTE,
            )
        if step > 2 * _FIRST and float(np.quantile(moved.max(axis=1), 0.99)) < _SETTLED:
            settled = True
            break
    return Fitted(solved, scales, spread, scatter, settled, step)


def _within(values: FloatArray) -> FloatArray:
    """Values kept where the law has a sense."""
    low = np.array([-3.0, -4.0, -0.6, -9.0, -9.0, -3.0])
    high = np.array([10.0, 4.0, 0.6, 9.0, 6.0, 3.0])
    return np.clip(values, low, high)


def _scales(dwells: Dwells) -> Scales:
    given = dwells.given
    return Scales.of(dwells.speed[given], dwells.temperature[given], dwells.torque[given])


def _prior(scales: Scales, free: BoolArray) -> tuple[FloatArray, FloatArray]:
    mean, deviation = expected(scales)
    return (
        np.concatenate([_START, np.zeros(len(OWN)), mean]),
        np.concatenate(
            [
                np.where(free, _START_DEVIATION, _NIL),
                np.where(free, _CHANGE_DEVIATION, _NIL),
                deviation,
            ]
        ),
    )


def _scatter(residual: FloatArray, error: FloatArray, size: FloatArray, dwells: Dwells) -> float:
    """Relative scatter that brings the mean square of residuals over errors to one, by bisection."""
    count = float(dwells.given.sum())
    free = max(count - len(OWN) * dwells.age.size * 0.5, 0.3 * count)

    def excess(scatter: float) -> float:
        return float((residual**2 / (error**2 + (scatter * size) ** 2)).sum()) - free

    if excess(0.0) <= 0.0:
        return 0.0
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) > 0.0 else (low, middle)
    return high
