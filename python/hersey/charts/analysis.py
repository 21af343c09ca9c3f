"""One chart per result, as Vega-Lite specifications: the same in the page, in a notebook and as a file.

Every chart takes the analysis document. Units of people appear here: rpm, degC, mN m.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import altair as alt
import numpy as np

from hersey.charts.damping import logs_chart
from hersey.charts.film import regime_chart
from hersey.charts.labels import apart
from hersey.charts.plan import profile_chart
from hersey.charts.regime import exponent_chart, exponent_row
from hersey.charts.render import write_pictures
from hersey.charts.stick_speed import stick_speed_chart
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
    logarithmic_axis,
    plot,
    ramp,
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
from hersey.document.analysis import Analysis
from hersey.document.parts.log import Point, Series
from hersey.stability.plan.result import Plan
from hersey.study.first_screen.result import StartPart
from hersey.units import celsius, rpm

#: Cells of a surface overlap a little: seams would shine through otherwise.
_OVERLAP = 1.004
_ROLL = "Roll speed (rpm)"
#: Share of a torque down to which its error is surely in the picture.
_SHORTEST = 0.6
#: Height of torque and damping.
_TALL = 290
#: Width kept for the axis of charts that share a time axis, so that they line up.
_AXIS = 42


#: Ratio of both ends of a curve to its least torque from which that is marked.
_RISES = 1.01


def charts(document: Analysis, *, but: tuple[str, ...] = ()) -> dict[str, Chart]:
    """Return every chart of a document by name, in the order of the report, ``but`` names that begin so."""
    makers: dict[str, Callable[[Analysis], Chart | None]] = {
        "torque": torque,
        "damping": damping,
        "surface": surface,
        "residuals": residuals,
        "regime": regime,
        "film": film,
        "transition": transition,
        "torque_budget": torque_budget,
        "stick_speed": stick_speed,
        "simulation_speed": simulation_speed,
        "simulation_force": simulation_force,
        "compare": compare,
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
    scale, unit = _torque_unit(document)
    subtitle = "filled: reached from below, open: from above, bars: two standard errors; lines: drag curves"
    subtitle += "" if document.fit.rest is None else "; the rest of the drive is taken off"
    title = alt.Title("Drag torque against speed", subtitle=subtitle)
    return _against_speed(document, "torque", f"Torque ({unit})", scale, []).properties(title=title)


def damping(document: Analysis) -> Chart:
    """Damping against speed per temperature (Figs. 3 and 7)."""
    scale, unit = _torque_unit(document)
    title = alt.Title(
        "Damping against speed", subtitle="dashed: slope -1, where torque does not depend on speed"
    )
    under = [_slope_of_minus_one(document, scale)]
    return _against_speed(document, "damping", f"Damping ({unit}·s/rad)", scale, under).properties(
        title=title
    )


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
            x=_speed("speed:Q", list(span([row["speed"] for row in rows]))),
            y=alt.Y("residual:Q", title="Measured / fitted \u2212 1 (%)"),
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
    return transition_chart(part)


def torque_budget(document: Analysis) -> Chart | None:
    """What of the torque the film carries, what the contact, what the rest of the drive."""
    return None if document.torque_budget is None else torque_budget_chart(document.torque_budget)


def stick_speed(document: Analysis) -> Chart | None:
    """V* against the stick speed, which nobody measures."""
    return None if document.stick_speed_sweep is None else stick_speed_chart(document)


def compare(document: Analysis) -> Chart | None:
    """Damping of one log over that of another."""
    return None if document.compare is None else logs_chart(document.compare)


def simulation_speed(document: Analysis) -> Chart | None:
    """Belt speed of the simulation (Fig. 9); None without one."""
    s = document.simulation
    if s is None:
        return None
    scale, unit = (1e3, "mm/s") if s.speed_unit == "m/s" else (1.0, s.speed_unit)
    rows = [{"time": t, "value": v * scale} for t, v in zip(s.time, s.belt_speed, strict=True)]
    marks = [(s.transition_speed * scale, "transition speed", "width", "right")]
    marks += (
        [(s.drive_speed * scale, "drive speed", "4", "left")] if s.drive_speed != s.transition_speed else []
    )
    line = _trace(rows, f"Belt speed ({unit})")
    layers: list[alt.Chart] = []
    for y, name, at, align in marks:
        mark = plot([{"y": y, "name": name}])
        layers.append(mark.mark_rule(color=INK, strokeDash=[4, 3]).encode(y="y:Q"))
        label = mark.mark_text(align=align, dy=-7, color=INK)  # type: ignore[arg-type]  # left or right
        layers.append(label.encode(x=alt.value(alt.ExprRef(at)), y="y:Q", text="name:N"))
    what = {"stick_slip": f"stick-slip at {s.frequency:.4g} Hz, stuck {s.stuck_fraction:.1%} of the time"}
    title = alt.Title(s.title, subtitle=what.get(s.kind, s.kind.replace("_", " ")))
    return alt.layer(line, *layers).properties(title=title, width=WIDTH, height=220)


def simulation_force(document: Analysis) -> Chart | None:
    """Spring force of the simulation; None without one."""
    s = document.simulation
    if s is None:
        return None
    rows = [{"time": t, "value": f} for t, f in zip(s.time, s.spring_force, strict=True)]
    return alt.layer(_trace(rows, f"Spring force ({s.force_unit})")).properties(width=WIDTH, height=160)


def timeline_speed(document: Analysis) -> Chart | None:
    """Speed over the log, dwells shaded; None for a table of means."""
    if not document.timeline.starts:
        return None
    return _timeline(document, document.timeline.speed, "Speed (rpm)", rpm, "The log: dwells used are shaded")


def timeline_torque(document: Analysis) -> Chart | None:
    """Torque over the log, dwells shaded; None for a table of means."""
    if not document.timeline.starts:
        return None
    scale, unit = _torque_unit(document)
    return _timeline(document, document.timeline.torque, f"Torque ({unit})", lambda v: v * scale, None)


def timeline_temperature(document: Analysis) -> Chart | None:
    """Temperature over the log, dwells shaded; None if not recorded."""
    series = document.timeline.temperature
    return None if series is None else _timeline(document, series, "Temperature (°C)", celsius, None)


def write_figures(document: Analysis, folder: Path, *, overwrite: bool = True) -> list[Path]:
    """Write every chart as SVG, PNG and PDF and return the paths; all are drawn before one is written."""
    return write_pictures(charts(document), folder, overwrite=overwrite)


def _torque_unit(document: Analysis) -> tuple[float, str]:
    """Factor from N m, and the unit in which the torques of a document read best."""
    told = document.units.get("torque")
    return (
        (1e3 if told == "mN·m" else 1.0, told)
        if told
        else torque_unit(max(abs(p.torque) for p in document.points))
    )


def _against_speed(
    document: Analysis, quantity: str, title: str, scale: float, under: list[alt.Chart]
) -> Chart:
    """Dwells and drag curves, each temperature named at its line's end, over what lies ``under``."""
    rows = _point_rows(document)
    for row, point in zip(rows, document.points, strict=True):
        value, error = abs(getattr(point, quantity)) * scale, 2 * abs(point.torque_error / point.torque)
        row |= {"y": value, "low": value * (1 - error), "high": value * (1 + error)}
    curves = [
        {
            "speed": rpm(v),
            "y": scale * b * (v if quantity == "torque" else 1.0),
            "level": temperature_name(c.temperature),
        }
        for c in document.fit.curves
        for v, b in zip(c.speed, c.damping, strict=True)
    ]
    ends = [end for r in rows for end in (max(r["low"], _SHORTEST * r["y"]), r["high"])]
    domain = span(ends + [r["y"] for r in curves])
    y = alt.Y("y:Q", title=title, **logarithmic_axis(domain))
    reach = span([r["speed"] for r in rows])
    x = alt.X("speed:Q", title=_ROLL, **logarithmic_axis(reach))
    levels = sorted({row["level"] for row in rows})
    shades = alt.Scale(domain=levels, range=ramp(len(levels)))
    color = alt.Color("level:N", scale=shades, legend=None)
    shown = {"opacity": alt.condition("indexof(hidden, datum.level) < 0", alt.value(1), alt.value(0.06))}
    line = plot(curves).mark_line(strokeWidth=1.6).encode(x=x, y=y, color=color, detail="level:N", **shown)
    base = plot(rows)
    bars = base.mark_rule(strokeWidth=1.2, clip=True).encode(
        x=x, y="low:Q", y2="high:Q", color=color, **shown
    )
    fill = alt.condition("datum.approach === 'from above'", alt.value("white"), color)
    dots = base.mark_point(size=30, strokeWidth=1.4).encode(
        x=x, y=y, stroke=color, fill=fill, tooltip=_point_tips(document), **shown
    )
    layers = [*under, *_ends(curves, domain, shades), *_bends(document, quantity, scale, x, y)]
    hidden = alt.param(name="hidden", value=[])
    series = [
        {"name": f"{level:.0f} °C", "value": level, "color": shade}
        for level, shade in zip(levels, ramp(len(levels)), strict=True)
    ]
    chart: Chart = alt.layer(*layers, line, bars, dots, width=WIDTH, height=_TALL)
    return chart.add_params(hidden).properties(usermeta={"series": series})


def _ends(curves: list[Row], domain: tuple[float, float], shades: alt.Scale) -> list[alt.Chart]:
    """The temperature at the end of each line, none nearer to the next than can be read."""
    ends = {row["level"]: row for row in curves}
    if len(ends) < 2:
        return []
    low, high = np.log(domain)
    ups = [_TALL * (float(np.log(row["y"])) - low) / (high - low) for row in ends.values()]
    named: list[Row] = [
        {"level": level, "y": float(np.exp(low + (high - low) * up / _TALL)), "text": f"{level:.0f} °C"}
        for level, up in zip(ends, apart(ups, APART), strict=True)
    ]
    text = plot(named).mark_text(align="left", dx=6, fontSize=11.5, fontWeight="bold")
    return [
        text.encode(
            x=across(),
            y="y:Q",
            text="text:N",
            color=alt.Color("level:N", scale=shades, legend=None),
        )
    ]


def _bends(document: Analysis, quantity: str, scale: float, x: alt.X, y: alt.Y) -> list[alt.Chart]:
    """A tick on each line where it is least, if it rises from there on both sides."""
    if quantity != "torque":
        return []
    rows: list[Row] = []
    for curve in document.fit.curves:
        torque = [v * b * scale for v, b in zip(curve.speed, curve.damping, strict=True)]
        least = int(np.argmin(torque))
        if min(torque[0], torque[-1]) > _RISES * torque[least]:
            rows.append({"speed": rpm(curve.speed[least]), "y": torque[least]})
    mark = plot(rows).mark_tick(orient="vertical", size=13, thickness=1.6, color=INK)
    return [mark.encode(x=x, y=y)] if rows else []


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
    low, high = (rpm(v) for v in document.fit.speed_range)
    end = min(high, low * top / bottom)
    rows = [{"speed": low, "y": top}, {"speed": end, "y": top * low / end}]
    chart: alt.Chart = (
        plot(rows).mark_line(color=INK, strokeDash=[4, 3], strokeWidth=1).encode(x="speed:Q", y="y:Q")
    )
    return chart


def _point_rows(document: Analysis) -> list[Row]:
    scale, _ = _torque_unit(document)
    return [_point_row(p, scale) for p in document.points]


def _point_row(p: Point, scale: float) -> Row:
    return {
        "speed": rpm(abs(p.speed)),
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


def _speed(field: str, domain: list[float] | None = None) -> alt.X:
    if domain is not None:
        return alt.X(field, title=_ROLL, **logarithmic_axis((domain[0], domain[1])))
    return alt.X(field, title=_ROLL, scale=logarithmic())


def _point_tips(document: Analysis) -> list[alt.Tooltip]:
    _, unit = _torque_unit(document)
    hot = [tip("temperature", "temperature (°C)")] if document.fit.temperature_range else []
    return [
        tip("speed", "speed (rpm)"),
        *hot,
        tip("torque_shown", f"torque ({unit})"),
        tip("damping_shown", f"damping ({unit}·s/rad)"),
        tip("residual", "measured / fitted - 1 (%)"),
        alt.Tooltip("approach:N", title="approached"),
        alt.Tooltip("from_to:N", title="dwell"),
    ]


def _trace(rows: list[Row], title: str) -> alt.Chart:
    chart: alt.Chart = (
        plot(rows)
        .mark_line(color=BLUE, strokeWidth=1.5)
        .encode(
            x=alt.X("time:Q", title="Time (s)", scale=alt.Scale(nice=False)),
            y=alt.Y("value:Q", title=title, axis=alt.Axis(minExtent=_AXIS)),
            tooltip=[tip("time", "time (s)"), tip("value", title)],
        )
        .add_params(zoom())
    )
    return chart


def _timeline(
    document: Analysis, series: Series, title: str, in_unit: Callable[[float], float], heading: str | None
) -> Chart:
    values = [float(f"{in_unit(v):.5g}") for v in series.value]
    rows = [{"time": t, "value": v} for t, v in zip(series.time, values, strict=True)]
    starts = document.timeline.starts
    dwells = [{"from": starts[p.run] + p.start, "to": starts[p.run] + p.end} for p in document.points]
    several = len(document.files) > 1
    shade = (
        plot(dwells)
        .mark_rect(color=GREEN, opacity=0.25)
        .encode(x="from:Q", x2="to:Q", y=alt.value(0), y2=alt.value(110))
    )
    line = (
        plot(rows)
        .mark_line(color=BLUE, strokeWidth=0.9)
        .encode(
            x=alt.X(
                "time:Q",
                title="Time (s), files one after another" if several else "Time (s)",
                scale=alt.Scale(nice=False),
            ),
            y=alt.Y("value:Q", title=title, scale=alt.Scale(zero=False), axis=alt.Axis(minExtent=_AXIS)),
            tooltip=[tip("time", "time (s)"), tip("value", title)],
        )
        .add_params(zoom())
    )
    chart = alt.layer(shade, line).properties(width=WIDTH, height=110)
    return chart.properties(title=heading) if heading else chart
