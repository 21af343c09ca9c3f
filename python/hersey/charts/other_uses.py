"""Age at which half of new units have ended, against what limits and loads them."""

from __future__ import annotations

import math

import altair as alt

from hersey.charts.style import HEIGHT, SHAPES, WIDTH, Chart, Row, categories, plot, ramp, tip
from hersey.life.other_uses import AS_STATED, OtherUses
from hersey.units import celsius


def other_uses_chart(uses: OtherUses) -> Chart:
    """Return the age at which half of new specimens have failed against the limit of the torque.

    Of fewer than four specimens it is that of the first to fail; with its 90 % interval.
    A line for each coldest start, of the duty that the machine file states; without a limit of the torque
    the duties stand side by side.
    """
    unit = f" ({uses.age_unit})" if uses.age_unit else ""
    limits = bool(uses.torque_limits)
    rows = _rows(uses)
    starts = list(dict.fromkeys(row["start"] for row in rows))
    legend = alt.Legend(title="coldest start (°C)", symbolOpacity=1) if uses.coldest else None
    look = {
        "x": _across(limits=limits),
        "color": categories(alt.Color, "start", dict(zip(starts, ramp(len(starts)), strict=True)), legend),
        **({"xOffset": alt.XOffset("start:N")} if not limits and uses.coldest else {}),
    }
    shape = categories(alt.Shape, "start", dict(zip(starts, SHAPES, strict=False)), legend)
    base, name = plot(rows), f"Age{unit or ' (1)'}"
    age = alt.Y("age:Q", title=name, scale=alt.Scale(zero=True))
    tips = [tip("age", f"age{unit}"), tip("low", "5 %"), tip("high", "95 %")]
    bars, dots = base.mark_rule(strokeWidth=1), base.mark_point(size=55, filled=True, opacity=1)
    layers = [
        bars.encode(y=alt.Y("low:Q", title=name), y2="high:Q", **look),
        dots.encode(y=age, shape=shape, tooltip=tips, **look),
    ]
    if limits:
        layers.insert(0, base.mark_line(strokeWidth=1.4).encode(y=age, **look))
    subtitle = f"{uses.headline()}; marks: medians with 90 % intervals"
    title = alt.Title("Time to failure at other operating conditions", subtitle=subtitle)
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def _across(*, limits: bool) -> alt.X:
    if not limits:
        return alt.X("x:N", title="Duty (share of the running time)", sort=None)
    scale = alt.Scale(zero=False, padding=14)
    return alt.X("x:Q", title="Motor torque limit (N·m)", scale=scale)


def _rows(uses: OtherUses) -> list[Row]:
    """The uses whose age is known, of the stated duty where limits of the torque differ."""
    limits = bool(uses.torque_limits)
    return [
        {
            "x": use.torque_limit if limits else use.duty,
            "age": half.value,
            "low": half.low,
            "high": half.high if math.isfinite(half.high) else half.value,
            "start": "" if use.coldest is None else f"{celsius(use.coldest):.0f}",
        }
        for use in uses.uses
        if not (limits and use.duty != AS_STATED)
        for half in [use.half]
        if half is not None and math.isfinite(half.value)
    ]
