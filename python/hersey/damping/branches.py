"""Two branches of the law: where they part, whether the data prove them, and where they meet.

The points part where torque is least (isotonic regression, no law assumed). From there the law with a corner
is fitted. Where a gradual bend describes the data better than a corner, or a corner leaves a trend, each
branch is instead the trend line through the points on its side, as one would draw it by hand. Trend lines
meet below the torque measured, and not where it is least: the transition is then the minimum of a smooth
curve through the points.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import optimize

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.candidates.branched import HELD, LEAST_POWER, Bend, Law, transition_exponent
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.intervals import profile_interval
from hersey.damping.candidates.likelihood import EVIDENCE, scatter_beyond
from hersey.damping.candidates.observations import Observations
from hersey.damping.dwells import SAME_SPEED, distinct_speeds
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.smoothing import MOST_GROUPS, Curve, Least, parabola
from hersey.units import rpm

#: Widths of a bend, in the logarithm of speed, that a corner is compared with.
BEND_WIDTHS = (0.15, 0.3, 0.6)
#: Points and distinct speeds that each branch needs.
MIN_BRANCH_POINTS, MIN_BRANCH_SPEEDS = 4, 3
#: Twice the logarithm of likelihood by which a corner leaves a trend: one time in a hundred by chance.
TREND = 5.4
#: Relative error below which dwells count as exact.
EXACT = 1e-6


@dataclass(frozen=True)
class Branches:
    """Two branches as fitted, and where torque is least (logarithms of scaled speed)."""

    fit: LawFit
    least: float  #: not a number if a smooth curve has no minimum
    ends: tuple[float, float]  #: 95 % interval
    closure: Closure | None  #: None where the branches meet in a corner


@dataclass(frozen=True)
class Closure:
    """The law with a corner at a gradual bend: least speed and torque there, exponents of the branches.

    ``values`` and ``covariance`` are of the variables of the surface. It leaves the transition at the torque
    that the dwells show there, which the trend lines themselves do not.
    """

    values: FloatArray
    covariance: FloatArray


@dataclass(frozen=True)
class Transition:
    """Where torque is least, between the falling (mixed) and the rising (EHL) branch."""

    speed: Estimate  #: rad/s, at the reference temperature of the surface
    meeting_speed: float  #: rad/s, there too, where the lines of the branches meet; the same in a corner
    mixed_exponent: Estimate  #: exponent of damping in speed below it, of the trend line if gradual
    temperature_exponent: float  #: transition speed varies as T to this power
    evidence: float  #: AICc of the single power law minus that of the two branches
    closure: Closure | None = None  #: what motion is given in the place of a gradual bend

    @property
    def gradual(self) -> bool:
        """Whether the bend is gradual: the branches are trend lines, its minimum that of a smooth curve."""
        return self.closure is not None


def fit_branches(data: Observations, single: LawFit) -> Branches | None:
    """Return the best two branches, or None if there are too few points for any."""
    law = replace(_law_of(single), branches=HELD)
    trend, powers, splits = None, _powers(single), []
    for _ in range(4):  # which points are slow depends on the law, which depends on it
        splits = _splits(data, single, transition_exponent(*powers))
        if not splits:
            return None
        trend = _trend_lines(data, law, single, splits)
        if np.allclose(powers, _powers(trend), rtol=1e-9):
            break
        powers = _powers(trend)
    assert trend is not None
    corner = fit_law(law, data, [trend.values])
    below = np.asarray(scaled_speed(data, corner) < corner.values[-1])
    if not (_enough(data, below) and _enough(data, ~below)) or _is_gradual(data, law, corner):
        return _around_a_bend(data, trend, _parted(data, trend, splits))
    ends = profile_interval(corner, data, law.index("at"))
    return Branches(corner, float(corner.values[-1]), ends, None)


def why_no_transition(data: Observations, single: LawFit, branches: Branches) -> str:
    """Return why a second branch is not announced; empty if torque falls and rises beyond doubt."""
    fit = branches.fit
    below, above, at = fit.estimate("c_mixed"), fit.estimate("c"), branches.least
    gain = single.aicc - fit.aicc
    if gain < EVIDENCE:
        return f"a second branch does not pay: its AICc is better by {gain:.1f}, {EVIDENCE:g} are asked"
    if below.high >= -1.0:
        bend = rpm(data.reference_speed * float(np.exp(fit.values[-1])))
        return f"below {bend:.3g} rpm the exponent is {below}: torque does not fall with speed beyond doubt"
    if above.low <= -1.0:
        return f"above the bend the exponent is {above}: torque does not rise with speed beyond doubt"
    scaled = scaled_speed(data, fit)
    if not scaled.min() < at < scaled.max():
        return "the falling and the rising branch do not meet within the speeds measured"
    if not np.all(np.isfinite(branches.ends)):
        return "where the falling and the rising branch meet has no bound in these data"
    return ""


def transition(data: Observations, single: LawFit, branches: Branches) -> Transition:
    """Return the transition that branches show."""
    fit = branches.fit
    best, low, high, meeting = (
        data.reference_speed * float(np.exp(v)) for v in (branches.least, *branches.ends, fit.values[-1])
    )
    reach = quantile(fit.freedom_of("at"))
    return Transition(
        speed=Estimate(best, best * float(np.log(high / low)) / (2 * reach), low, high),
        meeting_speed=meeting,
        mixed_exponent=fit.estimate("c_mixed"),
        temperature_exponent=transition_exponent(*_powers(fit)),
        evidence=single.aicc - fit.aicc,
        closure=branches.closure,
    )


def _law_of(fit: LawFit) -> Law:
    assert isinstance(fit.law, Law)
    return fit.law


def _powers(fit: LawFit) -> tuple[float, float]:
    """Exponents of temperature (0 if isothermal) and of speed above the transition."""
    law = _law_of(fit)
    e = float(fit.values[law.index("e")]) if law.thermal else 0.0
    return e, float(fit.values[law.index("c")])


def _temperatures(data: Observations, law: Law) -> FloatArray:
    """Logarithm of temperature about the reference, in the scale of the law; zeros if isothermal."""
    if law.thermal is None or data.inputs.kelvin is None:
        return np.zeros(len(data))
    return law.thermal.shape(data.inputs.kelvin)[0]


def scaled_speed(data: Observations, fit: LawFit) -> FloatArray:
    """Return ln(w/w_ref) at the same Hersey number at the reference temperature, shape (points,)."""
    shift = transition_exponent(*_powers(fit)) * _temperatures(data, _law_of(fit))
    return np.asarray(data.inputs.log_speed - shift)


def scaled_torque(data: Observations, fit: LawFit) -> FloatArray:
    """Return ln torque at the same Hersey number at the reference temperature, shape (points,).

    It is the ln torque measured unless 1 + c is so small that the move of the transition is bounded.
    """
    e, c = _powers(fit)
    power = e + (1.0 + c) * transition_exponent(e, c)
    return np.asarray(data.log_torque - power * _temperatures(data, _law_of(fit)))


def _trend_lines(
    data: Observations, law: Law, single: LawFit, splits: list[tuple[float, BoolArray]]
) -> LawFit:
    """A trend line on either side of the likeliest split."""
    likeliest = [below for chi, below in splits if chi <= splits[0][0] + 1e-9]
    return min((_fit_split(data, law, single, below) for below in likeliest), key=lambda fit: fit.aicc)


def _parted(data: Observations, trend: LawFit, splits: list[tuple[float, BoolArray]]) -> tuple[float, float]:
    """Scaled speeds between which the points part, by all splits that may as well be taken."""
    limit, scaled = splits[0][0] + quantile(len(data)) ** 2, scaled_speed(data, trend)
    kept = [below for chi, below in splits if chi <= limit]
    return min(float(scaled[b].max()) for b in kept), max(float(scaled[~b].min()) for b in kept)


def _is_gradual(data: Observations, law: Law, corner: LawFit) -> bool:
    """Whether a bend of some width describes the data better than a corner, or a corner leaves a trend."""
    bends = (fit_law(replace(law, bend=Bend(width)), data, [corner.values]) for width in BEND_WIDTHS)
    if any(bend.aicc_with(1) < corner.aicc for bend in bends):
        return True
    curve, _ = _curve(data, corner, corner.residuals, law.jacobian(corner.values, data.inputs))
    return curve.trend() > TREND


def _around_a_bend(data: Observations, trend: LawFit, parted: tuple[float, float]) -> Branches:
    """The trend lines on either side, and the minimum of a smooth curve through all points between them."""
    curve, groups = _curve(data, trend, scaled_torque(data, trend))
    least = curve.least()
    if least is None:
        return Branches(trend, np.nan, (-np.inf, np.inf), None)
    low, high = least.ends
    ends = (
        low if np.isfinite(low) else min(parted[0], least.log_speed),
        high if np.isfinite(high) else max(parted[1], least.log_speed),
    )
    return Branches(trend, least.log_speed, ends, _closure(data, trend, least, groups, ends))


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
    slope, _ = _law_of(fit).slopes(fit.values, data.inputs)
    return np.asarray(slope * _temperatures(data, _law_of(fit)))


def _by_power(fit: LawFit) -> FloatArray:
    """Derivative of that exponent by the values of the fit; zeros if isothermal or bounded."""
    law, out = _law_of(fit), np.zeros(fit.values.size)
    e, c = _powers(fit)
    if law.thermal and 1.0 + c > LEAST_POWER:
        out[law.index("e")], out[law.index("c")] = -1.0 / (1.0 + c), e / (1.0 + c) ** 2
    return out


def _move_error(fit: LawFit) -> float:
    by = _by_power(fit)
    return float(np.sqrt(max(float(by @ fit.covariance @ by), 0.0)))


def _closure(
    data: Observations, trend: LawFit, least: Least, groups: FloatArray, ends: tuple[float, float]
) -> Closure:
    """The corner at a minimum, and how its numbers go together: each is nearly linear in ln torque."""
    law, z = _law_of(trend), least.log_speed
    gains = _gains(data, trend)
    moved = _by_move(data, trend)[:, None] * (_by_power(trend) @ gains)[None, :]
    speed, torque = (
        per_point - per_point @ moved for per_point in (least.speed_gain @ groups, least.torque_gain @ groups)
    )
    together = np.vstack([torque, gains[1:-1], speed])
    shared = together @ trend.disturbances
    covariance = (together * trend.sigma**2) @ together.T + shared @ shared.T
    error = (ends[1] - ends[0]) / (2.0 * quantile(trend.freedom_of("at")))
    widened = np.ones(len(covariance))
    widened[-1] = max(error / float(np.sqrt(max(covariance[-1, -1], 1e-300))), 1.0)
    covariance = covariance * np.outer(widened, widened)
    c = float(trend.values[law.index("c")])
    to_level = np.eye(len(covariance))  # level = ln torque there - (1 + c) z - ln w_ref
    to_level[0, law.index("c")], to_level[0, -1] = -z, -(1.0 + c)
    level = least.log_torque - (1.0 + c) * z - float(np.log(data.reference_speed))
    return Closure(np.array([level, *trend.values[1:-1], z]), np.asarray(to_level @ covariance @ to_level.T))


def _gains(data: Observations, fit: LawFit) -> FloatArray:
    """By how much one unit of each ln torque moves the values of a fit, shape (values, points)."""
    slopes = np.column_stack([_law_of(fit).jacobian(fit.values, data.inputs), fit.disturbances])
    prior = np.diag(np.append(np.zeros(fit.values.size), np.ones(fit.disturbances.shape[1])))
    weighed = slopes / fit.sigma[:, None] ** 2
    return np.asarray(np.linalg.pinv(slopes.T @ weighed + prior) @ weighed.T)[: fit.values.size]


def _fit_split(data: Observations, law: Law, single: LawFit, below: BoolArray) -> LawFit:
    """The law with each point held to its branch, from two lines of their own."""
    z, heat = data.inputs.log_speed, [_temperatures(data, law)] if law.thermal else []
    columns = [np.ones_like(z), *heat, z, below * 1.0, below * z]
    weights = 1.0 / single.sigma
    linear, *_ = np.linalg.lstsq(
        np.column_stack(columns) * weights[:, None], data.log_torque * weights, rcond=None
    )
    jump, change = float(linear[-2]), float(linear[-1])
    c = float(linear[-3]) - 1.0
    at = -jump / change if change else float(z[below].max())
    start = np.array([*linear[:-3], c, c + change, at])
    return fit_law(replace(law, bend=Bend(below=below)), data, [start])


def _splits(data: Observations, single: LawFit, exponent: float) -> list[tuple[float, BoolArray]]:
    """Which points are slow, for every split with enough points on either side, the likeliest first.

    At a fixed Hersey number torque is a function of scaled speed alone. Its best falling curve below the
    split and best rising curve above it (isotonic regression, no law assumed) say how likely the split is.
    """
    scaled = data.inputs.log_speed - exponent * _temperatures(data, _law_of(single))
    order = np.argsort(scaled, kind="stable")
    torque = data.log_torque
    residuals = _unimodal_residuals(torque[order])
    scatter = scatter_beyond(residuals, single.errors[order], max(scaled.size // 2, 1))
    weights = 1.0 / (single.errors[order] ** 2 + scatter**2 + 1e-18)
    splits = []
    for i in np.nonzero(np.diff(scaled[order]) > 0.5 * SAME_SPEED)[0]:
        below = np.asarray(scaled <= 0.5 * (scaled[order][i] + scaled[order][i + 1]))
        if _enough(data, below) and _enough(data, ~below):
            sides = (slice(None, i + 1), False), (slice(i + 1, None), True)
            chi = 0.0
            for side, rising in sides:
                values = torque[order][side]
                curve = optimize.isotonic_regression(values, weights=weights[side], increasing=rising)
                chi += float(np.sum(weights[side] * (values - curve.x) ** 2))
            splits.append((chi, below))
    return sorted(splits, key=lambda f: f[0])


def _unimodal_residuals(torque: FloatArray) -> FloatArray:
    """Residuals of the best curve that falls, then rises."""
    best: FloatArray = np.asarray(torque - torque.mean())
    for i in range(1, torque.size):
        falling = optimize.isotonic_regression(torque[:i], increasing=False).x
        rising = optimize.isotonic_regression(torque[i:]).x
        residuals = torque - np.append(falling, rising)
        if residuals @ residuals < best @ best:
            best = np.asarray(residuals)
    return best


def _enough(data: Observations, side: BoolArray) -> bool:
    points, speeds = int(np.count_nonzero(side)), distinct_speeds(data.speed[side])
    return points >= MIN_BRANCH_POINTS and speeds >= MIN_BRANCH_SPEEDS
