"""Fitting one law: errors of torque, speed and temperature, and a scatter between dwells.

Errors of the inputs enter by the effective variance, each times the slope of the law there (Orear, Am. J.
Phys. 50 (1982) 912): exact for a law that is straight over an error bar, and unlike orthogonal distance
regression it leaves a likelihood in which laws can be compared. `errors_in_variables` checks it against
ODRPACK. The tare is a disturbance of all dwells together, fitted with its standard error as prior.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.branched import LEAST_POWER, Law
from hersey.damping.candidates.likelihood import HUBER, Minimum, aicc, bic, deviance, minimise, scatter_beyond
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.estimate import Estimate, estimate

AnyLaw = Law | StribeckLaw

#: Rounds in which scatter and effective variance settle.
_ROUNDS = 8
#: Relative error assumed of a dwell while the search for a start goes on.
_FIRST_SCATTER = 0.03
#: Largest number of parts in which data are left out in turn.
MOST_FOLDS = 40


@dataclass(frozen=True)
class LawFit:
    """A law as fitted; ``values`` are those of the law, ``tare`` the disturbance in its standard errors."""

    law: AnyLaw
    values: FloatArray
    tare: float
    covariance: FloatArray  #: of the values, model-based
    clustered: FloatArray  #: of the values, whatever the dwells of a cluster have in common
    scatter: float  #: relative, between dwells, beyond their errors
    errors: FloatArray  #: effective standard error of each ln torque, without the scatter
    residuals: FloatArray  #: ln(measured/fitted)
    cost: float
    deviance: float  #: twice the negative log-likelihood at its least

    @property
    def sigma(self) -> FloatArray:
        """Standard error of each ln torque with the scatter."""
        return np.sqrt(self.errors**2 + self.scatter**2 + 1e-20)

    @property
    def freedom(self) -> int:
        """Degrees of freedom."""
        return int(self.residuals.size - self.values.size)

    @property
    def parameters(self) -> int:
        """How many numbers were fitted, the scatter among them."""
        return int(self.values.size + 1)

    @property
    def aicc(self) -> float:
        """Akaike's criterion, corrected for few points."""
        return self.aicc_with(0)

    def aicc_with(self, more: int) -> float:
        """Return the same if ``more`` numbers were chosen beside those of the law."""
        return aicc(self.deviance, self.parameters + more, self.residuals.size)

    def estimate(self, name: str) -> Estimate:
        """Return a parameter of the law with its interval by covariance."""
        index = self.law.index(name)
        error = float(np.sqrt(max(self.covariance[index, index], 0.0)))
        return estimate(float(self.values[index]), error, self.freedom)

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
    weights = 1.0 / (data.torque_error**2 + _FIRST_SCATTER**2)
    tried = starts or law.starts(data.inputs, data.log_torque, weights)
    errors = np.array(data.torque_error)
    scatter = _FIRST_SCATTER
    sigma = np.sqrt(errors**2 + scatter**2)
    roughly = partial(search, law, data, sigma, precision=1e-4, calls=8)
    best = min((roughly(np.append(start, 0.0)) for start in tried), key=lambda m: m.cost)
    for _ in range(_ROUNDS):
        by_speed, by_heat = law.slopes(best.values[:-1], data.inputs)
        errors = np.sqrt(
            data.torque_error**2
            + (by_speed * data.speed_error) ** 2
            + (by_heat * data.temperature_error) ** 2
        )
        residuals = _residuals(law, data, best.values)
        freedom = len(data) - len(law.names)
        before, scatter = scatter, scatter_beyond(residuals, errors, freedom)
        sigma = np.sqrt(errors**2 + scatter**2 + 1e-20)
        best = search(law, data, sigma, best.values)
        if abs(scatter - before) <= 1e-5 * max(scatter, float(np.max(errors)), 1e-9):
            break
    residuals = _residuals(law, data, best.values)
    bread = np.asarray(np.linalg.pinv(best.jacobian.T @ best.jacobian, rcond=1e-14), dtype=np.float64)
    size = len(law.names)
    return LawFit(
        law=law,
        values=best.values[:size],
        tare=float(best.values[-1]),
        covariance=np.asarray(bread[:size, :size]),
        clustered=_clustered(best.jacobian, residuals / sigma, bread, data.cluster)[:size, :size],
        scatter=scatter,
        errors=errors,
        residuals=residuals,
        cost=best.cost,
        deviance=deviance(residuals, errors)[0] + float(best.values[-1]) ** 2,
    )


def search(
    law: AnyLaw,
    data: Observations,
    sigma: FloatArray,
    start: FloatArray,
    *,
    held: tuple[int, float] | None = None,
    tare: float = 0.0,
    precision: float = 1e-9,
    calls: int = 20,
) -> Minimum:
    """Return the least cost at fixed standard errors, over the values and the tare.

    Parameters
    ----------
    held
        Index and value of one parameter that is not varied.
    tare
        Expectation of the tare's disturbance, in its standard errors.
    precision, calls
        As `minimise` has them.
    """
    free = np.ones(start.size, dtype=bool)
    base = np.array(start)
    if held is not None:
        free[held[0]], base[held[0]] = False, held[1]
    known = not np.any(data.tare)
    free[-1] = not known  # without a tare there is no disturbance to fit

    def whole(some: FloatArray) -> FloatArray:
        full = base.copy()
        full[free] = some
        return full

    def residual(some: FloatArray) -> FloatArray:
        full = whole(some)
        return np.append(_residuals(law, data, full) / sigma, full[-1] - tare)

    def jacobian(some: FloatArray) -> FloatArray:
        full = whole(some)
        slopes = np.column_stack([law.jacobian(full[:-1], data.inputs), data.tare])
        rows = np.vstack([-slopes / sigma[:, None], np.append(np.zeros(full.size - 1), 1.0)])
        return np.asarray(rows[:, free])

    minimum = minimise(residual, jacobian, base[free], precision=precision, calls=calls)
    rows = np.zeros((minimum.jacobian.shape[0], start.size))
    rows[:, free] = minimum.jacobian
    rows[-1, -1] = 1.0
    return Minimum(whole(minimum.values), minimum.cost, rows)


def left_out(fit: LawFit, data: Observations) -> FloatArray:
    """Return residuals of dwells predicted without their own cluster; NaN where a law cannot say.

    A law with an exponent per temperature cannot predict a temperature that was left out.
    """
    start = np.append(fit.values, fit.tare)
    parts = data.cluster % MOST_FOLDS
    out = np.full(len(data), np.nan)
    for part in np.unique(parts):
        kept, missing = np.flatnonzero(parts != part), np.flatnonzero(parts == part)
        groups = getattr(fit.law, "groups", 1)
        if groups > 1 and np.unique(data.inputs.group[kept]).size < groups:
            return out
        minimum = search(fit.law, data.take(kept), fit.sigma[kept], start, precision=1e-6)
        out[missing] = _residuals(fit.law, data.take(missing), minimum.values)
    return out


def resampled(fit: LawFit, data: Observations, count: int, seed: int) -> FloatArray:
    """Return values fitted to data drawn cluster by cluster with replacement, shape (count, parameters)."""
    random = np.random.default_rng(seed)
    clusters = [np.flatnonzero(data.cluster == label) for label in np.unique(data.cluster)]
    starts = [np.append(fit.values, fit.tare)]
    if fit.law.broken:  # the cost has several minima in a corner
        at = fit.law.index("at")
        error = min(float(np.sqrt(fit.covariance[at, at])), 0.5)
        for aside in (-error, error):
            moved = starts[0].copy()
            moved[at] += aside
            starts.append(moved)
    draws = np.empty((count, fit.values.size))
    groups = getattr(fit.law, "groups", 1)
    for row in range(count):
        while True:
            sample = np.concatenate(
                [clusters[i] for i in random.integers(0, len(clusters), len(clusters))]
            ).astype(np.intp)
            if np.unique(data.inputs.group[sample]).size >= min(2, data.temperatures.size, 2) and (
                groups == 1 or np.unique(data.inputs.group[sample]).size == groups
            ):
                break
        disturbance = float(random.standard_normal())
        refit = partial(
            search, fit.law, data.take(sample), fit.sigma[sample], tare=disturbance, precision=1e-6
        )
        draws[row] = min((refit(s) for s in starts), key=lambda m: m.cost).values[:-1]
    return draws


def not_identified(fit: LawFit, data: Observations) -> dict[str, str]:
    """Return the parameters that the data do not determine, each with what would."""
    out: dict[str, str] = {}
    law = fit.law
    column = law.jacobian(fit.values, data.inputs) / fit.sigma[:, None]
    norms = np.linalg.norm(column, axis=0)
    _, singular, axes = np.linalg.svd(column / np.maximum(norms, 1e-300), full_matrices=False)
    for value, axis in zip(singular, axes, strict=True):
        if value < 1e-6 * singular[0]:
            for index in np.flatnonzero(np.abs(axis) > 0.1):
                out[law.names[index]] = "other parameters can make up for any change of it: vary speed and "
                out[law.names[index]] += "temperature independently"
    if isinstance(law, StribeckLaw):
        for name, what in (("stick", "slower"), ("viscous", "faster")):
            part = law.index(name)  # a factor e of it, in standard errors of all dwells together
            if norms[part] < 2.0 or fit.covariance[part, part] > 1.0:
                out[name] = f"the part it scales hardly shows: record dwells at {what} speeds"
        return out
    if law.broken:
        out |= _branches_shown(fit, data)
    if "q" in law.names:
        q, error = fit.values[law.index("q")], fit.covariance[law.index("q"), law.index("q")] ** 0.5
        if q <= 2.0 * error:
            out["q"] = "T0 has no lower bound in these data: record temperatures further apart"
    if "q" not in out and law.branches == "two branches, one Hersey number" and law.thermal:
        c = fit.values[law.index("c")]
        if 1.0 + c <= LEAST_POWER:
            out["at"] = (
                "torque hardly depends on viscosity above it (1 + c is at its bound), so where one Hersey "
                "number lies at other temperatures is not determined: record faster speeds"
            )
    return out


def _branches_shown(fit: LawFit, data: Observations) -> dict[str, str]:
    """Which parameters of a corner have too few speeds on either side."""
    assert isinstance(fit.law, Law)
    away = data.inputs.log_speed - fit.law.transition(fit.values, data.inputs)
    for side, what in ((away < 0, "slower"), (away >= 0, "faster")):
        levels = np.unique(np.round(np.sort(away[side]) / 0.03)).size
        if np.count_nonzero(side) < 3 or levels < 2:
            count = int(np.count_nonzero(side))
            where = "below" if what == "slower" else "above"
            reason = f"only {count} dwells lie {where} the transition: record dwells at {what} speeds"
            lost = ["at", "c_mixed"] if what == "slower" else ["at", "c"]
            return {name: reason for name in lost if name in fit.law.names}
    at = fit.law.index("at")
    if fit.covariance[at, at] ** 0.5 > 0.25 * float(np.ptp(data.inputs.log_speed)):
        return {
            "at": "the branches differ too little to say where they meet: record slower and faster speeds"
        }
    return {}


def _residuals(law: AnyLaw, data: Observations, values: FloatArray) -> FloatArray:
    return np.asarray(data.log_torque - law.predict(values[:-1], data.inputs) - values[-1] * data.tare)


def _clustered(jacobian: FloatArray, u: FloatArray, bread: FloatArray, cluster: IntArray) -> FloatArray:
    """Covariance of the values and the tare, whose prior is the last row."""
    return _cr3(jacobian[:-1], u, bread, cluster, np.outer(jacobian[-1], jacobian[-1]))


def clustered_covariance(jacobian: FloatArray, u: FloatArray, cluster: IntArray) -> FloatArray:
    """Return a covariance that holds whatever points of a cluster have in common (Bell and McCaffrey's CR3).

    Parameters
    ----------
    jacobian
        Of the residuals in standard errors, shape (points, parameters).
    u
        These residuals, shape (points,).
    cluster
        Label of each point, shape (points,).
    """
    bread = np.asarray(np.linalg.pinv(jacobian.T @ jacobian), dtype=np.float64)
    return _cr3(jacobian, u, bread, cluster, np.zeros_like(bread))


def _cr3(
    rows: FloatArray, u: FloatArray, bread: FloatArray, cluster: IntArray, prior: FloatArray
) -> FloatArray:
    out = np.zeros_like(bread)
    # the rows carry the root of Huber's weight already, so the residual carries the other root
    weighted = np.sign(u) * np.sqrt(np.minimum(np.abs(u), HUBER) * np.abs(u))
    labels = np.unique(cluster)
    for label in labels:
        members = np.flatnonzero(cluster == label)
        part = rows[members]
        leverage = np.eye(members.size) - part @ bread @ part.T
        push = part.T @ np.linalg.pinv(leverage) @ weighted[members]
        out += np.outer(push, push)
    shrink = (labels.size - 1) / labels.size
    return np.asarray(bread @ (shrink * out + prior) @ bread)
