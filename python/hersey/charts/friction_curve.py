"""The friction curve of a joint: torque against speed with the fitted law, signed if both ways."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import altair as alt
import numpy as np

from hersey.charts.style import (
    EDGE,
    HEIGHT,
    INK,
    WIDTH,
    Chart,
    Row,
    level_channels,
    plot,
    rows_of,
    temperature_name,
    tip,
    torque_unit,
)
from hersey.damping.dwells import groups_of_temperature
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.moving.friction import Moments
from hersey.units import celsius, rpm

#: Letters of a line of the subtitle.
_LINE = 110
#: Name of the parameter that lists the temperatures which the reader hid.
_HIDDEN = "hidden"


def friction_curve_chart(curve: FrictionCurve, moments: Moments | None = None) -> Chart:
    """Return the dwells and the curve, its parameters in the subtitle, over ``moments`` of a moving log."""
    data = curve.data
    torque = np.exp(data.log_torque)
    sign = np.ones_like(torque) if data.inputs.sign is None else data.inputs.sign
    factor, unit = torque_unit(float(torque.max()))
    kelvin = data.inputs.kelvin
    level: list[float | None] = [None] * len(data)
    if kelvin is not None and curve.reference_temperature is not None:
        for members in groups_of_temperature(kelvin):
            for i in members.tolist():
                level[i] = float(kelvin[members].mean())
    dwells = rows_of(
        speed=rpm(sign * data.speed),
        y=factor * sign * torque,
        low=factor * sign * torque * (1.0 - 2.0 * data.torque_error),
        high=factor * sign * torque * (1.0 + 2.0 * data.torque_error),
        level=[temperature_name(t) for t in level],
        temperature=[None] * len(data) if kelvin is None else celsius(kelvin),
    )
    tips = [tip("speed", "speed (rpm)"), tip("y", f"torque ({unit})")]
    return signed_chart(dwells, curve, (factor, unit), tips, moments)


def signed_chart(
    dwells: list[Row],
    curve: FrictionCurve,
    unit: tuple[float, str],
    tips: Sequence[alt.Tooltip],
    moments: Moments | None = None,
) -> Chart:
    """Return dwells (``speed``, ``y``, ``low``, ``high``, ``level``) and the lines of a friction curve.

    Of one direction, both are drawn as positive. ``unit`` is its factor from N m, and its name. ``moments``
    of a moving log are drawn pale under them.
    """
    both = curve.forward_speeds is not None and curve.reverse_speeds is not None
    shown = dwells if both else [_positive(row) for row in dwells]
    lines = _line_rows(curve, unit[0], both=both)
    levels = sorted({row["level"] for row in [*lines, *shown]})
    color, _ = level_channels(levels, legend=len(levels) > 1)
    opacity = alt.condition(f"indexof({_HIDDEN}, datum.level) < 0", alt.value(1), alt.value(0.06))
    x = alt.X("speed:Q", title="Speed (rpm)")
    y = alt.Y("y:Q", title=f"Torque ({unit[1]})", scale=alt.Scale(zero=both))
    drawn = plot(lines).mark_line(strokeWidth=1.6)
    bars, dots = plot(shown).mark_rule(strokeWidth=1.2), plot(shown).mark_point(size=30, filled=True)
    layers = [
        *_limits(lines, x, color),
        drawn.encode(x=x, y=y, color=color, detail="line:N", opacity=opacity),
        bars.encode(x=x, y="low:Q", y2="high:Q", color=color, opacity=opacity),
        dots.encode(x=x, y=y, color=color, opacity=opacity, tooltip=list(tips)),
    ]
    if moments is not None:
        layers.insert(0, _moments(moments, curve, unit[0], both=both).encode(x=x, y=y))
    if both:
        layers.insert(0, plot([{"y": 0.0}]).mark_rule(color=INK, strokeWidth=0.6).encode(y="y:Q"))
    subtitle = [*textwrap.wrap(str(_headline(curve)), _LINE), _legend(lines, moments)]
    title = alt.Title("Friction torque", subtitle=subtitle)
    chart: Chart = alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)
    return chart.add_params(alt.param(name=_HIDDEN, value=[]))


def _line_rows(curve: FrictionCurve, factor: float, *, both: bool) -> list[Row]:
    """The lines with their limits, in the unit of the chart."""
    rows: list[Row] = []
    for number, line in enumerate(curve.lines):
        side = 1.0 if both else float(np.sign(line.speed[0]))
        ends = {"low": line.low, "high": line.high}
        rows += rows_of(
            speed=rpm(side * np.asarray(line.speed)),
            y=factor * side * np.asarray(line.torque),
            level=[temperature_name(line.temperature)] * len(line.speed),
            line=[number] * len(line.speed),
            **{name: factor * side * np.asarray(each) for name, each in ends.items() if each is not None},
        )
    return rows


def _limits(lines: list[Row], x: alt.X, color: alt.Color) -> list[alt.Chart]:
    """The limits of lines that have some, shaded."""
    if not lines or "low" not in lines[0]:
        return []
    area = plot(lines).mark_area(opacity=0.18, clip=True)
    return [area.encode(x=x, y="low:Q", y2="high:Q", color=color, detail="line:N")]


def _moments(moments: Moments, curve: FrictionCurve, factor: float, *, both: bool) -> alt.Chart:
    """Single moments of the directions that the curve is drawn for."""
    speed, torque = np.asarray(moments.speed), np.asarray(moments.torque)
    ways = {1.0: curve.forward_speeds, -1.0: curve.reverse_speeds}
    side = np.sign(speed)
    of = np.isin(side, [way for way, ends in ways.items() if ends is not None])
    up = np.ones_like(side) if both else side
    rows = rows_of(speed=rpm(up * speed)[of], y=factor * (up * torque)[of])
    dots: alt.Chart = plot(rows).mark_point(size=12, filled=True, color=EDGE, opacity=0.45, clip=True)
    return dots


def _legend(lines: list[Row], moments: Moments | None) -> str:
    """What the marks are."""
    band = "shaded: 95 % limits of the curve; " if lines and "low" in lines[0] else ""
    if moments is None:
        return f"{band}bars: two standard errors"
    return f"{band}pale: single moments, without inertia and offset; dots: windows of speed"


def _positive(row: Row) -> Row:
    return row | {name: abs(row[name]) for name in ("speed", "y", "low", "high")}


def _headline(curve: FrictionCurve) -> str:
    """The headline, which a document that was read back holds as a text."""
    said = curve.headline
    return said() if callable(said) else said
