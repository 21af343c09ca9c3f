"""Errors that dwells share: of the zero of torque, and the scatter of whole visits and runs.

What moves all dwells of one stay at a temperature together (the temperature itself read a little off, the
lubricant spread anew) tilts the law of temperature, and no number of dwells in that stay averages it away.
Each such error is a disturbance: a column by which it moves every ln torque, times an effect whose prior is
the standard normal distribution. The standard deviations that scale these columns are estimated by
restricted maximum likelihood (Patterson and Thompson, Biometrika 58 (1971) 545), and the degrees of freedom
of what is fitted know how few visits there are (Satterthwaite, Biometrics Bull. 2 (1946) 110; for linear
mixed models Giesbrecht and Burns, Biometrics 41 (1985) 477).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.bordered import Bordered
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.visit_effects import VisitColumns, Visits
from hersey.damping.distributions import ratio_above
from hersey.result import Means, Record

#: Groups that tell how far groups scatter, where a law of temperature is fitted to them too: two may lie
#: close by chance, and would show none.
FEWEST_GROUPS = 3
#: Share of a contrast between groups that the law must leave. Of what it all but takes up (small changes of
#: temperature within a visit, a transition that moves with temperature) too little is left to show a scatter:
#: it would pass for none.
_LEFT = 0.25
#: Variances searched, over that of an average group of dwells, and how many are tried first.
_SEARCHED, _TRIED = (1e-3, 1e6), 46


@dataclass(frozen=True)
class Grouping:
    """Which dwells share an error: ``member`` is 1 where a dwell (row) belongs to a group (column)."""

    name: str  #: ``visit`` or ``run``
    member: FloatArray
    visits: Visits | None = None  #: of many visits, which are the groups


def groupings(data: Observations) -> tuple[Grouping, ...]:
    """Return the groups of dwells that may share an error: visits, and runs of several.

    Without temperatures nothing but runs parts visits, and they are called so.
    """
    visits, runs = _indicator(data.visit), _indicator(data.run)
    per_run = np.unique(np.column_stack([data.run, data.visit]), axis=0).shape[0] / runs.shape[1]
    name = "run" if data.inputs.kelvin is None and per_run == 1 else "visit"
    several = np.count_nonzero(visits.sum(axis=0) > 1) >= 2
    out = [Grouping(name, visits, Visits.many(data.visit))] if several else []
    if runs.shape[1] > 2 and per_run >= 2:
        out.append(Grouping("run", runs))
    return tuple(out)


def _indicator(label: IntArray) -> FloatArray:
    return np.asarray(label[:, None] == np.unique(label)[None, :], dtype=np.float64)


@dataclass(frozen=True)
class SharedScatter(Record):
    """Relative standard deviation of an error that the dwells of a group share.

    ``p_value`` is that of none at all, by an F test of the groups' residuals. ``estimable`` is False where
    the law takes up every difference between the groups, so that the dwells say nothing of their scatter.
    """

    name: str
    deviation: float
    p_value: Annotated[float, Means("of none, by an F test")]
    estimable: Annotated[bool, Means("whether the dwells show anything of it")]


def shared_variance(scatter: tuple[SharedScatter, ...]) -> float:
    """Return the relative variance of a dwell by all that it shares, in a visit and a run of its own."""
    return sum(shared.deviation**2 for shared in scatter)


def disturbances(
    data: Observations, grouped: tuple[Grouping, ...], scatter: tuple[SharedScatter, ...], by_heat: FloatArray
) -> FloatArray:
    """Return by how much one standard error of each shared error moves ln torque, shape (points, errors).

    They are those of the zero, of the heating of the film (``by_heat`` is the change of ln torque by
    temperature, 1/K, shape (points,)), then of every group whose scatter is not nil.
    """
    shown = [(g.member, s.deviation) for g, s in zip(grouped, scatter, strict=True) if s.deviation > 0]
    first = stated(data)
    columns = np.empty((len(data), first + sum(member.shape[1] for member, _ in shown)))
    columns[:, : data.tare.shape[1]] = data.tare
    if data.heating.size:
        columns[:, first - 1] = by_heat * data.heating
    for member, deviation in shown:
        np.multiply(deviation, member, out=columns[:, first : first + member.shape[1]])
        first += member.shape[1]
    return columns


def stated(data: Observations) -> int:
    """Return how many disturbances come first whose size is no guess of the fit: zero, rest and heating."""
    return int(data.tare.shape[1] + bool(data.heating.size))


def shared_scatter(
    grouped: tuple[Grouping, ...],
    before: tuple[SharedScatter, ...],
    data: Observations,
    slopes: FloatArray,
    by_heat: FloatArray,
    residuals: FloatArray,
    sigma: FloatArray,
) -> tuple[SharedScatter, ...]:
    """Return the scatter of each grouping, the others as they were.

    Parameters
    ----------
    slopes
        Derivatives of ln torque by the parameters of the law, shape (points, parameters).
    by_heat
        Its derivative by temperature, 1/K, shape (points,).
    residuals
        ln(measured/fitted), no disturbance subtracted, shape (points,).
    sigma
        Standard error of each dwell on its own, those of outlying dwells widened, shape (points,).
    """
    out = list(before)
    for number, grouping in enumerate(grouped):
        others = tuple(g for i, g in enumerate(grouped) if i != number)
        rest = tuple(s for i, s in enumerate(out) if i != number)
        held = _Held.of(disturbances(data, others, rest, by_heat), data)
        fewest = FEWEST_GROUPS if np.any(by_heat) else 2
        if grouping.member.shape[1] < fewest:
            out[number] = SharedScatter(grouping.name, 0.0, 1.0, estimable=False)
        else:
            out[number] = _restricted(grouping, slopes, held, residuals, sigma)
    return tuple(out)


@dataclass(frozen=True)
class _Held:
    """Disturbances besides those of a grouping; those of many visits on their own."""

    others: FloatArray
    visits: VisitColumns | None

    @classmethod
    def of(cls, columns: FloatArray, data: Observations) -> _Held:
        visits = VisitColumns.among(columns, data.visit, stated(data))
        return cls(columns if visits is None else visits.others(columns), visits)


def _restricted(
    grouping: Grouping, slopes: FloatArray, held: _Held, residuals: FloatArray, sigma: FloatArray
) -> SharedScatter:
    """Restricted likelihood of one variance, all that the law and the other errors explain projected out."""
    weigh = (1.0 / sigma)[:, None]
    others, groups = held.others, grouping.member * weigh
    rows = np.column_stack([slopes, others, residuals]) * weigh
    if held.visits is not None:
        rows, groups = (held.visits.freed(each, sigma) for each in (rows, groups))
    modes = others.shape[1]
    known = np.vstack([rows[:, :-1], np.eye(modes, slopes.shape[1] + modes, slopes.shape[1])])
    basis = _column_space(known)
    rest = np.append(rows[:, -1], np.zeros(modes))
    rest = rest - basis @ (basis.T @ rest)
    beside = _column_space(known[:, -modes:]) if modes else np.empty((len(known), 0))
    squares, along, largest = _contrasts(grouping, groups, basis, beside, rest)
    spread, axes = np.linalg.eigh(squares)
    seen = spread > _LEFT * largest
    spread, along = spread[seen], (axes.T @ along)[seen]
    if not spread.size:
        return SharedScatter(grouping.name, 0.0, 1.0, estimable=False)
    between = float(np.sum(along**2 / spread))
    freedom = residuals.size - basis.shape[1] + modes - spread.size
    within = max(float(rest @ rest) - between, 1e-300)
    p_value = ratio_above(between / spread.size / (within / max(freedom, 1)), spread.size, max(freedom, 1))
    variance = _likeliest(spread, along)
    return SharedScatter(grouping.name, variance**0.5, float(p_value), estimable=True)


def _contrasts(
    grouping: Grouping, groups: FloatArray, basis: FloatArray, beside: FloatArray, rest: FloatArray
) -> tuple[FloatArray, FloatArray, float]:
    """Products of the groups that the law leaves, with one another and with the residuals.

    And the greatest square of a group, only the other errors projected out.
    """
    points, count = groups.shape
    if grouping.visits is not None:  # no two share a dwell
        sums, weigh = grouping.visits.sums, groups[np.arange(points), grouping.visits.label]
        explained, taken = (sums(each[:points] * weigh[:, None], axis=0) for each in (basis, beside))
        whole = sums(weigh**2)
        left = np.diag(whole) - explained @ explained.T
        return left, sums(weigh * rest[:points]), float(np.max(whole - np.sum(taken**2, axis=1)))
    padded = np.vstack([groups, np.zeros((len(rest) - points, count))])
    left = padded - basis @ (basis.T @ padded)
    whole = padded - beside @ (beside.T @ padded) if beside.shape[1] else padded
    return left.T @ left, left.T @ rest, float(np.max(np.sum(whole**2, axis=0)))


def _column_space(matrix: FloatArray) -> FloatArray:
    left, singular, _ = np.linalg.svd(
        matrix / np.maximum(np.linalg.norm(matrix, axis=0), 1e-300), full_matrices=False
    )
    return np.asarray(left[:, singular > 1e-10 * singular[0]])


def _likeliest(spread: FloatArray, along: FloatArray) -> float:
    """Variance at which the restricted deviance of independent normal coordinates is least; 0 if nowhere."""

    def deviance(variance: FloatArray | float) -> FloatArray:
        inflated = 1.0 + variance * spread
        return np.asarray(np.sum(np.log(inflated) - variance * along**2 / inflated, axis=-1))

    grid = np.geomspace(*_SEARCHED, _TRIED) / float(np.mean(spread))
    best = int(np.argmin(deviance(grid[:, None])))
    low, high = grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)]
    refined = optimize.minimize_scalar(
        lambda log: float(deviance(float(np.exp(log)))), bounds=(np.log(low), np.log(high)), method="bounded"
    )
    return float(np.exp(refined.x)) if refined.fun < min(float(deviance(0.0)), 0.0) else 0.0


@dataclass(frozen=True)
class Freedom:
    """Degrees of freedom of what is fitted: those of the residuals where no error is shared.

    ``parts`` holds how the covariance of the values rises with each variance that was estimated (that of the
    dwells on their own, of visits, of runs), shape (parameters, parameters) each; ``uncertainty`` is the
    covariance of these variances.
    """

    residual: int
    covariance: FloatArray
    parts: tuple[FloatArray, ...] = ()
    uncertainty: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    #: variance of each value by a scatter of groups that is not estimable, over that by as much of dwells
    moved_by_untold: FloatArray = field(default_factory=lambda: np.empty(0))

    def of(self, weights: FloatArray) -> float:
        """Return those of a linear combination of the values, weights of shape (parameters,)."""
        variance = float(weights @ self.covariance @ weights)
        if not self.parts or variance <= 0:
            return float(max(self.residual, 1))
        by = np.array([float(weights @ part @ weights) for part in self.parts])
        uncertain = float(by @ self.uncertainty @ by)
        freedom = 2.0 * variance**2 / uncertain if uncertain > 0 else np.inf
        return float(np.clip(freedom, 1.0, max(self.residual, 1)))


def freedom_of(
    grouped: tuple[Grouping, ...],
    scatter: tuple[SharedScatter, ...],
    columns: FloatArray,
    sigma: FloatArray,
    bread: FloatArray,
    parameters: int,
) -> Freedom:
    """Return the degrees of freedom that the expected restricted information of the variances gives.

    Parameters
    ----------
    columns
        Derivatives of ln torque by the parameters and the effects, shape (points, parameters + effects).
    sigma
        Standard error of each dwell on its own, those of outlying dwells widened, shape (points,).
    bread
        Covariance of parameters and effects, shape (parameters + effects, parameters + effects).
    parameters
        How many of them are parameters.
    """
    residual, covariance = int(sigma.size - parameters), np.asarray(bread[:parameters, :parameters])
    members = [g.member for g, s in zip(grouped, scatter, strict=True) if s.deviation > 0 or _few_runs(g, s)]
    weight = 1.0 / sigma**2
    gain = (bread @ columns.T * weight)[:parameters]
    moved = np.zeros(parameters)
    for grouping, shared in zip(grouped, scatter, strict=True):
        if not shared.estimable:
            by_dwells = np.maximum(np.sum(gain**2, axis=1), 1e-300)
            moved += np.sum((gain @ grouping.member) ** 2, axis=1) / by_dwells
    if not members:
        return Freedom(residual, covariance, moved_by_untold=moved)
    left, singular, _ = np.linalg.svd(bread)
    root = (weight[:, None] * columns) @ (left * np.sqrt(singular))  # P = diag(weight) - root root^T
    overlap = root.T @ root
    squares = float(np.sum(weight**2) - 2.0 * np.sum(weight * np.sum(root**2, axis=1)) + np.sum(overlap**2))
    projected = [weight[:, None] * m - root @ (root.T @ m) for m in members]
    size = len(members) + 1
    information = np.empty((size, size))
    information[0, 0] = squares
    for i, (m, p) in enumerate(zip(members, projected, strict=True), start=1):
        information[0, i] = information[i, 0] = float(np.sum(p**2))
        for j, q in enumerate(projected, start=1):
            information[i, j] = float(np.sum((m.T @ q) ** 2))
    uncertainty = np.asarray(np.linalg.pinv(0.5 * information), dtype=np.float64)
    parts = [gain @ gain.T, *((gain @ m) @ (gain @ m).T for m in members)]
    return Freedom(residual, covariance, tuple(parts), uncertainty, moved)


def _few_runs(grouping: Grouping, shared: SharedScatter) -> bool:
    """Whether runs show no scatter of their own, which few of them may do by chance.

    A level of a few runs is then known with as many degrees of freedom as they have, not those of their
    dwells: by them 92 % of 95 % intervals held the truth of three runs (`benchmarks.tribometer`).
    """
    alike = shared.estimable and not shared.deviation > 0
    return alike and grouping.name == "run" and grouping.member.shape[1] >= FEWEST_GROUPS


def freedom_beside(
    grouped: tuple[Grouping, ...],
    scatter: tuple[SharedScatter, ...],
    normal: Bordered,
    sigma: FloatArray,
    parameters: int,
) -> Freedom:
    """Return the same where many effects are those of visits, from their normal equations."""
    residual = int(sigma.size - parameters)
    covariance = np.asarray(normal.inverse[:parameters, :parameters])
    gain = normal.gains(parameters) / sigma
    moved = np.zeros(parameters)
    for grouping, shared in zip(grouped, scatter, strict=True):
        if not shared.estimable:
            by_dwells = np.maximum(np.sum(gain**2, axis=1), 1e-300)
            moved += np.sum((gain @ grouping.member) ** 2, axis=1) / by_dwells
    runs = [g.member for g, s in zip(grouped, scatter, strict=True) if s.deviation > 0 and g.visits is None]
    information = _information(normal, sigma, runs)
    uncertainty = np.asarray(np.linalg.pinv(0.5 * information), dtype=np.float64)
    parts = [gain, normal.visits.sums(gain), *(gain @ m for m in runs)]
    return Freedom(residual, covariance, tuple(part @ part.T for part in parts), uncertainty, moved)


def _information(normal: Bordered, sigma: FloatArray, runs: list[FloatArray]) -> FloatArray:
    """Restricted information of the variances of dwells, visits and runs, twice (as in `freedom_of`).

    P = N - (N A) S^-1 (N A)^T, with N in blocks of visits, A the border and S its complement.
    """
    visits, inverse, label = normal.visits, normal.inverse, normal.visits.label
    weight, column = 1.0 / sigma**2, normal.by_visit / sigma
    border = normal.left / sigma[:, None]

    def of_visits(rows: FloatArray) -> FloatArray:  # N rows
        share = visits.sums(column[:, None] * rows, axis=0) / normal.diagonal[:, None]
        return np.asarray(weight[:, None] * rows - column[:, None] * share[label])

    square, by_square = border.T @ border, visits.sums(column**2) / normal.diagonal
    dwells = float(np.sum(weight**2) - 2.0 * np.sum(weight * column**2 / normal.diagonal[label]))
    dwells += float(np.sum(by_square**2)) - 2.0 * float(np.sum(inverse * (border.T @ of_visits(border))))
    dwells += float(np.sum((inverse @ square) * (inverse @ square).T))
    alone = weight * (normal.own_prior**2 / normal.diagonal)[label]  # N times the members of each visit
    by_border, twice = visits.sums(border, axis=0), visits.sums(border * alone[:, None], axis=0)
    weighed, sums = by_border @ inverse, visits.sums(alone)
    by_visits = np.sum(alone**2) - 2.0 * np.sum(weighed * twice) + np.sum((weighed @ square) * weighed)
    together = inverse @ (by_border.T @ by_border)
    of_both = np.sum(sums**2) - 2.0 * np.sum(sums * np.sum(weighed * by_border, axis=1))
    of_both += np.sum(together * together.T)
    left = [of_visits(run) - border @ (inverse @ (border.T @ run)) for run in runs]
    information = np.empty((2 + len(runs), 2 + len(runs)))
    information[0, :2], information[1, :2] = (dwells, by_visits), (by_visits, of_both)
    for i, each in enumerate(left, start=2):
        information[0, i] = information[i, 0] = float(np.sum(each**2))
        information[1, i] = information[i, 1] = float(np.sum(visits.sums(each, axis=0) ** 2))
        information[i, 2:] = [float(np.sum((run.T @ each) ** 2)) for run in runs]
    return information
