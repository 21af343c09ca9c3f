"""Failures typed in: the probability plot of their law, remaining life, a fleet, and tests to come."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import altair as alt
import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, EDGE, HEIGHT, INK, ORANGE, WIDTH, Chart, age_tip, plot, rows_of, tip
from hersey.charts.weibull import not_failed
from hersey.errors import capital

if TYPE_CHECKING:
    from hersey.life.failures.forecast import FleetForecast, RemainingLife
    from hersey.life.failures.law import FailureLaw
    from hersey.life.failures.test_plan import LifeTestPlan

#: Shares named on the axis, of which it shows those from the first below all points.
_SHARES = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.632, 0.8, 0.9, 0.95, 0.99)
#: Points of the line, and the factor by which the axis of ages goes beyond specimens and line.
_POINTS, _BEYOND = 41, 1.25
#: Colours of failure modes, and of failures allowed.
_COLOURS = [ORANGE, "#17694a", "#7a3f9d", "#a5301a", INK]


def law_chart(law: FailureLaw) -> Chart:
    """Return the probability plot: failures, the law with its band, and specimens that have not failed."""
    ages, shares = law.positions
    least = min([*shares.tolist(), 0.02])
    ticks = [each for each in _SHARES if each >= max([s for s in _SHARES if s < least], default=_SHARES[0])]
    domain = _domain(law, ticks)
    x = _ages(law, "age:Q", domain)
    y = _share_axis(law, ticks)
    layers = _modes(law, x, y, ticks) + _band(law, x, y, ticks, domain)
    points = plot(rows_of(age=ages, place=_place(law, shares), share=100 * shares))
    mark = points.mark_point(color=INK, filled=True, opacity=1, size=60, clip=True)
    layers.append(mark.encode(x=x, y=y, tooltip=[age_tip(law.unit), tip("share", "share failed (%)")]))
    running = law.at_use.low[~law.at_use.failed]
    if running.size:
        layers.append(not_failed(np.unique(running), law.unit, x, HEIGHT))
    title = alt.Title("Probability plot", subtitle=_heading(law))
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def _place(law: FailureLaw, shares: ArrayLike) -> FloatArray:
    """Where shares stand on the axis, on which Weibull and lognormal laws are straight lines."""
    values = np.asarray(shares, dtype=float)
    return np.asarray(ndtri(values) if law.law == "lognormal" else np.log(-np.log1p(-values)), dtype=float)


def _share_axis(law: FailureLaw, ticks: list[float]) -> alt.Y:
    places = _place(law, ticks).tolist()
    # Vega rounds the places of ticks, so each is told by the middle between it and the next.
    ends = [0.5 * (a + b) for a, b in pairwise([*places, places[-1] + 1.0])]
    named = "".join(f"datum.value < {e:.6f} ? '{100 * t:g}' : " for e, t in zip(ends, ticks, strict=True))
    return alt.Y(
        "place:Q",
        title="Share failed (%)",
        scale=alt.Scale(domain=[places[0], places[-1]], nice=False),
        axis=alt.Axis(values=places, labelExpr=f"{named}''"),
    )


def _ages(law: FailureLaw, field: str, domain: list[float]) -> alt.X:
    return alt.X(
        field,
        title=f"Age ({law.unit or 'as given'})",
        scale=alt.Scale(type="log", domain=domain, nice=False),
        axis=alt.Axis(format="~s", tickCount=8),
    )


def _domain(law: FailureLaw, ticks: list[float]) -> list[float]:
    """All specimens, and the law within a tenfold of them."""
    ends = np.concatenate([law.at_use.low, law.at_use.high])
    ends = ends[np.isfinite(ends) & (ends > 0)]
    low, high = float(ends.min()), float(ends.max())
    if law.is_known:
        first, last = (float(law.age_estimated(each)) for each in (ticks[0], ticks[-1]))
        low, high = max(min(low, first), low / 10), min(max(high, last), high * 10)
    return [low / _BEYOND, high * _BEYOND]


def _heading(law: FailureLaw) -> list[str]:
    bounds = f"; line and {100 * law.level:g} % band: {law.named} law" if law.is_known else ""
    modes = "; dashed: failure modes" if law.modes else ""
    modes += "; ages carried over to the stress of use" if law.acceleration is not None else ""
    words = f"points: failures{bounds}{modes}; ticks: specimens that have not failed"
    return [law.headline(), words, *(each.sentence for each in law.warnings)]


def _band(law: FailureLaw, x: alt.X, y: alt.Y, ticks: list[float], domain: list[float]) -> list[alt.Chart]:
    if not law.is_known:
        return []
    places = _places(law, ticks)
    shares = _share(law, places)
    ages, low, high = law.lives(shares)
    # Ends far outside would overflow the axis: they are drawn where it has long ended.
    low, high = np.maximum(low, domain[0] / 10), np.minimum(high, domain[1] * 10)
    chart = plot(rows_of(age=ages, low=low, high=high, place=places, share=100 * shares))
    band = chart.mark_area(orient="horizontal", color=BLUE, opacity=0.15, clip=True)
    line = chart.mark_line(color=BLUE, strokeWidth=2, clip=True)
    tips = [tip("share", "share failed (%)"), age_tip(law.unit), tip("low", "from"), tip("high", "to")]
    return [
        band.encode(x=_ages(law, "low:Q", domain), x2="high:Q", y=y),
        line.encode(x=x, y=y, order=alt.Order("place:Q"), tooltip=tips),
    ]


def _places(law: FailureLaw, ticks: list[float]) -> FloatArray:
    """Points of a line, evenly along the axis."""
    first, last = (float(each) for each in _place(law, [ticks[0], ticks[-1]]))
    return np.linspace(first, last, _POINTS)


def _share(law: FailureLaw, places: FloatArray) -> FloatArray:
    from scipy.special import ndtr

    return np.asarray(ndtr(places) if law.law == "lognormal" else -np.expm1(-np.exp(places)), dtype=float)


def _modes(law: FailureLaw, x: alt.X, y: alt.Y, ticks: list[float]) -> list[alt.Chart]:
    """The line of each failure mode alone, with its name."""
    if not law.modes:
        return []
    places = _places(law, ticks)
    rows = []
    for mode, fit in zip(law.modes, law.fits, strict=True):
        ages = fit.age(_share(law, places), law.stress)
        rows += [row | {"mode": mode.mode} for row in rows_of(age=ages, place=places)]
    names = [mode.mode for mode in law.modes]
    colours = alt.Scale(domain=names, range=[_COLOURS[i % len(_COLOURS)] for i in range(len(names))])
    legend = alt.Legend(title="Failure mode", orient="top")
    mark = plot(rows).mark_line(strokeDash=[5, 4], clip=True)
    order, color = alt.Order("place:Q"), alt.Color("mode:N", scale=colours, legend=legend)
    return [mark.encode(x=x, y=y, order=order, color=color, tooltip=[alt.Tooltip("mode:N")])]


def remaining_chart(found: RemainingLife) -> Chart:
    """Return the share of specimens of an age that run longer, against further age."""
    rows = rows_of(
        age=found.ahead,
        share=100 * found.outlive,
        low=100 * found.outlive_low,
        high=100 * found.outlive_high,
    )
    return _curve(
        rows,
        f"Further age ({found.unit or 'as given'})",
        "Share that still runs (%)",
        capital(found.headline()),
    )


def fleet_chart(found: FleetForecast) -> Chart:
    """Return the failures of a fleet against further age, with their prediction interval."""
    rows = rows_of(age=found.ahead, share=found.expected, low=found.low, high=found.high)
    title = f"Further age of each specimen ({found.unit or 'as given'})"
    return _curve(rows, title, "Failures", capital(found.headline()))


def _curve(rows: list[dict[str, object]], x_title: str, y_title: str, heading: str) -> Chart:
    chart = plot(rows)
    x = alt.X("age:Q", title=x_title, axis=alt.Axis(format="~s"))
    y = alt.Y("share:Q", title=y_title, scale=alt.Scale(zero=True))
    tips = [tip("age", x_title), tip("share", y_title), tip("low", "from"), tip("high", "to")]
    band = chart.mark_area(color=BLUE, opacity=0.15).encode(x=x, y=alt.Y("low:Q", title=y_title), y2="high:Q")
    line = chart.mark_line(color=BLUE, strokeWidth=2, point=True).encode(x=x, y=y, tooltip=tips)
    return alt.layer(band, line, title=alt.Title(heading), width=WIDTH, height=HEIGHT)


def plan_chart(plan: LifeTestPlan) -> Chart:
    """Return the specimens to test against test age, for each number of failures allowed."""
    rows = [
        {"age": d.age, "specimens": d.specimens, "allowed": f"{d.allowed} failed"}
        for d in plan.demonstrations
    ]
    title = f"Test age ({plan.unit or 'as given'})"
    kinds = sorted({str(row["allowed"]) for row in rows})
    chart = plot(rows).mark_line(point=True, strokeWidth=2)
    encoded = chart.encode(
        x=alt.X("age:Q", title=title, axis=alt.Axis(format="~s")),
        y=alt.Y("specimens:Q", title="Specimens to test", scale=alt.Scale(type="log")),
        color=alt.Color("allowed:N", title="", scale=alt.Scale(domain=kinds, range=[BLUE, ORANGE, EDGE])),
        tooltip=[tip("age", title), tip("specimens", "specimens"), alt.Tooltip("allowed:N")],
    )
    return alt.layer(encoded, title=alt.Title(plan.headline()), width=WIDTH, height=HEIGHT)
