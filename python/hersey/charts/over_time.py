"""Quantities over time: axes that line up from panel to panel, and what is marked on them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import altair as alt

from hersey.charts.style import BLUE, INK, ORANGE, TEMPERATURE, Row, categories, plot, rimmed, rows_of, tip
from hersey.units import celsius

#: The axis of values: panels one above another have the same width.
UP: Row = {"axis": alt.Axis(minExtent=46)}
#: An axis of time under which another panel has the same.
BARE: Row = {"labels": False, "ticks": False}


def time_axis(span: Sequence[float] | None = None, title: str | None = "Time (s)", **axis: Any) -> alt.X:
    """Return the axis of time, over a ``span`` or all that is drawn."""
    scale = alt.Scale(nice=False) if span is None else alt.Scale(domain=list(span), nice=False)
    look: Row = {"axis": alt.Axis(**axis)} if axis else {}
    return alt.X("time:Q", title=title, scale=scale, **look)


def over_time(
    rows: list[Row], name: str, x: alt.X, *, unit: str = "s", width: float = 1.5, **scale: Any
) -> alt.Chart:
    """Return rows of ``time`` and ``value`` as a line; ``scale`` is what its axis has beside its ``name``."""
    y = alt.Y("value:Q", title=name, scale=alt.Scale(**scale), **UP)
    line = plot(rows).mark_line(color=BLUE, strokeWidth=width, clip=True)
    drawn: alt.Chart = line.encode(x=x, y=y, tooltip=[tip("time", f"time ({unit})"), tip("value", name)])
    return drawn


def shaded(spans: Iterable[tuple[float, float]], color: str) -> alt.Chart:
    """Return stretches of time, shaded from top to bottom."""
    rows: list[Row] = [{"from": start, "to": end} for start, end in spans]
    drawn: alt.Chart = plot(rows).mark_rect(color=color, opacity=0.25).encode(x="from:Q", x2="to:Q")
    return drawn


def moment(
    time: float, name: str, x: alt.X, *, left: bool, color: str = INK, down: float = 4.0, **look: Any
) -> list[alt.Chart]:
    """Return an upright rule and its name, ``left`` of it or right, so many pixels ``down``."""
    mark = plot([{"time": time, "name": name}])
    rule = mark.mark_rule(color=color, **({"strokeWidth": 1} | look)).encode(x=x)
    side: Row = {"align": "right" if left else "left", "dx": -5 if left else 5, "baseline": "top"}
    return [rule, *rimmed(mark.encode(x=x, y=alt.value(down), text="name:N"), **side)]


def temperatures_over_time(
    times: Sequence[float], film: Sequence[float], roll: Sequence[float], x: alt.X, *, unit: str = "s"
) -> alt.Chart:
    """Return the temperatures (K) of film and roll, in degC."""
    rows = [
        row
        for body, kelvin in (("film", film), ("counterbody", roll))
        for row in rows_of(time=times, value=[celsius(t) for t in kelvin], body=[body] * len(times))
    ]
    legend = alt.Legend(title=None, orient="top-left", fillColor="white", padding=4)
    color = categories(alt.Color, "body", {"film": ORANGE, "counterbody": INK}, legend)
    drawn: alt.Chart = over_time(rows, TEMPERATURE, x, unit=unit, zero=False).encode(color=color)
    return drawn
