"""Friction against speed of a log that moves all the time: windows and moments of the log, and the law."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.friction_curve import friction_curve_chart
from hersey.charts.style import HEIGHT, INK, WIDTH, Chart, layered, plot, rows_of, torque_unit
from hersey.damping.moving.curve import moving_curve
from hersey.damping.moving.result import MovingFit
from hersey.errors import InsufficientDataError
from hersey.units import rpm

#: Points of each direction of the line.
_POINTS = 120


def moving_chart(fit: MovingFit) -> Chart:
    """Return friction (without inertia, gravity, offset) against speed in both directions, with the law."""
    try:
        curve = moving_curve(fit.points())
    except InsufficientDataError:
        curve = None
    return _law_alone(fit) if curve is None else friction_curve_chart(curve, fit.moments)


def _law_alone(fit: MovingFit) -> Chart:
    """The law where too few windows can judge it, as in start-stop tests of one speed."""
    one_way = np.geomspace(*fit.speed_range, _POINTS)
    ways = [way for way in (-1.0, 1.0) if np.any(way * fit.moments.speed > 0.0)]
    lines = [(np.sort(way * one_way), way) for way in ways]
    curves = [(speed, fit.friction(speed), way) for speed, way in lines]
    factor, unit = torque_unit(max(float(np.max(np.abs(torque))) for _, torque, _ in curves))
    x = alt.X("speed:Q", title="Speed (rpm)")
    y = alt.Y("torque:Q", title=f"Friction torque ({unit})")
    layers = []
    for speed, torque, way in curves:
        rows = rows_of(speed=rpm(speed), torque=factor * torque, way=[way] * speed.size)
        layers.append(plot(rows).mark_line(color=INK, strokeWidth=1.6).encode(x=x, y=y, order="speed:Q"))
    title = alt.Title("Friction while the speed changes", subtitle=f"line: {fit.law}")
    return layered(*layers, width=WIDTH, height=HEIGHT, title=title)
