"""Torque or damping against speed: dwells, drag curves and their limits, for page and notebook alike."""

from __future__ import annotations

from collections.abc import Sequence

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.labels import apart
from hersey.charts.style import (
    INK,
    ROLL_SPEED,
    WIDTH,
    Chart,
    Row,
    across,
    level_channels,
    logarithmic_axis,
    plot,
    rows_of,
    span,
    temperature_name,
)
from hersey.schema.domain import TORQUE, Domain

#: Share of a torque down to which its error is surely in the picture.
_SHORTEST = 0.6
_HEIGHT = 290
#: Names at the ends of lines are as far apart, pixels.
_APART = 16.0
#: Name of the parameter that lists the temperatures which the reader hid.
_HIDDEN = "hidden"


def curve_rows(
    speed: FloatArray,
    value: FloatArray,
    kelvin: float | None,
    limits: tuple[FloatArray, FloatArray] | None = None,
    of: Domain = TORQUE,
) -> list[Row]:
    """Return the rows of a curve over speed (SI) at one temperature."""
    name = [temperature_name(kelvin)] * len(speed)
    rows = rows_of(speed=of.shown_speed[1] * np.asarray(speed), y=value, level=name)
    if limits is None:
        return rows
    return [row | ends for row, ends in zip(rows, rows_of(low=limits[0], high=limits[1]), strict=True)]


def against_speed(
    dwells: list[Row],
    curves: list[Row],
    name: str,
    *,
    tips: Sequence[alt.Tooltip] = (),
    under: Sequence[alt.Chart] = (),
    parts: Sequence[Row] = (),
    turns: Sequence[Row] = (),
    speed: str = ROLL_SPEED,
) -> Chart:
    """Return dwells and curves; each temperature is named at its curve's end, or in a legend without curves.

    Parameters
    ----------
    dwells
        Rows of ``speed`` (rpm), ``y``, ``level``; with errors ``low`` and ``high``. An ``approach`` from
        above is drawn open.
    curves
        Rows of ``speed``, ``y``, ``level``; with limits ``low`` and ``high``.
    name
        Title of the axis up.
    parts
        Rows as of curves, of what is only a part of them: dashed.
    turns
        Rows of ``speed`` and ``y`` where curves turn, marked by a tick.
    speed
        Title of the axis across.
    """
    rows = [*dwells, *curves, *parts]
    x = alt.X("speed:Q", title=speed, **logarithmic_axis(span([row["speed"] for row in rows])))
    domain = span([end for row in rows for end in _reach(row)])
    y = alt.Y("y:Q", title=name, **logarithmic_axis(domain))
    levels = sorted({row["level"] for row in rows})
    color, shape = level_channels(levels, legend=not curves and levels != [temperature_name(None)])
    shown = {"opacity": alt.condition(f"indexof({_HIDDEN}, datum.level) < 0", alt.value(1), alt.value(0.06))}
    layers = [*under, *_limits(curves, x, color), *_ends(curves, domain, color)]
    if parts:
        dashed = plot(list(parts)).mark_line(strokeDash=[4, 3])
        layers.append(dashed.encode(x=x, y=y, color=color, **shown))
    if turns:
        mark = plot(list(turns)).mark_tick(orient="vertical", size=13, thickness=1.6, color=INK)
        layers.append(mark.encode(x=x, y=y))
    if curves:
        line = plot(curves).mark_line(strokeWidth=1.6)
        layers.append(line.encode(x=x, y=y, color=color, detail="level:N", **shown))
    base = plot(dwells)
    if dwells and "low" in dwells[0]:
        bars = base.mark_rule(strokeWidth=1.2, clip=True)
        layers.append(bars.encode(x=x, y="low:Q", y2="high:Q", color=color, **shown))
    if dwells:
        fill = alt.condition("datum.approach === 'from above'", alt.value("white"), color)
        dots = base.mark_point(size=30, strokeWidth=1.4)
        seen = shown if curves else {"shape": shape, **shown}
        layers.append(dots.encode(x=x, y=y, stroke=color, fill=fill, tooltip=list(tips), **seen))
    chart: Chart = alt.layer(*layers, width=WIDTH, height=_HEIGHT).add_params(
        alt.param(name=_HIDDEN, value=[])
    )
    return chart


def _reach(row: Row) -> list[float]:
    """What is in the picture of a row."""
    return [row["y"], max(row.get("low", row["y"]), _SHORTEST * row["y"]), row.get("high", row["y"])]


def _limits(curves: list[Row], x: alt.X, color: alt.Color) -> list[alt.Chart]:
    """The limits of curves that have some, shaded."""
    if not curves or "low" not in curves[0]:
        return []
    area = plot(curves).mark_area(opacity=0.18, clip=True)
    return [area.encode(x=x, y="low:Q", y2="high:Q", color=color)]


def _ends(curves: list[Row], domain: tuple[float, float], color: alt.Color) -> list[alt.Chart]:
    """The temperature at the end of each line, far enough apart to be read."""
    ends = {row["level"]: row for row in curves}
    if len(ends) < 2:
        return []
    low, high = np.log(domain)
    ups = [_HEIGHT * (float(np.log(row["y"])) - low) / (high - low) for row in ends.values()]
    named: list[Row] = [
        {"level": level, "y": float(np.exp(low + (high - low) * up / _HEIGHT)), "text": f"{level:.0f} °C"}
        for level, up in zip(ends, apart(ups, _APART), strict=True)
    ]
    text = plot(named).mark_text(align="left", dx=6, fontSize=11.5, fontWeight="bold")
    return [text.encode(x=across(), y="y:Q", text="text:N", color=color)]
