"""A law fitted again to some of its dwells: each part of them excluded in turn, or clusters drawn anew.

All these fits go together: each counts the dwells of its own so many times, the others not at all.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.reduced_search import ReducedSearch
from hersey.damping.candidates.shared_errors import stated
from hersey.damping.candidates.simultaneous import Minima, minimise_each
from hersey.damping.candidates.visit_effects import VisitColumns
from hersey.errors import InsufficientDataError

#: Resamples tried for one that holds every temperature.
_MOST_TRIES = 300
#: Largest number of parts in which data are excluded in turn.
MOST_FOLDS = 40
#: Relative precision of a fit, and most evaluations of the law for each of its parameters.
_PRECISION, _CALLS = 1e-6, 20
#: Numbers of derivatives that are in memory at once, of all fits that go together.
_TOGETHER = 4_000_000


def left_out(fit: LawFit, data: Observations) -> FloatArray:
    """Return residuals of dwells predicted without their own cluster; NaN where a law cannot say.

    A law with an exponent per temperature cannot predict a temperature that was excluded.
    """
    parts = data.cluster % MOST_FOLDS
    labels = np.unique(parts)
    kept = parts != labels[:, None]
    groups = getattr(fit.law, "groups", 1)
    if groups > 1 and any(np.unique(data.inputs.group[each]).size < groups for each in kept):
        return np.full(len(data), np.nan)
    start = np.tile(np.append(fit.values, fit.effects), (labels.size, 1))
    minima = _refitted(fit, data, start, kept.astype(float), np.zeros((labels.size, fit.effects.size)))
    missed = _residuals(fit, data, minima.values)
    return np.asarray(missed[np.searchsorted(labels, parts), np.arange(len(data))])


def resampled(fit: LawFit, data: Observations, count: int, seed: int) -> FloatArray:
    """Return values fitted to data drawn cluster by cluster with replacement, shape (count, parameters).

    None, shape (0, parameters), where hardly a draw holds all the temperatures that the law has exponents of.
    """
    random = np.random.default_rng(seed)
    labels, cluster = np.unique(data.cluster, return_inverse=True)
    times, expected = np.empty((count, len(data))), np.empty((count, fit.effects.size))
    for row in range(count):
        drawn = _drawn(fit, data, labels.size, cluster, random)
        if drawn is None:
            return np.empty((0, fit.values.size))
        times[row], expected[row] = drawn, random.standard_normal(fit.effects.size)
    starts = _starts(fit)
    each = np.arange(count).repeat(len(starts))
    minima = _refitted(fit, data, np.tile(starts, (count, 1)), times[each], expected[each])
    best = np.argmin(minima.cost.reshape(count, len(starts)), axis=1)
    found = minima.values.reshape(count, len(starts), -1)[np.arange(count), best]
    return np.asarray(found[:, : fit.values.size])


def _drawn(
    fit: LawFit, data: Observations, clusters: int, cluster: IntArray, random: np.random.Generator
) -> IntArray | None:
    """How often each dwell is drawn, with its cluster; None if hardly a draw holds what the law needs."""
    groups = getattr(fit.law, "groups", 1)
    needed = groups if groups > 1 else min(2, data.temperatures.size)
    for _ in range(_MOST_TRIES):
        times = np.bincount(random.integers(0, clusters, clusters), minlength=clusters)[cluster]
        if np.unique(data.inputs.group[times > 0]).size >= needed:
            return times
    return None


def _starts(fit: LawFit) -> FloatArray:
    """Where each search begins, values and effects: at the fit, and of a corner aside of it too."""
    start = np.append(fit.values, fit.effects)
    if not fit.law.broken:
        return start[None]
    aside = np.zeros_like(start)  # the cost has several minima in a corner
    aside[fit.law.index("at")] = min(fit.error("at"), 0.5)
    return np.array([start, start - aside, start + aside])


def _refitted(
    fit: LawFit, data: Observations, start: FloatArray, times: FloatArray, expected: FloatArray
) -> Minima:
    """The likeliest values and effects if dwells count so many ``times``, shape (fits, points)."""
    fewest = int(np.min(np.sum(times, axis=1), initial=np.inf)) + fit.effects.size
    if fewest < start.shape[1]:
        raise InsufficientDataError(f"{fewest} points are too few for {start.shape[1]} parameters")
    together = max(_TOGETHER // ((len(data) + fit.effects.size) * start.shape[1]), 1)
    parts = [
        _minima(fit, data, start[first:last], times[first:last], expected[first:last])
        for first in range(0, len(start), together)
        for last in (first + together,)
    ]
    return Minima(np.concatenate([p.values for p in parts]), np.concatenate([p.cost for p in parts]))


def _minima(
    fit: LawFit, data: Observations, start: FloatArray, times: FloatArray, expected: FloatArray
) -> Minima:
    own = VisitColumns.among(fit.disturbances, data.visit, stated(data))
    if own is not None:
        return _minima_beside(fit, data, own, start, times, expected)
    size, modes, points = fit.values.size, fit.effects.size, len(data)
    prior = np.eye(modes, start.shape[1], size)

    def residual(values: FloatArray, which: IntArray) -> FloatArray:
        return np.hstack([_residuals(fit, data, values) / fit.sigma, values[:, size:] - expected[which]])

    def jacobian(values: FloatArray, _: IntArray) -> FloatArray:
        slopes = np.empty((len(values), points + modes, start.shape[1]))
        slopes[:, :points, :size] = fit.law.jacobian(values[:, :size].T[:, :, None], data.inputs)
        slopes[:, :points, size:] = fit.disturbances
        slopes[:, :points] /= -fit.sigma[:, None]
        slopes[:, points:] = prior
        return slopes

    every = np.hstack([times, np.ones((len(times), modes))])
    return minimise_each(residual, jacobian, start, every, precision=_PRECISION, calls=_CALLS)


def _minima_beside(
    fit: LawFit,
    data: Observations,
    own: VisitColumns,
    start: FloatArray,
    times: FloatArray,
    expected: FloatArray,
) -> Minima:
    """The same where many effects are those of visits: they are no unknowns of the searches."""
    size = fit.values.size
    problem = ReducedSearch(fit.law, data, fit.disturbances, own, fit.sigma, expected, times)
    first = np.hstack([start[:, :size], own.split(start[:, size:])[1]])
    every = np.hstack([times, np.ones((len(times), fit.effects.size))])
    found = minimise_each(
        problem.residual, problem.jacobian, first, every, precision=_PRECISION, calls=_CALLS
    )
    effects = problem.effects(found.values, np.arange(len(start)))
    return Minima(np.hstack([found.values[:, :size], effects]), found.cost)


def _residuals(fit: LawFit, data: Observations, values: FloatArray) -> FloatArray:
    """ln(measured/fitted) of each set of values and effects, effects subtracted, shape (sets, points)."""
    size = fit.values.size
    law = fit.law.predict(values[:, :size].T[:, :, None], data.inputs)
    return np.asarray(data.log_torque - law - values[:, size:] @ fit.disturbances.T)
