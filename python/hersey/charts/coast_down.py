"""Speeds of coast-downs with the fitted curve, and the friction torque against speed."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.style import (
    BLUE,
    EDGE,
    GREEN,
    INK,
    ORANGE,
    SHADE,
    WIDTH,
    Chart,
    categories,
    plot,
    rows_of,
    stacked,
    tip,
    torque_unit,
)
from hersey.damping.coast_down.result import NAMES, CoastDown
from hersey.units import rpm

#: Rows drawn of each coast, at the most.
_DRAWN = 600
_LAW = "fitted law"


def coast_down_chart(found: CoastDown) -> Chart:
    """Return the chart of coast-downs: speeds over time, each from its start, and torque with its terms."""
    count = len(found.coasts)
    title = alt.Title(
        f"Friction from {count} coast-down{'s' if count > 1 else ''}",
        subtitle="dots: measured, above rows, below windows of speed with two standard errors; shade: 95 %",
    )
    return stacked(_speeds(found), _torques(found), spacing=16, title=title)


def _speeds(found: CoastDown) -> Chart:
    dots, lines = [], []
    for index, coast in enumerate(found.coasts):
        step = max(1, coast.rows // _DRAWN)
        time = coast.time[::step]
        dots += rows_of(time=time, speed=rpm(coast.speed[::step]))
        fitted = rpm(found.fit.predicted(index, time))
        lines += rows_of(time=time, speed=fitted, coast=[index] * time.size, index=range(time.size))
    x = alt.X("time:Q", title="Time from the start of each coast (s)", scale=alt.Scale(nice=False))
    y = alt.Y("speed:Q", title="Speed (rpm)")
    measured = plot(dots).mark_point(filled=True, size=12, color=ORANGE, opacity=0.5).encode(x=x, y=y)
    curve = plot(lines).mark_line(color=BLUE, strokeWidth=1.5)
    curve = curve.encode(x=x, y=y, detail="coast:N", order="index:Q")
    return alt.layer(measured, curve).properties(width=WIDTH, height=220)


def _torques(found: CoastDown) -> Chart:
    factor, unit = torque_unit(float(found.torque.max()))
    speed = rpm(found.speeds)
    band = rows_of(speed=speed, low=factor * found.low, high=factor * found.high)
    parts = found.friction.law * found.speeds[:, None] ** np.arange(found.friction.law.size)
    lines = rows_of(speed=speed, torque=factor * found.torque, line=[_LAW] * speed.size)
    for term, part in zip(NAMES, parts.T, strict=True):
        lines += rows_of(speed=speed, torque=factor * part, line=[term] * speed.size) if part.any() else []
    at = [factor * found.inertia.value * each.rate for each in found.windows]
    error = [2.0 * factor * found.inertia.value * each.rate_error for each in found.windows]
    dots = rows_of(
        speed=[rpm(each.speed) for each in found.windows],
        torque=at,
        low=[a - e for a, e in zip(at, error, strict=True)],
        high=[a + e for a, e in zip(at, error, strict=True)],
    )
    x = alt.X("speed:Q", title="Speed (rpm)")
    name = f"Friction torque ({unit})"
    y = alt.Y("torque:Q", title=name)
    legend = alt.Legend(title=None, orient="bottom", symbolOpacity=1)
    looks = dict(zip((_LAW, *NAMES), (BLUE, EDGE, GREEN, INK), strict=True))
    color = categories(alt.Color, "line", looks, legend)
    tips = [
        alt.Tooltip("line:N", title="line"),
        tip("speed", "speed (rpm)"),
        tip("torque", f"torque ({unit})"),
    ]
    shade = plot(band).mark_area(color=SHADE).encode(x=x, y=alt.Y("low:Q", title=name), y2="high:Q")
    curves = plot(lines).mark_line(strokeWidth=1.5).encode(x=x, y=y, color=color, tooltip=tips)
    bars = plot(dots).mark_rule(color=ORANGE).encode(x=x, y="low:Q", y2="high:Q")
    points = plot(dots).mark_point(filled=True, size=28, color=ORANGE)
    points = points.encode(x=x, y=y, tooltip=tips[1:])
    return alt.layer(shade, bars, curves, points).properties(width=WIDTH, height=260)
