"""Two branches of the law: where they part, whether the data prove them, and where they meet.

The points part where torque is least (isotonic regression, no law assumed). From there the law with a corner
is fitted. Where a gradual bend describes the data better than a corner, or a corner leaves a trend, each
branch is instead the trend line through the points on its side, as one would draw it by hand. Trend lines
meet below the torque measured, and not where it is least: the transition is then the minimum of a smooth
curve through the points.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from scipy import optimize

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.candidates.branched import FREE, HELD, Bend, Law, transition_exponent
from hersey.damping.candidates.fitting import LawFit, fit_law, starts_of
from hersey.damping.candidates.intervals import profile_interval
from hersey.damping.candidates.likelihood import EVIDENCE, scatter_beyond
from hersey.damping.candidates.observations import Observations
from hersey.damping.dwells import SAME_SPEED, distinct_speeds
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.gradual import Closure, closure_at, least_around, trend_left
from hersey.damping.scaled import law_of, move_of, powers_of, scaled_speed, temperatures_of
from hersey.result import Means, Record

#: Widths of a bend, in the logarithm of speed, that a corner is compared with.
BEND_WIDTHS = (0.15, 0.3, 0.6)
#: Points and distinct speeds that each branch needs: a line through two would fit any.
MIN_BRANCH_POINTS, MIN_BRANCH_SPEEDS = 3, 2
#: Twice the logarithm of likelihood by which a corner leaves a trend: by chance one time in a hundred, and
#: in a thousand.
TREND, PROVEN_TREND = 5.4, 9.6
_NOT_TOLD = (-np.inf, np.inf)


@dataclass(frozen=True)
class Branches:
    """Two branches as fitted, and where torque is least (logarithms of scaled speed)."""

    fit: LawFit
    least: float  #: not a number if a smooth curve has no minimum
    ends: tuple[float, float]  #: 95 % interval
    mixed: Estimate  #: exponent of the falling branch
    closure: Closure | None  #: None where the branches meet in a corner
    freed: float | None = None  #: as `Transition` has it


@dataclass(frozen=True)
class Transition(Record):
    """Transition: where torque is lowest, between the falling (mixed) and the rising (EHL) branch."""

    speed: Estimate  #: rad/s, at the reference temperature of the surface
    meeting_speed: Annotated[float, Means("speed at which the trend lines meet; equal to speed at a corner")]
    mixed_exponent: Estimate  #: exponent of damping in speed below it, of the trend line if gradual
    temperature_exponent: float  #: transition speed varies as T to this power
    evidence: Annotated[float, Means("AICc improvement over a single power law")]
    closure: Annotated[
        Closure | None,
        Means("corner that replaces a gradual bend in the motion; null for a corner"),
    ] = None
    #: AICc of a transition at one Hersey number minus that of this one, where it moves by itself
    freed: Annotated[
        float | None, Means("AICc penalty of a fixed Hersey number, if that is rejected; else null")
    ] = None

    @property
    def gradual(self) -> bool:
        """Whether the bend is gradual: the branches are trend lines, its minimum that of a smooth curve."""
        return self.closure is not None


def fit_branches(data: Observations, single: LawFit) -> Branches | None:
    """Return the best two branches, or None if there are too few points for any."""
    law = replace(law_of(single), branches=HELD)
    trend, powers, splits = None, powers_of(single), []
    for _ in range(4):  # which points are slow depends on the law, which depends on it
        splits = _splits(data, single, transition_exponent(*powers))
        if not splits:
            return None
        trend = _trend_lines(data, law, single, splits)
        if np.allclose(powers, powers_of(trend), rtol=1e-9):
            break
        powers = powers_of(trend)
    assert trend is not None
    # the split may hold a dwell of the other branch, so that the corner is searched from elsewhere as well
    corner = fit_law(law, data, [trend.values, *starts_of(law, data)])
    free, gain = _freed(data, corner)
    branches = _bent(data, free, trend, _parted(data, trend, splits))
    return replace(branches, freed=gain) if branches.fit is free else branches


def why_no_transition(data: Observations, single: LawFit, branches: Branches) -> str:
    """Return why there is no second branch; empty if torque clearly falls and then rises."""
    fit = branches.fit
    below, above, at = branches.mixed, fit.estimate("c"), branches.least
    if branches.closure is None and (few := _few(data, fit)):
        return few
    gain = single.aicc - fit.aicc
    if gain < EVIDENCE:
        return (
            f"a second branch is not supported by the data (AICc gain {gain:.1f}, at least {EVIDENCE:g} "
            "needed)"
        )
    if below.high >= -1.0:
        if not (meeting := _meeting(data, fit)):
            return (
                "two branches would meet outside the measured speeds, and the slower one, with "
                f"exponent {below}, does not prove that {data.domain.quantity} falls with speed"
            )
        return (
            f"the exponent below {meeting}, {below}, does not prove that {data.domain.quantity} falls with "
            "speed there"
        )
    if above.low <= -1.0:
        return (
            f"the exponent above the bend, {above}, does not prove that {data.domain.quantity} rises with "
            "speed there"
        )
    scaled = scaled_speed(data, fit)
    if not scaled.min() < at < scaled.max():
        return "the falling and the rising branch would meet outside the measured speeds"
    if not np.all(np.isfinite(branches.ends)):
        return "the data do not bound the speed at which the falling and the rising branch meet"
    return ""


def transition(data: Observations, single: LawFit, branches: Branches) -> Transition:
    """Return the transition between two branches."""
    fit = branches.fit
    best, low, high, meeting = (
        data.reference_speed * float(np.exp(v)) for v in (branches.least, *branches.ends, _corner_of(fit))
    )
    reach = quantile(fit.freedom_of("at"))
    return Transition(
        speed=Estimate(best, best * float(np.log(high / low)) / (2 * reach), low, high),
        meeting_speed=meeting,
        mixed_exponent=branches.mixed,
        temperature_exponent=move_of(fit),
        evidence=single.aicc - fit.aicc,
        closure=branches.closure,
        freed=branches.freed,
    )


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


def _freed(data: Observations, corner: LawFit) -> tuple[LawFit, float | None]:
    """The corner, or one that moves by itself where one Hersey number is excluded, and its gain in AICc."""
    law = replace(law_of(corner), branches=FREE)
    # where it is unknown how far visits scatter, what parts two of them would pass for another transition
    if law.thermal is None or any(not shared.estimable for shared in corner.shared):
        return corner, None
    free = fit_law(law, data, [np.append(corner.values, move_of(corner)), *starts_of(law, data)])
    gain = corner.aicc - free.aicc
    return (free, gain) if gain > EVIDENCE else (corner, None)


def _bent(data: Observations, corner: LawFit, trend: LawFit, parted: tuple[float, float]) -> Branches:
    """A corner, or trend lines about a gradual bend; while neither is excluded, the interval holds both."""
    law, at = law_of(corner), _corner_of(corner)
    bends = [fit_law(replace(law, bend=Bend(width)), data, [corner.values]) for width in BEND_WIDTHS]
    gain = corner.aicc - min(bend.aicc_with(1) for bend in bends)
    trend_of_corner = trend_left(data, corner)
    if gain > EVIDENCE or trend_of_corner > PROVEN_TREND:
        return _around_a_bend(data, trend, parted, None)
    if _few(data, corner):
        return Branches(corner, at, _NOT_TOLD, corner.estimate("c_mixed"), None)
    ends = profile_interval(corner, data, law.index("at"))
    sharp = Branches(corner, at, ends, _mixed(data, corner), None)
    if min(bend.deviance for bend in bends) >= corner.deviance and trend_of_corner < TREND:
        return sharp
    gradual = _around_a_bend(data, trend, parted, ends)
    if max(gain, trend_of_corner - TREND) > 0.0 and gradual.closure is not None:
        return gradual
    return sharp if gradual.closure is None else replace(sharp, ends=_both(ends, gradual.ends))


def _mixed(data: Observations, corner: LawFit) -> Estimate:
    """The exponent below a corner: also where a dwell beside it may be of either branch (by its profile)."""
    by_slope = corner.estimate("c_mixed")
    low, high = _both(
        (by_slope.low, by_slope.high), profile_interval(corner, data, law_of(corner).index("c_mixed"))
    )
    error = (high - low) / (2.0 * quantile(by_slope.freedom))
    return replace(by_slope, low=low, high=high, error=error if np.isfinite(error) else by_slope.error)


def _around_a_bend(
    data: Observations, trend: LawFit, parted: tuple[float, float], corner: tuple[float, float] | None
) -> Branches:
    """The trend lines on either side, and the minimum between them.

    Where the dwells do not bound it, the speeds between which they part do. ``corner`` is the interval of a
    corner that is not excluded.
    """
    least, groups = least_around(data, trend)
    if least is None:
        return Branches(trend, np.nan, _NOT_TOLD, trend.estimate("c_mixed"), None)
    low, high = least.ends
    ends = (
        low if np.isfinite(low) else min(parted[0], least.log_speed),
        high if np.isfinite(high) else max(parted[1], least.log_speed),
    )
    ends = ends if corner is None else _both(ends, corner)
    closure = closure_at(data, trend, least, groups, ends)
    return Branches(trend, least.log_speed, ends, trend.estimate("c_mixed"), closure)


def _both(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    return min(one[0], other[0]), max(one[1], other[1])


def _fit_split(data: Observations, law: Law, single: LawFit, below: BoolArray) -> LawFit:
    """The law with each point held to its branch, from two lines of their own."""
    z, of_temperature = data.inputs.log_speed, [temperatures_of(data, law)] if law.thermal else []
    columns = [np.ones_like(z), *of_temperature, z, below * 1.0, below * z]
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
    scaled = data.inputs.log_speed - exponent * temperatures_of(data, law_of(single))
    order = np.argsort(scaled, kind="stable")
    torque = data.log_torque
    residuals = _unimodal_residuals(torque[order])
    scatter = scatter_beyond(residuals, single.errors[order], max(scaled.size // 2, 1))
    weights = 1.0 / (single.errors[order] ** 2 + scatter**2 + 1e-18)
    falling, rising = _falling_and_rising(torque[order], weights)
    splits = []
    for i in np.nonzero(np.diff(scaled[order]) > 0.5 * SAME_SPEED)[0]:
        below = np.asarray(scaled <= 0.5 * (scaled[order][i] + scaled[order][i + 1]))
        if _enough(data, below) and _enough(data, ~below):
            splits.append((float(falling[i] + rising[i + 1]), below))
    return sorted(splits, key=lambda f: f[0])


def _unimodal_residuals(torque: FloatArray) -> FloatArray:
    """Residuals of the best curve that falls, then rises."""
    flat: FloatArray = np.asarray(torque - torque.mean())
    falling, rising = _falling_and_rising(torque, np.ones(torque.size))
    i = 1 + int(np.argmin(falling[:-1] + rising[1:])) if torque.size > 1 else 0
    if i == 0 or falling[i - 1] + rising[i] >= flat @ flat:
        return flat
    down = optimize.isotonic_regression(torque[:i], increasing=False).x
    return np.asarray(torque - np.append(down, optimize.isotonic_regression(torque[i:]).x))


def _falling_and_rising(values: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Weighed squares left by the best falling curve up to each value, and the best rising one from it on."""
    return _left_by_rising(-values, weights), _left_by_rising(-values[::-1], weights[::-1])[::-1]


def _left_by_rising(values: FloatArray, weights: FloatArray) -> FloatArray:
    """Weighed squares left by the best rising curve up to each value.

    Neighbours that would fall are pooled (Barlow et al., Statistical Inference under Order Restrictions,
    1972); what is pooled up to a value does not depend on those after it.
    """
    pools: list[tuple[float, float, float]] = []  # weight, mean, and squares left up to the end of the pool
    left = np.empty(values.size)
    for i, (mean, weight) in enumerate(zip(values.tolist(), weights.tolist(), strict=True)):
        own = 0.0
        while pools and pools[-1][1] >= mean:
            other, level, up_to = pools.pop()
            own += up_to - (pools[-1][2] if pools else 0.0)
            own += other * weight / (other + weight) * (level - mean) ** 2
            mean, weight = (other * level + weight * mean) / (other + weight), other + weight
        left[i] = own + (pools[-1][2] if pools else 0.0)
        pools.append((weight, mean, float(left[i])))
    return left


def _corner_of(fit: LawFit) -> float:
    """Where the lines of the branches meet, logarithm of scaled speed."""
    return float(fit.values[law_of(fit).index("at")])


def _meeting(data: Observations, fit: LawFit) -> str:
    """Where the lines meet at the reference temperature, in words; empty if outside the measured speeds."""
    at, measured = _corner_of(fit), data.inputs.log_speed
    if not measured.min() <= at <= measured.max():
        return ""
    return data.domain.at(data.reference_speed * float(np.exp(at)))


def _few(data: Observations, corner: LawFit) -> str:
    """Return which side of a corner has too few dwells to be a branch; empty if both have enough."""
    at = _corner_of(corner)
    away = scaled_speed(data, corner) - at
    speed = _meeting(data, corner)
    for side, where, what in ((away < 0.0, "below", "slower"), (away >= 0.0, "above", "faster")):
        if not _enough(data, side):
            held, levels = int(np.count_nonzero(side)), distinct_speeds(data.speed[side])
            if not speed:
                return f"two branches would meet outside the measured speeds. Record {what} dwells"
            return (
                f"only {held} dwells at {levels} speeds lie {where} {speed}, where two branches would meet; "
                f"{MIN_BRANCH_POINTS} dwells at {MIN_BRANCH_SPEEDS} speeds are needed. Record {what} dwells"
            )
    return ""


def _enough(data: Observations, side: BoolArray) -> bool:
    points, speeds = int(np.count_nonzero(side)), distinct_speeds(data.speed[side])
    return points >= MIN_BRANCH_POINTS and speeds >= MIN_BRANCH_SPEEDS
