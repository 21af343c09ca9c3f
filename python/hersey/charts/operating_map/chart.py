"""An operating map put together: regions, lines, points, names."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.labels import Labels
from hersey.charts.operating_map.frame import HEIGHT, WIDTH, Frame, speed_axis, temperature_axis
from hersey.charts.operating_map.lines import VISIBLE, contours, edges, speed_limit
from hersey.charts.operating_map.points import pointer, points
from hersey.charts.operating_map.regions import (
    bands_of,
    hatches,
    measured_box,
    measured_range,
    name_regions,
    regions,
)
from hersey.charts.style import BLUE, INK, ROLL_SPEED, Chart, Row, layered, logarithmic_axis, plot, rimmed
from hersey.stability.operating_map import OperatingMap
from hersey.units import rpm

#: Looks of the texts, by what they name, the first drawn first.
_LOOKS: dict[str, Row] = {
    "regions": {"fontSize": 13, "fontWeight": "bold", "color": INK},
    "points": {"fontSize": 13, "fontWeight": "bold", "color": "black"},
    "contours": {"fontSize": 11, "color": BLUE},
    "lines": {"fontSize": 11, "color": INK},
}


def map_chart(result: OperatingMap, *, tooltips: bool = True) -> Chart:
    """Return the chart of an operating map; without ``tooltips`` files that cannot show them are smaller."""
    frame, labels = Frame.of(result), Labels(WIDTH, HEIGHT)
    layers = _layers(result, frame, labels)
    texts = layered(*_texts(labels, frame))
    main = layered(*layers, texts, *([pointer(result, frame)] if tooltips else []))
    title = alt.Title(_title(result), subtitle=_subtitle(result))
    chart: Chart = layered(
        main, _revolutions(result, frame), title=title, width=WIDTH, height=HEIGHT
    ).resolve_scale(y="independent")
    return chart


def _layers(result: OperatingMap, frame: Frame, labels: Labels) -> list[alt.Chart]:
    """All but the texts, which points choose before lines and lines before regions."""
    bands = bands_of(result, frame)
    marks = points(result, frame, labels)
    limit = speed_limit(result, frame, labels)
    torques = contours(result, frame, labels)
    name_regions(bands, frame, labels, measured_box(result, frame))
    areas = [regions(bands, frame), *hatches(result, frame)]
    return [*areas, *torques, *edges(result, frame), *measured_range(result, frame), *limit, *marks]


def _texts(labels: Labels, frame: Frame) -> list[alt.Chart]:
    """All texts with a pale rim, so that lines do not run through them."""
    layers: list[alt.Chart] = []
    for style, look in _LOOKS.items():
        rows: list[Row] = []
        for text in labels.texts:
            if text.style == style:
                x, y = frame.at(text.across, text.up)
                rows.append({"x": x, "y": 1e3 * y, "text": text.text})
        if rows:
            base = plot(rows).encode(x=temperature_axis(frame), y=speed_axis(frame), text="text:N")
            layers += rimmed(base, **look)
    return layers


def _title(result: OperatingMap) -> str:
    return "Operating map" + (" (isothermal fit)" if result.temperature is None else "")


def _subtitle(result: OperatingMap) -> list[str]:
    counted = ", ".join(["fit", *(name.replace("_", " ") for name in result.uncertain)])
    first = "solid: transition, shaded: its 95 % interval"
    if np.any(result.upper > VISIBLE * result.transition):
        first += f"; dashed: V*, dotted: its 95 % interval (from {counted})"
    elif np.any(result.upper_interval[1] > VISIBLE * result.transition_interval[1]):
        first += f"; dotted: 95 % interval of V* (from {counted})"
    second = "thin: drag torque; frame: measured range; hatched: extrapolated"
    if result.torque_limit is not None:
        second += f"; stall beyond {result.torque_limit:.3g} N·m ({result.limited_by})"
    return [first, second]


def _revolutions(result: OperatingMap, frame: Frame) -> alt.Chart:
    """The second axis: revolutions of the roll."""
    low, high = (rpm(v / result.roll_radius) for v in (frame.low, frame.high))
    y = alt.Y("rpm:Q", title=ROLL_SPEED, **logarithmic_axis((low, high), orient="right", grid=False))
    rows: list[Row] = [{"x": float(frame.x[0]), "rpm": low}]
    chart: alt.Chart = plot(rows).mark_point(opacity=0, size=0).encode(x=temperature_axis(frame), y=y)
    return chart
