"""A drive profile as a chart: drive and belt speed, spring force and, over a course, temperature."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.style import BLUE, EDGE, INK, ORANGE, RIM, WIDTH, Chart, Row, level, levels, plot, tip
from hersey.errors import InsufficientDataError
from hersey.motion.schedule import Schedule
from hersey.stability.plan.result import Plan
from hersey.study.first_screen.result import StartPart
from hersey.units import celsius

#: Height of the panel of speeds.
_HEIGHT = 260
#: Width kept for the axes, so that the panels line up.
_AXIS = 46
_KEY = "V*: above it stick-slip dies out by itself. v_t: below it steady sliding is unstable."
#: Share of the time shown that lies before the drive starts, if it waits.
_BEFORE = 0.06
#: The fold is drawn up to this many greatest speeds.
_SHOWN = 1.5


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
    window = (start, end)
    panels: list[alt.Chart | Chart] = [_speeds(plan, window), _force(plan, window)]
    if temperature is not None:
        panels.append(_temperature(plan, temperature))
    heading = plan.verdict().split(". ")
    title = alt.Title("Drive profile", subtitle=[*_sentences(heading), plan.proof(), _KEY])
    stacked: Chart = alt.vconcat(*panels, spacing=14).properties(title=title)
    return stacked


def profile_chart(plan: Plan, motion: StartPart | None) -> Chart:
    """Return the profile of a plan of the document, with the motion it makes if that is known.

    The first slip does not set the scale: it is cut, and its peak written.
    """
    rows = plan.rows()
    end = plan.duration or (rows[-1].time if rows else 1.0)
    last = max(1.6 * end, rows[-1].time if rows else 0.0)
    drive = [(row.time, row.drive_speed) for row in rows]
    if drive:
        drive.append((last, drive[-1][1]))
    lines: list[tuple[str, list[tuple[float, float]]]] = [("drive", drive)]
    if motion is not None:
        last = max(motion.time)
        lines = [("drive", [*drive[:-1], (last, drive[-1][1])])] if drive else []
        straight = list(zip(motion.time, motion.straight, strict=True)) if motion.straight else []
        lines += [("belt, straight to speed", straight)] if straight else []
        lines.append(("belt", list(zip(motion.time, motion.belt_speed, strict=True))))
    marks = [(plan.transition_speed, "transition")]
    if plan.fold_speed is not None and plan.fold_speed < _SHOWN * max(
        plan.peak_speed or 0.0, plan.target_speed
    ):
        marks.append((plan.fold_speed, "V*"))
    top = 1e3 * max([plan.peak_speed or 0.0, plan.target_speed, *(v for v, _ in marks)]) * 2.2
    domain = (0.0, top)
    samples: list[Row] = [
        {"time": t, "value": round(1e3 * v, 2), "line": name} for name, line in lines for t, v in line
    ]
    names = [name for name, _ in lines]
    looks = {"drive": (INK, [7, 3]), "belt": (BLUE, [1, 0]), "belt, straight to speed": (EDGE, [1, 0])}
    key = alt.Legend(title=None, orient="bottom", symbolSize=400)
    color = alt.Scale(domain=names, range=[looks[name][0] for name in names])
    dash = alt.Scale(domain=names, range=[looks[name][1] for name in names])
    x = alt.X(
        "time:Q",
        title="Time (s)",
        scale=alt.Scale(domain=[0.0, last], nice=False),
        axis=alt.Axis(tickCount=6),
    )
    y = alt.Y("value:Q", title="Speed (mm/s)", scale=alt.Scale(domain=list(domain), nice=False))
    drawn = plot(samples).mark_line(strokeWidth=1.7, clip=True)
    layers: list[alt.Chart] = [
        *levels([(1e3 * v, name) for v, name in marks], domain, _HEIGHT),
        drawn.encode(
            x=x,
            y=y,
            color=alt.Color("line:N", scale=color, legend=key),
            strokeDash=alt.StrokeDash("line:N", scale=dash, legend=key),
            tooltip=[
                alt.Tooltip("line:N", title="line"),
                tip("time", "time (s)"),
                tip("value", "speed (mm/s)"),
            ],
        ),
        *_peaks(samples, top, x),
    ]
    if plan.duration is not None:
        mark = plot([{"time": plan.duration, "name": f"slides by {plan.duration:.2g} s at the latest"}])
        late = plan.duration > 0.55 * last
        look: Row = {"align": "right" if late else "left", "dx": -5 if late else 5, "baseline": "top"}
        text = mark.encode(x=x, y=alt.value(4), text="name:N")
        rule = mark.mark_rule(color=BLUE, strokeWidth=1).encode(x=x)
        layers += [rule, text.mark_text(**(look | RIM)), text.mark_text(color=INK, **look)]
    return alt.layer(*layers, title="Drive profile", width=WIDTH, height=_HEIGHT)


def _peaks(rows: list[Row], top: float, x: alt.X) -> list[alt.Chart]:
    """The peak of the belt, where it is cut off."""
    belt = [row for row in rows if row["line"] == "belt"]
    if not belt:
        return []
    peak = max(belt, key=lambda row: float(row["value"]))
    if peak["value"] <= top:
        return []
    named = plot([{"time": peak["time"], "text": f"\u2191 {peak['value']:.0f}"}])
    text = named.mark_text(align="right", dx=-6, baseline="top", color=INK)
    return [text.encode(x=x, y=alt.value(20), text="text:N")]


def _sentences(parts: list[str]) -> list[str]:
    return [part if part.endswith(".") else part + "." for part in parts]


def _speeds(plan: Plan, window: tuple[float, float]) -> Chart:
    assert plan.response is not None
    assert plan.schedule is not None
    scale, unit = (1e3, "mm/s") if plan.target_speed < 1.0 else (1.0, "m/s")
    top = max(plan.peak_speed, float(plan.response.belt_speed.max()))
    times = np.asarray(plan.schedule.times, dtype=float)
    drive: list[Row] = [
        {"time": max(t, window[0]), "value": v * scale, "line": "drive"}
        for t, v in zip(times.tolist(), np.asarray(plan.schedule.values).tolist(), strict=True)
        if t >= window[0] or t == times[times <= window[0]].max()
    ]
    drive.append({"time": window[1], "value": plan.target_speed * scale, "line": "drive"})
    for index, row in enumerate(drive):
        row["index"] = index
    belt = _rows(plan, plan.response.belt_speed * scale, "belt, nominal parameters")
    legend = alt.Legend(title=None, orient="top-right", fillColor="white", padding=4, symbolSize=500)
    names = ["drive", "belt, nominal parameters"]
    domain = (min(0.0, 1.05 * scale * float(plan.response.belt_speed.min())), 1.08 * top * scale)
    y = alt.Y(
        "value:Q",
        title=f"Speed ({unit})",
        scale=alt.Scale(domain=list(domain)),
        axis=alt.Axis(minExtent=_AXIS),
    )
    lines = (
        plot([*belt, *drive])
        .mark_line(strokeWidth=2, clip=True)
        .encode(
            x=_x(window, title=False),
            y=y,
            order="index:Q",
            color=alt.Color("line:N", scale=alt.Scale(domain=names, range=[ORANGE, BLUE]), legend=legend),
            strokeDash=alt.StrokeDash(
                "line:N", scale=alt.Scale(domain=names, range=[[7, 3], [1, 0]]), legend=legend
            ),
            tooltip=[tip("time", "time (s)"), tip("value", f"speed ({unit})")],
        )
    )
    marks = [(plan.transition_speed * scale, "v_t")]
    if plan.fold_speed < _SHOWN * top:
        marks.append((plan.fold_speed * scale, "V*"))
    layers = [*levels(marks, domain, _HEIGHT), lines, *_ready(plan)]
    return alt.layer(*layers, width=WIDTH, height=_HEIGHT)


def _force(plan: Plan, window: tuple[float, float]) -> Chart:
    assert plan.response is not None
    line = (
        plot(_rows(plan, plan.response.spring_force, "spring"))
        .mark_line(color=BLUE, strokeWidth=1.5, clip=True)
        .encode(
            x=_x(window),
            y=alt.Y("value:Q", title="Spring force (N)", axis=alt.Axis(minExtent=_AXIS)),
            order="index:Q",
            tooltip=[tip("time", "time (s)"), tip("value", "spring force (N)")],
        )
    )
    labels = {
        "spring_force": "limit",
        "motor_torque": "motor limit",
        "grip": "grip of the roll",
    }
    rules = []
    for use in plan.uses:
        if use.name in labels:
            force = use.limit * plan.peak_force / use.used
            rules += level(force, labels[use.name], lift=-4.0)
    return alt.layer(*rules, line, *_ready(plan, named=False)).properties(width=WIDTH, height=150)


def _temperature(plan: Plan, course: Schedule) -> Chart:
    """The whole course, with the moment at which the drive starts."""
    times = np.asarray(course.times, dtype=float)
    last = max(float(times[-1]), plan.duration)
    at = np.unique(np.concatenate([np.linspace(0.0, last, 200), times[times >= 0], [plan.duration]]))
    rows = [{"time": t, "value": celsius(course.at(t)), "index": i} for i, t in enumerate(at.tolist())]
    line = (
        plot(rows)
        .mark_line(color=BLUE, strokeWidth=1.5)
        .encode(
            x=alt.X("time:Q", title="Time (s), the whole course", scale=alt.Scale(nice=False)),
            y=alt.Y(
                "value:Q",
                title="Temperature (°C)",
                scale=alt.Scale(zero=False),
                axis=alt.Axis(minExtent=_AXIS),
            ),
            order="index:Q",
            tooltip=[tip("time", "time (s)"), tip("value", "temperature (°C)")],
        )
    )
    start = plot([{"time": plan.wait, "name": "drive starts"}])
    rule = start.mark_rule(color=ORANGE, strokeDash=[7, 3]).encode(x="time:Q")
    near_end = plan.wait > 0.8 * last
    text = start.mark_text(
        align="right" if near_end else "left", dx=-5 if near_end else 5, color=INK, baseline="bottom"
    ).encode(x="time:Q", y=alt.value(112), text="name:N")
    return alt.layer(line, rule, text).properties(width=WIDTH, height=120)


def _rows(plan: Plan, values: np.ndarray, line: str) -> list[Row]:
    assert plan.response is not None
    times = plan.wait + plan.response.time
    pairs = enumerate(zip(times.tolist(), values.tolist(), strict=True))
    rows: list[Row] = [{"time": t, "value": v, "line": line, "index": i} for i, (t, v) in pairs]
    if plan.wait > 0:
        rows.insert(0, {"time": 0.0, "value": 0.0, "line": line, "index": -1})
    return rows


def _ready(plan: Plan, *, named: bool = True) -> list[alt.Chart]:
    """The moment from which the belt slides for good."""
    mark = plot([{"time": plan.duration, "name": "slides for good from here"}])
    rule = mark.mark_rule(color=INK, strokeWidth=1).encode(x="time:Q")
    text = mark.mark_text(align="left", dx=5, baseline="top", color=INK)
    label = text.encode(x="time:Q", y=alt.value(62), text="name:N")
    return [rule, label] if named else [rule]


def _x(window: tuple[float, float], *, title: bool = True) -> alt.X:
    return alt.X(
        "time:Q",
        title="Time (s)" if title else None,
        scale=alt.Scale(domain=list(window), nice=False),
    )
