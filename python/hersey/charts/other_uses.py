"""Age at which half of new units have ended, against what limits and loads them."""

from __future__ import annotations

import math

import altair as alt

from hersey.charts.style import HEIGHT, SHAPES, WIDTH, Chart, Row, plot, ramp, tip
from hersey.life.other_uses import AS_STATED, OtherUses
from hersey.units import celsius


def other_uses_chart(uses: OtherUses) -> Chart:
    """Return the age of half of new units with its 90 % interval against the limit of the torque.

    A line for each coldest start, of the duty that the machine's file states; without a limit of the torque
    the duties stand side by side.
    """
    unit = f" ({uses.age_unit})" if uses.age_unit else ""
    limits = bool(uses.torque_limits)
    rows: list[Row] = []
    for use in uses.uses:
        if not use.ends or (limits and use.duty != AS_STATED):
            continue
        half = use.ends[-1].age
        if math.isfinite(half.value):
            rows.append(
                {
                    "x": use.torque_limit if limits else use.duty,
                    "age": half.value,
                    "low": half.low,
                    "high": half.high if math.isfinite(half.high) else half.value,
                    "start": "" if use.coldest is None else f"{celsius(use.coldest):.0f}",
                }
            )
    starts = list(dict.fromkeys(row["start"] for row in rows))
    legend = alt.Legend(title="coldest start (°C)", symbolOpacity=1) if uses.coldest else None
    colors = alt.Scale(domain=starts, range=ramp(len(starts)))
    shapes = alt.Scale(domain=starts, range=list(SHAPES[: len(starts)]))
    color = alt.Color("start:N", scale=colors, legend=legend)
    shape = alt.Shape("start:N", scale=shapes, legend=legend)
    x: alt.X = (
        alt.X(
            "x:Q",
            title="Limit of the motor's torque at the roll (N·m)",
            scale=alt.Scale(zero=False, padding=14),
        )
        if limits
        else alt.X("x:N", title="Duty (share of the running time)", sort=None)
    )
    base = plot(rows)
    age = alt.Y("age:Q", title=f"Age{unit or ' (1)'}", scale=alt.Scale(zero=True))
    offset = {"xOffset": alt.XOffset("start:N")} if not limits and uses.coldest else {}
    tooltips = [tip("age", f"age{unit}"), tip("low", "5 %"), tip("high", "95 %")]
    layers = [
        base.mark_rule(strokeWidth=1).encode(
            x=x, y=alt.Y("low:Q", title=f"Age{unit or ' (1)'}"), y2="high:Q", color=color, **offset
        ),
        base.mark_point(size=55, filled=True, opacity=1).encode(
            x=x, y=age, color=color, shape=shape, tooltip=tooltips, **offset
        ),
    ]
    if limits:
        layers.insert(0, base.mark_line(strokeWidth=1.4).encode(x=x, y=age, color=color))
    title = alt.Title(
        "Ages in other uses", subtitle=f"{uses.headline()}; marks: half of new units, 90 % intervals"
    )
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)
