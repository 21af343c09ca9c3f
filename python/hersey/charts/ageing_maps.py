"""The operating map of a unit when new, now and at the end, side by side."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.operating_map.frame import decades
from hersey.charts.operating_map.regions import REGIONS
from hersey.charts.style import INK, RIM, Chart, Row, plot, tip
from hersey.life.ageing_maps import AgeingMaps
from hersey.units import celsius

#: Width of all panels together without the gaps between them, and their height, px.
_ALL, _HEIGHT = 640, 320
#: Regions of the operating map that are told here, from slow to fast.
_TOLD = ("motor", "stick_slip", "bistable", "smooth")


def ageing_maps_chart(result: AgeingMaps) -> Chart:
    """Return one map per age, on the same axes."""
    named = {name: text for name, text, _, _ in REGIONS}
    colors = {name: color for name, _, _, color in REGIONS}
    scale = alt.Scale(domain=[named[name] for name in _TOLD], range=[colors[name] for name in _TOLD])
    width = _ALL / len(result.when)
    panels = [_panel(result, index, scale, width) for index in range(len(result.when))]
    title = alt.Title(
        f"Operating map of {result.unit} through its life",
        subtitle=["solid: transition; dashed: V*; points: operating points", *result.notes],
    )
    chart: Chart = alt.hconcat(*panels, title=title, spacing=14)
    return chart


def _panel(result: AgeingMaps, index: int, scale: alt.Scale, width: float) -> Chart:
    named = {name: text for name, text, _, _ in REGIONS}
    hot = celsius(result.temperature)
    low, high = float(result.speed[0]), float(result.speed[-1])
    x = alt.X(
        "x:Q",
        title="Temperature (°C)",
        scale=alt.Scale(domain=[float(hot[0]), float(hot[-1])], nice=False),
        axis=alt.Axis(grid=False, tickCount=4),
    )
    y = alt.Y(
        "y:Q",
        title="Drive speed at the belt (mm/s)" if index == 0 else None,
        scale=alt.Scale(type="log", domain=[1e3 * low, 1e3 * high], nice=False),
        axis=alt.Axis(grid=False, values=decades(1e3 * low, 1e3 * high), format="~g"),
    )
    rows: list[Row] = []
    for name, bottom, top in _regions(result, index):
        rows += [
            {
                "x": float(t),
                "y": 1e3 * float(a),
                "top": 1e3 * float(b),
                "region": named[name.split()[0]],
                "part": name,
            }
            for t, a, b in zip(hot, bottom, top, strict=True)
        ]
    legend = alt.Legend(
        orient="bottom", title=None, symbolType="square", symbolSize=140, labelLimit=260, columns=2
    )
    color = alt.Color("region:N", scale=scale, legend=legend)
    areas = plot(rows).mark_area(clip=True).encode(x=x, y=y, y2="top:Q", color=color, detail="part:N")
    lines = [
        plot(_line(hot, edge))
        .mark_line(color=INK, strokeWidth=1.6, strokeDash=dash, clip=True)
        .encode(x=x, y=y)
        for edge, dash in ((result.transition[index], [1, 0]), (result.upper[index], [5, 3]))
    ]
    marks = _points(result, index, x, y)
    title = alt.Title(result.names[index], fontSize=12, anchor="middle")
    panel: Chart = alt.layer(areas, *lines, *marks, title=title, width=width, height=_HEIGHT)
    return panel


def _line(hot: FloatArray, edge: FloatArray) -> list[Row]:
    return [{"x": float(t), "y": 1e3 * float(v)} for t, v in zip(hot, edge, strict=True) if v > 0]


def _regions(result: AgeingMaps, index: int) -> list[tuple[str, FloatArray, FloatArray]]:
    """Name, lower and upper edge (m/s) of each part of a region at each temperature."""
    low, high = float(result.speed[0]), float(result.speed[-1])
    below, above = _stalls(result, index)
    edges = [
        np.clip(each[index], low, high)
        for each in (result.transition, np.maximum(result.transition, result.upper))
    ]
    bounds = [np.clip(each, below, above) for each in edges]
    ends = np.full_like(below, low), np.full_like(below, high)
    return [
        ("motor below", ends[0], below),
        ("stick_slip", below, bounds[0]),
        ("bistable", bounds[0], bounds[1]),
        ("smooth", bounds[1], above),
        ("motor above", above, ends[1]),
    ]


def _stalls(result: AgeingMaps, index: int) -> tuple[FloatArray, FloatArray]:
    """Speeds (m/s) below and above which the torque is beyond the motor's."""
    low, high = float(result.speed[0]), float(result.speed[-1])
    columns = result.temperature.size
    if result.torque_limit is None:
        return np.full(columns, low), np.full(columns, high)
    below, above = np.empty(columns), np.empty(columns)
    logs, limit = np.log(result.speed), np.log(result.torque_limit)
    for column, torque in enumerate(np.log(result.torque[index])):
        least = int(np.argmin(torque))
        if torque[least] >= limit:
            below[column] = above[column] = high
            continue
        slow, fast = torque[: least + 1][::-1], torque[least:]
        below[column] = low if slow[-1] < limit else np.exp(np.interp(limit, slow, logs[: least + 1][::-1]))
        above[column] = high if fast[-1] < limit else np.exp(np.interp(limit, fast, logs[least:]))
    return below, above


def _points(result: AgeingMaps, index: int, x: alt.X, y: alt.Y) -> list[alt.Chart]:
    rows: list[Row] = [
        {
            "x": float(celsius(point.temperature)),
            "y": 1e3 * point.speed,
            "name": point.name,
            "state": result.state(index, point),
        }
        for point in result.points
        if result.temperature[0] <= point.temperature <= result.temperature[-1]
    ]
    if not rows:
        return []
    base = plot(rows).encode(x=x, y=y)
    mark = base.mark_point(
        shape="circle", filled=True, fill="white", stroke=INK, strokeWidth=1.6, size=60, clip=False
    )
    tips = [
        alt.Tooltip("name:N"),
        alt.Tooltip("state:N"),
        tip("x", "temperature (°C)"),
        tip("y", "speed (mm/s)"),
    ]
    text = base.encode(text="name:N")
    look: Row = {"align": "right", "dx": -8, "fontSize": 11}
    return [
        mark.encode(tooltip=tips),
        text.mark_text(**(look | RIM)),
        text.mark_text(**look, color="black"),
    ]
