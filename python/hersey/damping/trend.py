"""Whether torque rises or falls with speed, by the dwells themselves: no law is assumed.

At each temperature the mean torques of all pairs of speeds are compared. Torque rises somewhere if one pair
differs upward by more than its errors, which count scatter between dwells and what a wrong zero would do to
both; the significance is divided by the number of pairs (Bonferroni). A few dwells are tested together
instead (`order`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.observations import Observations
from hersey.damping.distributions import student_quantile
from hersey.damping.dwells import SAME_SPEED
from hersey.damping.dwells.groups import levels_of_speed
from hersey.damping.order import MOST, chances, off_parabolas
from hersey.log.white_noise import MEDIAN_MAGNITUDE

#: Probability with which a constant torque seems to rise or to fall somewhere.
BY_CHANCE = 0.002
#: Share of the squares about a curve that falls and then rises, below which one that rises first counts.
_HUMP = 0.1
#: Dwells from which it is asked whether torque rises first: fewer lie on either curve by chance.
_BOTH = 6
#: Fours of neighbouring speeds whose distance from a parabola tells the scatter.
_ENOUGH = 5
#: Least relative scatter between dwells that is assumed: sensors repeat no better.
_LEAST_SCATTER = 1e-3


@dataclass(frozen=True)
class Trend:
    """What torque does as speed rises; ``least`` is the speed (rad/s) of least mean torque.

    ``spread`` is half the range of mean torques at one temperature, relative: all that a constant torque
    leaves open.
    """

    rises: bool
    falls: bool
    least: float
    spread: float

    @property
    def constant(self) -> bool:
        """Whether torque neither rises nor falls beyond its errors."""
        return not (self.rises or self.falls)


def trend_of(data: Observations) -> Trend:
    """Return what torque does with speed in the dwells."""
    scatter, freedom = _scatter(data)
    rises = falls = False
    lows, spreads = [], [0.0]
    groups = [np.flatnonzero(data.inputs.group == g) for g in np.unique(data.inputs.group)]
    levels = [levels_of_speed(data.inputs.log_speed, members, SAME_SPEED) for members in groups]
    pairs = sum(len(each) * (len(each) - 1) // 2 for each in levels)
    chance = 0.5 * BY_CHANCE  # of each claim
    limit = float(student_quantile(1.0 - chance / max(pairs, 1), freedom))
    for each in levels:
        if len(each) < 2:
            continue
        mean, variance, tare = _means(data, each, scatter)
        change = mean[None, :] - mean[:, None]
        apart = np.sum((tare[None, :, :] - tare[:, None, :]) ** 2, axis=2)
        z = np.triu(change / np.sqrt(variance[None, :] + variance[:, None] + apart), 1)
        rises |= bool(np.any(z > limit))
        falls |= bool(np.any(z < -limit))
        spreads.append(0.5 * float(np.ptp(mean)))
        lows.append(float(np.exp(np.mean(data.inputs.log_speed[each[int(np.argmin(mean))]]))))
    if data.log_torque.size <= MOST:
        by_chance = _together(data, groups)
        rises, falls = by_chance[0] < chance, by_chance[1] < chance
    least = data.reference_speed * float(np.median(lows)) if lows else data.reference_speed
    return Trend(rises, falls, least, float(np.expm1(max(spreads))))


def _together(data: Observations, groups: list[IntArray]) -> tuple[float, float]:
    """How often chance makes torque rise, and fall, as it does whatever the zero, within two deviations."""
    sorted_ = [each[np.argsort(data.inputs.log_speed[each], kind="stable")] for each in groups]
    zeros = [np.zeros_like(data.log_torque)]
    zeros += [sign * 2.0 * column for column in data.tare.T for sign in (-1.0, 1.0)]
    z = data.inputs.log_speed
    found = [chances([(z[each], (data.log_torque + zero)[each]) for each in sorted_]) for zero in zeros]
    return max(rise for rise, _ in found), max(fall for _, fall in found)


def _means(
    data: Observations, levels: list[IntArray], scatter: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean ln torque of each speed, its variance, and its change by each error of the zero."""
    mean, variance, tare = [], [], []
    for level in levels:
        each = data.torque_error[level] ** 2 + scatter**2
        weight = 1.0 / each
        mean.append(float(np.average(data.log_torque[level], weights=weight)))
        variance.append(1.0 / float(weight.sum()))
        tare.append(np.average(data.tare[level], weights=weight, axis=0))
    return np.array(mean), np.array(variance), np.array(tare)


def _about_one_turn(y: FloatArray, first_rises: bool) -> float:
    """Sum of squares about the best curve that rises or falls, turns once, and goes the other way."""
    best = float(np.sum((y - y.mean()) ** 2))
    for i in range(1, y.size):
        before = optimize.isotonic_regression(y[:i], increasing=first_rises).x
        after = optimize.isotonic_regression(y[i:], increasing=not first_rises).x
        best = min(best, float(np.sum((y - np.append(before, after)) ** 2)))
    return best


def _freedom(size: int) -> float:
    """Squares that noise of one leaves about the best curve that falls and then rises, by simulation."""
    return max(0.62 * size - 2.4, 0.3)


def _scatter(data: Observations) -> tuple[float, float]:
    """Scatter of dwells about the best curve that turns once, and its degrees of freedom.

    Where torque changes by more than its scatter from speed to speed that curve misses nothing: then the
    scatter is that about parabolas through neighbours.
    """
    squares, freedom = 0.0, 0.0
    apart: list[float] = []
    for group in np.unique(data.inputs.group):
        members = np.flatnonzero(data.inputs.group == group)
        order = members[np.argsort(data.inputs.log_speed[members], kind="stable")]
        y = data.log_torque[order]
        valley, hump = (_about_one_turn(y, first_rises) for first_rises in (False, True))
        best = hump if hump < _HUMP * valley and y.size >= _BOTH else valley
        squares += best
        freedom += _freedom(y.size)
        apart += _about_parabolas(data, levels_of_speed(data.inputs.log_speed, members, SAME_SPEED))
    scatter = float(np.sqrt(squares / max(freedom, 1.0)))
    if len(apart) >= _ENOUGH:
        scatter = max(scatter, float(np.median(apart)) / MEDIAN_MAGNITUDE)
    return max(scatter, _LEAST_SCATTER), max(freedom, 2.0)


def _about_parabolas(data: Observations, levels: list[IntArray]) -> list[float]:
    """How far four neighbouring speeds lie off a parabola, as a standard deviation of dwells."""
    if len(levels) < 4:
        return []
    z = np.array([float(np.mean(data.inputs.log_speed[level])) for level in levels])
    y = np.array([float(np.mean(data.log_torque[level])) for level in levels])
    repeats = float(np.mean([level.size for level in levels]))
    return [float(abs(each)) for each in off_parabolas(z, y[None, :])[0] * np.sqrt(repeats)]
