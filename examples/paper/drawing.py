"""Drawings to scale: outlines, arrows, dimensions and texts, in the units of the thing drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import altair as alt

from hersey.charts.style import INK, RIM, Chart, Row, plot

#: Grey of what the file does not state.
UNSTATED = "#777"
#: Shades of rubber, core, heater and film, apart in greyscale.
RUBBER, CORE, HEATER, FILM = "#d9d2c5", "#a9adb3", "#f0c9a8", "#5b8bd0"
#: Length and half width of the head of an arrow, pixels.
_HEAD = (9.0, 3.2)
Place = tuple[float, float]


class Drawing:
    """A sheet of ``pixels`` to the unit, over ``across`` and ``up``, the same scale both ways."""

    def __init__(self, across: Place, up: Place, pixels: float) -> None:
        self.across, self.up, self.pixels = across, up, pixels
        self._layers: list[alt.Chart] = []

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, pixels."""
        (left, right), (low, high) = self.across, self.up
        return self.pixels * (right - left), self.pixels * (high - low)

    def outline(
        self, places: Sequence[Place], fill: str | None = None, *, stroke: str | None = INK, **look: Any
    ) -> None:
        """Draw a closed line, filled if a ``fill`` is given."""
        self.line([*places, places[0]], stroke=stroke, fill=fill, **look)

    def line(self, places: Sequence[Place], *, stroke: str | None = INK, **look: Any) -> None:
        """Draw a line through places."""
        style = {"strokeWidth": 1.2, "stroke": stroke, "clip": True} | look
        rows = [{"x": x, "y": y, "order": i} for i, (x, y) in enumerate(places)]
        self._add(plot(rows).mark_line(**style), order=alt.Order("order:Q"))

    def arrow(self, start: Place, end: Place, *, both: bool = False, color: str = INK) -> None:
        """Draw an arrow, or a dimension line with a head at either end."""
        self.line([start, end], stroke=color, strokeWidth=1.1)
        for tip, tail in [(end, start), *([(start, end)] if both else [])]:
            x, y = tip[0] - tail[0], tip[1] - tail[1]
            long = math.hypot(x, y)
            length, half = (each / self.pixels for each in _HEAD)
            foot = tip[0] - length * x / long, tip[1] - length * y / long
            side = -half * y / long, half * x / long
            corners = [tip, (foot[0] + side[0], foot[1] + side[1]), (foot[0] - side[0], foot[1] - side[1])]
            self.outline(corners, color, stroke=color, strokeWidth=0.5)

    def text(self, place: Place, text: str | Sequence[str], *, rim: bool = False, **look: Any) -> None:
        """Write one line, or several, left of which the place is unless told otherwise."""
        lines = [text] if isinstance(text, str) else list(text)
        base: Row = {"align": "left", "baseline": "middle", "fontSize": 12, "color": INK, "lineHeight": 15}
        rows: list[Row] = [{"x": place[0], "y": place[1]}]
        # A list of lines is not a field that Vega-Lite reads as text: it stands in the mark.
        for edge in [RIM, {}] if rim else [{}]:
            self._add(plot(rows).mark_text(**(base | look | edge), text=lines))

    def chart(self, **properties: Any) -> Chart:
        """Return the drawing."""
        width, height = self.size
        chart: Chart = alt.layer(*self._layers).properties(
            width=width, height=height, view=alt.ViewBackground(stroke=None), **properties
        )
        return chart

    def _add(self, mark: alt.Chart, **channels: Any) -> None:
        x, y = (alt.Scale(domain=list(ends), nice=False, zero=False) for ends in (self.across, self.up))
        self._layers.append(
            mark.encode(x=alt.X("x:Q", scale=x, axis=None), y=alt.Y("y:Q", scale=y, axis=None), **channels)
        )


def arc(centre: Place, radius: float, start: float, end: float, count: int = 181) -> list[Place]:
    """Return places on an arc, angles in rad from the x axis."""
    steps = [start + (end - start) * i / (count - 1) for i in range(count)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in steps]


def round_number(value: float) -> float:
    """Return the next smaller of 1, 2 and 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= value * (1.0 + 1e-9))
