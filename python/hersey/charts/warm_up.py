"""A warm-up as a chart: drive speed, drag beside what full speed at once would take, and temperatures."""

from __future__ import annotations

import math

import altair as alt

from hersey.charts.motion import temperatures_over_time
from hersey.charts.style import BLUE, INK, ORANGE, RIM, WIDTH, Chart, Row, level, plot, rows_of, tip
from hersey.stability.warm_up_result import WarmUp

#: Width kept for the axes, so that the panels line up.
_AXIS = 46


def warm_up_chart(warm: WarmUp) -> Chart:
    """Return speed, drag and temperatures of a warm-up over time."""
    panels = [
        _speed(warm),
        _drag(warm),
        temperatures_over_time(
            warm.time, warm.film_temperature, warm.roll_temperature, _time(warm, "Time (s)")
        ),
    ]
    title = alt.Title("Warm-up", subtitle=[warm.verdict(), *warm.beside()])
    stacked: Chart = alt.vconcat(*panels, spacing=14, title=title).resolve_scale(color="independent")
    return stacked


def _speed(warm: WarmUp) -> Chart:
    scale, unit = (1e3, "mm/s") if warm.target_speed < 1.0 else (1.0, "m/s")
    rows = rows_of(time=warm.time, value=warm.drive_speed * scale)
    line = plot(rows).mark_line(color=BLUE, strokeWidth=2)
    y = alt.Y("value:Q", title=f"Drive speed ({unit})", axis=alt.Axis(minExtent=_AXIS))
    tips = [tip("time", "time (s)"), tip("value", f"speed ({unit})")]
    layers = [line.encode(x=_time(warm), y=y, tooltip=tips), *_reached(warm)]
    return alt.layer(*layers, width=WIDTH, height=210)


def _drag(warm: WarmUp) -> Chart:
    """Drag of sliding steadily; where the drive goes at full speed at once, its greatest as a level."""
    rows = [row for row in rows_of(time=warm.time, value=warm.drag) if math.isfinite(row["value"])]
    tips = [tip("time", "time (s)"), tip("value", "drag (N)")]
    y = alt.Y("value:Q", title="Drag (N)", scale=alt.Scale(zero=True), axis=alt.Axis(minExtent=_AXIS))
    line = plot(rows).mark_line(color=BLUE, strokeWidth=2).encode(x=_time(warm), y=y, tooltip=tips)
    layers = [*level(warm.force_limit, "limit"), line]
    if warm.drag_at_once > warm.kept_below:
        layers = [*level(warm.drag_at_once, "at once"), *layers]
    return alt.layer(*layers, width=WIDTH, height=150)


def _reached(warm: WarmUp) -> list[alt.Chart]:
    """The moments of full speed: of the warm-up, and of standing until warm."""
    both = ((warm.full_speed, "full speed", BLUE), (warm.full_speed_standing, "standing until warm", ORANGE))
    layers = []
    for number, (time, name, color) in enumerate(both):
        if not math.isfinite(time):
            continue
        mark: list[Row] = [{"time": time, "name": name}]
        rule = plot(mark).mark_rule(color=color, strokeDash=[7, 3]).encode(x="time:Q")
        left = number == 0 or time > 0.7 * float(warm.time[-1])
        place: Row = {"align": "right" if left else "left", "dx": -5 if left else 5}
        for look in (RIM, {"color": INK}):
            text = plot(mark).mark_text(**place, **look)
            layers.append(text.encode(x="time:Q", y=alt.value(180 - 16 * number), text="name:N"))
        layers.insert(0, rule)
    return layers


def _time(warm: WarmUp, title: str | None = None) -> alt.X:
    return alt.X("time:Q", title=title, scale=alt.Scale(domain=[0.0, float(warm.time[-1])], nice=False))
