"""Specimens of a life test and the predicted share failed, on the axes of a Weibull plot.

The age at which a specimen fails is a forecast, so each is an interval, never a point at an exact age.
"""

from __future__ import annotations

from collections.abc import Sequence

import altair as alt
import numpy as np
from scipy.special import betaincinv

from hersey.arrays import FloatArray
from hersey.charts.style import (
    BLUE,
    HEIGHT,
    INK,
    ORANGE,
    WIDTH,
    Chart,
    Row,
    age_tip,
    categories,
    plot,
    rows_of,
    tip,
)
from hersey.charts.weibull import SHARES, place, share_axis
from hersey.life.time_to_failure.estimate import ShareEnded
from hersey.life.time_to_failure.first import SpecimenEnd

#: The factor by which the axis of ages goes beyond the specimens, and its least part of the last age.
_BEYOND, _LEAST = 1.25, 0.2
#: Word and colour of each state.
_STATES = {"failed": ("failed", INK), "unclear": ("unclear", ORANGE), "running": ("running, forecast", BLUE)}


def failures_chart(specimens: Sequence[SpecimenEnd], curve: ShareEnded, unit: str) -> Chart:
    """Return the predicted share failed, and each specimen at its median rank as a 90 % interval."""
    domain = _domain(specimens, curve)
    legend = alt.Legend(title=None, orient="bottom-right", symbolOpacity=1)
    color = categories(alt.Color, "state", dict(_STATES.values()), legend)
    tips = ["unit:N", "state:N", age_tip(unit), tip("low", "from"), tip("high", "to")]
    base = plot(_specimens(specimens, domain)).encode(y=share_axis("place:Q"), color=color)
    layers = _prediction(curve, unit, domain)
    for test, dash in (("!datum.unclear", [1, 0]), ("datum.unclear", [5, 3])):
        mark = base.transform_filter(test).mark_rule(strokeWidth=3, clip=True, strokeDash=dash)
        layers.append(mark.encode(x=_ages("low:Q", unit, domain), x2="high:Q", tooltip=tips))
    points = base.transform_filter("!datum.unclear").mark_point(filled=True, opacity=1, size=60, clip=True)
    layers.append(points.encode(x=_ages("age:Q", unit, domain), tooltip=tips))
    words = [
        "line and band: prediction for new specimens, 90 %",
        "bars: 90 % interval of the age at failure of each specimen, at its median rank",
    ]
    title = alt.Title("Weibull plot", subtitle=words)
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def _ages(field: str, unit: str, domain: tuple[float, float]) -> alt.X:
    return alt.X(
        field,
        title=f"Age ({unit or 'as given'})",
        scale=alt.Scale(type="log", domain=list(domain), nice=False),
        axis=alt.Axis(format="~s", tickCount=8),
    )


def _domain(specimens: Sequence[SpecimenEnd], curve: ShareEnded) -> tuple[float, float]:
    """Ages from the first per cent or the first specimen to the last that is known."""
    last = max(each.age.last for each in specimens)
    ends = [age for each in specimens for age in (each.age.age.value, each.age.age.high)]
    known = [age for age in ends if 0.0 < age < curve.age[-1]]
    seen = curve.age[(curve.median >= SHARES[0]) & (curve.median <= SHARES[-1])].tolist()
    return max(min([last, *known, *seen]) / _BEYOND, _LEAST * last), max([last, *known, *seen]) * _BEYOND


def _specimens(specimens: Sequence[SpecimenEnd], domain: tuple[float, float]) -> list[Row]:
    """Each specimen at its rank; its interval as far as it is on the axis, if it runs from its age on."""
    ordered = sorted(specimens, key=lambda each: each.age.age.value)
    rank = np.arange(1.0, len(ordered) + 1.0)
    ranks = place(betaincinv(rank, rank[::-1], 0.5)).tolist()
    rows: list[Row] = []
    for each, at in zip(ordered, ranks, strict=True):
        age = each.age.age
        low = max(age.low, each.age.last) if each.state == "running" else age.low
        if low < domain[1]:
            ends = {"low": max(low, domain[0]), "high": min(age.high, domain[1])}
            state = {"state": _STATES[each.state][0], "unclear": each.state == "unclear"}
            rows.append(
                {"unit": each.unit, "age": min(age.value, 2.0 * domain[1]), "place": at} | ends | state
            )
    return rows


def _prediction(curve: ShareEnded, unit: str, domain: tuple[float, float]) -> list[alt.Chart]:
    inside = curve.age > 0.0
    first, last = place([SHARES[0], SHARES[-1]])

    def at(shares: FloatArray) -> FloatArray:
        return np.clip(place(np.clip(shares[inside], 1e-9, 1.0 - 1e-9)), first - 1.0, last + 1.0)

    rows = rows_of(
        age=curve.age[inside],
        share=100.0 * curve.median[inside],
        low=at(curve.low),
        median=at(curve.median),
        high=at(curve.high),
    )
    age = _ages("age:Q", unit, domain)
    band = plot(rows).mark_area(color=BLUE, opacity=0.15, clip=True)
    line = plot(rows).mark_line(color=BLUE, strokeWidth=2, clip=True)
    return [
        band.encode(x=age, y=share_axis("low:Q"), y2="high:Q"),
        line.encode(
            x=age, y=share_axis("median:Q"), tooltip=[age_tip(unit), tip("share", "share failed (%)")]
        ),
    ]
