"""Torque against speed: dwells, the fitted surface, candidate laws, two logs, and what to record next."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import (
    BLUE,
    HEIGHT,
    INK,
    WIDTH,
    Chart,
    Row,
    level,
    logarithmic,
    plot,
    rows_of,
    temperature_channels,
    temperature_name,
    tip,
    torque_unit,
)
from hersey.damping.candidates import ModelComparison
from hersey.damping.candidates.intervals import Band
from hersey.damping.compare import LogComparison
from hersey.damping.design import TestDesign
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.rest import RestOfDrive
from hersey.damping.surface import DampingSurface
from hersey.units import celsius, rpm

#: Speeds at which a law is drawn, temperatures at which a surface is, and candidates that are listed.
_SPEEDS, _TEMPERATURES, _LISTED = 60, 4, 10
#: Speeds (rad/s) of a rest of the drive that is stated.
_STATED = (0.1, 30.0)
#: Share of the speed by which marks of two temperatures stand apart.
_APART = 0.045
_SPEED = "Drive speed (rpm)"


def steady_chart(points: SteadyPoints) -> Chart:
    """Return the dwells of a log: torque against speed, two standard errors each, temperatures apart."""
    speed, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
    kelvin = points.column("temperature") if points.log.has_temperature else None
    factor, unit = torque_unit(float(torque.max()))
    error = points.column("torque_error")
    levels, rows = _dwells(speed, torque * factor, 2.0 * error * factor, kelvin)
    for row, approach in zip(rows, points.table["approach"], strict=True):
        row["approach"] = approach
    tips = [alt.Tooltip("approach:N", title="approached")]
    title = alt.Title("Steady points", subtitle=f"{len(points)} dwells, with two standard errors of torque")
    return alt.layer(*_marks(rows, levels, unit, tips), title=title, width=WIDTH, height=HEIGHT)


def surface_chart(surface: DampingSurface) -> Chart:
    """Return the fitted law: torque against speed at temperatures over the measured range, with its band."""
    speed = np.geomspace(*surface.speed_range, _SPEEDS)
    hot: list[float | None] = [None]
    if surface.temperature_range is not None:
        hot = list(np.linspace(*surface.temperature_range, _TEMPERATURES))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        bands = [surface.predict(speed, None if t is None else np.full_like(speed, t)) for t in hot]
        bends = [(surface.transition_speed(t), t) for t in hot]
        marked = [
            (at, surface.transition_torque(t), t)
            for at, t in bends
            if surface.speed_range[0] < at < surface.speed_range[1]
        ]
    factor, unit = torque_unit(max(float(band.torque.max()) for band in bands))
    rows = _band_rows(speed, bands, hot, factor)
    corners = [
        {"speed": rpm(at), "torque": torque * factor, "level": temperature_name(t)}
        for at, torque, t in marked
    ]
    color, _ = temperature_channels(hot, legend=len(hot) > 1)
    x, y = _axes(unit)
    diamonds = plot(corners).mark_point(shape="diamond", size=90, filled=True, stroke="white", opacity=1)
    title = alt.Title(
        "Fitted drag torque",
        subtitle="lines: the law; shaded: its 95 % limits"
        + ("; diamonds: transition speed" if corners else ""),
    )
    layers = [*_lines(rows, color, unit), diamonds.encode(x=x, y=y, color=color)]
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def rest_chart(rest: RestOfDrive) -> Chart:
    """Return what the drive takes without the film: torque against speed at temperatures, with its limits."""
    speed = np.geomspace(*(rest.speed_range or _STATED), _SPEEDS)
    hot: list[float | None] = [rest.reference_temperature]
    if rest.temperature_range is not None and rest.reference_temperature is not None:
        hot = list(np.linspace(*rest.temperature_range, _TEMPERATURES))
    factor, unit = torque_unit(float(rest.torque(speed[-1:], hot[0]).max()))
    rows: list[Row] = []
    for t in hot:
        torque = rest.torque(speed, t)
        reach = 2.0 * np.linalg.norm(rest.errors(speed, t), axis=1)
        rows += rows_of(
            speed=rpm(speed),
            torque=factor * torque,
            low=factor * np.maximum(torque - reach, 1e-2 * torque),  # a logarithm has no place for nothing
            high=factor * (torque + reach),
            level=[temperature_name(t)] * speed.size,
        )
    color, _ = temperature_channels(hot, legend=len(hot) > 1)
    title = alt.Title("Rest of the drive", subtitle="lines: the law; shaded: two standard errors")
    return alt.layer(*_lines(rows, color, unit), title=title, width=WIDTH, height=HEIGHT)


def models_chart(comparison: ModelComparison) -> Chart:
    """Return the dwells with the law that was chosen, over the candidates by how much worse they are."""
    panels = alt.vconcat(_chosen(comparison), _ranking(comparison), spacing=20)
    stacked: Chart = panels.resolve_scale(color="independent", shape="independent")
    return stacked


def _chosen(comparison: ModelComparison) -> Chart:
    data = comparison.data
    measured = data.reference_speed * np.exp(data.inputs.log_speed)
    torque = np.exp(data.log_torque)
    factor, unit = torque_unit(float(torque.max()))
    levels, rows = _dwells(
        measured, torque * factor, 2 * data.torque_error * torque * factor, data.inputs.kelvin
    )
    speed = np.geomspace(measured.min(), measured.max(), _SPEEDS)
    hot: list[float | None] = [None] if data.inputs.kelvin is None else list(data.temperatures)
    bands = [comparison.predict(speed, t) for t in hot]
    color, _ = temperature_channels(levels, legend=data.inputs.kelvin is not None)
    name = comparison.chosen.candidate.name
    title = alt.Title("The law chosen", subtitle=f"{name}; shaded: 95 % limits of the law")
    lines = _lines(_band_rows(speed, bands, hot, factor), color, unit, tips=False)
    return alt.layer(*lines, *_marks(rows, levels, unit, []), title=title, width=WIDTH, height=HEIGHT)


def _ranking(comparison: ModelComparison) -> Chart:
    listed = comparison.candidates[:_LISTED]
    rows: list[Row] = [
        {
            "name": c.candidate.key,
            "worse": c.delta_aicc,
            "text": f"{c.delta_aicc:.4g}" + (", chosen" if c is comparison.chosen else ""),
            "weight": c.weight,
        }
        for c in listed
    ]
    y = alt.Y("name:N", title=None, sort=[r["name"] for r in rows], axis=alt.Axis(labelLimit=220))
    x = alt.X(
        "worse:Q",
        title="AICc above the least (no unit; 10 is decisive)",
        scale=alt.Scale(type="symlog", domainMin=0.0),
        axis=alt.Axis(values=[0, 1, 3, 10, 30, 100, 300, 1000, 3000, 10000]),
    )
    bars = plot(rows).mark_bar(color="#9fb4d6").encode(x=x, y=y, tooltip=[tip("weight", "Akaike weight")])
    text = plot(rows).mark_text(align="left", dx=4, color=INK).encode(x=x, y=y, text=alt.Text("text:N"))
    more = len(comparison.candidates) - len(listed)
    subtitle = "all on the same dwells" + (f"; {more} more are worse" if more else "")
    title = alt.Title("Candidate laws", subtitle=subtitle)
    return alt.layer(bars, text, title=title, width=WIDTH, height=22 * len(rows))


def logs_chart(comparison: LogComparison) -> Chart:
    """Return damping of the second log over that of the first against speed, with simultaneous limits."""
    a, b = comparison.names
    temperatures, speeds = np.asarray(comparison.temperatures), np.asarray(comparison.speeds)
    hot: list[float | None] = list(temperatures) if temperatures.size else [None]
    rows: list[Row] = []
    for number, kelvin in enumerate(hot):
        apart = 1.0 + _APART * (number - 0.5 * (len(hot) - 1))
        rows += rows_of(
            x=apart * rpm(speeds),
            speed=rpm(speeds),
            ratio=comparison.ratio[number],
            low=comparison.low[number],
            high=comparison.high[number],
            level=[temperature_name(kelvin)] * speeds.size,
        )
    color, shape = temperature_channels(hot, legend=len(hot) > 1)
    x = alt.X("x:Q", title=_SPEED, scale=logarithmic())
    y = alt.Y("ratio:Q", title="Damping of B over A (no unit)", scale=alt.Scale(zero=False))
    tips = [tip("speed", "speed (rpm)"), tip("ratio", "B over A"), tip("low", "95 % from"), tip("high", "to")]
    bars = plot(rows).mark_rule(strokeWidth=2)
    dots = plot(rows).mark_point(filled=True, size=40, opacity=1)
    layers = [
        *level(1.0, "no change"),
        bars.encode(x=x, y=alt.Y("low:Q"), y2=alt.Y2("high:Q"), color=color),
        dots.encode(x=x, y=y, color=color, shape=shape, tooltip=tips),
    ]
    beside = ", temperatures beside each other" if len(hot) > 1 else ""
    subtitle = [f"A: {a}, B: {b}; bars: simultaneous 95 % limits{beside}", comparison.verdict]
    title = alt.Title("Two logs compared", subtitle=subtitle)
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def design_chart(design: TestDesign) -> Chart:
    """Return the dwells to record next in their order, and what is known after each."""
    return alt.vconcat(
        _where(design),
        _gain(design),
        spacing=18,
        title=alt.Title("Dwells to record next", subtitle=_what(design)),
    )


def _what(design: TestDesign) -> str:
    wanted = f"to know the {design.quantity} best" if design.quantity else "to know all parameters best"
    return f"{wanted}; numbers: their order; law: {design.law}"


def _where(design: TestDesign) -> Chart:
    rows: list[Row] = [
        {
            "speed": rpm(point.speed),
            "temperature": 0.0 if point.kelvin is None else celsius(point.kelvin),
            "number": str(number),
        }
        for number, point in enumerate(design.points, 1)
    ]
    thermal = all(point.kelvin is not None for point in design.points)
    # Dwells at one place are one mark with all their numbers.
    places: dict[tuple[float, float], list[str]] = {}
    for row in rows:
        places.setdefault((row["speed"], row["temperature"]), []).append(row["number"])
    names = [{"speed": v, "temperature": t, "text": ", ".join(n)} for (v, t), n in places.items()]
    speeds, heats = [row["speed"] for row in rows], [row["temperature"] for row in rows]
    x = alt.X(
        "speed:Q",
        title=_SPEED,
        scale=alt.Scale(type="log", domain=[min(speeds) / 1.6, 1.6 * max(speeds)], nice=False),
    )
    y = alt.Y(
        "temperature:Q",
        title="Temperature (°C)" if thermal else None,
        scale=alt.Scale(domain=[min(heats) - 15.0, max(heats) + 15.0], nice=False),
        axis=alt.Axis() if thermal else None,
    )
    dots = plot(rows).mark_point(filled=True, color=BLUE, size=90, opacity=1)
    text = plot(names).mark_text(align="left", dx=9, dy=-9, color=INK, fontSize=12, fontWeight="bold")
    layers = [dots.encode(x=x, y=y), text.encode(x=x, y=y, text=alt.Text("text:N"))]
    return alt.layer(*layers, width=WIDTH, height=240 if thermal else 70)


def _gain(design: TestDesign) -> Chart:
    """Standard error of the quantity, or volume of the confidence region, after each dwell."""
    now = design.error_now
    factor, unit = (rpm(1.0), "rpm") if design.unit == "rad/s" else (1.0, design.unit or "no unit")
    if now is None:
        values = [1.0, *(point.volume for point in design.points)]
        name = "Region of all parameters over today's (no unit)"
    else:
        values = [factor * now, *(factor * point.error for point in design.points if point.error is not None)]
        name = f"Standard error ({unit})"
    rows = rows_of(dwells=range(len(values)), value=values)
    x = alt.X("dwells:O", title="Dwells recorded (count)", axis=alt.Axis(labelAngle=0))
    y = alt.Y("value:Q", title=name.split(" over")[0] if now is None else name, scale=alt.Scale(zero=True))
    line = plot(rows).mark_line(color=BLUE, strokeWidth=1.8).encode(x=x, y=y)
    tips = [tip("value", name)]
    dots = plot(rows).mark_point(color=BLUE, filled=True, size=60, opacity=1).encode(x=x, y=y, tooltip=tips)
    return alt.layer(line, dots, width=WIDTH, height=170)


def _dwells(
    speed: FloatArray, torque: FloatArray, reach: FloatArray, kelvin: FloatArray | None
) -> tuple[list[float | None], list[Row]]:
    """Mean temperature of each group of dwells, K, and one row per dwell in units of people."""
    group: list[float | None] = [None] * speed.size
    if kelvin is not None:
        for members in groups_of_temperature(kelvin):
            for i in members.tolist():
                group[i] = float(kelvin[members].mean())
    rows = rows_of(
        speed=rpm(speed),
        torque=torque,
        low=torque - reach,
        high=torque + reach,
        level=[temperature_name(t) for t in group],
        temperature=[None] * speed.size if kelvin is None else celsius(kelvin),
    )
    return group, rows


def _marks(
    rows: list[Row], levels: Sequence[float | None], unit: str, tips: list[alt.Tooltip]
) -> list[alt.Chart]:
    """Dwells as points with their errors."""
    color, shape = temperature_channels(levels, legend=levels[0] is not None)
    x, y = _axes(unit)
    hot = [tip("temperature", "temperature (°C)")] if levels[0] is not None else []
    numbers = [tip("speed", "speed (rpm)"), tip("torque", f"torque ({unit})"), *hot, *tips]
    bars = plot(rows).mark_rule(strokeWidth=1.5)
    dots = plot(rows).mark_point(filled=True, size=55, opacity=0.9)
    return [
        bars.encode(x=x, y=alt.Y("low:Q"), y2=alt.Y2("high:Q"), color=color),
        dots.encode(x=x, y=y, color=color, shape=shape, tooltip=numbers),
    ]


def _band_rows(
    speed: FloatArray, bands: Sequence[Band], kelvin: Sequence[float | None], factor: float
) -> list[Row]:
    rows: list[Row] = []
    for band, t in zip(bands, kelvin, strict=True):
        low, high = band.confidence
        rows += rows_of(
            speed=rpm(speed),
            torque=factor * band.torque,
            low=factor * low,
            high=factor * high,
            level=[temperature_name(t)] * speed.size,
        )
    return rows


def _lines(rows: list[Row], color: alt.Color, unit: str, *, tips: bool = True) -> list[alt.Chart]:
    """Laws as lines with their limits shaded."""
    x, y = _axes(unit)
    numbers = [tip("speed", "speed (rpm)"), tip("torque", f"torque ({unit})")] if tips else []
    area = plot(rows).mark_area(opacity=0.18)
    line = plot(rows).mark_line(strokeWidth=1.8)
    return [
        area.encode(x=x, y=alt.Y("low:Q"), y2=alt.Y2("high:Q"), color=color),
        line.encode(x=x, y=y, color=color, detail=alt.Detail("level:N"), tooltip=numbers),
    ]


def _axes(unit: str) -> tuple[alt.X, alt.Y]:
    x = alt.X("speed:Q", title=_SPEED, scale=logarithmic())
    return x, alt.Y("torque:Q", title=f"Torque ({unit})", scale=logarithmic())
