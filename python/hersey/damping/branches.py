"""Two branches of the law: where they part, whether the data prove them, and where they meet.

The points part where torque is least (isotonic regression, no law assumed). From there the law with a corner
is fitted; where a gradual bend describes the data much better than a corner, each branch is instead the trend
line through the points on its side, as one would draw it by hand.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import optimize

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.candidates.branched import HELD, Bend, Law, transition_exponent
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.intervals import profile_interval
from hersey.damping.candidates.likelihood import EVIDENCE, scatter_beyond
from hersey.damping.candidates.observations import Observations
from hersey.damping.dwells import SAME_SPEED, distinct_speeds
from hersey.damping.estimate import Estimate, quantile
from hersey.units import rpm

#: Widths of a bend, in the logarithm of speed, that a corner is compared with.
BEND_WIDTHS = (0.15, 0.3, 0.6)
#: Points and distinct speeds that each branch needs.
MIN_BRANCH_POINTS, MIN_BRANCH_SPEEDS = 4, 3


@dataclass(frozen=True)
class Branches:
    """Two branches as fitted, and where they part and meet (logarithms of scaled speed)."""

    fit: LawFit
    parted_at: float
    meeting: tuple[float, float]  #: 95 % interval
    gradual: bool


@dataclass(frozen=True)
class Transition:
    """Where the falling (mixed) branch meets the rising (EHL) one."""

    speed: Estimate  #: rad/s, at the reference temperature of the surface, where the branches meet
    least_torque_speed: float  #: rad/s, there too: between the slow and the fast points
    mixed_exponent: Estimate  #: exponent of damping in speed below it
    temperature_exponent: float  #: transition speed varies as T to this power
    evidence: float  #: AICc of the single power law minus that of the two branches
    gradual: bool  #: whether the branches are trend lines on either side of a gradual bend


def fit_branches(data: Observations, single: LawFit) -> Branches | None:
    """Return the best two branches, or None if there are too few points for any."""
    law = replace(_law_of(single), branches=HELD)
    trend, powers = None, _powers(single)
    for _ in range(4):  # which points are slow depends on the law, which depends on it
        splits = _splits(data, single, transition_exponent(*powers))
        if not splits:
            return None
        trend = _trend_lines(data, law, single, splits, transition_exponent(*powers))
        if np.allclose(powers, _powers(trend.fit), rtol=1e-9):
            break
        powers = _powers(trend.fit)
    assert trend is not None
    corner = fit_law(law, data, [trend.fit.values])
    below = np.asarray(_scaled_speed(data, corner) < corner.values[-1])
    if not (_enough(data, below) and _enough(data, ~below)) or _is_gradual(data, law, corner):
        return trend
    meeting = profile_interval(corner, data, law.index("at"))
    return Branches(corner, trend.parted_at, meeting, gradual=False)


def why_no_transition(data: Observations, single: LawFit, branches: Branches) -> str:
    """Return why a second branch is not announced; empty if torque falls and rises beyond doubt."""
    fit = branches.fit
    below, above, at = fit.estimate("c_mixed"), fit.estimate("c"), float(fit.values[-1])
    gain = single.aicc - fit.aicc
    if gain < EVIDENCE:
        return f"a second branch does not pay: its AICc is better by {gain:.1f}, {EVIDENCE:g} are asked"
    if below.high >= -1.0:
        bend = rpm(data.reference_speed * float(np.exp(at)))
        return f"below {bend:.3g} rpm the exponent is {below}: torque does not fall with speed beyond doubt"
    if above.low <= -1.0:
        return f"above the bend the exponent is {above}: torque does not rise with speed beyond doubt"
    scaled = _scaled_speed(data, fit)
    if not scaled.min() < at < scaled.max():
        return "the falling and the rising branch do not meet within the speeds measured"
    if not np.all(np.isfinite(branches.meeting)):
        return "where the falling and the rising branch meet has no bound in these data"
    return ""


def transition(data: Observations, single: LawFit, branches: Branches) -> Transition:
    """Return the transition that branches show."""
    fit = branches.fit
    best, low, high, least = (
        data.reference_speed * float(np.exp(v))
        for v in (fit.values[-1], *branches.meeting, branches.parted_at)
    )
    reach = quantile(fit.freedom_of("at"))
    return Transition(
        speed=Estimate(best, best * float(np.log(high / low)) / (2 * reach), low, high),
        least_torque_speed=least,
        mixed_exponent=fit.estimate("c_mixed"),
        temperature_exponent=transition_exponent(*_powers(fit)),
        evidence=single.aicc - fit.aicc,
        gradual=branches.gradual,
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


def _scaled_speed(data: Observations, fit: LawFit) -> FloatArray:
    """Logarithm of speed at the same Hersey number at the reference temperature."""
    shift = transition_exponent(*_powers(fit)) * _temperatures(data, _law_of(fit))
    return np.asarray(data.inputs.log_speed - shift)


def _trend_lines(
    data: Observations, law: Law, single: LawFit, splits: list[tuple[float, BoolArray]], exponent: float
) -> Branches:
    """A trend line on either side of the likeliest split; where they meet is as uncertain as the split."""
    limit = splits[0][0] + quantile(len(data)) ** 2
    solved = [(chi, below, _fit_split(data, law, single, below)) for chi, below in splits if chi <= limit]
    meetings = [fit.estimate("at") for _, _, fit in solved]
    likeliest = [s for s in solved if s[0] <= splits[0][0] + 1e-9]
    _, below, best = min(likeliest, key=lambda s: s[2].aicc)
    scaled = data.inputs.log_speed - exponent * _temperatures(data, law)
    return Branches(
        best,
        parted_at=0.5 * float(scaled[below].max() + scaled[~below].min()),
        meeting=(min(m.low for m in meetings), max(m.high for m in meetings)),
        gradual=True,
    )


def _is_gradual(data: Observations, law: Law, corner: LawFit) -> bool:
    """Whether a bend of some width describes the data much better than a corner."""
    bends = (fit_law(replace(law, bend=Bend(width)), data, [corner.values]) for width in BEND_WIDTHS)
    return any(bend.aicc_with(1) < corner.aicc - EVIDENCE for bend in bends)


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
