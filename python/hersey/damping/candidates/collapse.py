"""Whether curves of friction fall onto one when drawn against the Hersey number.

The curve they would share is a broken line through knots. Each group of points (a temperature, a speed, a
load) may then stand off it by a level and a slope of its own. If these deviations are larger than chance and
than what the points of one curve scatter, there is no common curve.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.observations import Observations
from hersey.damping.distributions import ratio_above
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import takes_si

#: Deviation of a group, relative, below which curves are one for every purpose of a drive.
NEGLIGIBLE = 0.03
#: p-value below which deviations are no chance.
_CHANCE = 0.01
#: Points for each knot of the common curve, and the most knots.
_POINTS_PER_KNOT, _MOST_KNOTS = 4, 8


@dataclass(frozen=True)
class HerseyCollapse:
    """Measure and verdict; relative deviations as root mean squares of logarithms."""

    collapses: bool | None  #: None where the data cannot tell
    deviation: float  #: of the groups from the common curve
    scatter: float  #: of points about their own group's curve
    spread_before: float  #: of the groups against speed alone, where the Hersey number was fitted
    p_value: float
    overlap: float  #: share of points at a Hersey number that another group has too
    shifts: FloatArray  #: ln(viscosity) of each group relative to the first, where fitted
    verdict: str


@takes_si()
def hersey_collapse(
    log_hersey: ArrayLike, log_friction: ArrayLike, groups: Sequence[object] | FloatArray | IntArray
) -> HerseyCollapse:
    """Judge curves whose Hersey numbers are known.

    Parameters
    ----------
    log_hersey
        ln(viscosity x speed / pressure) in any units, shape (points,).
    log_friction
        Logarithm of the friction coefficient, or of torque at one load, shape (points,).
    groups
        Which curve each point belongs to, shape (points,).

    Raises
    ------
    InsufficientDataError
        If there are fewer than two groups, or too few points to tell curves from scatter.

    Examples
    --------
    >>> import numpy as np
    >>> speed, load = np.meshgrid([1.0, 2.0, 4.0, 8.0], [1.0, 2.0, 4.0])
    >>> x = np.log(speed / load).ravel()
    >>> found = hersey_collapse(x, 0.3 * x, load.ravel())
    >>> found.collapses
    True
    """
    x, y = np.asarray(log_hersey, dtype=np.float64), np.asarray(log_friction, dtype=np.float64)
    _, group = np.unique(np.asarray(groups), return_inverse=True)
    if not (x.shape == y.shape == group.shape and x.ndim == 1):
        raise ParameterError(
            "log_hersey, log_friction and groups must be one-dimensional and of equal length"
        )
    if not (np.all(np.isfinite(x)) and np.all(np.isfinite(y))):
        raise ParameterError("Hersey number and friction must be positive and finite")
    _require(group)
    return _judged(x, y, group, np.empty(0), 0.0)


def temperature_collapse(data: Observations, shared: float = 0.0) -> HerseyCollapse:
    """Judge the temperatures of a log: viscosity at each is whatever brings its curve nearest the others'.

    ``shared`` is the relative scatter of whole visits: by so much a temperature stands off for no fault of
    its curve.

    Raises
    ------
    InsufficientDataError
        If there are fewer than two temperatures.
    """
    z, y, group = data.inputs.log_speed, data.log_torque, data.inputs.group
    _require(group)
    count = int(group.max())

    def misfit(shifts: FloatArray) -> FloatArray:
        x = z + np.append(0.0, shifts)[group]
        return np.asarray(y - _common(x, _knots(x)) @ _solved(_common(x, _knots(x)), y))

    def cost(shifts: FloatArray) -> float:
        return float(np.sum(misfit(shifts) ** 2))

    before = _deviation(z, y, group)[0]
    candidates: list[FloatArray] = [np.zeros(count)]
    for per_step in (-2.0, -1.0, -0.5, 0.5, 1.0):
        candidates.append(np.asarray(per_step * np.arange(1.0, count + 1.0)))
    start = min(candidates, key=cost)
    optimum = optimize.fmin(cost, start, maxfun=3000, xtol=1e-5, ftol=1e-10, disp=False)
    shifts = np.append(0.0, np.asarray(optimum, dtype=np.float64))
    return _judged(z + shifts[group], y, group, shifts, before, shared)


def _require(group: IntArray) -> None:
    groups, counts = np.unique(group, return_counts=True)
    if groups.size < 2:
        raise InsufficientDataError("one curve cannot collapse. Record other temperatures or loads")
    if counts.min() < 3:
        raise InsufficientDataError("a curve has fewer than 3 points. Record more speeds")


def _judged(
    x: FloatArray, y: FloatArray, group: IntArray, shifts: FloatArray, before: float, shared: float = 0.0
) -> HerseyCollapse:
    deviation, scatter, p_value = _deviation(x, y, group, fitted=max(shifts.size - 1, 0))
    overlap = _overlap(x, group)
    collapses: bool | None = True
    if overlap < 0.3:
        collapses = None
        verdict = (
            f"Whether the curves collapse cannot be determined: only {100 * overlap:.0f} % of the "
            "points share a Hersey number with another curve. Widen the speed range."
        )
    elif p_value < _CHANCE and max(NEGLIGIBLE, 0.5 * scatter) < deviation <= 2.0 * shared:
        collapses = None
        verdict = (
            f"Whether the curves collapse cannot be determined: they differ by {100 * deviation:.0f} "
            f"% rms, no more than whole visits do ({100 * shared:.0f} %)."
        )
    elif p_value < _CHANCE and deviation > max(NEGLIGIBLE, 0.5 * scatter):
        collapses = False
        verdict = (
            "The curves do NOT collapse onto one against the Hersey number: they differ by "
            f"{100 * deviation:.0f} % rms and each scatters by {100 * scatter:.1f} % (p = "
            f"{p_value:.1g}). Do not draw one Stribeck curve through them."
        )
    else:
        verdict = (
            "The curves collapse onto one against the Hersey number: they differ by "
            f"{100 * deviation:.1f} % rms and scatter by {100 * scatter:.1f} %."
        )
    return HerseyCollapse(collapses, deviation, scatter, before, p_value, overlap, shifts, verdict)


def _deviation(x: FloatArray, y: FloatArray, group: IntArray, fitted: int = 0) -> tuple[float, float, float]:
    """Root mean squares of the groups' deviations and of the scatter, and the p-value of no deviation."""
    common = _common(x, _knots(x))
    columns = [common]
    for index in range(int(group.max()) + 1):
        member = (group == index) * 1.0
        columns.append(np.column_stack([member, member * (x - x[group == index].mean())]))
    both = np.column_stack(columns)
    r_common, r_own = y - common @ _solved(common, y), y - both @ _solved(both, y)
    s_common, s_own = float(r_common @ r_common), float(r_own @ r_own)
    rank_common, rank_own = (int(np.linalg.matrix_rank(m)) for m in (common, both))
    freedom, more = y.size - rank_own - fitted, max(rank_own - rank_common, 1)
    if freedom < 2:
        raise InsufficientDataError("too few points to separate curves from scatter. Record more speeds")
    variance = s_own / freedom
    ratio = (s_common - s_own) / more / max(variance, 1e-24)
    deviation = float(np.sqrt(max(s_common - s_own - more * variance, 0.0) / y.size))
    return deviation, float(np.sqrt(variance)), float(ratio_above(ratio, more, freedom))


def _knots(x: FloatArray) -> FloatArray:
    count = int(np.clip(x.size // _POINTS_PER_KNOT, 2, _MOST_KNOTS))
    return np.unique(np.quantile(x, np.linspace(0.0, 1.0, count)))


def _common(x: FloatArray, knots: FloatArray) -> FloatArray:
    """Columns of a broken line: a constant, a slope, and a change of slope at each inner knot."""
    return np.column_stack([np.ones_like(x), x - knots[0], *(np.maximum(x - k, 0.0) for k in knots[1:-1])])


def _solved(columns: FloatArray, y: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.lstsq(columns, y, rcond=None)[0])


def _overlap(x: FloatArray, group: IntArray) -> float:
    """Share of points within the range of another group."""
    inside = np.zeros(x.size, dtype=bool)
    for index in range(int(group.max()) + 1):
        low, high = x[group == index].min(), x[group == index].max()
        inside |= (group != index) & (x >= low) & (x <= high)
    return float(np.mean(inside))
