"""The regions of an operating map, and where they are extrapolated."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.labels import Box, Labels
from hersey.charts.operating_map.frame import HEIGHT, WIDTH, Frame, side_to_side, speed_axis, temperature_axis
from hersey.charts.style import INK, Row, categories, plot
from hersey.stability.operating_map import OperatingMap
from hersey.units import celsius

#: Name, text in the legend, text on the map, and colour of each region, lightness falling.
REGIONS = (
    ("smooth", "smooth", "smooth", "#eef5fb"),
    ("bistable", "depends on start", "depends on start", "#f5cf7f"),
    ("swing", "depends on start: oscillates when slowed down", "oscillates", "#e08f2d"),
    ("stick_slip", "sticks", "sticks", "#cc6a3d"),
    ("creep", "sticks: slower than the stick speed", "below stick speed", "#a8503a"),
    ("stall", "stall: the drive slips", "stall", "#44444e"),
    ("motor", "stall: above the motor limit", "motor stalls", "#44444e"),
)
#: Lower and upper edge (m/s) of a part of a region at each column of the chart.
Edges = tuple[FloatArray, FloatArray]
Bands = dict[str, list[Edges]]
#: Pixels between hatches.
_HATCH = 9.0
#: Least height of a region that is shown, in pixels.
_THIN = 4.0


def bands_of(result: OperatingMap, frame: Frame) -> Bands:
    """Return the parts of each region; the one beyond the drive has two, or all where it does not start."""
    names = ("stall_below", "lower", "transition", "upper", "stall_above")
    below, lower, bend, upper, above = (
        frame.clipped(side_to_side(result, getattr(result, n))) for n in names
    )
    below = np.where(side_to_side(result, result.starts.astype(float)) > 0, below, frame.high)
    sticks = frame.clipped(np.array([0.0]) if result.given else side_to_side(result, result.stick_speed))
    bottom, top = np.full_like(below, frame.low), np.full_like(below, frame.high)

    def between(low: FloatArray, high: FloatArray) -> Edges:
        low = np.clip(low, below, above)
        return low, np.maximum(np.clip(high, below, above), low)

    bands = {
        "creep": [between(bottom, np.minimum(sticks, lower))],
        "stick_slip": [between(np.maximum(bottom, sticks), lower)],
        "swing": [between(lower, bend)],
        "bistable": [between(bend, upper)],
        "smooth": [between(upper, top)],
        "stall": [],
        "motor": [],
    }
    return bands | {result.beyond: [(bottom, below), (above, top)]}


def regions(bands: Bands, frame: Frame) -> alt.Chart:
    """Return the regions as areas with their legend."""
    rows = [
        {"x": x, "y": 1e3 * low, "top": 1e3 * high, "region": text, "part": f"{name} {part}"}
        for name, text, _, _ in REGIONS
        for part, edges in enumerate(bands[name])
        if HEIGHT * np.log(edges[1] / edges[0]).max() > _THIN * np.log(frame.high / frame.low)
        for x, low, high in zip(*map(np.ndarray.tolist, (frame.x, *edges)), strict=True)
    ]
    seen = {row["region"] for row in rows}
    chart: alt.Chart = plot(rows).mark_area(clip=True)
    return chart.encode(
        x=temperature_axis(frame),
        y=speed_axis(frame),
        y2="top:Q",
        color=region_color("region", [name for name, text, _, _ in REGIONS if text in seen], symbolSize=160),
        detail="part:N",
    )


def region_color(field: str, names: Collection[str], **legend: Any) -> alt.Color:
    """Return the colours of regions by these ``names``, with their legend below."""
    looks = {text: color for name, text, _, color in REGIONS if name in names}
    look: Row = {"symbolType": "square", "symbolStrokeColor": "#666", "labelLimit": 260} | legend
    color: alt.Color = categories(alt.Color, field, looks, alt.Legend(orient="bottom", title=None, **look))
    return color


def hatches(result: OperatingMap, frame: Frame) -> list[alt.Chart]:
    """Return diagonals across all that is extrapolated, pale ones between them for dark regions."""
    looks = ((0.0, "#555", 0.45), (_HATCH / 2, "white", 0.3))
    charts = []
    for start, color, opacity in looks:
        mark = plot(_diagonals(result, frame, start)).mark_rule(
            color=color, opacity=opacity, strokeWidth=0.7, clip=True
        )
        charts.append(mark.encode(x=temperature_axis(frame), y=speed_axis(frame), x2="x2:Q", y2="y2:Q"))
    return charts


def _diagonals(result: OperatingMap, frame: Frame, offset: float) -> list[Row]:
    left, bottom, right, top = measured_box(result, frame)
    rows: list[Row] = []
    for shift in np.arange(offset - HEIGHT, WIDTH, _HATCH).tolist():
        start, end = max(0.0, shift), min(float(WIDTH), shift + HEIGHT)
        enter, leave = max(left, bottom + shift), min(right, top + shift)
        inside = [enter, leave] if leave > enter else []
        stops = sorted([start, *(min(max(v, start), end) for v in inside), end])
        for a, b in zip(stops[::2], stops[1::2], strict=True):
            if b - a > 0.5:
                (x, y), (x2, y2) = frame.at(a, a - shift), frame.at(b, b - shift)
                rows.append({"x": x, "y": 1e3 * y, "x2": x2, "y2": 1e3 * y2})
    return rows


def measured_box(result: OperatingMap, frame: Frame) -> Box:
    """Return what the dwells span, pixels."""
    low, high = (frame.up(v) for v in result.measured_speed)
    left, right = 0.0, float(WIDTH)
    if result.measured_temperature is not None:
        left, right = (frame.across(celsius(t)) for t in result.measured_temperature)
    return max(left, 0.0), max(low, 0.0), min(right, float(WIDTH)), min(high, float(HEIGHT))


def measured_range(result: OperatingMap, frame: Frame) -> list[alt.Chart]:
    """Return the frame around what the dwells span."""
    left, bottom, right, top = measured_box(result, frame)
    if not (right > left and top > bottom):
        return []
    (x, y), (x2, y2) = frame.at(left, bottom), frame.at(right, top)
    rows: list[Row] = [{"x": x, "y": 1e3 * y, "x2": x2, "y2": 1e3 * y2}]
    base = plot(rows).encode(x=temperature_axis(frame), y=speed_axis(frame), x2="x2:Q", y2="y2:Q")
    return [
        base.mark_rect(filled=False, stroke=stroke, strokeWidth=width)
        for stroke, width in (("white", 3.0), (INK, 1.2))
    ]


def name_regions(bands: Bands, frame: Frame, labels: Labels, measured: Box) -> None:
    """Name each region where it has the most room, if possible where dwells were measured."""
    across = np.array([frame.across(x) for x in frame.x.tolist()])
    for name, _, text, _ in REGIONS:
        parts = [(across, _heights(low, frame), _heights(high, frame)) for low, high in bands[name]]
        labels.inside(text, parts, "regions", preferred=measured)


def _heights(edge: FloatArray, frame: Frame) -> FloatArray:
    return np.array([frame.up(v) for v in edge.tolist()])
