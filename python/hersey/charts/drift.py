"""Drift with age: one panel per quantity, specimens as thin lines, all of them as a line with its band."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.growth import age_axis
from hersey.charts.style import BLUE, INK, WIDTH, Chart, age_tip, plot, rows_of, tip
from hersey.errors import capital
from hersey.life.drift.quantities import Quantity
from hersey.life.drift.result import Drift

#: Most specimens drawn; of more, this many at even steps.
_DRAWN = 60
_COLUMNS, _GAP, _AXIS, _HEIGHT = 2, 18, 52, 170
#: How a quantity is shown: factor from its SI unit, and unit.
_SHOWN = {
    "rad/s": (60.0 / (2.0 * np.pi), "rpm"),
    "J/mol": (1e-3, "kJ/mol"),
    "N m": (1e3, "mN·m"),
    "1": (1.0, "1"),
}


def drift_chart(drift: Drift) -> Chart:
    """Return each quantity against age; a specimen ends at its last observation."""
    count = len(drift.units)
    chosen = np.unique(np.linspace(0, count - 1, min(count, _DRAWN)).round().astype(int))
    panels = [_panel(drift, each, chosen.tolist()) for each in drift.quantities]
    rows = [alt.hconcat(*panels[i : i + _COLUMNS], spacing=_GAP) for i in range(0, len(panels), _COLUMNS)]
    some = "" if len(chosen) == count else f" ({len(chosen)} of {count})"
    words = f"thin: specimens{some}; thick, with 90 % band: all specimens"
    title = alt.Title("Drift", subtitle=[drift.headline(), words])
    return alt.vconcat(*rows, spacing=14, title=title)


def _panel(drift: Drift, quantity: Quantity, chosen: list[int]) -> Chart:
    scale, unit = _SHOWN[quantity.si]
    x = age_axis("age", drift.age_unit, alt.Scale(), 5)
    title = f"{capital(quantity.name)} ({unit})"
    axis = alt.Axis(minExtent=_AXIS, tickCount=5)
    y = alt.Y("value:Q", title=title, scale=alt.Scale(zero=False), axis=axis)
    low, middle, high = scale * quantity.band
    seen = np.isfinite(middle) & np.isfinite(low) & np.isfinite(high)
    band = plot(rows_of(age=drift.ages[seen], value=middle[seen], low=low[seen], high=high[seen]))
    tips = [age_tip(drift.age_unit), tip("value", f"{quantity.name} ({unit})")]
    units = [alt.Tooltip("unit:N"), *tips]
    area, line = band.mark_area(color=BLUE, opacity=0.18), band.mark_line(color=BLUE, strokeWidth=2.5)
    layers = [
        area.encode(x=x, y=alt.Y("low:Q", title=title), y2="high:Q"),
        _lines(drift, quantity, chosen, scale).encode(x=x, y=y, detail="unit:N", tooltip=units),
        line.encode(x=x, y=y, tooltip=[*tips, tip("low", "from"), tip("high", "to")]),
    ]
    heading = alt.Title(quantity.where, fontSize=11, fontWeight="normal", anchor="start")
    width = (WIDTH - _GAP - _AXIS) // _COLUMNS
    panel: Chart = alt.layer(*layers, title=heading, width=width, height=_HEIGHT)
    return panel


def _lines(drift: Drift, quantity: Quantity, chosen: list[int], scale: float) -> alt.Chart:
    rows = []
    for i in chosen:
        ages = np.append(drift.ages[drift.ages < drift.last_age[i]], drift.last_age[i])
        values = scale * np.interp(ages, drift.ages, quantity.curves[i])
        seen = np.isfinite(values)
        rows += rows_of(unit=[drift.units[i]] * int(seen.sum()), age=ages[seen], value=values[seen])
    chart: alt.Chart = plot(rows).mark_line(color=INK, strokeWidth=0.8, opacity=0.55)
    return chart
