"""A torque log: speed, torque and temperature over time."""

from __future__ import annotations

from collections.abc import Sequence

import altair as alt
import numpy as np

from hersey.charts.over_time import BARE, over_time, shaded, time_axis
from hersey.charts.style import (
    GREEN,
    INK,
    ROLL_SPEED,
    TEMPERATURE,
    WIDTH,
    Chart,
    Row,
    plot,
    rows_of,
    torque_unit,
)
from hersey.log.torque_log import TorqueLog
from hersey.study.thinning import kept
from hersey.units import celsius

#: Points drawn of a log, shared out among its runs, and least of one run.
_POINTS, _LEAST = 3000, 200


def log_chart(log: TorqueLog) -> Chart:
    """Return speed, torque and temperature over time, runs one after another."""
    starts = np.cumsum([0.0, *(float(run.time[-1] - run.time[0]) for run in log.runs)]).tolist()
    of, (factor, unit) = log.domain, torque_unit(max(float(np.abs(run.torque).max()) for run in log.runs))
    name, speed = f"Torque ({unit})", ROLL_SPEED if of.speed == "speed" else of.speed_axis
    if not of.is_torque:
        factor, name = of.shown[1], of.axis
    quantities = {
        speed: [of.shown_speed[1] * run.speed for run in log.runs],
        name: [factor * run.torque for run in log.runs],
    }
    if log.has_temperature:
        hot = [celsius(run.temperature) for run in log.runs if run.temperature is not None]
        quantities[TEMPERATURE] = hot
    panels = []
    for number, (name, values) in enumerate(quantities.items(), 1):
        rows: list[Row] = []
        for start, run, of_run in zip(starts, log.runs, values, strict=False):
            index = kept(of_run, max(_LEAST, _POINTS // len(log.runs)))
            rows += rows_of(time=start + run.time[index] - run.time[0], value=of_run[index])
        below = number < len(quantities)
        x = time_axis((0.0, starts[-1]), None, **BARE) if below else time_axis((0.0, starts[-1]))
        panels.append(log_panel(rows, name, x, ends=starts[1:-1]))
    files = f"{log.runs[0].name}" if len(log.runs) == 1 else f"{len(log.runs)} files one after another"
    subtitle = f"{files}: {log.rows} rows, the extremes kept in what is drawn"
    return alt.vconcat(*panels, spacing=8, title=alt.Title("The log as recorded", subtitle=subtitle))


def log_panel(
    rows: list[Row],
    name: str,
    x: alt.X,
    *,
    dwells: Sequence[tuple[float, float]] = (),
    ends: Sequence[float] = (),
) -> Chart:
    """Return one quantity over time, with the dwells shaded and dashes where a run ends."""
    layers = [shaded(dwells, GREEN)] if dwells else []
    layers.append(over_time(rows, name, x, width=0.9, zero=False))
    if ends:
        marks = plot(rows_of(time=ends)).mark_rule(color=INK, strokeDash=[2, 3])
        layers.append(marks.encode(x=x))
    return alt.layer(*layers, width=WIDTH, height=130)
