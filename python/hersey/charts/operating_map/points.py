"""The operating points on an operating map, and its tooltips."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.labels import Labels
from hersey.charts.operating_map.frame import Frame, speed_axis, temperature_axis
from hersey.charts.style import DIAMOND, Row, plot
from hersey.stability.operating_map import OperatingMap
from hersey.units import ZERO_CELSIUS, celsius, rpm


def points(result: OperatingMap, frame: Frame, labels: Labels) -> list[alt.Chart]:
    """Return the machine's points within the window, and name them."""
    rows: list[Row] = []
    for number, point in enumerate(result.points, 1):
        x = (
            celsius(point.temperature)
            if result.temperature is not None
            else number / (len(result.points) + 1)
        )
        if not (frame.x[0] <= x <= frame.x[-1] and frame.low <= point.speed <= frame.high):
            continue
        labels.beside(point.name, frame.across(x), frame.up(point.speed), "points")
        rows.append(
            {
                "x": x,
                "y": 1e3 * point.speed,
                "name": point.name,
                "rpm": rpm(point.speed / result.roll_radius),
                "torque": point.at.torque,
                "state": point.at.verdict(),
            }
        )
    if not rows:
        return []
    marks = plot(rows).mark_point(filled=True, **(DIAMOND | {"strokeWidth": 2, "size": 110}))
    tips = [alt.Tooltip("name:N", title="point"), *_tips(result)]
    return [marks.encode(x=temperature_axis(frame), y=speed_axis(frame), tooltip=tips)]


def _tips(result: OperatingMap) -> list[alt.Tooltip]:
    hot = [("x", "temperature (°C)")] if result.temperature is not None else []
    numbers = [
        *hot,
        ("y", "drive speed (mm/s)"),
        ("rpm", "drive speed (rpm)"),
        ("torque", "drag torque (N·m)"),
    ]
    tips = [alt.Tooltip(f"{field}:Q", title=title, format=".3~g") for field, title in numbers]
    return [*tips, alt.Tooltip("state:N", title="here")]


def pointer(result: OperatingMap, frame: Frame) -> alt.Chart:
    """Return invisible cells with the state of the belt as their tooltip."""
    columns, speeds = np.linspace(frame.x[0], frame.x[-1], 25), np.geomspace(frame.low, frame.high, 31)
    columns = columns if result.temperature is not None else frame.x
    middles = 0.5 * (columns[1:] + columns[:-1])
    centres = np.sqrt(speeds[1:] * speeds[:-1])
    across, up = (grid.ravel() for grid in np.meshgrid(middles, centres, indexing="ij"))
    states = result.look_up(
        temperature=None if result.temperature is None else across + ZERO_CELSIUS, speed=up
    )
    rows: list[Row] = []
    for number, (x, speed, state) in enumerate(zip(across.tolist(), up.tolist(), states, strict=True)):
        i, j = divmod(number, centres.size)
        rows.append(
            {
                "left": float(columns[i]),
                "right": float(columns[i + 1]),
                "bottom": 1e3 * float(speeds[j]),
                "top": 1e3 * float(speeds[j + 1]),
                "x": x,
                "y": 1e3 * speed,
                "rpm": rpm(speed / result.roll_radius),
                "torque": state.torque,
                "state": state.verdict() + (" (extrapolated)" if state.extrapolated else ""),
            }
        )
    chart: alt.Chart = plot(rows).mark_rect(opacity=0, clip=True)
    return chart.encode(
        x=temperature_axis(frame, "left:Q"),
        x2="right:Q",
        y=speed_axis(frame, "bottom:Q"),
        y2="top:Q",
        tooltip=_tips(result),
    )
