"""Torque against speed: dwells, the fitted surface, candidate laws, two logs, and what to record next."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.against_speed import against_speed, curve_rows
from hersey.charts.style import (
    APPROACHES,
    BLUE,
    HEIGHT,
    INK,
    ROLL_SPEED,
    TEMPERATURE,
    WIDTH,
    Chart,
    Row,
    level,
    logarithmic,
    plot,
    rows_of,
    stacked,
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
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.damping.surface import DampingSurface
from hersey.schema.domain import Domain
from hersey.units import celsius, rpm

#: Speeds at which a law is drawn, temperatures at which a surface is drawn, and models that are listed.
_SPEEDS, _TEMPERATURES, _LISTED = 60, 4, 10
#: Speeds (rad/s) of a no-load torque that is stated.
_STATED = (0.1, 30.0)
#: Share of the speed by which marks of two temperatures stand apart.
_APART = 0.045


def steady_chart(points: SteadyPoints) -> Chart:
    """Return the dwells of a log: torque against speed, two standard errors each, temperatures apart."""
    torque = np.abs(points.column("torque"))
    kelvin = points.column("temperature") if points.log.has_temperature else None
    of = points.domain
    factor, title_up = _shown(of, float(torque.max()))
    shares = points.column("torque_error") / torque
    rows = _dwells(of, np.abs(points.column("speed")), factor * torque, shares, kelvin)
    for row, approach in zip(rows, points.table["approach"], strict=True):
        row["approach"] = approach
    subtitle = f"{len(points)} dwells; {APPROACHES}"
    title = alt.Title("Steady points", subtitle=subtitle)
    tips = [*_tips(of, title_up, hot=kelvin is not None), alt.Tooltip("approach:N", title="approached")]
    return against_speed(rows, [], title_up, tips=tips, speed=_speed_title(of)).properties(title=title)


def surface_chart(surface: DampingSurface) -> Chart:
    """Return the fitted law: torque against speed at temperatures over the measured range, with its band."""
    speed = np.geomspace(*surface.speed_range, _SPEEDS)
    hot: list[float | None] = [None]
    if surface.temperature_range is not None:
        hot = list(np.linspace(*surface.temperature_range, _TEMPERATURES))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        bands = [
            surface.predict(speed=speed, temperature=None if t is None else np.full_like(speed, t))
            for t in hot
        ]
        of = surface.domain
        factor, title_up = _shown(of, max(float(band.torque.max()) for band in bands))
        low, high = surface.speed_range
        turns: list[Row] = [
            {"speed": of.shown_speed[1] * at, "y": factor * float(surface.torque(speed=at, temperature=t))}
            for at, t in ((surface.transition_speed(t), t) for t in hot)
            if low < at < high
        ]
    subtitle = "lines: fitted law; shaded: 95 % limits" + ("; ticks: transition speed" if turns else "")
    rows = _band_rows(of, speed, bands, hot, factor)
    name = "Fitted drag torque" if of.is_torque else f"Fitted {of.quantity}"
    return against_speed([], rows, title_up, turns=turns, speed=_speed_title(of)).properties(
        title=alt.Title(name, subtitle=subtitle)
    )


def rest_chart(rest: NoLoadTorque) -> Chart:
    """Return the no-load torque: torque against speed at temperatures, with its limits."""
    speed = np.geomspace(*(rest.speed_range or _STATED), _SPEEDS)
    hot: list[float | None] = [rest.reference_temperature]
    if rest.temperature_range is not None and rest.reference_temperature is not None:
        hot = list(np.linspace(*rest.temperature_range, _TEMPERATURES))
    factor, unit = torque_unit(float(rest.torque(speed[-1:], temperature=hot[0]).max()))
    rows: list[Row] = []
    for t in hot:
        torque = factor * rest.torque(speed, temperature=t)
        reach = 2.0 * factor * np.linalg.norm(rest.errors(speed, temperature=t), axis=1)
        low = np.maximum(torque - reach, 1e-2 * torque)  # a logarithm has no place for nothing
        rows += curve_rows(speed, torque, t, (low, torque + reach))
    title = alt.Title("No-load torque", subtitle="lines: fitted law; shaded: two standard errors")
    return against_speed([], rows, f"Torque ({unit})").properties(title=title)


def models_chart(comparison: ModelComparison) -> Chart:
    """Return the dwells with the chosen model, above the other models by how much worse they are."""
    return stacked(_chosen(comparison), _ranking(comparison), spacing=20)


def _chosen(comparison: ModelComparison) -> Chart:
    data = comparison.data
    kelvin, torque = data.inputs.kelvin, np.exp(data.log_torque)
    measured = data.reference_speed * np.exp(data.inputs.log_speed)
    of = data.domain
    factor, title_up = _shown(of, float(torque.max()))
    dwells = _dwells(of, measured, factor * torque, data.torque_error, kelvin)
    speed = np.geomspace(measured.min(), measured.max(), _SPEEDS)
    hot: list[float | None] = [None] if kelvin is None else list(data.temperatures)
    bands = [comparison.predict(speed=speed, temperature=t) for t in hot]
    curves = _band_rows(of, speed, bands, hot, factor)
    name = comparison.chosen.candidate.name
    title = alt.Title("Chosen model", subtitle=f"{name}; shaded: 95 % limits")
    tips = _tips(of, title_up, hot=kelvin is not None)
    chart: Chart = against_speed(dwells, curves, title_up, tips=tips, speed=_speed_title(of))
    return chart.properties(title=title)


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
        title="AICc above the lowest (no unit; 10 is decisive)",
        scale=alt.Scale(type="symlog", domainMin=0.0),
        axis=alt.Axis(values=[0, 1, 3, 10, 30, 100, 300, 1000, 3000, 10000]),
    )
    bars = plot(rows).mark_bar(color="#9fb4d6").encode(x=x, y=y, tooltip=[tip("weight", "Akaike weight")])
    text = plot(rows).mark_text(align="left", dx=4, color=INK).encode(x=x, y=y, text=alt.Text("text:N"))
    more = len(comparison.candidates) - len(listed)
    subtitle = "all fitted to the same dwells" + (f"; {more} worse models are not shown" if more else "")
    title = alt.Title("Model comparison", subtitle=subtitle)
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
    x = alt.X("x:Q", title=ROLL_SPEED, scale=logarithmic())
    y = alt.Y("ratio:Q", title="Damping of B over A (no unit)", scale=alt.Scale(zero=False))
    tips = [tip("speed", "speed (rpm)"), tip("ratio", "B over A"), tip("low", "95 % from"), tip("high", "to")]
    bars = plot(rows).mark_rule(strokeWidth=2)
    dots = plot(rows).mark_point(filled=True, size=40, opacity=1)
    layers = [
        *level(1.0, "no change"),
        bars.encode(x=x, y=alt.Y("low:Q"), y2=alt.Y2("high:Q"), color=color),
        dots.encode(x=x, y=y, color=color, shape=shape, tooltip=tips),
    ]
    subtitle = [f"A: {a}; B: {b}; bars: simultaneous 95 % limits", comparison.verdict]
    title = alt.Title("Comparison of two logs", subtitle=subtitle)
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def design_chart(design: TestDesign) -> Chart:
    """Return the dwells to record next in their order, and what is known after each."""
    wanted = (
        f"to determine the {design.quantity} best" if design.quantity else "to determine all parameters best"
    )
    subtitle = f"{wanted}; numbers: order of recording; law: {design.law}"
    title = alt.Title("Dwells to record next", subtitle=subtitle)
    return stacked(_where(design), _gain(design), title=title, spacing=18)


def _where(design: TestDesign) -> Chart:
    thermal = all(point.kelvin is not None for point in design.points)
    rows = rows_of(
        speed=[rpm(point.speed) for point in design.points],
        temperature=[0.0 if point.kelvin is None else celsius(point.kelvin) for point in design.points],
        number=[str(number) for number in range(1, len(design.points) + 1)],
    )
    # Dwells at one place are one mark with all their numbers.
    places: dict[tuple[float, float], list[str]] = {}
    for row in rows:
        places.setdefault((row["speed"], row["temperature"]), []).append(row["number"])
    names = [{"speed": v, "temperature": t, "text": ", ".join(n)} for (v, t), n in places.items()]
    speeds, heats = zip(*places, strict=True)
    reach = alt.Scale(type="log", domain=[min(speeds) / 1.6, 1.6 * max(speeds)], nice=False)
    x = alt.X("speed:Q", title=ROLL_SPEED, scale=reach)
    y = alt.Y(
        "temperature:Q",
        title=TEMPERATURE if thermal else None,
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
        name = "Confidence region of all parameters over today's (no unit)"
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


def _shown(of: Domain, largest: float) -> tuple[float, str]:
    """Factor from SI, and the title of an axis of what was measured."""
    if not of.is_torque:
        return of.shown[1], of.axis
    factor, unit = torque_unit(largest)
    return factor, f"Torque ({unit})"


def _speed_title(of: Domain) -> str:
    return ROLL_SPEED if of.speed == "speed" else of.speed_axis


def _dwells(
    of: Domain, speed: FloatArray, torque: FloatArray, share: FloatArray, kelvin: FloatArray | None
) -> list[Row]:
    """One row per dwell in the units of readers, with two relative standard errors."""
    group: list[float | None] = [None] * speed.size
    if kelvin is not None:
        for members in groups_of_temperature(kelvin):
            for i in members.tolist():
                group[i] = float(kelvin[members].mean())
    return rows_of(
        speed=of.shown_speed[1] * speed,
        y=torque,
        low=torque * (1.0 - 2.0 * share),
        high=torque * (1.0 + 2.0 * share),
        level=[temperature_name(t) for t in group],
        temperature=[None] * speed.size if kelvin is None else celsius(kelvin),
    )


def _tips(of: Domain, name: str, *, hot: bool) -> list[alt.Tooltip]:
    """The tooltip of a dwell."""
    degrees = [tip("temperature", "temperature (°C)")] if hot else []
    speed = f"{of.speed} ({of.shown_speed[0]})"
    return [tip("speed", speed), tip("y", name[0].lower() + name[1:]), *degrees]


def _band_rows(
    of: Domain, speed: FloatArray, bands: Sequence[Band], kelvin: Sequence[float | None], factor: float
) -> list[Row]:
    rows: list[Row] = []
    for band, t in zip(bands, kelvin, strict=True):
        low, high = band.confidence
        rows += curve_rows(speed, factor * band.torque, t, (factor * low, factor * high), of)
    return rows
