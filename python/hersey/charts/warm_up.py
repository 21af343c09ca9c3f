"""A warm-up as a chart: drive speed, drag, the drag of full speed at once, and temperatures."""

from __future__ import annotations

import math

import altair as alt

from hersey.charts.over_time import moment, over_time, temperatures_over_time, time_axis
from hersey.charts.style import BLUE, ORANGE, WIDTH, Chart, level, rows_of, stacked
from hersey.stability.warm_up_result import WarmUp


def warm_up_chart(warm: WarmUp) -> Chart:
    """Return speed, drag and temperatures of a warm-up over time."""
    span = (0.0, float(warm.time[-1]))
    both = warm.film_temperature.tolist(), warm.roll_temperature.tolist()
    hot = temperatures_over_time(warm.time.tolist(), *both, time_axis(span))
    bare = time_axis(span, None)
    panels = [_speed(warm, bare), _drag(warm, bare), hot.properties(width=WIDTH, height=120)]
    title = alt.Title("Warm-up", subtitle=[warm.verdict(), *warm.beside()])
    return stacked(*panels, title=title, spacing=14)


def _speed(warm: WarmUp, x: alt.X) -> Chart:
    """The drive speed, and the moments of full speed: of the warm-up, and of standing until warm."""
    scale, unit = (1e3, "mm/s") if warm.target_speed < 1.0 else (1.0, "m/s")
    rows = rows_of(time=warm.time, value=warm.drive_speed * scale)
    layers = [over_time(rows, f"Drive speed ({unit})", x, width=2)]
    both = (
        (warm.full_speed, "full speed", BLUE),
        (warm.full_speed_standing, "warm-up at standstill", ORANGE),
    )
    for number, (time, name, color) in enumerate(both):
        if math.isfinite(time):
            left = number == 0 or time > 0.7 * float(warm.time[-1])
            layers += moment(time, name, x, left=left, color=color, down=174 - 16 * number, strokeDash=[7, 3])
    return alt.layer(*layers, width=WIDTH, height=210)


def _drag(warm: WarmUp, x: alt.X) -> Chart:
    """Drag of sliding steadily; where the drive goes at full speed at once, its greatest as a level."""
    rows = [row for row in rows_of(time=warm.time, value=warm.drag) if math.isfinite(row["value"])]
    layers = [*level(warm.force_limit, "limit"), over_time(rows, "Drag (N)", x, width=2, zero=True)]
    if warm.drag_at_once > warm.kept_below:
        layers = [*level(warm.drag_at_once, "at once"), *layers]
    return alt.layer(*layers, width=WIDTH, height=150)
