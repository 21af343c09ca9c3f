"""Many least-squares problems of one kind at once: the dwells resampled, or some of them excluded.

Each goes its own way by the rules of MINPACK's Levenberg-Marquardt (J. J. Moré, Lect. Notes Math. 630 (1978)
105), as `likelihood.minimise` sends one, and so ends where that would; but a law is evaluated for all of them
in one call.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.damping.candidates.likelihood import FIRST_STEP, HUBER, loss, minimise, share

#: Residuals in standard errors, or their derivatives, of values of problems: (values, which) to shape
#: (problems, residuals) or (problems, residuals, parameters).
OfEach = Callable[[FloatArray, IntArray], FloatArray]
#: Share of the step that was expected from which it is taken, and from which the next is as long or longer.
_TAKEN, _SHORTER, _LONGER = 1e-4, 0.25, 0.75
#: How near the length of a step comes to its limit.
_NEAR = 0.1
#: Rounds in which the damping that makes it so long is found.
_ROUNDS = 10
#: Slope along a parameter, over the greatest that was met, below which a search goes on alone.
_VANISHES = 1e-6
#: Least square of a slope: what a step is divided by, so that its own square is a number.
_LEAST = 1e-150
_SMALL = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Minima:
    """Where the cost of each problem is least."""

    values: FloatArray  #: shape (problems, parameters)
    cost: FloatArray  #: shape (problems,)


def minimise_each(
    residual: OfEach,
    jacobian: OfEach,
    start: FloatArray,
    times: FloatArray,
    *,
    precision: float,
    calls: int,
) -> Minima:
    """Return the values that make the sum of ``times`` `loss` least in each problem, from ``start``.

    Parameters
    ----------
    start
        Shape (problems, parameters).
    times
        How often each residual counts, shape (problems, residuals).
    precision, calls
        As of `likelihood.minimise`.
    """
    effort = {"precision": precision, "calls": calls}
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # of slopes that all but vanish
        searches = _Searches(residual, np.sqrt(times), start, precision, calls * (start.shape[1] + 1))
        running = np.arange(len(start))
        while running.size:
            values = searches.values[running]
            u, root = residual(values, running), searches.root[running]
            slopes = (root * share(u, HUBER))[:, :, None] * jacobian(values, running)
            running = running[~searches.step(running, slopes, root * _shrunk(u))]
        for each in np.flatnonzero(searches.lost).tolist():
            searches.values[each] = _alone(residual, jacobian, start[each], times[each], each, **effort)
        u = residual(searches.values, np.arange(len(start)))
    return Minima(searches.values, np.asarray(np.sum(times * loss(u, HUBER), axis=1)))


def _alone(
    residual: OfEach,
    jacobian: OfEach,
    start: FloatArray,
    times: FloatArray,
    each: int,
    **effort: Any,
) -> FloatArray:
    """One problem by MINPACK itself, which pivots where slopes all but vanish."""
    rows, which = np.repeat(np.arange(times.size), times.astype(np.intp)), np.array([each])
    return minimise(
        lambda values: residual(values[None], which)[0][rows],
        lambda values: jacobian(values[None], which)[0][rows],
        start,
        **effort,
    ).values


def _shrunk(u: FloatArray) -> FloatArray:
    """Residuals whose squares are twice the negative logarithm of their density."""
    return np.asarray(np.where(np.abs(u) <= HUBER, u, np.sign(u) * np.sqrt(loss(u, HUBER))))


def _norm(rows: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(rows, axis=1))


class _Searches:
    """How far each problem has come, arrays of shape (problems, ...)."""

    def __init__(
        self, residual: OfEach, root: FloatArray, start: FloatArray, precision: float, most: int
    ) -> None:
        self.residual, self.root = residual, root  #: root of how often a residual counts
        self.precision, self.most = max(precision, _SMALL), most
        self.values = start.copy()
        self.size = self._size(start, np.arange(len(start)))  #: root of the cost
        self.scale = np.zeros_like(start)  #: of each parameter: the greatest slope that was met
        self.limit = np.full(len(start), np.nan)  #: longest step, in scales
        self.damping = np.zeros(len(start))
        self.calls = np.ones(len(start), dtype=np.intp)
        self.lost = np.zeros(len(start), dtype=bool)  #: whose slopes all but vanish along a parameter

    def _size(self, values: FloatArray, which: IntArray) -> FloatArray:
        return _norm(self.root[which] * _shrunk(self.residual(values, which)))

    def step(self, which: IntArray, slopes: FloatArray, u: FloatArray) -> BoolArray:
        """Move each problem by one step that makes its cost less; return those that are at their end."""
        norms = np.sqrt(np.einsum("brp,brp->bp", slopes, slopes))
        first = np.isnan(self.limit[which])
        begun = np.maximum(self.scale[which], norms)
        self.scale[which] = np.where(first[:, None] & (norms == 0.0), 1.0, begun)
        length = self._length(which)
        longest = FIRST_STEP * np.where(length > 0.0, length, 1.0)
        self.limit[which] = np.where(first, longest, self.limit[which])
        problem = _Linear.of(slopes, u, self.scale[which])
        self.lost[which] = np.any(norms < _VANISHES * self.scale[which], axis=1)
        ends: BoolArray = self.lost[which] | ~np.any(
            problem.gradient, axis=1
        )  # without a slope there is no way on
        waiting = np.flatnonzero(~ends)
        while waiting.size:
            taken, done = self._tried(which[waiting], problem.take(waiting), first[waiting])
            ends[waiting] = done
            waiting = waiting[~(taken | done)]
        return ends

    def _tried(self, mine: IntArray, problem: _Linear, first: BoolArray) -> tuple[BoolArray, BoolArray]:
        """Try a step in each problem; return which have taken it, and which have come to their end."""
        size = self.size[mine]
        step, damping = problem.step(self.limit[mine], self.damping[mine])
        length = _norm(self.scale[mine] * step)
        limit = np.where(first, np.minimum(self.limit[mine], length), self.limit[mine])
        moved = self.values[mine] + step
        there = self._size(moved, mine)
        self.calls[mine] += 1
        actual = np.where(_NEAR * there < size, 1.0 - (there / size) ** 2, -1.0)
        straight = (_norm(problem.along(step)) / size) ** 2
        damped = damping * (length / size) ** 2
        expected = straight + 2.0 * damped
        ratio = np.divide(actual, expected, out=np.zeros_like(actual), where=expected != 0.0)
        shorter = _shortened(actual, -(straight + damped), _NEAR * there >= size)
        limit, damping = _limited(ratio, shorter, limit, length, damping)
        self.limit[mine], self.damping[mine] = limit, damping
        taken = ratio >= _TAKEN
        self.values[mine[taken]], self.size[mine[taken]] = moved[taken], there[taken]
        flat = (np.abs(actual) <= self.precision) & (expected <= self.precision) & (0.5 * ratio <= 1.0)
        near = limit <= self.precision * self._length(mine)
        return taken, flat | near | (self.calls[mine] >= self.most)

    def _length(self, which: IntArray) -> FloatArray:
        """Length of the values, in scales."""
        return _norm(self.scale[which] * self.values[which])


def _shortened(actual: FloatArray, slope: FloatArray, worse: BoolArray) -> FloatArray:
    """By what a step is shortened that gained less than expected."""
    less = np.where(actual >= 0.0, 0.5, 0.5 * slope / (slope + 0.5 * actual))
    return np.where(worse | ~(less >= _NEAR), _NEAR, less)


def _limited(
    ratio: FloatArray, less: FloatArray, limit: FloatArray, length: FloatArray, damping: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """How long the next step may be, and its damping."""
    shorter, longer = ratio <= _SHORTER, (damping == 0.0) | (ratio >= _LONGER)
    more = np.where(longer, 2.0 * length, limit)
    limit = np.where(shorter, less * np.minimum(limit, 10.0 * length), more)
    return limit, np.where(shorter, damping / less, np.where(longer, 0.5 * damping, damping))


@dataclass(frozen=True)
class _Linear:
    """The linear problem of each: triangular ``factor`` and ``right`` side of its slopes in scales."""

    factor: FloatArray  #: shape (problems, parameters, parameters)
    right: FloatArray  #: shape (problems, parameters)
    gradient: FloatArray  #: in scales
    scale: FloatArray
    full: BoolArray  #: whether every parameter has a slope, shape (problems,)

    @classmethod
    def of(cls, slopes: FloatArray, u: FloatArray, scale: FloatArray) -> _Linear:
        scaled, parameters = slopes / scale[:, None, :], scale.shape[1]
        flat, rows = ~np.any(scaled, axis=1), np.concatenate([scaled, u[:, :, None]], axis=2)
        if np.any(flat):  # held by a row of its own: without a slope it would take the place of another
            holds = np.eye(parameters, parameters + 1) * flat[:, :, None]
            rows = np.concatenate([rows, holds], axis=1)
        both: FloatArray = np.linalg.qr(rows, mode="r")  # type: ignore[assignment]
        factor, right = both[:, :parameters, :parameters], both[:, :parameters, parameters]
        return cls(factor, right, np.einsum("brp,br->bp", scaled, u), scale, ~np.any(flat, axis=1))

    def take(self, index: IntArray) -> _Linear:
        return _Linear(
            self.factor[index], self.right[index], self.gradient[index], self.scale[index], self.full[index]
        )

    def along(self, step: FloatArray) -> FloatArray:
        """Return how a step changes the residuals, as long as the law is straight."""
        return np.asarray(np.einsum("bij,bj->bi", self.factor, self.scale * step))

    def step(self, limit: FloatArray, damping: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the best step of each that is no longer than its limit, and the damping that makes it so."""
        step = self._undamped()
        length = np.nan_to_num(_norm(step), nan=np.inf)
        long = np.flatnonzero(length > (1.0 + _NEAR) * limit)
        found = np.zeros_like(damping)
        if long.size:
            step[long], found[long] = self.take(long)._damped(limit[long], damping[long], length[long])
        return -step / self.scale, found

    def _undamped(self) -> FloatArray:
        """The step to the minimum of the linear problem; nothing along what has no slope."""
        flat = np.diagonal(self.factor, axis1=1, axis2=2) == 0.0
        factor = self.factor + np.eye(flat.shape[1]) * flat[:, None, :]
        return np.asarray(np.linalg.solve(factor, np.where(flat, 0.0, self.right)[:, :, None])[:, :, 0])

    def _damped(
        self, limit: FloatArray, damping: FloatArray, length: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The step of about the length of its limit, by Newton's method on the damping."""
        left, singular, axes = np.linalg.svd(self.factor)
        shape = _Damped(singular**2, singular * np.einsum("bij,bi->bj", left, self.right))
        bounded = self.full & np.isfinite(length)  # a slope that all but vanishes bounds no damping
        low = np.where(bounded, (length - limit) / limit / shape.falls(np.zeros_like(limit)), 0.0)
        slope = _norm(self.gradient)
        high = slope / limit
        damping = np.minimum(np.maximum(damping, low), high)
        damping = np.where(damping == 0.0, slope / length, damping)
        done, before = np.zeros(limit.size, dtype=bool), length - limit
        for _ in range(_ROUNDS):
            damping = np.where(damping == 0.0, np.maximum(1e-300, 1e-3 * high), damping)
            off = shape.length(damping) - limit
            done |= (np.abs(off) <= _NEAR * limit) | ((low == 0.0) & (off <= before) & (before < 0.0))
            if np.all(done):
                break
            low = np.where(off > 0.0, np.maximum(low, damping), low)
            high = np.where(off < 0.0, np.minimum(high, damping), high)
            next_ = np.maximum(low, damping + off / limit / shape.falls(damping))
            damping, before = np.where(done, damping, next_), off
        return np.einsum("bji,bj->bi", axes, shape.along(damping)), damping


@dataclass(frozen=True)
class _Damped:
    """A damped step along the axes of the squares of the slopes: by ``values`` and gradient there."""

    values: FloatArray
    gradient: FloatArray

    def along(self, damping: FloatArray) -> FloatArray:
        return self.gradient / self._shifted(damping)

    def length(self, damping: FloatArray) -> FloatArray:
        return _norm(self.along(damping))

    def falls(self, damping: FloatArray) -> FloatArray:
        """Return by how much the length falls with damping, relative."""
        share = self.along(damping) / self.length(damping)[:, None]
        return np.asarray(np.sum(share**2 / self._shifted(damping), axis=1))

    def _shifted(self, damping: FloatArray) -> FloatArray:
        return np.maximum(self.values + damping[:, None], _LEAST)
