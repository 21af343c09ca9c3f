"""The operating map of a specimen when new, now and at its failure, side by side."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.operating_map.regions import REGIONS, region_color
from hersey.charts.style import INK, TEMPERATURE, Chart, Row, logarithmic_axis, plot, rimmed, rows_of, tip
from hersey.life.ageing_maps import AgeingMaps
from hersey.units import celsius

#: Width of all panels together without the gaps between them, and their height, px.
_ALL, _HEIGHT = 640, 320
#: Regions of the operating map that are shown here, from slow to fast.
_REGIONS = ("motor", "stick_slip", "bistable", "smooth")


def ageing_maps_chart(result: AgeingMaps) -> Chart:
    """Return one map per age, on the same axes."""
    width = _ALL / len(result.when)
    panels = [_panel(result, index, width) for index in range(len(result.when))]
    title = alt.Title(
        f"Operating map of {result.unit} over its life",
        subtitle=["solid: transition; dashed: V*; points: operating points", *map(str, result.warnings)],
    )
    chart: Chart = alt.hconcat(*panels, title=title, spacing=14)
    return chart


def _panel(result: AgeingMaps, index: int, width: float) -> Chart:
    named = {name: text for name, text, _, _ in REGIONS}
    hot = celsius(result.temperature)
    scale = alt.Scale(domain=[float(hot[0]), float(hot[-1])], nice=False)
    x = alt.X("x:Q", title=TEMPERATURE, scale=scale, axis=alt.Axis(grid=False, tickCount=4))
    domain = logarithmic_axis((1e3 * float(result.speed[0]), 1e3 * float(result.speed[-1])), grid=False)
    y = alt.Y("y:Q", title="Drive speed (mm/s)" if index == 0 else None, **domain)
    rows = [
        row | {"region": named[name.split()[0]], "part": name}
        for name, bottom, top in _regions(result, index)
        for row in rows_of(x=hot, y=1e3 * bottom, top=1e3 * top)
    ]
    color = region_color("region", _REGIONS, symbolSize=140, columns=2)
    areas = plot(rows).mark_area(clip=True).encode(x=x, y=y, y2="top:Q", color=color, detail="part:N")
    lines = [
        plot([row for row in rows_of(x=hot, y=1e3 * edge) if row["y"] > 0])
        .mark_line(color=INK, strokeWidth=1.6, strokeDash=dash, clip=True)
        .encode(x=x, y=y)
        for edge, dash in ((result.transition[index], [1, 0]), (result.upper[index], [5, 3]))
    ]
    title = alt.Title(result.names[index], fontSize=12, anchor="middle")
    marks = _points(result, index, x, y)
    panel: Chart = alt.layer(areas, *lines, *marks, title=title, width=width, height=_HEIGHT)
    return panel


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
    mark = base.mark_point(filled=True, fill="white", stroke=INK, strokeWidth=1.6, size=60, clip=False)
    numbers = [tip("x", "temperature (°C)"), tip("y", "speed (mm/s)")]
    tips = [alt.Tooltip("name:N"), alt.Tooltip("state:N"), *numbers]
    names = rimmed(base.encode(text="name:N"), align="right", dx=-8, fontSize=11)
    return [mark.encode(tooltip=tips), *names]
