"""One chart per result, as Vega-Lite specifications: the same in the page, in a notebook and as a file.

Every chart takes the analysis document. Units of people appear here: rpm, degC, mN m.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import altair as alt
import numpy as np

from hersey.charts.carried import carried_chart
from hersey.charts.damping import logs_chart
from hersey.charts.film import regime_chart
from hersey.charts.labels import apart
from hersey.charts.plan import profile_chart
from hersey.charts.regime import exponent_chart, exponent_row
from hersey.charts.render import write_pictures
from hersey.charts.style import (
    APART,
    BLUE,
    GREEN,
    HEIGHT,
    INK,
    WIDTH,
    Chart,
    Row,
    across,
    logarithmic,
    plot,
    ramp,
    temperature_channels,
    temperature_name,
    tip,
    torque_unit,
    unchecked,
    zoom,
)
from hersey.charts.transition import transition_chart
from hersey.document.parts import Analysis, PlanPart, Point, Series
from hersey.units import celsius, rpm

#: Cells of a surface overlap a little: seams would shine through otherwise.
_OVERLAP = 1.004
#: Height of torque and damping.
_TALL = 290
#: Width kept for the axis of charts that share a time axis, so that they line up.
_AXIS = 42


def charts(document: Analysis) -> dict[str, Chart]:
    """Return every chart of a document by name, in the order of the report."""
    makers: dict[str, Callable[[Analysis], Chart | None]] = {
        "torque": torque,
        "damping": damping,
        "surface": surface,
        "residuals": residuals,
        "regime": regime,
        "film": film,
        "transition": transition,
        "carried": carried,
        "compare": compare,
        "timeline_speed": timeline_speed,
        "timeline_torque": timeline_torque,
        "timeline_temperature": timeline_temperature,
    }
    with unchecked():
        made = {name: make(document) for name, make in makers.items()}
        made |= {f"plan_{i}": profile_chart(*each) for i, each in enumerate(_plans(document))}
    return {name: chart for name, chart in made.items() if chart is not None}


def torque(document: Analysis) -> Chart:
    """Torque against speed per temperature, with the fitted law (the paper's Fig. 2)."""
    scale, unit = _torque_unit(document)
    subtitle = "filled: reached from below, open: from above, bars: two standard errors; lines: the fitted law"
    subtitle += "" if document.fit.rest is None else "; the rest of the drive is taken off"
    title = alt.Title("Drag torque against speed", subtitle=subtitle)
    return _against_speed(document, "torque", f"Torque ({unit})", scale, []).properties(title=title)


def damping(document: Analysis) -> Chart:
    """Damping against speed per temperature (Figs. 3 and 7)."""
    scale, unit = _torque_unit(document)
    title = alt.Title(
        "Damping against speed", subtitle="dashed: slope -1, where torque does not depend on speed"
    )
    slope = _slope_of_minus_one(document, scale)
    chart = _against_speed(document, "damping", f"Damping ({unit}·s/rad)", scale, [slope])
    return chart.properties(title=title)


def surface(document: Analysis) -> Chart:
    """The fitted surface over temperature and speed, with the dwells on it (Fig. 4)."""
    scale, unit = _torque_unit(document)
    hot = document.fit.temperature_range is not None
    cells = [
        {
            "from": rpm(c.speed_low),
            "to": rpm(c.speed_high) * _OVERLAP,
            "low": 0.0 if c.temperature_low is None else celsius(c.temperature_low),
            "high": 1.0 if c.temperature_high is None else celsius(c.temperature_high * _OVERLAP ** (1 / 8)),
            "damping": c.damping * scale,
        }
        for c in document.fit.cells
    ]
    low, high = (rpm(v) for v in document.fit.speed_range)
    x = _speed("from:Q", [low * 0.93, high * 1.07])
    shade = alt.Scale(type="log", scheme="viridis", nice=False)
    cell = (
        plot(cells)
        .mark_rect(strokeWidth=0, clip=True)
        .encode(
            x=x,
            x2="to:Q",
            y=alt.Y(
                "low:Q",
                title="Temperature (°C)" if hot else None,
                scale=alt.Scale(zero=False, nice=False, padding=8),
                axis=alt.Axis() if hot else None,
            ),
            y2="high:Q",
            color=alt.Color("damping:Q", title=f"B ({unit}·s/rad)", scale=shade),
            tooltip=[tip("damping", f"fitted damping ({unit}·s/rad)")],
        )
    )
    line = [{"from": rpm(t.speed), "low": celsius(t.temperature)} for t in document.fit.transition_curve]
    rows = [r | {"from": r["speed"], "low": r["temperature"]} for r in _point_rows(document)] if hot else []
    bend = (
        plot(line)
        .mark_line(color="white", strokeDash=[6, 4], strokeWidth=2)
        .encode(x=x, y="low:Q", order="low:Q")
    )
    dots = (
        plot(rows)
        .mark_point(filled=True, fill="white", stroke="#222", strokeWidth=1, size=40, opacity=1)
        .encode(x=x, y="low:Q", tooltip=_point_tips(document))
    )
    subtitle = document.fit.law + ("; circles: the dwells" if rows else "")
    subtitle += "; dashed: transition speed" if line else ""
    title = alt.Title("Fitted damping surface", subtitle=subtitle)
    layers = [cell, *([bend] if line else []), *([dots] if rows else [])]
    return alt.layer(*layers).properties(title=title, width=WIDTH, height=HEIGHT if hot else 80)


def residuals(document: Analysis) -> Chart:
    """Residuals against speed, by direction of approach."""
    rows = _point_rows(document)
    zero = plot([{"y": 0}]).mark_rule(color=INK).encode(y="y:Q")
    dots = (
        plot(rows)
        .mark_point(filled=True, size=55, opacity=0.85)
        .encode(
            x=_speed("speed:Q"),
            y=alt.Y("residual:Q", title="measured / fitted - 1 (%)"),
            color=_temperature_channels(document)[0],
            shape=alt.Shape(
                "approach:N",
                title="approached",
                scale=alt.Scale(
                    domain=["from below", "from above", "start"],
                    range=["triangle-up", "triangle-down", "circle"],
                ),
            ),
            tooltip=_point_tips(document),
        )
        .add_params(zoom())
    )
    title = alt.Title(
        "Residuals", subtitle="up and down triangles apart mean hysteresis; a bend means a wrong law"
    )
    return alt.layer(zero, dots).properties(title=title, width=WIDTH, height=220)


def regime(document: Analysis) -> Chart:
    """Exponent of damping per temperature and branch with its interval, against the named hypotheses."""
    c = document.fit.coefficients["c"]
    surface: Row = {
        "where": "all",
        "order": 1e6,
        "branch": "rising torque" if document.fit.transition else "all speeds",
        "value": c.value,
        "low": c.low,
        "high": c.high,
        "speeds": f"{document.fit.points} dwells together",
    }
    rows = [exponent_row(branch) for branch in document.regime.exponents]
    solved = document.film.exponents.solved if document.film and document.film.exponents else None
    hypotheses = [(h.name, h.low, h.high) for h in document.regime.hypotheses]
    return exponent_chart([row for row in rows if row["where"] != "all"] + [surface], hypotheses, solved)


def film(document: Analysis) -> Chart | None:
    """Which law of film thickness holds in the user's nip."""
    part = document.film
    return None if part is None else regime_chart(part.points, part.dwells, part.layer_factor)


def transition(document: Analysis) -> Chart | None:
    """Transition speed of the user's contact against temperature, and that of the log."""
    part = None if document.film is None else document.film.transition
    if part is None:
        return None
    return transition_chart(part.temperature, part.speed, part.measured, part.low, part.high)


def carried(document: Analysis) -> Chart | None:
    """What of the torque the film carries, what the contact, what the rest of the drive."""
    return None if document.carried is None else carried_chart(document.carried)




def compare(document: Analysis) -> Chart | None:
    """Damping of one log over that of another."""
    return None if document.compare is None else logs_chart(document.compare)
