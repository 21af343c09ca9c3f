"""Marks and lines of dwells, shared by the figures that are drawn of a log; speeds in rpm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import Row, plot, rows_of, temperature_channels, temperature_name, torque_unit
from hersey.units import rpm
from paper.measured import Branch, Measured

SPEED = "Drive speed (rpm)"
#: Points of a line.
_POINTS = 60
#: Ratio by which the axis of speed is longer than the dwells at either end.
_MARGIN = 1.06
#: Temperature (K), speed (rad/s) and height of a line.
Curve = tuple[float | None, FloatArray, FloatArray]


def unit_of(measured: Measured) -> tuple[float, str]:
    """Return the factor from N m, and the unit in which the log's torques read best."""
    return torque_unit(float(measured.torque.max()))


def marks(measured: Measured, y: FloatArray, channel: alt.Y, x: alt.X) -> alt.Chart:
    """One mark per dwell, its temperature by colour and shape."""
    return dots(
        measured,
        [(k, measured.speed[i : i + 1], y[i : i + 1]) for i, k in enumerate(measured.kelvin)],
        channel,
        x,
    )


def dots(measured: Measured, curves: Sequence[Curve], channel: alt.Y, x: alt.X) -> alt.Chart:
    """One mark per place of `lines`."""
    rows: list[Row] = []
    for kelvin, speed, height in curves:
        rows += rows_of(speed=rpm(speed), y=height, level=[temperature_name(kelvin)] * speed.size)
    color, shape = _channels(measured)
    chart: alt.Chart = (
        plot(rows)
        .mark_point(filled=True, size=42, opacity=0.9)
        .encode(x=x, y=channel, color=color, shape=shape)
    )
    return chart


def _channels(measured: Measured) -> tuple[alt.Color, alt.Shape]:
    """Colour and shape of temperatures, named above the chart: on its right stand names of lines."""
    return temperature_channels(measured.kelvin, legend=measured.surface.b is not None, orient="top")


def speed_axis(measured: Measured) -> alt.X:
    """The logarithmic axis of speed, alike in panels that stand over each other."""
    low, high = rpm(measured.speed.min()), rpm(measured.speed.max())
    scale = alt.Scale(type="log", domain=[low / _MARGIN, high * _MARGIN], nice=False)
    return alt.X("speed:Q", title=SPEED, scale=scale)


def lines(measured: Measured, curves: Sequence[Curve], **look: Any) -> alt.Chart:
    """Lines of temperature (K), speed (rad/s) and height, in the colours of `marks`."""
    rows: list[Row] = []
    for number, (kelvin, speed, height) in enumerate(curves):
        rows += rows_of(
            speed=rpm(speed),
            y=height,
            level=[temperature_name(kelvin)] * speed.size,
            curve=[number] * speed.size,
        )
    color, _ = _channels(measured)
    chart: alt.Chart = (
        plot(rows)
        .mark_line(**{"clip": True, "strokeWidth": 1.6} | look)
        .encode(x="speed:Q", y="y:Q", color=color, detail="curve:N")
    )
    return chart


def span(measured: Measured, branch: Branch, count: int = _POINTS) -> FloatArray:
    """Return speeds over a branch, evenly spaced in logarithms, rad/s."""
    speed = measured.speed[branch.index]
    return np.geomspace(speed.min(), speed.max(), count)


def table(measured: Measured) -> dict[str, tuple[float, ...]]:
    """Return the dwells as the data of a figure, in SI; a temperature that is not known is NaN."""
    kelvin = [np.nan if each is None else each for each in measured.kelvin]
    columns = {
        "speed (rad/s)": measured.speed,
        "temperature (K)": np.array(kelvin),
        "torque (N m)": measured.torque,
        "damping (N m s/rad)": measured.damping,
    }
    return {name: tuple(values.tolist()) for name, values in columns.items()}
