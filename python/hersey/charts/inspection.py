"""The channels of a log as a chart: one panel each unless it is constant, extremes kept, faults named."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, INK, ORANGE, WIDTH, Chart, Row, plot
from hersey.errors import InsufficientDataError
from hersey.inspection.file_report import ChannelReport, FileReport
from hersey.inspection.inspecting import Inspection
from hersey.inspection.raw import raw_channels
from hersey.study.thinning import kept

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
    return alt.vconcat(*panels, spacing=10, title=title)


def channels_chart(inspection: Inspection, *, paths: Sequence[str | Path] = ()) -> Chart:
    """Return the channels as recorded if the ``paths`` of the files are given, or else where faults begin."""
    return inspection_chart(paths, inspection) if paths else findings_chart(inspection)


def findings_chart(inspection: Inspection) -> Chart:
    """Return where the faults of each channel begin; the samples themselves are in the files alone.

    Raises
    ------
    InsufficientDataError
        If there is no channel.
    """
    panels = [_findings(report) for report in inspection.files if report.channels]
    if not panels:
        raise InsufficientDataError("there is no channel to draw")
    title = alt.Title("Channels: range and faults", subtitle=_subtitle(inspection))
    return alt.vconcat(*panels, spacing=18, title=title)


def _subtitle(inspection: Inspection) -> str:
    support = inspection.support
    if support is None:
        return inspection.problem[:110]
    return f"{support.dwells} dwells at {support.speeds} speeds, {len(support.temperatures)} temperatures"


def _findings(report: FileReport) -> Chart:
    """One line per channel from its first row to its last, a mark where each kind of fault begins."""
    names = [f"{c.name}, {c.role}" if c.role else c.name for c in report.channels]
    lines = [
        {"channel": name, "row": 1, "end": c.traits.rows, "text": _range(c)}
        for name, c in zip(names, report.channels, strict=True)
    ]
    faults: list[Row] = [
        {"channel": name, "row": fault.first + 1, "kind": fault.kind, "rows": fault.rows}
        for name, channel in zip(names, report.channels, strict=True)
        for fault in channel.traits.faults
    ]
    scale = alt.Scale(domain=[0, max(report.rows, 1)], nice=False)
    x = alt.X("row:Q", title="Row (number)", scale=scale, axis=alt.Axis(tickCount=8))
    # A domain, not a sort: Vega-Lite makes an expression of a sort, and these are names from a file.
    order = alt.Scale(domain=list(dict.fromkeys(names)))
    y = alt.Y("channel:N", title=None, scale=order, axis=alt.Axis(labelLimit=220))
    kinds = sorted({fault["kind"] for fault in faults})
    legend = alt.Legend(title="start of a fault", orient="bottom") if kinds else None
    shape = alt.Shape("kind:N", scale=alt.Scale(domain=kinds), legend=legend)
    bar = plot(lines).mark_rule(strokeWidth=3, color=BLUE, opacity=0.55)
    text = plot(lines).mark_text(align="left", dx=8, fontSize=11, color=INK)
    dots = plot(faults).mark_point(filled=True, color=ORANGE, size=90, opacity=1)
    tips = [alt.Tooltip("kind:N", title="fault"), alt.Tooltip("rows:Q", title="rows affected")]
    layers = [
        bar.encode(x=x, x2=alt.X2("end:Q"), y=y),
        text.encode(x=alt.value(WIDTH), y=y, text=alt.Text("text:N")),
        dots.encode(x=x, y=y, shape=shape, tooltip=tips),
    ]
    clean = "" if faults else ", no fault found"
    words = f"{report.rows} rows{clean}; right: minimum to maximum"
    heading = alt.Title(report.name, subtitle=words, fontSize=12)
    return alt.layer(*layers, title=heading, width=WIDTH, height=26 * len(names))


def _range(channel: ChannelReport) -> str:
    unit = f" {channel.unit}" if channel.unit else ""
    missing = f", {channel.traits.missing} missing" if channel.traits.missing else ""
    return f"{channel.traits.low:.4g} to {channel.traits.high:.4g}{unit}{missing}"


def _panels(path: Path, report: FileReport) -> list[alt.LayerChart]:
    raw = {channel.column.path: channel for channel in raw_channels(path).channels}
    alive = [c for c in report.channels if all(fault.kind != "constant" for fault in c.traits.faults)]
    channels = sorted(alive, key=lambda c: not c.role)
    channels = [c for c in channels if c.role != "time" and c.name != c.clock][:_PANELS]
    panels = []
    for channel in channels:
        values, time, unit = raw[channel.name].values, raw[channel.name].clock, "s"
        if time is None:
            time = getattr(raw.get(channel.clock), "values", None)
            unit = next((c.unit for c in report.channels if c.name == channel.clock), "")
        if np.isfinite(values).any():
            panels.append(_panel(channel, values, time, f"Time ({unit})" if time is not None else "Row"))
    return panels


def _panel(channel: ChannelReport, values: FloatArray, time: FloatArray | None, title: str) -> alt.LayerChart:
    x = np.arange(1.0, values.size + 1.0) if time is None else time - np.nanmin(time)
    index = kept(values, _POINTS, known=x)
    rows: list[Row] = [
        {"x": float(f"{a:.7g}"), "y": float(f"{b:.6g}"), "index": i}
        for i, (a, b) in enumerate(zip(x[index].tolist(), values[index].tolist(), strict=True))
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
    line = plot(rows).mark_line(color=BLUE, strokeWidth=1, clip=True)
    layers = [line.encode(x=at, y=y, order="index:Q", tooltip=[alt.Tooltip("x:Q"), alt.Tooltip("y:Q")])]
    if marks:
        points = plot(marks).mark_point(color=ORANGE, size=90, strokeWidth=2)
        layers.append(points.encode(x="x:Q", y="y:Q", tooltip=[alt.Tooltip("kind:N")]))
    look: Row = {"anchor": "start", "fontSize": 11, "subtitleFontSize": 10}
    said = "; ".join(map(str, channel.warnings))
    heading = alt.Title(name + role, subtitle=said[:110] or "no fault found", **look)
    return alt.LayerChart(layer=layers, width=WIDTH, height=_HEIGHT, title=heading)
