"""Share failed against age, on axes that make a Weibull law a straight line."""

from __future__ import annotations

import altair as alt
import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, HEIGHT, INK, WIDTH, Chart, age_tip, plot, rows_of, tip
from hersey.life.population import Population

#: Shares named on the axis; the first and the last end it.
SHARES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.632, 0.9, 0.99)
#: Points of the line, and the factor by which the axis of ages goes beyond units and line.
_POINTS, _BEYOND = 81, 1.25


def weibull_chart(population: Population) -> Chart:
    """Return the Weibull plot: failures at median ranks, the law with its band, and the other specimens.

    A unit that has not failed is a tick on the axis of ages.
    """
    x = _ages_axis(population, "age:Q")
    y = share_axis("place:Q")
    layers = [*_law(population, x, y), _failures(population, x, y)]
    others = population.ages[~population.failed]
    if others.size:
        layers.append(not_failed(others, population.unit, x, HEIGHT))
    title = alt.Title("Weibull plot", subtitle=_heading(population))
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def _ages_axis(population: Population, field: str) -> alt.X:
    return alt.X(
        field,
        title=f"Age ({population.unit or 'as given'})",
        scale=alt.Scale(type="log", domain=_domain(population), nice=False),
        axis=alt.Axis(format="~s", tickCount=8),
    )


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


def _heading(population: Population) -> list[str]:
    law = "" if population.shape is None else f"; line and {100 * population.level:g} % band: Weibull law"
    words = f"points: failures at median ranks{law}; ticks: specimens that have not failed"
    return [population.headline(), words, *(each.sentence for each in population.warnings)]


def _domain(population: Population) -> list[float]:
    """All specimens, and the law from 1 % to 99 % within a hundredfold of them."""
    low, high = float(population.ages.min()), float(population.ages.max())
    if population.shape is not None:
        first, last = (float(each) for each in population.lives([SHARES[0], SHARES[-1]])[0])
        low, high = max(min(low, first), low / 100), min(max(high, last), high * 100)
    return [low / _BEYOND, high * _BEYOND]


def _law(population: Population, x: alt.X, y: alt.Y) -> list[alt.Chart]:
    if population.shape is None:
        return []
    places = np.linspace(float(place(SHARES[0])), float(place(SHARES[-1])), _POINTS)
    shares = -np.expm1(-np.exp(places))
    ages, low, high = population.lives(shares)
    # Ends far outside would overflow the axis: they are drawn where it has long ended.
    first, last = _domain(population)
    low, high = np.maximum(low, first / 10), np.minimum(high, last * 10)
    rows = rows_of(age=ages, low=low, high=high, place=places, share=100 * shares)
    chart = plot(rows)
    band = chart.mark_area(orient="horizontal", color=BLUE, opacity=0.15, clip=True)
    line = chart.mark_line(color=BLUE, strokeWidth=2, clip=True)
    tips = [tip("share", "share failed (%)"), age_tip(population.unit), tip("low", "from"), tip("high", "to")]
    return [
        band.encode(x=_ages_axis(population, "low:Q"), x2="high:Q", y=y),
        line.encode(x=x, y=y, order=alt.Order("place:Q"), tooltip=tips),
    ]


def _failures(population: Population, x: alt.X, y: alt.Y) -> alt.Chart:
    ages, shares = population.median_ranks
    points = plot(rows_of(age=ages, place=place(shares), share=100 * shares))
    mark = points.mark_point(color=INK, filled=True, opacity=1, size=60, clip=True)
    chart: alt.Chart = mark.encode(
        x=x, y=y, tooltip=[age_tip(population.unit), tip("share", "median rank (%)")]
    )
    return chart


def not_failed(ages: FloatArray, unit: str, x: alt.X, height: float) -> alt.Chart:
    """Return the specimens that have not failed, as ticks on the axis of ages of a chart of this height."""
    ticks: alt.Chart = plot(rows_of(age=ages)).mark_rule(color=INK, strokeWidth=2)
    ends = {"y": alt.value(height - 14), "y2": alt.value(height)}
    return ticks.encode(x=x, tooltip=[age_tip(unit)], **ends)
