"""The channels of a log as a chart: one panel each unless it is constant, extremes kept, faults named."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import altair as alt
import numpy as np
from tsdownsample import MinMaxLTTBDownsampler

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, ORANGE, WIDTH, Chart, Row, plot
from hersey.errors import InsufficientDataError
from hersey.inspection.inspecting import ChannelReport, FileReport, Inspection
from hersey.inspection.raw import raw_channels

#: Points drawn of a channel; panels of a file, those with a role first.
_POINTS, _PANELS = 2000, 12
_AXIS, _HEIGHT = 56, 90


def inspection_chart(paths: Sequence[str | Path], inspection: Inspection) -> Chart:
    """Return the channels of the files that were inspected, one panel each against time or row.

    Raises
    ------
    InsufficientDataError
        If no channel holds a number.
    """
    panels: list[alt.LayerChart] = []
    for path, report in zip(paths, inspection.files, strict=True):
        panels += _panels(Path(path), report)
    if not panels:
        raise InsufficientDataError("there is no channel to draw")
    title = alt.Title("Channels as recorded", subtitle=", ".join(file.name for file in inspection.files[:4]))
    stacked: Chart = alt.vconcat(*panels, spacing=10).properties(title=title)
    return stacked


def _panels(path: Path, report: FileReport) -> list[alt.LayerChart]:
    raw = {channel.column.path: channel for channel in raw_channels(path).channels}
    alive = [c for c in report.channels if all(fault.kind != "constant" for fault in c.traits.faults)]
    shown = sorted(alive, key=lambda c: not c.role)
    shown = [c for c in shown if c.role != "time" and c.name != c.clock][:_PANELS]
    panels = []
    for channel in shown:
        values = raw[channel.name].values
        clock = raw[channel.name].clock
        time = clock if clock is not None else getattr(raw.get(channel.clock), "values", None)
        unit = (
            "s"
            if clock is not None
            else next((c.unit for c in report.channels if c.name == channel.clock), "")
        )
        if np.isfinite(values).any():
            panels.append(_panel(channel, values, time, f"Time ({unit})" if time is not None else "Row"))
    return panels


def _panel(channel: ChannelReport, values: FloatArray, time: FloatArray | None, title: str) -> alt.LayerChart:
    x = np.arange(1.0, values.size + 1.0) if time is None else time - np.nanmin(time)
    good = np.flatnonzero(np.isfinite(values) & np.isfinite(x))
    kept = good
    if good.size > _POINTS:
        kept = good[MinMaxLTTBDownsampler().downsample(np.ascontiguousarray(values[good]), n_out=_POINTS)]
    rows: list[Row] = [
        {"x": float(f"{a:.7g}"), "y": float(f"{b:.6g}"), "index": i}
        for i, (a, b) in enumerate(zip(x[kept].tolist(), values[kept].tolist(), strict=True))
    ]
    marks: list[Row] = [
        {"x": float(x[f.first]), "y": float(values[f.first]), "kind": f.kind}
        for f in channel.traits.faults
        if f.kind != "constant" and np.isfinite(x[f.first])
    ]
    name = f"{channel.name} [{channel.unit}]" if channel.unit else channel.name
    role = f", {channel.role}" if channel.role else ""
    y = alt.Y("y:Q", title=None, scale=alt.Scale(zero=False), axis=alt.Axis(minExtent=_AXIS, tickCount=4))
    at = alt.X("x:Q", title=title, scale=alt.Scale(nice=False))
    line = (
        plot(rows)
        .mark_line(color=BLUE, strokeWidth=1, clip=True)
        .encode(x=at, y=y, order="index:Q", tooltip=[alt.Tooltip("x:Q"), alt.Tooltip("y:Q")])
    )
    point = (
        plot(marks)
        .mark_point(color=ORANGE, size=90, strokeWidth=2)
        .encode(x="x:Q", y="y:Q", tooltip=[alt.Tooltip("kind:N")])
    )
    said = "; ".join(channel.findings)
    heading = alt.Title(
        name + role, subtitle=said[:110] or "nothing found", anchor="start", fontSize=11, subtitleFontSize=10
    )
    return alt.LayerChart(layer=[line, point], width=WIDTH, height=_HEIGHT, title=heading)
