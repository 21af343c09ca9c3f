"""The lines of an operating map, and their names."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.labels import Labels
from hersey.charts.operating_map.frame import Frame, side_to_side, speed_axis, temperature_axis
from hersey.charts.style import BLUE, INK, Row, plot, torque_unit
from hersey.stability.operating_map import OperatingMap

#: Least share by which V* exceeds the transition speed where its line is drawn.
VISIBLE = 1.01
#: Contours of torque aimed at, and the steps that read well.
_CONTOURS, _STEPS = 6, (1.0, 2.0, 2.5, 5.0, 10.0)


def edges(result: OperatingMap, frame: Frame) -> list[alt.Chart]:
    """Return the transition speed and V* with their intervals, and the edges of the stall."""
    low, high = (frame.clipped(side_to_side(result, edge)) for edge in result.transition_interval)
    shade = [
        {"x": x, "y": 1e3 * a, "top": 1e3 * b}
        for x, a, b in zip(*map(np.ndarray.tolist, (frame.x, low, high)), strict=True)
    ]
    area = plot(shade).mark_area(color=INK, opacity=0.35, clip=True)
    interval = area.encode(x=temperature_axis(frame), y=speed_axis(frame), y2="top:Q")
    beyond = VISIBLE * result.transition_interval[1]
    fold = np.where(result.upper > VISIBLE * result.transition, result.upper, 0.0)
    charts = [
        _line(result, frame, result.transition, [1.0, 0.0], 1.8),
        _line(result, frame, fold, [7.0, 4.0], 1.8),
        *(
            _line(result, frame, np.where(edge > beyond, edge, 0.0), [1.5, 3.5], 1.3)
            for edge in result.upper_interval
        ),
        *(_line(result, frame, edge, [1.0, 0.0], 1.0) for edge in (result.stall_below, result.stall_above)),
    ]
    return [interval, *(chart for chart in charts if chart is not None)]


def _line(
    result: OperatingMap, frame: Frame, edge: FloatArray, dash: list[float], width: float, color: str = INK
) -> alt.Chart | None:
    """A line where there is a speed, which may leave the window; none at 0 or far beyond it."""
    columns = zip(frame.x.tolist(), side_to_side(result, edge).tolist(), strict=True)
    rows: list[Row] = [{"x": x, "y": 1e3 * v} for x, v in columns if 0.5 * frame.low < v < 2.0 * frame.high]
    if len(rows) < 2:
        return None
    line: alt.Chart = plot(rows).mark_line(color=color, strokeDash=dash, strokeWidth=width, clip=True)
    return line.encode(x=temperature_axis(frame), y=speed_axis(frame))


def contours(result: OperatingMap, frame: Frame, labels: Labels) -> list[alt.Chart]:
    """Return lines of constant torque where the belt slides steadily, each with its value."""
    scale, unit = torque_unit(float(result.torque.max()))
    charts = []
    for level in _levels(result, scale):
        rising = result.contour(level / scale)[1]
        speeds = np.where(rising > 1.0001 * result.transition, rising, 0.0)
        line = _line(result, frame, speeds, [1.0, 0.0], 0.9, BLUE)
        if line is not None:
            charts.append(line)
            labels.along(f"{level:.4g} {unit}", frame.line(side_to_side(result, speeds)), "contours")
    return charts


def _levels(result: OperatingMap, scale: float) -> list[float]:
    """Round torques from the least above the transition to the greatest that does not stall."""
    rising = result.speed >= result.transition[:, None]
    if not np.any(rising):
        return []
    low = scale * float(result.torque[rising].min())
    high = scale * min(float(result.torque[rising].max()), result.torque_limit or np.inf)
    rough = (high - low) / _CONTOURS
    if not rough > 0:
        return []
    power = 10.0 ** np.floor(np.log10(rough))
    step = next(s for s in _STEPS if s * power >= rough * 0.999) * power
    return [float(k * step) for k in range(int(np.ceil(low / step)), int(np.ceil(high / step)))]


def speed_limit(result: OperatingMap, frame: Frame, labels: Labels) -> list[alt.Chart]:
    """Return the greatest speed of the drive as a line, if it lies within the window."""
    if result.speed_limit is None or not frame.low < result.speed_limit < frame.high:
        return []
    limit = np.full(result.transition.size, result.speed_limit)
    looks = (([1.0, 0.0], 3.0, "white"), ([10.0, 3.0, 2.0, 3.0], 1.3, INK))
    lines = [_line(result, frame, limit, *look) for look in looks]
    labels.along("drive limit", frame.line(side_to_side(result, limit)), "lines")
    return [line for line in lines if line is not None]
