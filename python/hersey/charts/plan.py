"""A drive profile as a chart: drive and belt speed, spring force and, over a course, temperature."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.over_time import UP, moment, over_time, time_axis
from hersey.charts.style import (
    BLUE,
    EDGE,
    INK,
    ORANGE,
    TEMPERATURE,
    WIDTH,
    Chart,
    Row,
    categories,
    level,
    levels,
    plot,
    rows_of,
    tip,
)
from hersey.errors import InsufficientDataError
from hersey.motion.schedule import Schedule
from hersey.stability.plan.result import Plan
from hersey.study.first_screen.result import StartPart
from hersey.units import celsius

#: Height of the panel of speeds.
_HEIGHT = 260
_KEY = "Above V* stick-slip dies out. Below the transition, steady sliding is unstable."
#: Share of the time shown that lies before the drive starts, if it waits.
_BEFORE = 0.06
#: The fold is drawn up to this many greatest speeds.
_SHOWN = 1.5
#: Colour and dashes of each line.
_LOOKS = {
    "drive": (INK, [7, 3]),
    "sliding": (BLUE, [1, 0]),
    "sliding, nominal parameters": (BLUE, [1, 0]),
    "sliding without the profile": (EDGE, [1, 0]),
}
#: What limits the force on the spring.
_LIMITS = {"spring_force": "limit", "motor_torque": "motor limit", "grip": "grip"}
#: Times (s) and values.
Line = Sequence[tuple[float, float]]


def plan_chart(plan: Plan, *, temperature: Schedule | None = None) -> Chart:
    """Return the chart of a plan, and the course of ``temperature`` (K) if there is one.

    Raises
    ------
    InsufficientDataError
        If there is no profile to draw.
    """
    if plan.response is None or plan.schedule is None:
        raise InsufficientDataError("there is no profile to draw: " + plan.verdict())
    end = plan.wait + float(plan.response.time[-1])
    start = max(0.0, plan.wait - _BEFORE * (end - plan.wait)) if plan.wait > 0 else 0.0
    scale, unit = (1e3, "mm/s") if plan.target_speed < 1.0 else (1.0, "m/s")
    belt = _of_belt(plan, plan.response.belt_speed)
    slow, fast = min(v for _, v in belt), max(plan.peak_speed, *(v for _, v in belt))
    lines = {"sliding, nominal parameters": belt, "drive": _drive(plan, (start, end))}
    domain = (min(0.0, 1.05 * slow), 1.08 * fast)
    panels = [
        _speeds(plan, lines, time_axis((start, end), None), domain, scale, unit, **UP),
        _force(plan, time_axis((start, end))),
        *([] if temperature is None else [_temperature(plan, temperature)]),
    ]
    sentences = [part.rstrip(".") + "." for part in plan.verdict().split(". ")]
    title = alt.Title("Start-up profile", subtitle=[*sentences, plan.proof(), _KEY])
    return alt.vconcat(*panels, spacing=14, title=title)


def profile_chart(plan: Plan, motion: StartPart | None) -> Chart:
    """Return the profile of a plan of the document, with the motion it makes if that is known.

    The first slip does not set the scale: it is cut, and its peak written.
    """
    rows = plan.rows()
    end = plan.duration or rows[-1].time
    last = max(1.6 * end, rows[-1].time) if motion is None else max(motion.time)
    lines: dict[str, Line] = {"drive": _drive(plan, (0.0, last))}
    if motion is not None and motion.straight:
        lines["sliding without the profile"] = _rounded(motion.time, motion.straight)
    if motion is not None:
        lines["sliding"] = _rounded(motion.time, motion.belt_speed)
    domain = (0.0, 2.2 * max(_greatest(plan), *(v for v, _ in _marks(plan))))
    chart = _speeds(plan, lines, time_axis((0.0, last), tickCount=6), domain)
    return chart.properties(title="Start-up profile")


def _rounded(time: Sequence[float], speed: Sequence[float]) -> Line:
    """A line of the page, as finely as it is seen there."""
    return [(t, round(v, 5)) for t, v in zip(time, speed, strict=True)]


def _drive(plan: Plan, window: tuple[float, float]) -> Line:
    """What the drive does in a window of time, up to its end."""
    rows = plan.rows()
    before = max(row.time for row in rows if row.time <= window[0])
    line = [(max(row.time, window[0]), row.drive_speed) for row in rows if row.time >= before]
    return [*line, (window[1], plan.target_speed)]


def _of_belt(plan: Plan, values: FloatArray) -> Line:
    """What the belt does under the plan; while the drive waits it stands."""
    assert plan.response is not None
    line = list(zip((plan.wait + plan.response.time).tolist(), values.tolist(), strict=True))
    return [(0.0, 0.0), *line] if plan.wait > 0 else line


def _greatest(plan: Plan) -> float:
    return max(plan.peak_speed or 0.0, plan.target_speed)


def _marks(plan: Plan) -> list[tuple[float, str]]:
    """Speeds (m/s) that are drawn as levels."""
    marks = [(plan.transition_speed, "transition"), (plan.fold_speed, "V*")]
    return [
        (v, name) for v, name in marks if v is not None and (name != "V*" or v < _SHOWN * _greatest(plan))
    ]


def _speeds(
    plan: Plan,
    lines: dict[str, Line],
    x: alt.X,
    domain: tuple[float, float],
    scale: float = 1e3,
    unit: str = "mm/s",
    **look: Any,
) -> Chart:
    """Speeds (m/s) of drive and belt within a domain, the levels that matter, and when the belt slides."""
    rows: list[Row] = [
        {"time": t, "value": scale * v, "line": name} for name, line in lines.items() for t, v in line
    ]
    ends = (scale * domain[0], scale * domain[1])
    key = alt.Legend(title=None, orient="bottom", symbolSize=400)
    y = alt.Y("value:Q", title=f"Speed ({unit})", scale=alt.Scale(domain=list(ends), nice=False), **look)
    tips = [alt.Tooltip("line:N", title="line"), tip("time", "time (s)"), tip("value", f"speed ({unit})")]
    drawn = plot(rows).mark_line(strokeWidth=1.7, clip=True)
    layers = [
        *levels([(scale * v, name) for v, name in _marks(plan) if v < domain[1]], ends, _HEIGHT),
        drawn.encode(
            x=x,
            y=y,
            color=categories(alt.Color, "line", {name: _LOOKS[name][0] for name in lines}, key),
            strokeDash=categories(alt.StrokeDash, "line", {name: _LOOKS[name][1] for name in lines}, key),
            tooltip=tips,
        ),
        *_peak([row for row in rows if row["line"] == "sliding"], ends[1], x),
        *_ready(plan, x, lines["drive"][-1][0]),
    ]
    return alt.layer(*layers, width=WIDTH, height=_HEIGHT)


def _peak(belt: list[Row], top: float, x: alt.X) -> list[alt.Chart]:
    """The peak of the belt, where it is cut off."""
    peak = max(belt, key=lambda row: float(row["value"]), default={"value": top})
    if peak["value"] <= top:
        return []
    named = plot([{"time": peak["time"], "text": f"\u2191 {peak['value']:.0f}"}])
    text = named.mark_text(align="right", dx=-6, baseline="top", color=INK)
    return [text.encode(x=x, y=alt.value(20), text="text:N")]


def _ready(plan: Plan, x: alt.X, end: float) -> list[alt.Chart]:
    """The moment from which the belt slides for good, on an axis up to an ``end``."""
    if plan.duration is None:
        return []
    late = plan.duration > 0.55 * end
    name = f"slides by {plan.duration:.2g} s at the latest"
    return moment(plan.duration, name, x, left=late, color=BLUE)


def _force(plan: Plan, x: alt.X) -> Chart:
    assert plan.response is not None
    rows: list[Row] = [{"time": t, "value": v} for t, v in _of_belt(plan, plan.response.spring_force)]
    limits = [
        layer
        for use in plan.uses
        if use.name in _LIMITS
        for layer in level(use.limit * plan.peak_force / use.used, _LIMITS[use.name], lift=-4.0)
    ]
    line = over_time(rows, "Spring force (N)", x)
    return alt.layer(*limits, line, *_ready(plan, x, rows[-1]["time"])[:1], width=WIDTH, height=150)


def _temperature(plan: Plan, course: Schedule) -> Chart:
    """The whole course, with the moment at which the drive starts."""
    times = np.asarray(course.times, dtype=float)
    last = max(float(times[-1]), plan.duration)
    at = np.unique(np.concatenate([np.linspace(0.0, last, 200), times[times >= 0], [plan.duration]])).tolist()
    rows = rows_of(time=at, value=[celsius(course.at(t)) for t in at])
    x = time_axis(title="Time (s), whole course")
    late = plan.wait > 0.8 * last
    start = moment(plan.wait, "drive starts", x, left=late, color=ORANGE, down=100, strokeDash=[7, 3])
    return alt.layer(over_time(rows, TEMPERATURE, x, zero=False), *start, width=WIDTH, height=120)
