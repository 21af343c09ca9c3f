"""The least cost of a law at fixed standard errors: over its values and the effects of disturbances."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.candidates.bordered import Bordered
from hersey.damping.candidates.likelihood import Minimum, minimise
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.reduced_search import ReducedSearch, SearchedLaw
from hersey.damping.candidates.shared_errors import stated
from hersey.damping.candidates.visit_effects import VisitColumns


class Effort(NamedTuple):
    """When a search ends: at a relative ``precision``, or after so many ``calls`` of the law."""

    precision: float = 1e-9
    calls: int = 20


@dataclass(frozen=True)
class Found(Minimum):
    """Where a search found the least cost, values and effects; ``bordered`` if those of visits are many."""

    bordered: Bordered | None = None


#: The effort of a search where none is stated.
USUAL = Effort()


def search(
    law: SearchedLaw,
    data: Observations,
    columns: FloatArray,
    sigma: FloatArray,
    start: FloatArray,
    *,
    held: tuple[int, float] | None = None,
    expected: FloatArray | None = None,
    effort: Effort = USUAL,
) -> Found:
    """Return the least cost at fixed standard errors, over the values and the effects of disturbances.

    Parameters
    ----------
    columns
        By how much each disturbance moves ln torque, shape (points, disturbances).
    start
        Values and effects.
    held
        Index and value of one parameter that is not varied.
    expected
        Expectation of the effects, in their standard errors; zeros if not given.
    effort
        When it ends.
    """
    own = VisitColumns.among(columns, data.visit, stated(data))
    if own is not None:
        return _search_beside(law, data, columns, own, sigma, start, held, expected, effort)
    base, free = _freed(start, held)
    modes = columns.shape[1]
    size = start.size - modes
    # what no step of the search moves
    fixed = np.vstack([np.zeros((len(data), start.size)), np.eye(modes, start.size, size)])
    fixed[: len(data), size:] = -columns / sigma[:, None]
    centre = np.zeros(modes) if expected is None else expected

    def whole(some: FloatArray) -> FloatArray:
        full = base.copy()
        full[free] = some
        return full

    def residual(some: FloatArray) -> FloatArray:
        full = whole(some)
        return np.append(residuals_of(law, data, columns, full) / sigma, full[size:] - centre)

    def jacobian(some: FloatArray) -> FloatArray:
        slopes = fixed.copy()
        slopes[: len(data), :size] = -law.jacobian(whole(some)[:size], data.inputs) / sigma[:, None]
        return slopes if held is None else slopes[:, free]

    minimum = minimise(residual, jacobian, base[free], precision=effort.precision, calls=effort.calls)
    rows = np.zeros((minimum.jacobian.shape[0], start.size))
    rows[:, free] = minimum.jacobian
    return Found(whole(minimum.values), minimum.cost, rows)


def _freed(start: FloatArray, held: tuple[int, float] | None) -> tuple[FloatArray, BoolArray]:
    """Where a search begins, with a parameter that is held at its value, and which are not held."""
    base, free = np.array(start), np.ones(start.size, dtype=bool)
    if held is not None:
        free[held[0]], base[held[0]] = False, held[1]
    return base, free


def _search_beside(
    law: SearchedLaw,
    data: Observations,
    columns: FloatArray,
    own: VisitColumns,
    sigma: FloatArray,
    start: FloatArray,
    held: tuple[int, float] | None,
    expected: FloatArray | None,
    effort: Effort,
) -> Found:
    """The same where many effects are those of visits: they are no unknowns of the search."""
    size, one = start.size - columns.shape[1], np.zeros(1, dtype=np.intp)
    centre = np.zeros((1, columns.shape[1])) if expected is None else expected[None]
    problem = ReducedSearch(law, data, columns, own, sigma, centre, np.ones((1, len(data))))
    base, free = _freed(np.append(start[:size], own.split(start[size:])[1]), held)

    def whole(some: FloatArray) -> FloatArray:
        full = base.copy()
        full[free] = some
        return full[None]

    minimum = minimise(
        lambda some: problem.residual(whole(some), one)[0],
        lambda some: problem.jacobian(whole(some), one)[0][:, free],
        base[free],
        precision=effort.precision,
        calls=effort.calls,
    )
    values = whole(minimum.values)
    found = np.append(values[0, :size], problem.effects(values, one)[0])
    return Found(found, minimum.cost, minimum.jacobian, problem.bordered(values))


def residuals_of(law: SearchedLaw, data: Observations, columns: FloatArray, values: FloatArray) -> FloatArray:
    """Return ln(measured/fitted) at values and effects, effects subtracted."""
    size = values.size - columns.shape[1]
    return np.asarray(data.log_torque - law.predict(values[:size], data.inputs) - columns @ values[size:])
