"""Cost per unit of age against the age of a planned replacement."""

from __future__ import annotations

import math

import altair as alt
import numpy as np

from hersey.charts.style import BLUE, HEIGHT, INK, ORANGE, WIDTH, Chart, age_tip, plot, rows_of, tip
from hersey.life.age import one_of
from hersey.life.replacement import Replacement

#: Greatest cost on the axis, and how far the axis of ages goes beyond the best age and its interval.
_MOST, _BEYOND = 2.0, 2.0
#: Where the interval of the best age is drawn, above the axis.
_FOOT = 0.03


def replacement_chart(found: Replacement) -> Chart:
    """Return the cost against the age of replacement, over that of running to failure, with its band."""
    known = [each for each in (found.age.value, found.age.high) if math.isfinite(each)]
    level = np.abs(found.cost - 1.0) > 1e-3
    seen = [float(found.ages[level].max())] if level.any() else [float(found.ages[-1])]
    end = min(_BEYOND * max(known, default=seen[0]), float(found.ages[-1]))
    inside = found.ages <= end
    rows = rows_of(
        age=found.ages[inside],
        cost=100.0 * found.cost[inside],
        low=100.0 * found.cost_low[inside],
        high=np.minimum(100.0 * found.cost_high[inside], 1000.0 * _MOST),
    )
    name = f"Cost per {one_of(found.unit)}" if found.unit else "Cost per unit of age"
    x = alt.X(
        "age:Q",
        title=f"Age of replacement ({found.unit or 'as given'})",
        scale=alt.Scale(domain=[0.0, end], nice=False),
        axis=alt.Axis(format="~s"),
    )
    scale = alt.Scale(domain=[0.0, 100.0 * _MOST])
    y, low = (
        alt.Y(f"{field}:Q", title=f"{name} (% of running to failure)", scale=scale)
        for field in ("cost", "low")
    )
    chart = plot(rows)
    tips = [
        age_tip(found.unit, "replaced at"),
        tip("cost", "cost (%)"),
        tip("low", "from"),
        tip("high", "to"),
    ]
    layers = [
        chart.mark_area(color=BLUE, opacity=0.15, clip=True).encode(x=x, y=low, y2="high:Q"),
        plot([{"cost": 100.0}]).mark_rule(color=INK, strokeDash=[4, 3]).encode(y=y),
        chart.mark_line(color=BLUE, strokeWidth=2, clip=True).encode(x=x, y=y, tooltip=tips),
    ]
    words = f"line and band: {100 * found.level:g} %; dashed: run to failure"
    if math.isfinite(found.age.value):
        span = {"age": found.age.low, "high": min(found.age.high, end), "cost": 100.0 * _MOST * _FOOT}
        mark = plot([span]).mark_rule(color=ORANGE, strokeWidth=4, clip=True)
        layers.append(mark.encode(x=x, x2="high:Q", y=y))
        point = plot([span | {"age": found.age.value}]).mark_point(
            color=ORANGE, filled=True, opacity=1, size=70
        )
        layers.append(point.encode(x=x, y=y, tooltip=[age_tip(found.unit, "least cost")]))
        words += "; orange: age of least cost"
    costs = f"a failure costs {found.cost_of_failure:g} times a planned replacement"
    title = alt.Title("Planned replacement", subtitle=[costs, words])
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)
