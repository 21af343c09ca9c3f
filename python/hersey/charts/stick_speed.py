"""V* against the stick speed, which no log measures."""

from __future__ import annotations

import math

import altair as alt
import numpy as np

from hersey.charts.style import DIAMOND, INK, WIDTH, Chart, Row, logarithmic_axis, plot, rimmed, rows_of, tip
from hersey.decision.behaviour import StickSpeeds
from hersey.document.analysis import Analysis
from hersey.units import celsius

_HEIGHT = 260
#: Grounds of the zones, as on the operating map.
_SMOOTH, _DEPENDS, _STICKS = "#e7f1f4", "#f4dc94", "#e2a78f"


def stick_speed_chart(document: Analysis) -> Chart:
    """Return what the belt does at which drive speed, over the range of the stick speed."""
    sweep = document.stick_speed_sweep
    assert sweep is not None
    stick, transition = ([1e3 * v for v in each] for each in (sweep.stick_speed, sweep.transition))
    upper = [1e3 * v if math.isfinite(v) else None for v in sweep.upper]
    known = [v for v in upper if v is not None] or transition
    top = 1.25 * max(*known, *transition)
    edge = [top if v is None else v for v in upper]
    base = plot(rows_of(stick=stick, transition=transition, upper=upper, edge=edge))
    sides = logarithmic_axis((min(stick), max(stick)))
    at = "" if sweep.temperature is None else f" at {celsius(sweep.temperature):.0f} °C"
    x = alt.X("stick:Q", title=f"Stick speed{at} (mm/s), assumed", **sides)
    y_scale = alt.Scale(domain=[0, top], nice=False)
    turns, folds, ends = (
        alt.Y(f"{name}:Q", title="Drive speed (mm/s)", scale=y_scale)
        for name in ("transition", "upper", "edge")
    )
    names = {"stick": "stick speed (mm/s)", "transition": "transition (mm/s)", "upper": "V* (mm/s)"}
    line = base.mark_line(color=INK, strokeWidth=1.8, strokeDash=[7, 4])
    ground = plot([{"low": min(stick), "high": max(stick)}]).mark_rect(color=_SMOOTH)
    layers = [
        ground.encode(x=alt.X("low:Q", **sides), x2="high:Q"),
        base.mark_area(color=_DEPENDS, line=False).encode(x=x, y=ends, y2="transition:Q"),
        base.mark_area(color=_STICKS, line=False).encode(x=x, y=turns),
        base.mark_line(color=INK, strokeWidth=1.8).encode(x=x, y=turns),
        line.encode(x=x, y=folds, tooltip=[tip(*each) for each in names.items()]),
        *_words(stick, transition, known, top, sides, y_scale),
        *_points(document, top, y_scale),
        *_stated(sweep, x, folds),
    ]
    title = alt.Title(
        f"V* against the stick speed{at}",
        subtitle="solid: transition; dashed: V*",
    )
    return alt.layer(*layers, title=title, width=WIDTH, height=_HEIGHT)


def _words(
    stick: list[float], transition: list[float], upper: list[float], top: float, sides: Row, scale: alt.Scale
) -> list[alt.Chart]:
    """Names of the zones, each in its middle where it is widest."""
    at = stick[0] * (stick[-1] / stick[0]) ** 0.06
    far = stick[0] * (stick[-1] / stick[0]) ** 0.72
    named: list[Row] = [
        {"x": far, "y": 0.5 * (top + upper[-1]), "text": "smooth"},
        {"x": at, "y": 0.5 * (upper[0] + transition[0]), "text": "depends on start"},
        {"x": at, "y": 0.5 * transition[0], "text": "sticks"},
    ]
    text = plot(named).mark_text(align="left", fontWeight="bold", fontSize=13, color=INK)
    return [text.encode(x=alt.X("x:Q", **sides), y=alt.Y("y:Q", scale=scale), text="text:N")]


def _points(document: Analysis, top: float, scale: alt.Scale) -> list[alt.Chart]:
    """Speeds of the user's points that lie in the picture."""
    decided = [] if document.decision is None else document.decision.points
    named: list[Row] = [
        {"y": 1e3 * p.speed, "text": f"{p.name} {1e3 * p.speed:.3g}"} for p in decided if 1e3 * p.speed < top
    ]
    if not named:
        return []
    base = plot(named).encode(y=alt.Y("y:Q", scale=scale))
    text = base.encode(x=alt.value(alt.ExprRef("width - 6")), text="text:N")
    look: Row = {"align": "right", "dy": -8, "fontSize": 12, "fontWeight": "bold"}
    return [base.mark_rule(color=INK, strokeDash=[9, 3, 2, 3]), text.mark_text(color=INK, **look)]


def _stated(sweep: StickSpeeds, x: alt.X, y: alt.Y) -> list[alt.Chart]:
    """V* at the stick speed of the machine file."""
    known = [(v, u) for v, u in zip(sweep.stick_speed, sweep.upper, strict=True) if math.isfinite(u)]
    if len(known) < 2 or not known[0][0] <= sweep.stated <= known[-1][0]:
        return []
    upper = 1e3 * float(np.interp(sweep.stated, [v for v, _ in known], [u for _, u in known]))
    row = plot([{"stick": 1e3 * sweep.stated, "upper": upper, "text": f"machine file: {upper:.3g}"}])
    look: Row = {"align": "left", "dx": 9, "dy": -9, "fontSize": 12, "fontWeight": "bold"}
    mark = row.mark_point(**DIAMOND).encode(x=x, y=y)
    return [mark, *rimmed(row.encode(x=x, y=y, text="text:N"), **look)]
