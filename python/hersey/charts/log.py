"""A torque log as recorded: speed, torque and temperature over time."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, INK, WIDTH, Chart, Row, plot, rows_of, tip, torque_unit
from hersey.log.torque_log import TorqueLog
from hersey.study.thinning import kept
from hersey.units import celsius, rpm

#: Points drawn of a log, shared out among its runs, and least of one run.
_POINTS, _LEAST = 3000, 200
_AXIS, _HEIGHT = 52, 130


def log_chart(log: TorqueLog) -> Chart:
    """Return speed, torque and temperature over time, runs one after another."""
    starts = np.cumsum([0.0, *(float(run.time[-1] - run.time[0]) for run in log.runs)])
    factor, unit = torque_unit(max(float(np.abs(run.torque).max()) for run in log.runs))
    panels = [
        ("Speed (rpm)", [rpm(run.speed) for run in log.runs]),
        (f"Torque ({unit})", [factor * run.torque for run in log.runs]),
    ]
    if log.has_temperature:
        panels.append(
            (
                "Temperature (°C)",
                [celsius(run.temperature) for run in log.runs if run.temperature is not None],
            )
        )
    last = len(panels) - 1
    charts = [_panel(log, starts, name, values, timed=i == last) for i, (name, values) in enumerate(panels)]
    return alt.vconcat(*charts, spacing=8, title=alt.Title("The log as recorded", subtitle=_subtitle(log)))


def _subtitle(log: TorqueLog) -> str:
    files = f"{log.runs[0].name}" if len(log.runs) == 1 else f"{len(log.runs)} files one after another"
    return f"{files}: {log.rows} rows, the extremes kept in what is drawn"


def _panel(log: TorqueLog, starts: FloatArray, name: str, values: list[FloatArray], *, timed: bool) -> Chart:
    rows: list[Row] = []
    for number, (run, of_run) in enumerate(zip(log.runs, values, strict=True)):
        index = kept(of_run, max(_LEAST, _POINTS // len(log.runs)))
        time = starts[number] + run.time[index] - run.time[0]
        rows += rows_of(time=time, value=of_run[index], run=[number] * index.size)
    axis = alt.Axis(labels=timed, ticks=timed)
    domain = [0.0, float(starts[-1])]
    x = alt.X(
        "time:Q",
        title="Time (s)" if timed else None,
        scale=alt.Scale(domain=domain, nice=False),
        axis=axis,
    )
    y = alt.Y("value:Q", title=name, scale=alt.Scale(zero=False), axis=alt.Axis(minExtent=_AXIS))
    tips = [tip("time", "time (s)"), tip("value", name)]
    line = plot(rows).mark_line(color=BLUE, strokeWidth=0.9)
    ends = plot(rows_of(time=starts[1:-1])).mark_rule(color=INK, strokeDash=[2, 3])
    layers = [line.encode(x=x, y=y, detail=alt.Detail("run:N"), tooltip=tips), ends.encode(x=x)]
    return alt.layer(*layers, width=WIDTH, height=_HEIGHT)
