"""Friction against age at one speed: blocks, the law with its interval, the steady value and its age."""

from __future__ import annotations

from typing import Any

import altair as alt

from hersey.charts.over_time import moment, shaded
from hersey.charts.style import BLUE, GREEN, HEIGHT, INK, RED, WIDTH, Chart, level, plot, rows_of, tip
from hersey.errors import capital
from hersey.life.trend.result import FrictionTrend
from hersey.life.trend.shown import age_unit, friction_unit

#: What an axis of age is called, by what it is counted in.
_AXES = {"time": "Time in motion", "distance": "Distance", "revolutions": "Revolutions"}


def trend_chart(found: FrictionTrend) -> Chart:
    """Return friction against age; green is the part in which it is steady."""
    unit, size = age_unit(found.by, found.last_age)
    named, factor = friction_unit(found.domain.unit, float(abs(found.value).max()))
    end = found.last_age / size
    title = _AXES[found.by] if found.by == "revolutions" else f"{_AXES[found.by]} ({unit})"
    x = alt.X("time:Q", title=title, scale=alt.Scale(domain=[0.0, end], nice=False))
    label = f"{capital(found.domain.quantity)} ({named})" if named else capital(found.domain.quantity)
    y = alt.Y("value:Q", title=label, scale=alt.Scale(zero=False))
    tips = [tip("time", f"age ({unit})"), tip("value", label)]
    rows: dict[str, Any] = {"time": found.age / size}
    blocks = plot(rows_of(**rows, value=factor * found.value))
    law = plot(rows_of(**rows, value=factor * found.fitted, low=factor * found.low, high=factor * found.high))
    layers: list[Any] = []
    if (steady := _steady_from(found)) is not None and steady < found.last_age:
        layers.append(shaded([(steady / size, end)], GREEN))
    layers += [
        law.mark_area(color=BLUE, opacity=0.2).encode(x=x, y=alt.Y("low:Q", title=label), y2="high:Q"),
        blocks.mark_circle(color=INK, size=14, opacity=0.6).encode(x=x, y=y, tooltip=tips),
        law.mark_line(color=BLUE, strokeWidth=2.2).encode(x=x, y=y, tooltip=tips),
    ]
    if found.steady is not None:
        layers += level(factor * found.steady.value, "steady")
    for jump in found.jumps:
        age = jump.age / size
        layers += moment(age, f"jump {100.0 * jump.change.value:+.0f} %", x, left=age > 0.5 * end, color=RED)
    subtitle = [f"{found.headline()}.", _key(found)]
    heading = alt.Title(f"{capital(found.domain.quantity)} at one speed", subtitle=subtitle)
    chart: Chart = alt.layer(*layers, title=heading, width=WIDTH, height=HEIGHT)
    return chart


def _steady_from(found: FrictionTrend) -> float | None:
    return None if found.steady_age is None else found.steady_age.value


def _key(found: FrictionTrend) -> str:
    steady = f"; green: within {100 * found.share:.3g} % of steady" if found.steady is not None else ""
    return f"points: means of rows; line and band: law with its 95 % interval{steady}"
