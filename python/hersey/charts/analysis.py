"""One chart per result, as Vega-Lite specifications: the same in the page, in a notebook and as a file.

Every chart takes the analysis document. Units of people appear here: rpm, degC, mN m.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import altair as alt
import numpy as np

from hersey.charts.against_speed import against_speed, curve_rows
from hersey.charts.damping import logs_chart
from hersey.charts.film import regime_chart
from hersey.charts.friction_curve import signed_chart
from hersey.charts.log import log_panel
from hersey.charts.over_time import over_time, time_axis
from hersey.charts.plan import profile_chart
from hersey.charts.regime import exponent_chart, exponent_row
from hersey.charts.render import write_pictures
from hersey.charts.stick_speed import stick_speed_chart
from hersey.charts.style import (
    APPROACHES,
    HEIGHT,
    INK,
    ROLL_SPEED,
    TEMPERATURE,
    WIDTH,
    Chart,
    Row,
    categories,
    levels,
    logarithmic_axis,
    plot,
    ramp,
    rows_of,
    span,
    temperature_channels,
    temperature_name,
    tip,
    torque_unit,
    unchecked,
    zoom,
)
from hersey.charts.torque_budget import torque_budget_chart
from hersey.charts.transition import transition_chart
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.document.analysis import Analysis
from hersey.document.parts.fit import Curve
from hersey.document.parts.log import Point, Series
from hersey.errors import capital
from hersey.schema.domain import Domain
from hersey.stability.plan.result import Plan
from hersey.study.first_screen.result import StartPart
from hersey.units import celsius

#: Cells of a surface overlap a little: seams would shine through otherwise.
_OVERLAP = 1.004
#: Ratio of both ends of a curve to its least torque from which that is marked.
_RISES = 1.01
#: Tooltips of a dwell that a window of a moving log has not.
_WHEN = (alt.Tooltip("approach:N", title="approached"), alt.Tooltip("from_to:N", title="dwell"))


def charts(document: Analysis, *, but: tuple[str, ...] = ()) -> dict[str, Chart]:
    """Return every chart of a document by name, in the order of the report, ``but`` names that begin so."""
    makers: dict[str, Callable[[Analysis], Chart | None]] = {
        "torque": torque,
        "damping": damping,
        "surface": surface,
        "residuals": residuals,
        "regime": regime,
        "film": film,
        "transition": lambda d: _if_there(transition_chart, d.film and d.film.transition),
        "torque_budget": lambda d: _if_there(torque_budget_chart, d.torque_budget),
        "stick_speed": lambda d: _if_there(lambda _: stick_speed_chart(d), d.stick_speed_sweep),
        "simulation_speed": simulation_speed,
        "simulation_force": simulation_force,
        "compare": lambda d: _if_there(logs_chart, d.compare),
        "timeline_speed": timeline_speed,
        "timeline_torque": timeline_torque,
        "timeline_temperature": timeline_temperature,
    }
    with unchecked():
        made = {name: make(document) for name, make in makers.items() if not name.startswith(but)}
        made |= {
            f"plan_{i}": profile_chart(*each) for i, each in enumerate(_plans(document)) if each[0].rows()
        }
    return {name: chart for name, chart in made.items() if chart is not None}


def torque(document: Analysis) -> Chart:
    """Torque against speed per temperature, with the drag curves (the paper's Fig. 2)."""
    if document.friction is not None:
        return _friction_curve(document, document.friction)
    of = _of(document)
    heading = "Drag torque" if document.fit.rest is None else "Drag torque, no-load torque subtracted"
    lines = "fitted drag curves" if of.is_torque else "fitted curves"
    title = alt.Title(
        heading if of.is_torque else capital(of.quantity), subtitle=f"{APPROACHES}; lines: {lines}"
    )
    return _against_speed(document, "torque", _axis(document), turns=True).properties(title=title)


def damping(document: Analysis) -> Chart | None:
    """Damping against speed per temperature (Figs. 3 and 7); None where a friction curve leads."""
    if document.friction is not None:
        return None
    scale, _ = _torque_unit(document)
    quantity = _of(document).quantity
    title = alt.Title("Damping against speed", subtitle=f"dashed: slope -1, constant {quantity}")
    under = [_slope_of_minus_one(document, scale)]
    name = f"Damping ({_damping_unit(document)})"
    return _against_speed(document, "damping", name, under=under).properties(title=title)


def surface(document: Analysis) -> Chart | None:
    """The fitted surface over temperature and speed, with the dwells on it (Fig. 4); None as for damping."""
    if document.friction is not None:
        return None
    unit, factor = _damping_unit(document), _per_speed(document)
    hot = document.fit.temperature_range is not None
    low, high = (factor * v for v in document.fit.speed_range)
    x = _speed(document, "from:Q", (low * 0.93, high * 1.07))
    y = alt.Y(
        "low:Q",
        title=TEMPERATURE if hot else None,
        scale=alt.Scale(zero=False, nice=False, padding=8),
        axis=alt.Axis() if hot else None,
    )
    shade = alt.Scale(type="log", scheme="viridis", nice=False)
    color = alt.Color("damping:Q", title=f"B ({unit})", scale=shade)
    tips = [tip("damping", f"fitted damping ({unit})")]
    cells = plot(_cells(document)).mark_rect(strokeWidth=0, clip=True)
    layers = [cells.encode(x=x, x2="to:Q", y=y, y2="high:Q", color=color, tooltip=tips)]
    line = [{"from": factor * t.speed, "low": celsius(t.temperature)} for t in document.fit.transition_curve]
    subtitle = document.fit.law
    if line:
        bend = plot(line).mark_line(color="white", strokeDash=[6, 4], strokeWidth=2)
        layers.append(bend.encode(x=x, y="low:Q", order="low:Q"))
    if hot:
        rows = [r | {"from": r["speed"], "low": r["temperature"]} for r in _point_rows(document)]
        look: Row = {"fill": "white", "stroke": "#222", "strokeWidth": 1, "size": 40, "opacity": 1}
        dots = plot(rows).mark_point(filled=True, **look)
        layers.append(dots.encode(x=x, y="low:Q", tooltip=_point_tips(document)))
        subtitle += "; circles: the dwells"
    subtitle += "; dashed: transition speed" if line else ""
    title = alt.Title("Fitted damping surface", subtitle=subtitle)
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT if hot else 80)


def _cells(document: Analysis) -> list[Row]:
    """Cells of the surface in the units of readers; without temperature they are as high as the chart."""
    scale, _ = _torque_unit(document)
    factor = _per_speed(document)
    return [
        {
            "from": factor * c.speed_low,
            "to": factor * c.speed_high * _OVERLAP,
            "low": 0.0 if c.temperature_low is None else celsius(c.temperature_low),
            "high": 1.0 if c.temperature_high is None else celsius(c.temperature_high * _OVERLAP ** (1 / 8)),
            "damping": c.damping * scale,
        }
        for c in document.fit.cells
    ]


def residuals(document: Analysis) -> Chart:
    """Residuals against speed, by direction of approach."""
    rows = _point_rows(document)
    if document.friction is not None:
        for row, residual in zip(rows, document.friction.residuals, strict=True):
            row["residual"] = 100.0 * float(np.expm1(residual))
    zero = plot([{"y": 0}]).mark_rule(color=INK).encode(y="y:Q")
    shapes = {"from below": "triangle-up", "from above": "triangle-down", "start": "circle"}
    dots = plot(rows).mark_point(filled=True, size=55, opacity=0.85)
    subtitle = "a gap between the two kinds of triangles: hysteresis; a bend: wrong model"
    shape: Row = {"shape": categories(alt.Shape, "approach", shapes, alt.Legend(title="approached"))}
    if document.moving is not None:
        subtitle, shape = "windows of speed; a bend: wrong model", {}
    dots = dots.encode(
        x=_speed(document, "speed:Q", span([row["speed"] for row in rows])),
        y=alt.Y("residual:Q", title="Measured / fitted \u2212 1 (%)", scale=alt.Scale(padding=8)),
        color=_temperature_channels(document)[0],
        tooltip=_point_tips(document),
        **shape,
    ).add_params(zoom())
    title = alt.Title("Residuals", subtitle=subtitle)
    return alt.layer(zero, dots, title=title, width=WIDTH, height=220)


def regime(document: Analysis) -> Chart | None:
    """Exponent of damping per temperature and branch with its interval, against the named hypotheses.

    None where a friction curve leads: no film has its exponent.
    """
    if document.friction is not None:
        return None
    c = document.fit.coefficients["c"]
    what = "torque" if _of(document).is_torque else "friction"
    surface: Row = {
        "where": "all",
        "order": 1e6,
        "branch": f"rising {what}" if document.fit.transition else "all speeds",
        "value": c.value,
        "low": c.low,
        "high": c.high,
        "speeds": f"{document.fit.points} dwells together",
    }
    rows = [exponent_row(branch, _of(document)) for branch in document.regime.exponents]
    solved = document.film.exponents.solved if document.film and document.film.exponents else None
    hypotheses = [(h.name, h.low, h.high) for h in document.regime.hypotheses]
    return exponent_chart([row for row in rows if row["where"] != "all"] + [surface], hypotheses, solved)


def film(document: Analysis) -> Chart | None:
    """The film regime of the contact."""
    part = document.film
    return None if part is None else regime_chart(part.points, part.dwells, part.layer_factor)


def _if_there(draw: Callable[[Any], Chart], part: object) -> Chart | None:
    """The chart of a part that not every document has."""
    return None if part is None else draw(part)


def simulation_speed(document: Analysis) -> Chart | None:
    """Belt speed of the simulation (Fig. 9); None without one."""
    s = document.simulation
    if s is None:
        return None
    scale, unit = (1e3, "mm/s") if s.speed_unit == "m/s" else (1.0, s.speed_unit)
    marks = dict.fromkeys([s.transition_speed * scale], "transition speed")
    marks.setdefault(s.drive_speed * scale, "drive speed")
    domain = (0.0, 1.05 * scale * max(*s.belt_speed, s.transition_speed))
    rows = rows_of(time=s.time, value=[scale * v for v in s.belt_speed])
    line = over_time(rows, f"Sliding speed ({unit})", time_axis(), domain=domain)
    what = {"stick_slip": f"stick-slip at {s.frequency:.4g} Hz, stuck {s.stuck_fraction:.1%} of the time"}
    title = alt.Title(s.title, subtitle=what.get(s.kind, s.kind.replace("_", " ")))
    return alt.layer(line, *levels(list(marks.items()), domain, 220), title=title, width=WIDTH, height=220)


def simulation_force(document: Analysis) -> Chart | None:
    """Spring force of the simulation; None without one."""
    s = document.simulation
    if s is None:
        return None
    rows = rows_of(time=s.time, value=s.spring_force)
    line = over_time(rows, f"Spring force ({s.force_unit})", time_axis())
    return alt.layer(line, width=WIDTH, height=160)


def timeline_speed(document: Analysis) -> Chart | None:
    """Speed over the log, dwells shaded; None for a table of means."""
    chart = _timeline(
        document, document.timeline.speed, _speed_axis(document), lambda v: v * _per_speed(document)
    )
    return None if chart is None else chart.properties(title="The log (shaded: dwells used)")


def timeline_torque(document: Analysis) -> Chart | None:
    """Torque over the log, dwells shaded; None for a table of means."""
    scale, _ = _torque_unit(document)
    return _timeline(document, document.timeline.torque, _axis(document), lambda v: v * scale)


def timeline_temperature(document: Analysis) -> Chart | None:
    """Temperature over the log, dwells shaded; None if not recorded."""
    return _timeline(document, document.timeline.temperature, TEMPERATURE, celsius)


def write_figures(document: Analysis, folder: Path, *, overwrite: bool = True) -> list[Path]:
    """Write every chart as SVG, PNG and PDF and return the paths; all are drawn before one is written."""
    return write_pictures(charts(document), folder, overwrite=overwrite)


def _torque_unit(document: Analysis) -> tuple[float, str]:
    """Factor from N m, and the unit in which the torques of a document read best."""
    of, unit = _of(document), document.units.get("torque")
    if not of.is_torque:
        return of.shown[1], of.shown[0]
    return (
        (1e3 if unit == "mN·m" else 1.0, unit)
        if unit
        else torque_unit(max(abs(p.torque) for p in document.points))
    )


def _of(document: Analysis) -> Domain:
    """What was measured."""
    return Domain.read(document.fit.domain)


def _axis(document: Analysis) -> str:
    """Title of an axis of what was measured."""
    of = _of(document)
    return f"Torque ({_torque_unit(document)[1]})" if of.is_torque else of.axis


def _damping_unit(document: Analysis) -> str:
    of, (_, unit) = _of(document), _torque_unit(document)
    return f"{unit}·s/rad" if of.is_torque else of.damping_unit


def _per_speed(document: Analysis) -> float:
    """Factor from SI to the unit in which people read the speed."""
    return _of(document).shown_speed[1]


def _speed_axis(document: Analysis) -> str:
    return ROLL_SPEED if _of(document).speed == "speed" else _of(document).speed_axis


def _against_speed(
    document: Analysis, quantity: str, name: str, *, under: Sequence[alt.Chart] = (), turns: bool = False
) -> Chart:
    """Dwells and drag curves, and what the page needs to show and hide each temperature."""
    scale, _ = _torque_unit(document)
    rows = _point_rows(document)
    for row, point in zip(rows, document.points, strict=True):
        value, error = abs(getattr(point, quantity)) * scale, 2 * abs(point.torque_error / point.torque)
        row |= {"y": value, "low": value * (1 - error), "high": value * (1 + error)}
    curves = [_curve(c, quantity, scale, _of(document)) for c in document.fit.curves]
    chart = against_speed(
        rows,
        [row for curve in curves for row in curve],
        name,
        tips=_point_tips(document),
        under=under,
        turns=[turn for curve in curves for turn in _turns(curve)] if turns else [],
        speed=_speed_axis(document),
    )
    shown: Chart = chart.properties(usermeta={"series": _series(rows)})
    return shown


def _friction_curve(document: Analysis, curve: FrictionCurve) -> Chart:
    """Dwells and the friction curve of a joint, with the signs of the rotation."""
    scale, unit = _torque_unit(document)
    thermal = curve.reference_temperature is not None
    rows = _point_rows(document)
    for row, point in zip(rows, document.points, strict=True):
        value, error = point.torque * scale, 2.0 * point.torque_error * scale
        row |= {
            "speed": _per_speed(document) * point.speed,
            "y": value,
            "low": value - error,
            "high": value + error,
        }
        row["level"] = row["level"] if thermal else temperature_name(None)
    chart = signed_chart(rows, curve, (scale, unit), _point_tips(document), document.moments)
    shown: Chart = chart.properties(usermeta={"series": _series(rows)})
    return shown


def _series(rows: list[Row]) -> list[Row]:
    """What the page needs to show and hide each temperature."""
    levels = sorted({row["level"] for row in rows})
    return [
        {"name": f"{level:.0f} °C", "value": level, "color": shade}
        for level, shade in zip(levels, ramp(len(levels)), strict=True)
    ]


def _curve(curve: Curve, quantity: str, scale: float, of: Domain) -> list[Row]:
    speed, damping = np.array(curve.speed), np.array(curve.damping)
    shown = scale * damping * (speed if quantity == "torque" else 1.0)
    return curve_rows(speed, shown, curve.temperature, of=of)


def _turns(curve: list[Row]) -> list[Row]:
    """Where a curve is least, if it rises from there on both sides."""
    least = min(curve, key=lambda row: float(row["y"]))
    rises = min(curve[0]["y"], curve[-1]["y"]) > _RISES * least["y"]
    return [{"speed": least["speed"], "y": least["y"]}] if rises else []


def _plans(document: Analysis) -> list[tuple[Plan, StartPart | None]]:
    """Plans that are drawn, with the motion they make if the document has it."""
    if document.decision is not None:
        planned = [(p.plan, p.motion) for p in document.decision.points if p.plan]
        if planned:
            return planned
    return [] if document.plan is None else [(document.plan, None)]


def _slope_of_minus_one(document: Analysis, scale: float) -> alt.Chart:
    """From the upper left corner of the data down, as far as they reach."""
    top = max(p.damping for p in document.points) * scale
    bottom = min(p.damping for p in document.points) * scale
    low, high = (_per_speed(document) * v for v in document.fit.speed_range)
    end = min(high, low * top / bottom)
    rows = [{"speed": low, "y": top}, {"speed": end, "y": top * low / end}]
    chart: alt.Chart = (
        plot(rows).mark_line(color=INK, strokeDash=[4, 3], strokeWidth=1).encode(x="speed:Q", y="y:Q")
    )
    return chart


def _point_rows(document: Analysis) -> list[Row]:
    scale, _ = _torque_unit(document)
    return [_point_row(p, scale, _per_speed(document)) for p in document.points]


def _point_row(p: Point, scale: float, per_speed: float) -> Row:
    return {
        "speed": per_speed * abs(p.speed),
        "temperature": None if p.temperature is None else celsius(p.temperature),
        "level": temperature_name(p.group_temperature),
        "torque_shown": abs(p.torque) * scale,
        "damping_shown": p.damping * scale,
        "residual": 100.0 * float(np.expm1(p.residual)),
        "approach": p.approach,
        "from_to": f"{p.start:.1f} to {p.end:.1f} s",
    }


def _temperature_channels(document: Analysis) -> tuple[alt.Color, alt.Shape]:
    kelvin = [p.group_temperature for p in document.points]
    return temperature_channels(kelvin, legend=document.fit.temperature_range is not None)


def _speed(document: Analysis, field: str, domain: tuple[float, float]) -> alt.X:
    return alt.X(field, title=_speed_axis(document), **logarithmic_axis(domain))


def _point_tips(document: Analysis) -> list[alt.Tooltip]:
    of = _of(document)
    hot = [tip("temperature", "temperature (°C)")] if document.fit.temperature_range else []
    return [
        tip("speed", f"{of.speed} ({of.shown_speed[0]})"),
        *hot,
        tip("torque_shown", _axis(document)[0].lower() + _axis(document)[1:]),
        tip("damping_shown", f"damping ({_damping_unit(document)})"),
        tip("residual", "measured / fitted - 1 (%)"),
        *([] if document.moving is not None else _WHEN),
    ]


def _timeline(
    document: Analysis, series: Series | None, name: str, in_unit: Callable[[float], float]
) -> Chart | None:
    starts = document.timeline.starts
    if series is None or not starts:
        return None
    rows = rows_of(time=series.time, value=[in_unit(v) for v in series.value])
    dwells = [(starts[p.run] + p.start, starts[p.run] + p.end) for p in document.points]
    several = "; files follow one another" if len(document.files) > 1 else ""
    return log_panel(rows, name, time_axis(title=f"Time (s){several}"), dwells=dwells)
