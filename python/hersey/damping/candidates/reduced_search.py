"""The problem of a search without the effects of visits: each is the likeliest one given everything else."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.bordered import Bordered
from hersey.damping.candidates.likelihood import HUBER, share
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.visit_effects import VisitColumns


class SearchedLaw(Protocol):
    """What a search asks of a law, of values of one problem or of several."""

    def predict(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return ln torque."""

    def jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return its slopes by the values."""


@dataclass
class ReducedSearch:
    """Residuals and slopes of several problems of one law, of its values and the other effects.

    ``centre`` is what their effects are expected to be, ``times`` how often their dwells count, each of shape
    (problems, ...).
    """

    law: SearchedLaw
    data: Observations
    columns: FloatArray  #: of all disturbances, shape (points, disturbances)
    own: VisitColumns
    sigma: FloatArray
    centre: FloatArray
    times: FloatArray
    _last: tuple[bytes, FloatArray, FloatArray] = field(init=False, default=(b"", np.empty(0), np.empty(0)))

    def __post_init__(self) -> None:
        """Keep what no step moves."""
        self.others = self.own.others(self.columns)
        self.by = self.own.size / self.sigma
        self.own_centre, self.other_centre = self.own.split(self.centre)

    @property
    def _more(self) -> int:
        return int(self.others.shape[1])

    def residual(self, values: FloatArray, which: IntArray) -> FloatArray:
        """Return residuals of the dwells, of the other effects and of those of visits, in standard errors."""
        return self._at(values, which)[0]

    def effects(self, values: FloatArray, which: IntArray) -> FloatArray:
        """Return all effects, in the order of the disturbances."""
        size = values.shape[1] - self._more
        return self.own.joined(self._at(values, which)[1], values[:, size:])

    def _at(self, values: FloatArray, which: IntArray) -> tuple[FloatArray, FloatArray]:
        key = which.tobytes() + values.tobytes()
        if key != self._last[0]:
            size = values.shape[1] - self._more
            fitted = self.law.predict(values[:, :size].T[:, :, None], self.data.inputs)
            off = (self.data.log_torque - fitted - values[:, size:] @ self.others.T) / self.sigma
            effects = self.own.visits.likeliest(off, self.by, self.own_centre[which], self.times[which])
            u = off - self.by * effects[:, self.own.visits.label]
            beside = values[:, size:] - self.other_centre[which], effects - self.own_centre[which]
            self._last = key, np.hstack([u, *beside]), effects
        return self._last[1:]

    def border(self, values: FloatArray) -> FloatArray:
        """Return the slopes of the residuals of dwells, effects of visits held."""
        size = values.shape[1] - self._more
        slopes = np.empty((len(values), len(self.data), values.shape[1]))
        slopes[:, :, :size] = self.law.jacobian(values[:, :size].T[:, :, None], self.data.inputs)
        slopes[:, :, size:] = self.others
        slopes /= -self.sigma[:, None]
        return slopes

    def jacobian(self, values: FloatArray, which: IntArray) -> FloatArray:
        """Return the slopes of `residual`, effects of visits following as a step of all together has them."""
        points, more, size = len(self.data), self._more, values.shape[1] - self._more
        u, border, visits = self.residual(values, which), self.border(values), self.own.visits
        weight = self.times[which] * share(u[:, :points], HUBER) ** 2 * -self.by
        square = visits.sums(weight * -self.by) + share(u[:, points + more :], HUBER) ** 2
        follow = visits.sums(weight[:, :, None] * border, axis=1) / square[:, :, None]
        slopes = np.zeros((*u.shape, values.shape[1]))
        slopes[:, :points] = border + self.by[:, None] * follow[:, visits.label]
        slopes[:, points : points + more] = np.eye(more, values.shape[1], size)
        slopes[:, points + more :] = -follow
        return slopes

    def bordered(self, values: FloatArray) -> Bordered:
        """Return the normal equations of the first problem at its minimum, values of shape (1, ...)."""
        points, more = len(self.data), self._more
        u = self.residual(values, np.zeros(1, dtype=np.intp))[0]
        kept = np.sqrt(HUBER / np.maximum(np.abs(u), HUBER))
        prior = np.eye(more, values.shape[1], values.shape[1] - more) * kept[points : points + more, None]
        border = kept[:points, None] * self.border(values)[0]
        return Bordered(self.own.visits, border, -kept[:points] * self.by, prior, kept[points + more :])
