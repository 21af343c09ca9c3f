"""The friction curve of a joint: torque against speed with the fitted law, signed if both ways."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import altair as alt
import numpy as np

from hersey.charts.style import (
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
from hersey.units import celsius, rpm

#: Letters of a line of the subtitle.
_LINE = 110
#: Name of the parameter that lists the temperatures which the reader hid.
_HIDDEN = "hidden"


def friction_curve_chart(curve: FrictionCurve) -> Chart:
    """Return the dwells and the fitted friction curve, its parameters in the subtitle."""
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
    return signed_chart(dwells, curve, (factor, unit), tips)


def signed_chart(
    dwells: list[Row], curve: FrictionCurve, unit: tuple[float, str], tips: Sequence[alt.Tooltip]
) -> Chart:
    """Return dwells (``speed``, ``y``, ``low``, ``high``, ``level``) and the lines of a friction curve.

    Of one direction, both are drawn as positive. ``unit`` is its factor from N m, and its name.
    """
    both = curve.forward_speeds is not None and curve.reverse_speeds is not None
    shown = dwells if both else [_positive(row) for row in dwells]
    lines: list[Row] = []
    for number, line in enumerate(curve.lines):
        side = 1.0 if both else float(np.sign(line.speed[0]))
        lines += rows_of(
            speed=rpm(side * np.asarray(line.speed)),
            y=unit[0] * side * np.asarray(line.torque),
            level=[temperature_name(line.temperature)] * len(line.speed),
            line=[number] * len(line.speed),
        )
    levels = sorted({row["level"] for row in [*lines, *shown]})
    color, _ = level_channels(levels, legend=len(levels) > 1)
    opacity = alt.condition(f"indexof({_HIDDEN}, datum.level) < 0", alt.value(1), alt.value(0.06))
    x = alt.X("speed:Q", title="Speed (rpm)")
    y = alt.Y("y:Q", title=f"Torque ({unit[1]})", scale=alt.Scale(zero=both))
    drawn = plot(lines).mark_line(strokeWidth=1.6)
    bars, dots = plot(shown).mark_rule(strokeWidth=1.2), plot(shown).mark_point(size=30, filled=True)
    layers = [
        drawn.encode(x=x, y=y, color=color, detail="line:N", opacity=opacity),
        bars.encode(x=x, y="low:Q", y2="high:Q", color=color, opacity=opacity),
        dots.encode(x=x, y=y, color=color, opacity=opacity, tooltip=list(tips)),
    ]
    if both:
        layers.insert(0, plot([{"y": 0.0}]).mark_rule(color=INK, strokeWidth=0.6).encode(y="y:Q"))
    subtitle = [*textwrap.wrap(str(_headline(curve)), _LINE), "bars: two standard errors"]
    title = alt.Title("Friction torque", subtitle=subtitle)
    chart: Chart = alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)
    return chart.add_params(alt.param(name=_HIDDEN, value=[]))


def _positive(row: Row) -> Row:
    return row | {name: abs(row[name]) for name in ("speed", "y", "low", "high")}


def _headline(curve: FrictionCurve) -> str:
    """The headline, which a document that was read back holds as a text."""
    said = curve.headline
    return said() if callable(said) else said
