"""Normal equations of a law with an effect for each visit: a diagonal, bordered by everything else.

What a fit reports of them (covariances, what the effects take up) needs only the inverse of the border's
complement (Schur): it has as many rows as the law and the other disturbances have numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.clustered import alike, pushes_of, robust_residuals
from hersey.damping.candidates.visit_effects import Visits


@dataclass(frozen=True)
class Bordered:
    """Slopes of residuals in standard errors, weighted, of the law and of all effects."""

    visits: Visits
    border: FloatArray  #: by values and other effects, shape (points, border)
    by_visit: FloatArray  #: by the effect of the visit of each dwell, shape (points,)
    prior: FloatArray  #: rows of the priors of the other effects, shape (others, border)
    own_prior: FloatArray  #: of the priors of the effects of visits, shape (visits,)

    @cached_property
    def diagonal(self) -> FloatArray:
        """Squares of the slopes by each effect of a visit."""
        return self.visits.sums(self.by_visit**2) + self.own_prior**2

    @cached_property
    def share(self) -> FloatArray:
        """By how much an effect of a visit falls as a number of the border rises, shape (visits, border)."""
        sums = self.visits.sums(self.by_visit[:, None] * self.border, axis=0)
        return np.asarray(sums / self.diagonal[:, None])

    @cached_property
    def left(self) -> FloatArray:
        """Slopes of the dwells by the border, effects of visits following, shape (points, border)."""
        return np.asarray(self.border - self.by_visit[:, None] * self.share[self.visits.label])

    @cached_property
    def priors(self) -> FloatArray:
        """What the priors of all effects add to the squares of these slopes."""
        own = self.own_prior[:, None] * self.share
        return np.asarray(self.prior.T @ self.prior + own.T @ own)

    @cached_property
    def inverse(self) -> FloatArray:
        """Covariance of values and other effects."""
        complement = self.left.T @ self.left + self.priors
        return np.asarray(np.linalg.pinv(complement, rcond=1e-14), dtype=np.float64)

    def taken_up(self, size: int) -> float:
        """Return how many degrees of freedom all effects take up, of a law of so many values."""
        variances = 1.0 / self.diagonal + np.sum((self.share @ self.inverse) * self.share, axis=1)
        effects = self.diagonal.size + self.border.shape[1] - size
        return float(effects - np.sum(variances) - np.trace(self.inverse[size:, size:]))

    def gains(self, size: int) -> FloatArray:
        """Return by how much each residual moves the values, shape (size, points)."""
        return np.asarray(self.inverse[:size] @ self.left.T)

    def clustered(self, u: FloatArray, cluster: IntArray, size: int) -> FloatArray:
        """Return the covariance of the values whatever the dwells of a cluster have in common (CR3)."""
        residuals, pushes = robust_residuals(u), []
        gains = self.gains(size).T
        for of in alike(cluster):
            rows, own, label = self.left[of], self.by_visit[of], self.visits.label[of]
            together = own[:, :, None] * own[:, None, :] / self.diagonal[label][:, :, None]
            hat = rows @ self.inverse @ rows.swapaxes(1, 2)
            hat += np.where(label[:, :, None] == label[:, None, :], together, 0.0)
            pushes.append(pushes_of(gains[of], hat, residuals[of]))
        moved = np.vstack(pushes)
        shrink = (len(moved) - 1) / len(moved)
        by_prior = self.inverse[:size] @ self.priors @ self.inverse[:size].T
        return np.asarray(shrink * moved.T @ moved + by_prior)
