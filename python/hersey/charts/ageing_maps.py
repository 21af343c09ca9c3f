"""The operating map of a specimen when new, now and at its failure, side by side."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.operating_map.regions import REGIONS, region_color
from hersey.charts.style import INK, TEMPERATURE, Chart, Row, logarithmic_axis, plot, rimmed, rows_of, tip
from hersey.life.age import Age
from hersey.life.ageing_maps import AgeingMaps
from hersey.units import celsius

#: Width of all panels together without the gaps between them, and their height, px.
_ALL, _HEIGHT = 640, 320
#: Pixels between hatches, and of the pieces that they are made of.
_HATCH, _PIECE = 9.0, 3.0
#: Regions of the operating map that are shown here, from slow to fast.
_REGIONS = ("motor", "stick_slip", "bistable", "smooth")


def ageing_maps_chart(result: AgeingMaps) -> Chart:
    """Return one map per age, on the same axes."""
    width = _ALL / len(result.when)
    panels = [_panel(result, index, width) for index in range(len(result.when))]
    words = ["solid: transition; dashed: V*; points: operating points", *map(str, result.warnings)]
    if not result.measured.all():
        words.insert(1, f"hatched: extrapolated beyond the dwells or the age last seen ({_measured(result)})")
    title = alt.Title(f"Operating map of {result.unit} over its life", subtitle=words)
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
    hatched = [
        plot(_hatches(result, index, width, shift)).mark_rule(color=tone, opacity=opacity, clip=True)
        for shift, tone, opacity in ((0.0, "#555", 0.45), (_HATCH / 2, "white", 0.3))
        if not result.measured[index].all()
    ]
    areas = alt.layer(areas, *(each.encode(x=x, y=y, x2="x2:Q", y2="y2:Q") for each in hatched))
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


def _measured(result: AgeingMaps) -> str:
    """What the dwells and the runs span, as far as the maps show it."""
    seen = [i for i in range(len(result.when)) if result.measured[i].any()]
    if not seen:
        return "nothing is measured"
    inside = np.asarray(result.measured[seen].any(axis=0))
    hot, speed = celsius(result.temperature[inside.any(axis=1)]), 1e3 * result.speed[inside.any(axis=0)]
    return (
        f"measured: {hot[0]:.3g} to {hot[-1]:.3g} °C, {speed[0]:.3g} to {speed[-1]:.3g} mm/s, "
        f"up to {Age(float(result.ages[seen].max()), result.age_unit)}"
    )


def _hatches(result: AgeingMaps, index: int, width: float, shift: float) -> list[Row]:
    """Pieces of diagonals over the places that are not measured."""
    hot, logs = celsius(result.temperature), np.log(1e3 * result.speed)
    open_, rows = ~result.measured[index], []
    for start in np.arange(shift - _HEIGHT, width, _HATCH).tolist():
        at = np.arange(max(0.0, start), min(width, start + _HEIGHT) + _PIECE / 2, _PIECE)
        across, up = at / width, (at - start) / _HEIGHT
        column = np.rint(np.clip(across, 0.0, 1.0) * (hot.size - 1)).astype(int)
        row = np.rint(np.clip(up, 0.0, 1.0) * (logs.size - 1)).astype(int)
        inside = np.concatenate([[0], open_[column, row].astype(int), [0]])
        ends = np.flatnonzero(np.diff(inside)).reshape(-1, 2)
        x, y = hot[0] + across * (hot[-1] - hot[0]), np.exp(logs[0] + up * (logs[-1] - logs[0]))
        rows += [
            {"x": x[a], "y": y[a], "x2": x[b - 1], "y2": y[b - 1]} for a, b in ends.tolist() if b > a + 1
        ]
    return rows


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
