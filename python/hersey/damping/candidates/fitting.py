"""Fitting one law: errors of torque, speed and temperature, and a scatter between dwells.

Errors of the inputs enter by the effective variance, each times the slope of the law there (Orear, Am. J.
Phys. 50 (1982) 912): exact for a law that is straight over an error bar, and unlike orthogonal distance
regression it leaves a likelihood in which laws can be compared. `errors_in_variables` checks it against
ODRPACK. What dwells share, the error of the zero and the scatter of visits and runs (`shared_errors`), are
disturbances of many dwells together, fitted with their standard errors as prior.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.branched import Law
from hersey.damping.candidates.clustered import clustered_with_prior
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.likelihood import HUBER, aicc, bic, deviance, scatter_beyond
from hersey.damping.candidates.no_load_law import RestLaw
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.searching import Effort, Found, residuals_of, search
from hersey.damping.candidates.shared_errors import (
    Freedom,
    Grouping,
    SharedScatter,
    disturbances,
    freedom_beside,
    freedom_of,
    groupings,
    shared_scatter,
    stated,
)
from hersey.damping.candidates.shared_load import SharedLoadLaw
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.visit_effects import Integrated
from hersey.damping.estimate import Estimate, estimate
from hersey.damping.friction_curve.dwell_law import DwellFriction
from hersey.damping.friction_curve.law import THINNING

AnyLaw = Law | StribeckLaw | ConstantPlusLaw | RestLaw | SharedLoadLaw | DwellFriction

#: Rounds in which scatter and effective variance settle.
_ROUNDS = 8
#: Relative error assumed of a dwell while the search for a start goes on.
_FIRST_SCATTER = 0.03
#: Standard errors of the zero or the rest beyond which a fit is tried from a wide scatter too: of a law that
#: does not hold, an error of the zero by tens of them can make up for a part, and then leaves little scatter.
_STRAINED = 4.0
#: That scatter.
_WIDE_SCATTER = 0.3
#: Variance of a value by a scatter of groups that is unknown, over that by as much of dwells, that is
#: little: groups may scatter several times as much as dwells.
_LITTLE = 0.1


@dataclass(frozen=True)
class LawFit:
    """A law as fitted; ``effects`` are the disturbances that dwells share, in their standard errors."""

    law: AnyLaw
    values: FloatArray
    effects: FloatArray  #: shape (disturbances,)
    disturbances: FloatArray  #: by how much each moves ln torque, shape (points, disturbances)
    covariance: FloatArray  #: of the values, model-based
    clustered: FloatArray  #: of the values, whatever the dwells of a cluster have in common
    scatter: float  #: relative, between dwells, beyond their errors
    shared: tuple[SharedScatter, ...]  #: of visits and runs
    errors: FloatArray  #: effective standard error of each ln torque, without the scatter
    residuals: FloatArray  #: ln(measured/fitted), the disturbances subtracted
    cost: float
    deviance: float  #: twice the negative log-likelihood at its least
    freedoms: Freedom

    @property
    def sigma(self) -> FloatArray:
        """Standard error of each ln torque on its own, with the scatter."""
        return np.sqrt(self.errors**2 + self.scatter**2 + 1e-20)

    @property
    def freedom(self) -> int:
        """Degrees of freedom of the residuals; those of a value are in ``freedoms``."""
        return int(self.residuals.size - self.values.size)

    @property
    def parameters(self) -> int:
        """How many numbers were fitted, the scatters among them."""
        return int(self.values.size + 1 + len(self.shared))

    @property
    def aicc(self) -> float:
        """Akaike's criterion, corrected for few points."""
        return self.aicc_with(0)

    def aicc_with(self, more: int) -> float:
        """Return the same if ``more`` numbers were chosen beside those of the law."""
        return aicc(self.deviance, self.parameters + more, self.residuals.size)

    def freedom_of(self, name: str) -> float:
        """Return the degrees of freedom of a parameter's interval."""
        return self.freedoms.of(np.eye(self.values.size)[self.law.index(name)])

    def not_estimable(self, name: str) -> str:
        """Return why a parameter has no interval though the dwells determine its value; empty if it has.

        A law of temperature that takes up every difference between the visits leaves nothing to say how
        far visits scatter. That leaves open what depends on temperature: its law, and a transition that moves
        with it; levels and exponents of speed are those of these visits.
        """
        thermal = (name in ("e", "q", "at", "d") and self.law.thermal is not None) or name == THINNING
        moved = self.freedoms.moved_by_untold
        if not thermal or not moved.size or moved[self.law.index(name)] < _LITTLE:
            return ""
        return (
            "each temperature was visited once, so visits cannot be separated from temperature. "
            "Visit one again, or record another"
        )

    def error(self, name: str) -> float:
        """Return the standard error of a parameter; of exact data the variance may round to below 0."""
        index = self.law.index(name)
        return float(np.sqrt(max(self.covariance[index, index], 0.0)))

    def estimate(self, name: str) -> Estimate:
        """Return a parameter of the law with its interval by covariance; unbounded if it is unknown."""
        value, error = float(self.values[self.law.index(name)]), self.error(name)
        if self.not_estimable(name):
            return Estimate(value, error, -np.inf, np.inf)
        return estimate(value, error, self.freedom_of(name))

    @property
    def bic(self) -> float:
        """Schwarz's criterion."""
        return bic(self.deviance, self.parameters, self.residuals.size)


def fit_law(law: AnyLaw, data: Observations, starts: list[FloatArray] | None = None) -> LawFit:
    """Return the likeliest values of a law.

    Parameters
    ----------
    starts
        Where to search from; found from linear fits if not given.
    """
    tried = starts or starts_of(law, data)
    fit = _fit_from(law, data, tried, _FIRST_SCATTER)
    if not np.any(np.abs(fit.effects[: stated(data)]) > _STRAINED):
        return fit
    return min((fit, _fit_from(law, data, tried, _WIDE_SCATTER)), key=lambda found: found.deviance)


def _fit_from(law: AnyLaw, data: Observations, tried: list[FloatArray], scatter: float) -> LawFit:
    """Fit and scatter in turn, until they settle, from a scatter on."""
    size = len(law.names)
    grouped = groupings(data)
    shared = tuple(SharedScatter(g.name, 0.0, 1.0, estimable=True) for g in grouped)
    columns = disturbances(data, grouped, shared, np.zeros(len(data)))
    errors = np.array(data.torque_error)
    sigma = np.sqrt(errors**2 + scatter**2)
    roughly = partial(search, law, data, columns, sigma, effort=Effort(1e-4, 8))
    nothing = np.zeros(columns.shape[1])
    best = min((roughly(np.append(start, nothing)) for start in tried), key=lambda m: m.cost)
    for _ in range(_ROUNDS):
        values = best.values[:size]
        by_speed, by_heat = law.slopes(values, data.inputs)
        errors = np.sqrt(
            data.torque_error**2
            + (by_speed * data.speed_error) ** 2
            + (by_heat * data.temperature_error) ** 2
        )
        residuals = residuals_of(law, data, columns, best.values)
        before, shared_before, scatter_before = columns, shared, scatter
        taken = _taken_up(best, size)
        scatter = scatter_beyond(residuals, errors, max(len(data) - size - taken, 1.0))
        sigma = np.sqrt(errors**2 + scatter**2 + 1e-20)
        if grouped:
            whole = residuals + columns @ best.values[size:]
            slopes = law.jacobian(values, data.inputs)
            wide = _widened(residuals, sigma)
            shared = shared_scatter(grouped, shared, data, slopes, by_heat, whole, wide)
        columns = disturbances(data, grouped, shared, by_heat)
        effects = best.values[size:] if columns.shape == before.shape else np.zeros(columns.shape[1])
        best = search(law, data, columns, sigma, np.append(values, effects))
        if _settled(scatter, scatter_before, shared, shared_before, float(np.max(errors))):
            break
    return _law_fit(law, data, grouped, shared, columns, errors, scatter, best)


def starts_of(law: AnyLaw, data: Observations) -> list[FloatArray]:
    """Return where the search for the likeliest values of a law begins, from linear fits."""
    weights = 1.0 / (data.torque_error**2 + _FIRST_SCATTER**2)
    return law.starts(data.inputs, data.log_torque, weights)


def _law_fit(
    law: AnyLaw,
    data: Observations,
    grouped: tuple[Grouping, ...],
    shared: tuple[SharedScatter, ...],
    columns: FloatArray,
    errors: FloatArray,
    scatter: float,
    best: Found,
) -> LawFit:
    size, known = len(law.names), stated(data)
    sigma = np.sqrt(errors**2 + scatter**2 + 1e-20)
    residuals = residuals_of(law, data, columns, best.values)
    effects = best.values[size:]
    of_known = columns[:, :known] @ effects[:known]
    wide = _widened(residuals, sigma)
    if best.bordered is not None:
        clustered = best.bordered.clustered(residuals / sigma, data.cluster, size)
        freedoms = freedom_beside(grouped, shared, best.bordered, wide, size)
    else:
        bread = np.asarray(np.linalg.pinv(best.jacobian.T @ best.jacobian, rcond=1e-14), dtype=np.float64)
        clustered = clustered_with_prior(best.jacobian, residuals / sigma, bread, data.cluster)[:size, :size]
        slopes = np.column_stack([law.jacobian(best.values[:size], data.inputs), columns])
        freedoms = freedom_of(grouped, shared, slopes, wide, bread, size)
    return LawFit(
        law=law,
        values=best.values[:size],
        effects=effects,
        disturbances=columns,
        covariance=freedoms.covariance,
        clustered=clustered,
        scatter=scatter,
        shared=shared,
        errors=errors,
        residuals=residuals,
        cost=best.cost,
        deviance=_deviance(grouped, shared, residuals, columns @ effects - of_known, errors)
        + float(np.sum(effects[:known] ** 2)),
        freedoms=freedoms,
    )


def _deviance(
    grouped: tuple[Grouping, ...],
    shared: tuple[SharedScatter, ...],
    residuals: FloatArray,
    common: FloatArray,
    errors: FloatArray,
) -> float:
    """Twice the negative log-likelihood, what visits and runs share integrated out (Laplace)."""
    members = [s.deviation * g.member for g, s in zip(grouped, shared, strict=True) if s.deviation > 0]
    if not members:
        return deviance(residuals, errors)[0]
    whole = residuals + common
    if (visits := grouped[0].visits) is not None and shared[0].deviation > 0:
        others = np.column_stack([np.empty((residuals.size, 0)), *members[1:]])
        return deviance(whole, errors, shared=Integrated(visits, shared[0].deviation, others))[0]
    return deviance(whole, errors, shared=np.column_stack(members))[0]


def _taken_up(found: Found, size: int) -> float:
    """How many degrees of freedom the effects of the disturbances take up."""
    if found.bordered is not None:
        return found.bordered.taken_up(size)
    bread = np.linalg.pinv(found.jacobian.T @ found.jacobian, rcond=1e-14)
    return float(bread.shape[0] - size - np.trace(bread[size:, size:]))


def _widened(residuals: FloatArray, sigma: FloatArray) -> FloatArray:
    """Standard errors of the dwells, of those that lie outside as much wider as their weight is less."""
    return np.asarray(sigma * np.sqrt(np.maximum(np.abs(residuals) / (HUBER * sigma), 1.0)))


def _settled(
    scatter: float,
    before: float,
    shared: tuple[SharedScatter, ...],
    shared_before: tuple[SharedScatter, ...],
    largest: float,
) -> bool:
    least = 1e-5 * max(scatter, largest, 1e-9)
    moved = [abs(a.deviation - b.deviation) for a, b in zip(shared, shared_before, strict=True)]
    return abs(scatter - before) <= least and all(m <= 10.0 * least for m in moved)
