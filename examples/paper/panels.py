"""The charts that the figures are put together from, in the looks of the house."""

from __future__ import annotations

import math
from typing import Any

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, INK, Chart, Row, plot, ramp, rows_of
from hersey.motion.schedule import Schedule
from hersey.motion.trajectory import Trajectory
from paper.judges import Quantity
from paper.sweep import Sweep

#: Colour and shape of the three values traced: each alone tells them apart, also in greyscale.
COLORS, SHAPES = ramp(3), ("circle", "square", "triangle-up")
#: Width of one of two panels that stand side by side under a full one.
_HALF = 292
#: Width kept for the vertical axes, so that stacked panels line up.
_AXIS = 42


def trace(
    time: FloatArray,
    value: FloatArray,
    *,
    title: str,
    domain: tuple[float, float],
    color: str = BLUE,
    timed: bool = False,
) -> alt.Chart:
    """A quantity against time; of a stack of panels only the last is ``timed``."""
    rows = rows_of(time=time, value=value)
    y = alt.Y(
        "value:Q",
        title=title,
        scale=alt.Scale(domain=list(domain), nice=False),
        axis=alt.Axis(minExtent=_AXIS, tickCount=5),
    )
    chart: alt.Chart = (
        plot(rows)
        .mark_line(color=color, strokeWidth=1.6, clip=True)
        .encode(x=_time("time:Q", float(time[-1]), timed), y=y)
    )
    return chart


def driven(
    run: Trajectory, drive: Schedule, *, domain: tuple[float, float], timed: bool
) -> alt.LayerChart | alt.FacetChart:
    """Belt speed against time, and dashed the drive speed."""
    end = float(run.time[-1])
    line = trace(run.time, run.belt_speed, title="Speed (in/s)", domain=domain, timed=timed)
    points = zip(np.asarray(drive.times).tolist(), np.asarray(drive.values).tolist(), strict=True)
    corners = [(0.0, drive.first), *((t, v) for t, v in points if 0.0 < t < end), (end, drive.at(end))]
    rows: list[Row] = [{"time": t, "value": v, "corner": i} for i, (t, v) in enumerate(corners)]
    dashed = plot(rows).mark_line(color=INK, strokeDash=[5, 3], strokeWidth=1.4)
    return alt.layer(line, dashed.encode(x=_time("time:Q", end, timed), y="value:Q", order="corner:Q"))


def trend_panel(
    sweep: Sweep,
    quantity: Quantity,
    traced: list[float],
    *,
    title: str,
    dashed: tuple[str, float] | None = None,
) -> Chart:
    """A quantity against the parameter, both logarithmic, so that a power law is a straight line.

    ``traced`` are its values in the cases drawn as traces; ``dashed`` names a power law to compare with.
    """
    parameter, along = sweep.parameter, quantity.along(sweep)
    rows = [{"x": float(x), "y": float(y)} for x, y in zip(sweep.value, along, strict=True)]
    names = [f"{value:g}" for value in parameter.traced]
    dots: list[Row] = [
        {"x": x, "y": y, "of": name} for x, y, name in zip(parameter.traced, traced, names, strict=True)
    ]
    compared = _power_law(parameter.traced, traced[1], *dashed) if dashed else []
    low, high = _ends([float(row["y"]) for row in [*rows, *dots, *compared]])
    x = alt.X(
        "x:Q",
        title=parameter.axis,
        scale=alt.Scale(
            type="log", domain=[parameter.traced[0] * 0.93, parameter.traced[-1] * 1.07], nice=False
        ),
        axis=alt.Axis(values=list(parameter.ticks), format="~g"),
    )
    y = alt.Y(
        "y:Q",
        title=title,
        scale=alt.Scale(type="log", domain=[low, high], nice=False),
        axis=alt.Axis(minExtent=_AXIS, format="~g", values=_ticks(low, high)),
    )
    color = alt.Color("of:N", scale=alt.Scale(domain=names, range=COLORS), legend=None)
    shape = alt.Shape("of:N", scale=alt.Scale(domain=names, range=list(SHAPES)), legend=None)
    layers = [
        plot(compared).mark_line(color=INK, strokeDash=[4, 3], strokeWidth=1).encode(x=x, y=y),
        _name(compared[-1:], stroke="white", strokeWidth=4).encode(x=x, y=y),
        _name(compared[-1:], color=INK).encode(x=x, y=y),
        plot(rows).mark_line(color=INK, strokeWidth=1.8).encode(x=x, y=y),
        plot(dots).mark_point(filled=True, size=80, opacity=1).encode(x=x, y=y, color=color, shape=shape),
    ]
    exponent = quantity.trend(sweep).exponent
    heading = alt.Title(f"fitted power: {parameter.symbol}^{exponent:.2f}", fontSize=12, frame="group")
    return alt.layer(*(layers if dashed else layers[3:])).properties(width=_HALF, height=200, title=heading)


def _name(rows: list[Row], **look: Any) -> alt.Chart:
    """The name of a line beside its end; a white edge keeps grid lines out of the letters."""
    chart: alt.Chart = plot(rows).mark_text(align="right", dx=-14, fontSize=12, **look).encode(text="name:N")
    return chart


def _power_law(x: tuple[float, ...], middle: float, name: str, exponent: float) -> list[Row]:
    """From end to end through the value at the middle."""
    return [{"x": at, "y": middle * (at / x[1]) ** exponent, "name": name} for at in (x[0], x[-1])]


def _ends(values: list[float]) -> tuple[float, float]:
    """Ends of a logarithmic axis, a tenth wider than the values."""
    low, high = min(values), max(values)
    margin = (high / low) ** 0.1
    return low / margin, high * margin


def _ticks(low: float, high: float) -> list[float]:
    """Round values within, eight at most."""
    size = 10.0 ** math.floor(math.log10(high - low))
    for step in (size * m for m in (0.1, 0.2, 0.5, 1.0, 2.0)):
        first, last = math.ceil(low / step), math.floor(high / step)
        if last - first < 8:
            break
    return [float(value) for value in np.round(np.arange(first, last + 1) * step, 9)]


def _time(field: str, end: float, timed: bool) -> alt.X:
    """The time axis; panels above the last keep its grid alone."""
    axis = (
        alt.Axis(tickCount=12, format=".1f") if timed else alt.Axis(tickCount=12, labels=False, ticks=False)
    )
    scale = alt.Scale(domain=[0.0, end], nice=False)
    return alt.X(field, title="Time (s)" if timed else None, scale=scale, axis=axis)
