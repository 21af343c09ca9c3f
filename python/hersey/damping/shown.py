"""Whether the dwells themselves show that torque falls and rises: enough of them, in each direction.

Two branches can be fitted where one dwell stands out, or where the forward rotation falls and the reverse one
does not. A transition is announced of what the dwells show by themselves.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.branches import Branches
from hersey.damping.candidates.observations import Observations
from hersey.damping.dwells import SAME_SPEED, SteadyPoints, distinct_speeds
from hersey.damping.dwells.groups import levels_of_speed
from hersey.damping.estimate import quantile
from hersey.damping.scaled import scaled_speed, scaled_torque
from hersey.errors import ROTATION

#: Speeds on either side whose torque must exceed the least.
ABOVE_LEAST = 2
#: Standard errors by which it must fall and rise in each direction that has enough speeds.
_IN_EACH = 1.0
#: Speeds on either side from which on a direction is asked.
_SPEEDS_OF_A_WAY = 3


def why_not_shown(points: SteadyPoints, data: Observations, branches: Branches) -> str:
    """Return why the dwells do not show the transition that branches have; empty if they do."""
    z, y = scaled_speed(data, branches.fit), scaled_torque(data, branches.fit)
    sides = (z < branches.least, "below", "fall"), (z >= branches.least, "above", "rise")
    at, quantity = data.domain.at(data.reference_speed * float(np.exp(branches.least))), data.domain.quantity
    for side, where, _ in sides:
        high, speeds = _higher(z, y, side, branches, _least(branches, float(np.log(data.reference_speed))))
        if high < ABOVE_LEAST:
            return (
                f"{where} {at}, {quantity} clearly exceeds its minimum at only {high} of {speeds} speeds, "
                f"and {ABOVE_LEAST} are needed. Record more dwells {where} this speed"
            )
    for ways, advice in _directions(points):
        judged = [
            (way, dwells) for way, dwells in ways if all(_enough(data, dwells & s) for s, _, _ in sides)
        ]
        for side, where, does in sides:
            missing = [way for way, dwells in judged if _trend(z, y, branches, side & dwells) < _IN_EACH]
            if missing:
                ways_named = " or ".join(missing)
                return f"{where} {at}, {quantity} does not {does} in the dwells {ways_named}{advice}"
    return ""


def _higher(
    z: FloatArray, y: FloatArray, side: BoolArray, branches: Branches, least: tuple[float, float]
) -> tuple[int, int]:
    """How many speeds of a side have more torque than the least beyond the errors, and of how many."""
    torque, error = least
    levels = levels_of_speed(z, np.flatnonzero(side), 0.5 * SAME_SPEED)
    reach, weight = quantile(branches.fit.freedom), 1.0 / branches.fit.sigma**2
    high = 0
    for level in levels:
        mean = float(np.average(y[level], weights=weight[level]))
        high += mean - torque > reach * float(np.hypot(error, np.sum(weight[level]) ** -0.5))
    return high, len(levels)


def _least(branches: Branches, log_reference: float) -> tuple[float, float]:
    """Least ln torque of the law with a corner at the transition, and its standard error."""
    fit, closure = branches.fit, branches.closure
    values = fit.values if closure is None else closure.values
    covariance = fit.covariance if closure is None else closure.covariance
    c, at = fit.law.index("c"), fit.law.index("at")
    by = np.zeros(values.size)
    by[0], by[c], by[at] = 1.0, values[at], 1.0 + values[c]
    level = values[0] + (0.0 if closure is None else log_reference)  # of torque, not of damping
    torque = float(level + (1.0 + values[c]) * values[at])
    return torque, float(np.sqrt(max(float(by @ covariance @ by), 0.0)))


def _directions(points: SteadyPoints) -> list[tuple[list[tuple[str, BoolArray]], str]]:
    """The ways in which dwells were come to, each with its dwells, and what to do if one shows none."""
    forward = np.asarray(points.column("speed") > 0.0)
    out = [
        (
            [("of forward rotation", forward), ("of reverse rotation", ~forward)],
            f". Fit each rotation separately with {ROTATION.to()}",
        )
    ]
    if "approach" in points.table.columns:
        approach = np.asarray(points.table["approach"].to_list())
        ways = [(f"approached {way}", np.asarray(approach == way)) for way in ("from below", "from above")]
        out.append(
            (
                ways,
                (
                    ". Warming or running-in can cause this. Run the drive in, then record speeds up "
                    "and down again"
                ),
            )
        )
    return out


def _enough(data: Observations, members: BoolArray) -> bool:
    return distinct_speeds(data.speed[members]) >= _SPEEDS_OF_A_WAY


def _trend(z: FloatArray, y: FloatArray, branches: Branches, members: BoolArray) -> float:
    """By how many standard errors torque rises away from the transition, by a line of these dwells alone."""
    away, weight = np.abs(z[members] - branches.least), 1.0 / branches.fit.sigma[members] ** 2
    centred = away - np.average(away, weights=weight)
    spread = float(np.sum(weight * centred**2))
    return float(np.sum(weight * centred * y[members]) / np.sqrt(spread))
