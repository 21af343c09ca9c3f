"""Two branches of the law: where they part, whether the data prove them, and where they meet.

The points part where torque is least (isotonic regression, no law assumed). From there the law with a corner
is fitted; where a gradual bend describes the data much better than a corner, each branch is instead the trend
line through the points on its side, as one would draw it by hand.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.estimation import Estimate, Solution, fitted_scatter, quantile
from hersey.damping.law import (
    SAME_SPEED,
    FitData,
    corner_residual,
    distinct_speeds,
    hersey_exponent,
    log_damping,
)
from hersey.units import rpm

#: AICc by which a second branch must beat a single power law before it is announced.
EVIDENCE = 6.0
#: Widths of a bend, in the logarithm of speed, that a corner is compared with.
BEND_WIDTHS = (0.15, 0.3, 0.6)
#: Points and distinct speeds that each branch needs.
MIN_BRANCH_POINTS, MIN_BRANCH_SPEEDS = 4, 3


@dataclass(frozen=True)
class Branches:
    """Two branches as fitted, and where they part and meet (logarithms of scaled speed)."""

    solution: Solution
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


def fit_branches(data: FitData, single: Solution) -> Branches | None:
    """Return the best two branches, or None if there are too few points for any."""
    found, (b, c) = None, data.exponents(single)
    for _ in range(4):  # which points are slow depends on b and c, which depend on it
        temperature_exponent = hersey_exponent(b, c)
        splits = _splits(data, temperature_exponent)
        if not splits:
            return None
        found = _trend_lines(data, splits, temperature_exponent)
        if np.allclose((b, c), data.exponents(found.solution), rtol=1e-9):
            break
        b, c = data.exponents(found.solution)
    assert found is not None
    corner = data.solve(corner_residual(data), found.solution.values)
    below = np.asarray(data.scaled_speed(corner) < corner.values[-1])
    if not (_enough(data, below) and _enough(data, ~below)) or _is_gradual(data, corner):
        return found
    return Branches(corner, found.parted_at, corner.interval_of_last(), gradual=False)


def why_no_transition(data: FitData, single: Solution, branches: Branches) -> str:
    """Return why a second branch is not announced; empty if torque falls and rises beyond doubt."""
    solution = branches.solution
    below, above = solution.estimate(data.pick(c=1.0, change=1.0)), solution.estimate(data.pick(c=1.0))
    gain = single.aicc(data.error) - solution.aicc(data.error)
    if gain < EVIDENCE:
        return f"a second branch does not pay: its AICc is better by {gain:.1f}, {EVIDENCE:g} are asked"
    if below.high >= -1.0:
        bend = rpm(data.reference_speed * float(np.exp(solution.values[-1])))
        return f"below {bend:.3g} rpm the exponent is {below}: torque does not fall with speed beyond doubt"
    if above.low <= -1.0:
        return f"above the bend the exponent is {above}: torque does not rise with speed beyond doubt"
    scaled = data.scaled_speed(solution)
    if not scaled.min() < solution.values[-1] < scaled.max():
        return "the falling and the rising branch do not meet within the speeds measured"
    return ""


def transition(data: FitData, single: Solution, branches: Branches) -> Transition:
    """Return the transition that branches show."""
    solution = branches.solution
    best, low, high, least = (
        data.reference_speed * float(np.exp(v))
        for v in (solution.values[-1], *branches.meeting, branches.parted_at)
    )
    reach = quantile(data.y.size - solution.values.size)
    return Transition(
        speed=Estimate(best, best * float(np.log(high / low)) / (2 * reach), low, high),
        least_torque_speed=least,
        mixed_exponent=solution.estimate(data.pick(c=1.0, change=1.0)),
        temperature_exponent=hersey_exponent(*data.exponents(solution)),
        evidence=single.aicc(data.error) - solution.aicc(data.error),
        gradual=branches.gradual,
    )


def _trend_lines(
    data: FitData, splits: list[tuple[float, BoolArray]], temperature_exponent: float
) -> Branches:
    """A trend line on either side of the likeliest split; where they meet is as uncertain as the split."""
    limit = splits[0][0] + quantile(data.y.size) ** 2
    solved = [(chi, below, _solve_split(data, below)) for chi, below in splits if chi <= limit]
    ends = [solution.interval_of_last() for _, _, solution in solved]
    likeliest = [s for s in solved if s[0] <= splits[0][0] + 1e-9]
    _, below, best = min(likeliest, key=lambda s: s[2].aicc(data.error))
    scaled = data.z - temperature_exponent * data.temperatures
    return Branches(
        best,
        parted_at=0.5 * float(scaled[below].max() + scaled[~below].min()),
        meeting=(min(e[0] for e in ends), max(e[1] for e in ends)),
        gradual=True,
    )


def _is_gradual(data: FitData, corner: Solution) -> bool:
    """Whether a bend of some width describes the data much better than a corner."""
    for width in BEND_WIDTHS:

        def residual(values: FloatArray, width: float = width) -> FloatArray:
            return np.asarray(data.y - log_damping(values, data.temperatures, data.z, data.thermal, width))

        bend = data.solve(residual, corner.values)
        if bend.aicc(data.error, more=1) < corner.aicc(data.error) - EVIDENCE:
            return True
    return False


def _branch_residual(data: FitData, below: BoolArray) -> Callable[[FloatArray], FloatArray]:
    """Residuals with each point held to its branch, as with trend lines drawn through either side."""
    thermal = data.thermal

    def residual(values: FloatArray) -> FloatArray:
        level, b, c = (values[0], values[1], values[2]) if thermal else (values[0], 0.0, values[1])
        change, at = values[-2:]
        reach = data.z - at - hersey_exponent(b, c) * data.temperatures
        return np.asarray(data.y - level - b * data.temperatures - c * data.z - change * below * reach)

    return residual


def _solve_split(data: FitData, below: BoolArray) -> Solution:
    columns = [np.ones_like(data.z), *([data.x] if data.x is not None else []), data.z]
    slow = [below * 1.0, below * data.z]
    start, *_ = np.linalg.lstsq(np.column_stack([*columns, *slow]), data.y, rcond=None)
    jump, change = float(start[-2]), float(start[-1])
    at = -jump / change if change else float(data.z[below].max())
    return data.solve(_branch_residual(data, below), np.append(start[:-2], [change, at]))


def _splits(data: FitData, temperature_exponent: float) -> list[tuple[float, BoolArray]]:
    """Which points are slow, for every split with enough points on either side, the likeliest first.

    At a fixed Hersey number torque is a function of scaled speed alone. Its best falling curve below the
    split and best rising curve above it (isotonic regression, no law assumed) say how likely the split is.
    """
    scaled = data.z - temperature_exponent * data.temperatures
    torque = data.y + data.z
    order = np.argsort(scaled, kind="stable")
    scatter = fitted_scatter(_unimodal_residuals(torque[order]), data.error[order], max(scaled.size // 2, 1))
    weights = 1.0 / (data.error[order] ** 2 + scatter**2 + 1e-18)
    found = []
    for i in np.nonzero(np.diff(scaled[order]) > 0.5 * SAME_SPEED)[0]:
        below = np.asarray(scaled <= 0.5 * (scaled[order][i] + scaled[order][i + 1]))
        if _enough(data, below) and _enough(data, ~below):
            sides = (slice(None, i + 1), False), (slice(i + 1, None), True)
            chi = 0.0
            for side, rising in sides:
                values = torque[order][side]
                curve = optimize.isotonic_regression(values, weights=weights[side], increasing=rising)
                chi += float(np.sum(weights[side] * (values - curve.x) ** 2))
            found.append((chi, below))
    return sorted(found, key=lambda f: f[0])


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


def _enough(data: FitData, side: BoolArray) -> bool:
    points, speeds = int(np.count_nonzero(side)), distinct_speeds(data.speed[side])
    return points >= MIN_BRANCH_POINTS and speeds >= MIN_BRANCH_SPEEDS
