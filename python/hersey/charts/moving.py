"""Friction against speed of a log that moves all the time: windows of the log, and the fitted law."""

from __future__ import annotations

from typing import Any

import altair as alt
import numpy as np

from hersey.charts.style import (
    BLUE,
    HEIGHT,
    INK,
    WIDTH,
    Chart,
    layered,
    plot,
    rows_of,
    temperature_channels,
    temperature_name,
    torque_unit,
)
from hersey.damping.moving.result import MovingFit
from hersey.errors import InsufficientDataError
from hersey.units import rpm

#: Points of each direction of the line.
_POINTS = 120


def moving_chart(fit: MovingFit) -> Chart:
    """Return friction (without inertia, gravity, offset) against speed in both directions, with the law."""
    slow, fast = fit.speed_range
    one_way = np.geomspace(slow, fast, _POINTS)
    used = fit.fitting.equations.speed
    ways = [way for way in (-1.0, 1.0) if np.any(way * used > 0.0)]
    lines = [(np.sort(way * one_way), way) for way in ways]
    curves = [(speed, fit.friction(speed), way) for speed, way in lines]
    factor, unit = torque_unit(max(float(np.max(np.abs(torque))) for _, torque, _ in curves))
    x = alt.X("speed:Q", title="Speed (rpm)")
    y = alt.Y("torque:Q", title=f"Friction torque ({unit})")
    layers = []
    for speed, torque, way in curves:
        rows = rows_of(speed=rpm(speed), torque=factor * torque, way=[way] * speed.size)
        layers.append(plot(rows).mark_line(color=INK, strokeWidth=1.6).encode(x=x, y=y, order="speed:Q"))
    layers += _windows(fit, factor, x, y)
    subtitle = f"line: {fit.law}; dots: windows of the log, two standard errors"
    title = alt.Title("Friction while the speed changes", subtitle=subtitle)
    return layered(*layers, width=WIDTH, height=HEIGHT, title=title)


def _windows(fit: MovingFit, factor: float, x: alt.X, y: alt.Y) -> list[alt.Chart]:
    try:
        points = fit.points()
    except InsufficientDataError:
        return []
    torque, error = factor * points.column("torque"), 2.0 * factor * points.column("torque_error")
    kelvin = points.column("temperature").tolist() if fit.log.has_temperature else [None] * len(points)
    rows = rows_of(
        speed=rpm(points.column("speed")),
        torque=torque,
        low=torque - error,
        high=torque + error,
        level=[temperature_name(each) for each in kelvin],
    )
    base = plot(rows)
    color: Any = alt.value(BLUE)
    if fit.log.has_temperature:
        color = temperature_channels(kelvin)[0]
    bars = base.mark_rule().encode(x=x, y="low:Q", y2="high:Q", color=color)
    return [bars, base.mark_point(filled=True, size=36).encode(x=x, y=y, color=color)]
