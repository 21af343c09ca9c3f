"""Where the posterior of what all specimens share is highest under each law, and how wide it is there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.life.growth.laws import Law
from hersey.life.growth.marginal import likelihood, modes, weights_of
from hersey.life.growth.points import Points

#: Prior mean and standard deviation of m1 = E ln(r T). m0 is flat.
RATE_PRIOR = (-0.5, 2.0)
#: Medians of the priors of the spreads of level and rate, and standard deviations of their logarithms.
LEVEL_SPREAD, RATE_SPREAD = (0.1, 1.2), (0.3, 0.8)
#: Greatest logarithm of a spread: 4 and 4.6 deviations of the priors; beyond it likelihoods are not sound.
_WIDEST = 2.5
#: Scale of the half-normal prior of the scatter of runs.
RUN_SCATTER = 0.1
#: Specimens whose mode is sought before that of all.
_FIRST = 40
#: How much worse, in ln evidence, a law may fit to be drawn from at all.
_HOPELESS = 25.0
#: Steps to the mode at the most, and the longest.
_STEPS, _STRIDE = 25, 2.0
#: Shares of a step that are tried.
_FRACTIONS = np.array([1.0, 0.5, 0.2, 0.05, 0.01, 0.0])
#: How well m0 and m1 are known at best, about.
_KNOWN = (0.02, 0.1)
#: Least number that is divided by.
_LEAST = 1e-300
#: Log density that stands for none where slopes are taken.
_NOTHING = -1e6


def _half_normal(logs: FloatArray, scale: float) -> FloatArray:
    """Log density of the logarithm of a half-normal number."""
    return 0.5 * math.log(2.0 / math.pi) - math.log(scale) + logs - 0.5 * np.exp(2.0 * logs) / scale**2


def _normal(values: FloatArray, mean: float, deviation: float) -> FloatArray:
    return -0.5 * ((values - mean) / deviation) ** 2 - math.log(deviation * math.sqrt(2.0 * math.pi))


def _log_normal(logs: FloatArray, median: float, deviation: float) -> FloatArray:
    """Log density of the logarithm of a lognormal number."""
    return _normal(logs, math.log(median), deviation)


def shared_of(
    law: Law, coordinates: FloatArray, middle: FloatArray | None, units: int
) -> tuple[FloatArray, FloatArray]:
    """Return what all specimens share, and the log of the Jacobian, from coordinates without a funnel.

    The means m0 and m1 are known the worse, the more specimens differ: they are counted from a middle in what
    so many specimens tell of them. Without a middle they are what all specimens share.
    """
    if middle is None:
        return coordinates, np.zeros(len(coordinates))
    shared = coordinates.copy()
    scales = np.sqrt(np.exp(2.0 * coordinates[:, 1]) / units + _KNOWN[0] ** 2)
    shared[:, 0] = middle[0] + scales * coordinates[:, 0]
    jacobian = np.log(scales)
    if law.grows:
        precision = 1.0 / (np.exp(2.0 * coordinates[:, 4]) / units + _KNOWN[1] ** 2) + RATE_PRIOR[1] ** -2
        shared[:, 3] = middle[1] + coordinates[:, 3] / np.sqrt(precision)
        jacobian -= 0.5 * np.log(precision)
    return shared, jacobian


def log_posterior(
    law: Law, points: Points, coordinates: FloatArray, middle: FloatArray | None, start: FloatArray
) -> FloatArray:
    """Return the likelihood times priors over coordinates; far outside any sense it is nothing."""
    total = np.full(len(coordinates), -np.inf)
    near: BoolArray = np.asarray((np.abs(coordinates) < 40.0).all(axis=1))
    shared, jacobian = shared_of(law, np.where(near[:, None], coordinates, 0.0), middle, len(points.value))
    sane = near & np.asarray((np.abs(shared[:, 1:3]) < 20.0).all(axis=1)) & (shared[:, 1] < _WIDEST)
    if law.grows:
        sane &= np.asarray((np.abs(shared[:, 3:5]) < 20.0).all(axis=1)) & (shared[:, 4] < _WIDEST)
    for i, (_, mean, deviation) in enumerate(law.shapes, 5):
        sane &= np.abs(shared[:, i] - mean) < 6.0 * deviation
    held = shared[sane]
    if not len(held):
        return total
    density = _log_normal(held[:, 1], *LEVEL_SPREAD) + _half_normal(held[:, 2], RUN_SCATTER)
    if law.grows:
        density += _normal(held[:, 3], *RATE_PRIOR) + _log_normal(held[:, 4], *RATE_SPREAD)
    for i, (_, mean, deviation) in enumerate(law.shapes, 5):
        density += _normal(held[:, i], mean, deviation)
    total[sane] = density + jacobian[sane] + likelihood(law, points, held, start)
    return np.where(np.isfinite(total), total, -np.inf)


def first_guess(law: Law, points: Points) -> tuple[FloatArray, FloatArray]:
    """What all share, and sizes of the specimens, from lines through each specimen."""
    number = points.given.sum(axis=1)
    mean_age = (points.age * points.given).sum(axis=1) / number
    mean = (points.value * points.given).sum(axis=1) / number
    away = (points.age - mean_age[:, None]) * points.given
    square = (away**2).sum(axis=1)
    slope = (away * points.value).sum(axis=1) / np.where(square > 0, square, 1.0)
    pooled = (away * points.value).sum() / max(square.sum(), _LEAST)
    slope = np.where(square > 0, slope, pooled) if law.grows else np.zeros(len(number))
    left = (points.value - mean[:, None] - slope[:, None] * away) * points.given
    scatter = max(math.sqrt((left**2).sum() / max(number.sum() - 2 * len(number), 1)), 1e-3)
    level = mean - slope * mean_age
    spread = max(float(np.std(level)), 0.05)
    size = np.log(np.maximum(slope, 0.02))
    guess = [level.mean(), math.log(spread), math.log(min(scatter, 0.3))]
    if law.grows:
        guess += [size.mean(), math.log(max(float(np.std(size)), 0.1))]
    return np.array([*guess, *(mean for _, mean, _ in law.shapes)]), size


def _derivatives(
    law: Law, points: Points, at: FloatArray, middle: FloatArray | None, start: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Gradient of the log posterior and the covariance that its curvature gives, by central differences."""
    number, step = at.size, 0.03
    unit = np.eye(number) * step
    pairs = [(i, j) for i in range(number) for j in range(i)]
    spots = [at, *(at + unit), *(at - unit)]
    spots += [at + unit[i] + unit[j] for i, j in pairs] + [at - unit[i] - unit[j] for i, j in pairs]
    found = np.maximum(log_posterior(law, points, np.array(spots), middle, start), _NOTHING)
    here, up, down = found[0], found[1 : number + 1], found[number + 1 : 2 * number + 1]
    second = np.diag((up - 2 * here + down) / step**2)
    both, neither = np.split(found[2 * number + 1 :], 2)
    for k, (i, j) in enumerate(pairs):
        mixed = both[k] + neither[k] + 2 * here - up[i] - up[j] - down[i] - down[j]
        second[i, j] = second[j, i] = mixed / (2 * step**2)
    values, vectors = np.linalg.eigh(-second)
    return (up - down) / (2 * step), (vectors / np.maximum(np.abs(values), 0.3)) @ vectors.T


def _climbed(law: Law, points: Points, at: FloatArray, sizes: FloatArray) -> tuple[FloatArray, FloatArray]:
    for _ in range(_STEPS):
        if law.grows:
            one = at[None]
            sizes = modes(law, points, one, weights_of(points, one), sizes)[0][0]
        gradient, covariance = _derivatives(law, points, at, None, sizes)
        step = covariance @ gradient
        step *= min(1.0, _STRIDE / max(np.abs(step).max(), _LEAST))
        tried = at + _FRACTIONS[:, None] * step
        best = int(np.argmax(log_posterior(law, points, tried, None, sizes)))
        at = tried[best]
        if np.abs(_FRACTIONS[best] * step).max() < 0.05:
            break
    return at, sizes


@dataclass(frozen=True)
class Peak:
    """The mode of what all specimens share under a law."""

    law: Law
    at: FloatArray
    mode: FloatArray  #: the same in coordinates round the middle
    covariance: FloatArray
    middle: FloatArray
    sizes: FloatArray
    log_evidence: float  #: by a normal law round the mode


def peaks(laws: list[Law], points: Points) -> list[Peak]:
    """Return the modes of the laws that need be drawn from: the others fit hopelessly worse.

    Those of the first specimens come before those of all: they tell where to begin, and what need not be
    tried.
    """
    few = points.part(_FIRST)
    guesses = [first_guess(law, few) for law in laws]
    found = _hopeful([_peak_of(law, few, *guess) for law, guess in zip(laws, guesses, strict=True)])
    if len(few.value) == len(points.value):
        return found
    sizes = {each.law.name: first_guess(each.law, points)[1] for each in found}
    return _hopeful([_peak_of(each.law, points, each.at, sizes[each.law.name]) for each in found])


def _hopeful(found: list[Peak]) -> list[Peak]:
    best = max(each.log_evidence for each in found)
    return [each for each in found if each.log_evidence > best - _HOPELESS]


def _peak_of(law: Law, points: Points, guess: FloatArray, sizes: FloatArray) -> Peak:
    at, sizes = _climbed(law, points, guess, sizes)
    middle = at[[0, 3]] if law.grows else at[:1]
    mode = at.copy()
    mode[[0, 3] if law.grows else [0]] = 0.0
    _, covariance = _derivatives(law, points, mode, middle, sizes)
    height = float(log_posterior(law, points, mode[None], middle, sizes)[0])
    width = 0.5 * (np.linalg.slogdet(covariance)[1] + mode.size * math.log(2.0 * math.pi))
    return Peak(law, at, mode, covariance, middle, sizes, height + float(width))
