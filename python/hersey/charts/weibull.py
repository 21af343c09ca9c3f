"""Axes that make a Weibull law a straight line, and the specimens that have not failed."""

from __future__ import annotations

import altair as alt
import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.charts.style import INK, age_tip, plot, rows_of

#: Shares named on the axis; the first and the last end it.
SHARES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.632, 0.9, 0.99)


def share_axis(field: str) -> alt.Y:
    """Return the axis on which a Weibull law is a straight line, for a field of `place`."""
    share = "1 - exp(-exp(datum.value))"
    return alt.Y(
        field,
        title="Share failed (%)",
        scale=alt.Scale(domain=place([SHARES[0], SHARES[-1]]).tolist(), nice=False),
        axis=alt.Axis(values=place(SHARES).tolist(), labelExpr=f"format(100 * ({share}), '.3~g')"),
    )


def place(shares: ArrayLike) -> FloatArray:
    """Return where shares stand on the axis: a Weibull law is a straight line there."""
    return np.asarray(np.log(-np.log1p(-np.asarray(shares, dtype=float))))


def not_failed(ages: FloatArray, unit: str, x: alt.X, height: float) -> alt.Chart:
    """Return the specimens that have not failed, as ticks on the axis of ages of a chart of this height."""
    ticks: alt.Chart = plot(rows_of(age=ages)).mark_rule(color=INK, strokeWidth=2)
    ends = {"y": alt.value(height - 14), "y2": alt.value(height)}
    return ticks.encode(x=x, tooltip=[age_tip(unit)], **ends)
