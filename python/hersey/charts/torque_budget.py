"""The torque budget of the drive: its parts stacked against speed, with the dwells."""

from __future__ import annotations

import altair as alt

from hersey.charts.style import (
    HEIGHT,
    INK,
    ROLL_SPEED,
    WIDTH,
    Chart,
    Row,
    categories,
    logarithmic_axis,
    plot,
    rows_of,
    span,
    tip,
    torque_unit,
)
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.units import celsius, rpm

#: Parts from below, with their names and shades that stay apart in grey.
_PARTS = (
    ("rest", "no-load torque", "#c9d1d6"),
    ("contact", "contact", "#b8500c"),
    ("shear", "film shear", "#0a5c8f"),
    ("inlet", "film inlet", "#74a9cf"),
)


def torque_budget_chart(part: TorqueBudgetPart) -> Chart:
    """Return the parts of the torque as areas, one upon another, and the whole torque of the dwells."""
    factor, unit = torque_unit(max(part.measured_torque))
    rows = [
        {"speed": rpm(speed), "torque": factor * torque, "part": name, "order": order}
        for order, (field, name, _) in enumerate(_PARTS)
        for speed, torque in zip(part.speed, getattr(part, field), strict=True)
    ]
    whole = [factor * torque for torque in part.measured_torque]
    dwells = rows_of(speed=[rpm(speed) for speed in part.measured_speed], whole=whole)
    x = alt.X("speed:Q", title=ROLL_SPEED, **logarithmic_axis(span([row["speed"] for row in rows])))
    y = alt.Y("torque:Q", title=f"Torque ({unit})", stack="zero", axis=alt.Axis(tickCount=6))
    legend = alt.Legend(title=None, orient="bottom", columns=2, symbolOpacity=1)
    color = categories(alt.Color, "part", {name: shade for _, name, shade in _PARTS}, legend)
    at = tip("speed", "speed (rpm)")
    tips = [alt.Tooltip("part:N", title="part"), at, tip("torque", f"torque ({unit})")]
    areas = plot(rows).mark_area(line=False)
    areas = areas.encode(x=x, y=y, order="order:Q", color=color, tooltip=tips)
    look: Row = {"fill": "white", "stroke": INK, "strokeWidth": 1.2, "size": 45, "opacity": 1}
    dots = plot(dwells).mark_point(filled=True, **look)
    dots = dots.encode(x=x, y="whole:Q", tooltip=[at, tip("whole", f"torque ({unit})")])
    title = alt.Title(
        f"Torque budget at {celsius(part.temperature):.0f} °C",
        subtitle="areas: contact model on the no-load torque; circles: measured",
    )
    return alt.layer(areas, dots, title=title, width=WIDTH, height=HEIGHT)
