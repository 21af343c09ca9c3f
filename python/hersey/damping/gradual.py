"""A gradual bend: the minimum of a smooth curve through the dwells, and what motion is given of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.bordered import Bordered
from hersey.damping.candidates.branched import LEAST_POWER
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.shared_errors import stated
from hersey.damping.candidates.visit_effects import VisitColumns
from hersey.damping.estimate import quantile
from hersey.damping.scaled import law_of, powers_of, scaled_speed, scaled_torque, temperatures_of
from hersey.damping.smoothing import MOST_GROUPS, Curve, Least, parabola
from hersey.result import Means, Record

#: Relative error below which dwells count as exact.
EXACT = 1e-6


@dataclass(frozen=True)
class Closure(Record):
    """The law with a corner at a gradual bend: least speed and torque there, exponents of the branches.

    ``values`` and ``covariance`` are of the variables of the surface. It leaves the transition at the torque
    that the dwells show there, which the trend lines themselves do not.
    """

    values: Annotated[FloatArray, Means("of the variables of the fit, in their order", shape="(n,)")]
    covariance: Annotated[FloatArray, Means(shape="(n, m)")]


def least_around(data: Observations, trend: LawFit) -> tuple[Least | None, FloatArray]:
    """Return the minimum of a smooth curve through all dwells, if any, and how these are put into groups."""
    curve, groups = _curve(data, trend, scaled_torque(data, trend))
    return curve.least(), groups


def trend_left(data: Observations, corner: LawFit) -> float:
    """Return by how much a smooth curve beside a corner is likelier than the corner: twice the logarithm."""
    slopes = law_of(corner).jacobian(corner.values, data.inputs)
    return _curve(data, corner, corner.residuals, slopes)[0].trend()


def closure_at(
    data: Observations, trend: LawFit, least: Least, groups: FloatArray, ends: tuple[float, float]
) -> Closure:
    """Return the corner at a minimum, and how its numbers go together: each is nearly linear in ln torque.

    ``ends`` is the interval of its speed. The trend lines scatter the dwells more than the curve does.
    """
    law, z = law_of(trend), least.log_speed
    gains = _gains(data, trend)
    moved = _by_move(data, trend)[:, None] * (_by_power(trend) @ gains)[None, :]
    speed, torque = (
        per_point - per_point @ moved for per_point in (least.speed_gain @ groups, least.torque_gain @ groups)
    )
    together = np.vstack([torque, gains[1:-1], speed])
    shared = together @ trend.disturbances
    covariance = (together * trend.sigma**2) @ together.T + shared @ shared.T
    by = np.ones(len(covariance))
    by[0] = np.sqrt(least.scale)
    if np.all(np.isfinite(ends)):  # a minimum without a bound is not announced
        error = (ends[1] - ends[0]) / (2.0 * quantile(trend.freedom_of("at")))
        by[-1] = error / np.sqrt(max(float(covariance[-1, -1]), 1e-300))
    covariance = covariance * np.outer(by, by)
    c = float(trend.values[law.index("c")])
    to_level = np.eye(len(covariance))  # level = ln torque there - (1 + c) z - ln w_ref
    to_level[0, law.index("c")], to_level[0, -1] = -z, -(1.0 + c)
    level = least.log_torque - (1.0 + c) * z - float(np.log(data.reference_speed))
    return Closure(np.array([level, *trend.values[1:-1], z]), np.asarray(to_level @ covariance @ to_level.T))


def _curve(
    data: Observations, fit: LawFit, values: FloatArray, known: FloatArray | None = None
) -> tuple[Curve, FloatArray]:
    """A smooth curve in scaled speed through values of the points, and how these are put into groups.

    How the transition moves with temperature is as uncertain as the fit has it. ``known`` is as `Curve` has
    it, per point; a parabola if not given.
    """
    scaled = scaled_speed(data, fit)
    variance = fit.sigma**2 + EXACT**2
    groups = _grouped(scaled, variance)
    shared = groups @ np.column_stack([fit.disturbances, _by_move(data, fit) * _move_error(fit)])
    at = groups @ scaled
    curve = Curve(
        at=at,
        values=groups @ values,
        noise=np.diag(groups**2 @ variance) + shared @ shared.T,
        floor=float(np.median((fit.errors**2 + EXACT**2) / variance)),
        known=parabola(at) if known is None else groups @ known,
        freedom=max(fit.freedom_of("at"), 1.0),
    )
    return curve, groups


def _grouped(scaled: FloatArray, variance: FloatArray) -> FloatArray:
    """Weights that average neighbouring points, shape (groups, points); each its own group if not many."""
    members = np.array_split(np.argsort(scaled, kind="stable"), min(scaled.size, MOST_GROUPS))
    weights = np.zeros((len(members), scaled.size))
    for row, member in zip(weights, members, strict=True):
        row[member] = 1.0 / variance[member] / np.sum(1.0 / variance[member])
    return weights


def _by_move(data: Observations, fit: LawFit) -> FloatArray:
    """By how much one unit of the transition's exponent in temperature moves ln torque, shape (points,)."""
    slope, _ = law_of(fit).slopes(fit.values, data.inputs)
    return np.asarray(slope * temperatures_of(data, law_of(fit)))


def _by_power(fit: LawFit) -> FloatArray:
    """Derivative of that exponent by the values of the fit; zeros if isothermal or bounded."""
    law, out = law_of(fit), np.zeros(fit.values.size)
    if "d" in law.names:
        out[law.index("d")] = 1.0
        return out
    e, c = powers_of(fit)
    if law.thermal and 1.0 + c > LEAST_POWER:
        out[law.index("e")], out[law.index("c")] = -1.0 / (1.0 + c), e / (1.0 + c) ** 2
    return out


def _move_error(fit: LawFit) -> float:
    by = _by_power(fit)
    return float(np.sqrt(max(float(by @ fit.covariance @ by), 0.0)))


def _gains(data: Observations, fit: LawFit) -> FloatArray:
    """By how much one unit of each ln torque moves the values of a fit, shape (values, points)."""
    size, sigma = fit.values.size, fit.sigma
    own = VisitColumns.among(fit.disturbances, data.visit, stated(data))
    if own is not None:
        others = own.others(fit.disturbances)
        border = np.column_stack([law_of(fit).jacobian(fit.values, data.inputs), others])
        prior, own_prior = np.eye(others.shape[1], border.shape[1], size), np.ones(own.visits.count)
        normal = Bordered(own.visits, border / sigma[:, None], own.size / sigma, prior, own_prior)
        return normal.gains(size) / sigma
    slopes = np.column_stack([law_of(fit).jacobian(fit.values, data.inputs), fit.disturbances])
    prior = np.diag(np.append(np.zeros(size), np.ones(fit.disturbances.shape[1])))
    weighed = slopes / sigma[:, None] ** 2
    return np.asarray(np.linalg.pinv(slopes.T @ weighed + prior) @ weighed.T)[:size]
