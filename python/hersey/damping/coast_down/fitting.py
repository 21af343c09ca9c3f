"""One law of friction fitted to the speeds of all coasts, each with a first speed of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.damping.coast_down.closed_form import speeds
from hersey.damping.coast_down.noise import Noise, covariance_of_fit, noise_of
from hersey.damping.distributions import ratio_above
from hersey.log.counters import step_of_levels
from hersey.log.white_noise import BEND_OF_NOISE

#: Coefficients of the deceleration: constant, linear and quadratic in speed.
TERMS = 3
#: A step this many times the scatter of the rows is not hidden by noise.
_COARSE = 1.0
#: Steps of a coarse reading in a block at the most, and blocks of a coast that are wanted.
_STEPS, _BLOCKS = 4, 40
#: Relative change at which the search ends.
_TOLERANCE = 1e-12


@dataclass(frozen=True)
class Trace:
    """Speed of a coast against time from its first row, both of shape (rows,).

    ``blocks`` are the first rows of blocks whose means are fitted; every row counts alone if it is empty.
    """

    time: FloatArray
    speed: FloatArray
    blocks: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.intp))


@dataclass(frozen=True)
class Additions:
    """Small additions to a fit, in directions that neither each other nor the fit can replace.

    ``values`` and ``covariance`` are of these directions, ``back`` turns additions into them.
    """

    values: FloatArray
    covariance: FloatArray
    back: FloatArray
    noise: Noise

    def p_value(self, freedom: float) -> float:
        """Return the probability that chance makes them as large."""
        distance = float(self.values @ np.linalg.solve(self.covariance, self.values)) / self.values.size
        return float(ratio_above(distance, self.values.size, freedom))

    def own(self) -> tuple[FloatArray, FloatArray]:
        """Return the additions themselves and their covariance."""
        turn = np.linalg.pinv(self.back)
        return turn @ self.values, turn @ self.covariance @ turn.T


@dataclass(frozen=True)
class CoastFit:
    """A law fitted to coasts.

    Attributes
    ----------
    law
        Coefficients of the deceleration, shape (3,), 0 for a term that is not in the law.
    first
        First speed of each coast, shape (coasts,).
    covariance
        Of the coefficients, shape (3, 3), for the noise as it is.
    noise
        Noise of the rows, or of the angle where speeds are differences of it.
    of_angle
        Whether the sums of the speeds were fitted.
    """

    law: FloatArray
    first: FloatArray
    covariance: FloatArray
    noise: Noise
    of_angle: bool
    traces: tuple[Trace, ...]

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the errors, which the rows near the ends of the coasts decide."""
        return max((self.noise.effective_rows - TERMS - self.first.size) / TERMS, 1.0)

    def predicted(self, coast: int, time: FloatArray) -> FloatArray:
        """Return the speed of a coast at times after its first row."""
        return speeds(self.law, float(self.first[coast]), time)[0]

    def added(self, extra: Sequence[FloatArray]) -> Additions:
        """Return what small additions to the fit would be.

        ``extra`` is the change of speed by each addition, shape (rows, additions) for each coast.
        """
        columns, rest = _linear(self.traces, self.law, self.first, np.ones(TERMS, dtype=bool), self.of_angle)
        new = [whole(each, trace, self.of_angle) for each, trace in zip(extra, self.traces, strict=True)]
        own, plain = np.linalg.qr(np.vstack(columns))[0], np.vstack(new)
        plain = plain - own @ (own.T @ plain)  # what the law cannot do
        turned, back = np.linalg.qr(plain - own @ (own.T @ plain))
        left = np.concatenate(rest)
        left = left - own @ (own.T @ left)
        values = turned.T @ left
        left = left - turned @ values
        ends = np.cumsum([each.size for each in rest])[:-1]
        parts = np.split(left, ends)
        noise = noise_of(parts, own.shape[1] + values.size)
        return Additions(values, covariance_of_fit(np.split(turned, ends), parts, noise), back, noise)


def fit_coasts(traces: Sequence[Trace], terms: Sequence[bool] = (True,) * TERMS) -> CoastFit:
    """Fit a law to coasts; terms that are not in it are 0.

    Speeds whose errors alternate are differences of an angle: their sums are fitted then, whose errors are
    independent.
    """
    free = np.array(terms, dtype=bool)
    law, first = _start(traces, free)
    law, first = _searched(traces, law, first, free, of_angle=False)
    columns, rest = _linear(traces, law, first, free, of_angle=False)
    parameters = int(free.sum()) + len(traces)
    noise = noise_of(rest, parameters)
    of_angle = noise.is_differenced
    coarse = None if of_angle else in_steps(traces)
    if coarse is not None:
        return fit_coasts(coarse, terms)
    if of_angle:
        law, first = _searched(traces, law, first, free, of_angle=True)
        columns, rest = _linear(traces, law, first, free, of_angle=True)
        noise = noise_of(rest, parameters + len(traces))
    covariance = np.zeros((TERMS, TERMS))
    count = int(free.sum())
    covariance[np.ix_(free, free)] = covariance_of_fit(columns, rest, noise)[:count, :count]
    return CoastFit(law, first, covariance, noise, of_angle, tuple(traces))


def within_physics(fit: CoastFit) -> tuple[FloatArray, float]:
    """Return the coefficients, none negative, nearest to a fit by its errors, and the distance squared."""
    if (fit.law >= 0).all():
        return fit.law, 0.0
    scale = np.sqrt(np.diag(fit.covariance))
    weight = np.linalg.pinv(fit.covariance / np.outer(scale, scale), hermitian=True)
    best, least = np.zeros(TERMS), np.inf
    for kept in product((True, False), repeat=TERMS):
        free = np.array(kept)
        held = ~free
        shift = np.zeros(TERMS)
        shift[held] = -fit.law[held] / scale[held]
        if free.any():  # the others follow those that are held
            inside = weight[np.ix_(free, free)]
            shift[free] = np.linalg.solve(inside, -weight[np.ix_(free, held)] @ shift[held])
        law, distance = fit.law + shift * scale, float(shift @ weight @ shift)
        if (law >= -1e-12 * np.abs(fit.law)).all() and distance < least:
            best, least = np.maximum(law, 0.0), distance
    return best, least


def in_steps(traces: Sequence[Trace]) -> tuple[Trace, ...] | None:
    """Return coasts with blocks over whole steps of a coarse reading; None if noise hides the steps.

    The error of a coarse reading repeats with each step. It averages out over whole steps, and is no noise
    within one.
    """
    step = step_of_levels(np.concatenate([trace.speed for trace in traces]))
    bends = [np.diff(trace.speed, 2) for trace in traces]
    scatter = float(np.median(np.abs(np.concatenate(bends)))) / BEND_OF_NOISE
    if not step or step < _COARSE * scatter or any(trace.blocks.size for trace in traces):
        return None
    drop = min(float(trace.speed[0] - trace.speed[-1]) for trace in traces)
    whole = float(np.clip(drop / step // _BLOCKS, 1, _STEPS)) * step
    return tuple(replace(trace, blocks=_blocks(trace.speed, whole)) for trace in traces)


def _blocks(speed: FloatArray, size: float) -> IntArray:
    """First rows of blocks, each of which begins where speed has fallen by so much."""
    starts, level = [0], speed[0]
    below = np.minimum.accumulate(speed)
    while True:
        level -= size
        row = int(np.searchsorted(-below, -level - 1e-9 * size, side="left"))
        if row >= speed.size:
            return np.array(starts[:-1] if len(starts) > 2 else starts, dtype=np.intp)
        if row > starts[-1]:
            starts.append(row)


def _start(traces: Sequence[Trace], free: BoolArray) -> tuple[FloatArray, FloatArray]:
    """First values, from slopes over parts of each coast."""
    rate, at, weight = [], [], []
    for trace in traces:
        for part in np.array_split(np.arange(trace.time.size), min(12, max(2, trace.time.size // 8))):
            t = trace.time[part] - trace.time[part].mean()
            if part.size < 2 or not np.any(t):
                continue
            rate.append(-float(t @ trace.speed[part] / (t @ t)))
            at.append(float(trace.speed[part].mean()))
            weight.append(float(np.sqrt(t @ t)))
    w, d, p = np.array(at), np.array(rate), np.array(weight)
    top = w.max()
    basis = np.stack([np.ones(w.size), w / top, (w / top) ** 2], axis=-1) * free
    from scipy.optimize import nnls

    values, _ = nnls(basis * p[:, None], d * p)
    law = values / top ** np.arange(TERMS)
    return law, np.array([trace.speed[: max(1, trace.time.size // 50)].mean() for trace in traces])


def _searched(
    traces: Sequence[Trace], law: FloatArray, first: FloatArray, free: BoolArray, *, of_angle: bool
) -> tuple[FloatArray, FloatArray]:
    from scipy.optimize import least_squares

    top = float(first.max())
    scale = np.concatenate([(1.0 / top ** np.arange(TERMS))[free], np.ones(first.size)])
    kept = int(free.sum())

    def split(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        values = np.zeros(TERMS)
        values[free] = (x * scale)[:kept]
        return values, x[kept:]

    def residual(x: FloatArray) -> FloatArray:
        return np.asarray(-np.concatenate(_linear(traces, *split(x), free, of_angle)[1]))

    def jacobian(x: FloatArray) -> FloatArray:
        return np.asarray(np.vstack(_linear(traces, *split(x), free, of_angle)[0]) * scale)

    begin = np.concatenate([law[free], first]) / scale
    size = _TOLERANCE
    found = least_squares(residual, begin, jacobian, x_scale="jac", ftol=size, xtol=size, gtol=size)
    return split(found.x)


def _linear(
    traces: Sequence[Trace], law: FloatArray, first: FloatArray, free: BoolArray, of_angle: bool
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Derivatives by the coefficients that are free and all first speeds, and what is left, per coast."""
    columns, rest = [], []
    for index, trace in enumerate(traces):
        speed, by = speeds(law, float(first[index]), trace.time)
        own = np.zeros((trace.time.size, len(traces)))
        own[:, index] = by[:, TERMS]
        columns.append(whole(np.hstack([by[:, :TERMS][:, free], own]), trace, of_angle))
        rest.append(whole((trace.speed - speed)[:, None], trace, of_angle)[:, 0])
    return columns, rest


def whole(columns: FloatArray, trace: Trace, of_angle: bool) -> FloatArray:
    """Return columns of speeds, of their means over blocks, or of the angles that they sum up to."""
    if not of_angle and trace.blocks.size:
        rows = np.diff(np.append(trace.blocks, columns.shape[0]))
        return np.asarray(np.add.reduceat(columns, trace.blocks, axis=0) / rows[:, None])
    if not of_angle:
        return columns
    steps = np.diff(trace.time, prepend=2.0 * trace.time[0] - trace.time[1])  # of which rows are the ends
    summed = np.cumsum(columns * steps[:, None], axis=0)
    return np.asarray(summed - summed.mean(axis=0))
