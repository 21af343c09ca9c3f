"""Effects of many visits, eliminated from a search and from the algebra after it.

Given the law, the likeliest effect of a visit depends on its own dwells alone, so that it need not be
searched for (Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973) 413). The time of a search then grows with the
dwells, not with the dwells times the square of the visits.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.damping.candidates.likelihood import HUBER, influence

#: Visits from which on their effects are eliminated; a search over fewer takes less time as it is.
MANY = 24
#: Rounds in which the likeliest effect is found: of outlying dwells, whose cost is not a square.
_ROUNDS = 100


@dataclass(frozen=True)
class Visits:
    """Which visit each dwell belongs to, from 0, shape (points,)."""

    label: IntArray

    @classmethod
    def many(cls, visit: IntArray) -> Visits | None:
        """Return the visits of dwells, None if they are few."""
        labels, label = np.unique(visit, return_inverse=True)
        return cls(np.asarray(label, dtype=np.intp)) if labels.size >= MANY else None

    @cached_property
    def count(self) -> int:
        """How many visits there are."""
        return int(self.label.max()) + 1

    @cached_property
    def _order(self) -> tuple[IntArray | None, IntArray]:
        """Dwells by their visit, None if they are in that order, and the first one of each visit."""
        order = None if np.all(np.diff(self.label) >= 0) else np.argsort(self.label, kind="stable")
        sorted_ = self.label if order is None else self.label[order]
        return order, np.searchsorted(sorted_, np.arange(self.count))

    def sums(self, values: FloatArray, axis: int = -1) -> FloatArray:
        """Return the sums over the dwells of each visit, along an axis of dwells."""
        order, first = self._order
        sorted_ = values if order is None else np.take(values, order, axis=axis)
        return np.asarray(np.add.reduceat(sorted_, first, axis=axis))

    def likeliest(
        self, off: FloatArray, by: FloatArray, centre: FloatArray, times: FloatArray | float = 1.0
    ) -> FloatArray:
        """Return the effects that make the cost of their dwells and of themselves least, shape (..., visits).

        Parameters
        ----------
        off
            Residuals in standard errors, no effect of a visit subtracted, shape (..., points).
        by
            By how much an effect moves them, shape (points,).
        centre
            Expectation of the effects, shape (..., visits).
        times
            How often each dwell counts, shape (..., points).
        """
        counted = times * by
        effects = (self.sums(counted * off) + centre) / (self.sums(counted * by) + 1.0)
        low, high = np.full(effects.shape, -np.inf), np.full(effects.shape, np.inf)
        # the side of Huber's limit that each was on before the last step: Newton's is exact if all stay there
        side, own_side = np.zeros(off.shape), np.zeros(effects.shape)
        straight: BoolArray = np.ones(effects.shape, dtype=bool)
        for _ in range(_ROUNDS):
            u, beside = off - by * effects[..., self.label], effects - centre
            now, own_now = _side(u), _side(beside)
            moves = (self.sums(1.0 * (now != side)) > 0) | (own_now != own_side) | ~straight
            if not np.any(moves):
                break
            side, own_side = now, own_now
            fall = np.where(moves, self.sums(counted * influence(u, HUBER)) - influence(beside, HUBER), 0.0)
            low, high = np.where(fall > 0.0, effects, low), np.where(fall < 0.0, effects, high)
            steep = self.sums(counted * by * (side == 0.0)) + (own_side == 0.0)
            newton = effects + fall / np.where(steep > 0.0, steep, 1.0)
            straight = (fall == 0.0) | ((steep > 0.0) & (low < newton) & (newton < high))
            slow = self._slow(u, beside, counted * by)
            effects = np.where(straight, newton, _safe(effects, fall, low, high, slow))
        return effects

    def _slow(self, u: FloatArray, beside: FloatArray, squares: FloatArray) -> FloatArray:
        """A slope that no slope of the cost exceeds: a step by it never goes too far."""
        weight = HUBER / np.maximum(np.abs(u), HUBER)
        return np.asarray(self.sums(squares * weight) + HUBER / np.maximum(np.abs(beside), HUBER))


def _side(u: FloatArray) -> FloatArray:
    """0 within Huber's limit, else the sign."""
    return np.asarray(np.sign(u) * (np.abs(u) > HUBER))


def _safe(
    effects: FloatArray, fall: FloatArray, low: FloatArray, high: FloatArray, slope: FloatArray
) -> FloatArray:
    """A step where Newton's leaves the bracket: to its middle, or a careful one while it is open."""
    bounded = np.isfinite(low) & np.isfinite(high)
    middle = 0.5 * (np.where(bounded, low, 0.0) + np.where(bounded, high, 0.0))
    return np.where(bounded, middle, effects + fall / slope)


@dataclass(frozen=True)
class VisitColumns:
    """The disturbances that are those of visits: ``first`` to ``last`` of all, one for each visit."""

    visits: Visits
    size: FloatArray  #: by how much the effect of its visit moves each ln torque, shape (points,)
    first: int
    last: int

    @classmethod
    def among(cls, columns: FloatArray, visit: IntArray, known: int) -> VisitColumns | None:
        """Return those among the disturbances of dwells, if they are many; ``known`` come before them."""
        if columns.shape[1] < known + MANY:
            return None
        visits = Visits.many(visit)
        if visits is None or columns.shape[1] < known + visits.count:  # runs are fewer than visits
            return None
        size = columns[np.arange(visit.size), known + visits.label]
        return cls(visits, size, known, known + visits.count)

    def others(self, columns: FloatArray) -> FloatArray:
        """Return the other disturbances."""
        return np.delete(columns, slice(self.first, self.last), axis=1)

    def freed(self, rows: FloatArray, sigma: FloatArray) -> FloatArray:
        """Return weighted rows of dwells whose squares are those that likeliest effects of visits leave."""
        by, label = self.size / sigma, self.visits.label
        root = np.sqrt(1.0 + self.visits.sums(by**2))
        share = self.visits.sums(by[:, None] * rows, axis=0) / (root * (1.0 + root))[:, None]
        return np.asarray(rows - by[:, None] * share[label])

    def split(self, effects: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the effects of visits and the others, along the last axis."""
        own = effects[..., self.first : self.last]
        return own, np.delete(effects, slice(self.first, self.last), axis=-1)

    def joined(self, own: FloatArray, others: FloatArray) -> FloatArray:
        """Return all effects in their order, the reverse of `split`."""
        return np.concatenate([others[..., : self.first], own, others[..., self.first :]], axis=-1)


@dataclass(frozen=True)
class Integrated:
    """Effects of visits and others, whose prior is the standard normal distribution, integrated out."""

    visits: Visits
    deviation: float  #: by how much the effect of a visit moves its dwells
    others: FloatArray  #: by how much the other effects move each dwell, shape (points, others)

    def __call__(self, residuals: FloatArray, variance: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Return what `likelihood.deviance` integrates."""
        weight, label = 1.0 / variance, self.visits.label
        diagonal = 1.0 + self.deviation**2 * self.visits.sums(weight)
        sums = self.deviation * self.visits.sums(weight * residuals)
        weighted = weight[:, None] * self.others
        share = self.deviation * self.visits.sums(weighted, axis=0)
        normal = np.eye(self.others.shape[1]) + self.others.T @ weighted
        normal -= share.T @ (share / diagonal[:, None])
        border = np.linalg.solve(normal, weighted.T @ residuals - share.T @ (sums / diagonal))
        own = (sums - share @ border) / diagonal
        common = self.deviation * own[label] + self.others @ border
        inflation = float(np.sum(np.log(diagonal)) + np.linalg.slogdet(normal)[1])
        return common, np.append(own, border), inflation
