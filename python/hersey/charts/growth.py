"""Growth of an indicator with age: runs, median and band of each specimen, and the ages at a limit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import (
    BLUE,
    DIAMOND,
    HEIGHT,
    INK,
    ORANGE,
    WIDTH,
    Chart,
    Row,
    age_tip,
    plot,
    rows_of,
    tip,
)
from hersey.errors import capital
from hersey.life.growth.fit import Growth, GrowthCurves
from hersey.life.growth.limit_ages import AgeAtLimit, AgesAtLimit
from hersey.life.maintenance import Stretch

#: Units shown, panels in a row, and pixels of each where there are several.
_SHOWN, _COLUMNS, _GAP, _HEIGHT = 12, 4, 58, 150
_POINTS = 61
#: How far the axis of ages goes, in the greatest age; and beyond the last median.
_FARTHEST, _BEYOND = 3.0, 1.2
#: Room above the axis of values, and the ratio of its ends from which it is logarithmic.
_FREE, _STEEP = 1.1, 10.0


class _Axes(NamedTuple):
    """What all panels share."""

    width: int
    height: int
    age: alt.Scale
    value: alt.Scale
    end: float


def growth_chart(
    growth: Growth, *, ages: AgesAtLimit | None = None, si: str = "", stretches: Sequence[Stretch] = ()
) -> Chart:
    """Return the growth of each specimen, one panel each; with ``ages`` also where it reaches the limit.

    Of many specimens the first are shown. ``si`` is the unit of the values. ``stretches`` says which units of
    the growth are parts of one specimen, between maintenance.
    """
    panels = _panels(growth, stretches)
    count = min(len(panels), _SHOWN)
    by_unit = {each.unit: each for each in ages.units} if ages else {}
    shown = dict(list(panels.items())[:count])
    known = [by_unit[unit] for unit in shown if unit in by_unit]
    last = max(begun + growth.last_age[i] for parts in panels.values() for i, begun in parts)
    end = axis_end(last, [each.age.value for each in known])
    at = np.linspace(0.0, end, _POINTS)
    drawn = [i for parts in shown.values() for i, _ in parts]
    curves, runs = growth.at(at, units=[growth.units[i] for i in drawn]), growth.runs_of_units()
    line = ages.limit if ages and not ages.accumulates else None
    columns = min(count, _COLUMNS)
    values = np.concatenate([runs[i][1] for i in drawn])
    top = _FREE * max(float(values.max()), line or float(curves.median[:, -1].min()))
    steep = top > _STEEP * float(values.min())
    bottom = float(values.min()) / _FREE if steep else 0.0
    axes = _Axes(
        WIDTH if count == 1 else (WIDTH - _GAP * (columns - 1)) // columns,
        HEIGHT if count == 1 else _HEIGHT,
        alt.Scale(domain=[0.0, end], nice=False),
        alt.Scale(domain=[bottom, top], nice=not steep, type="log" if steep else "linear"),
        end,
    )
    made = []
    for k, (unit, parts) in enumerate(shown.items()):
        title = _values(growth, si, short=count > 1) if k % columns == 0 else None
        layers = _grown(growth, curves, runs, parts, at, axes, title, _unit(si), 10.0 * top)
        if line is not None:
            rule = plot([{"value": line}]).mark_rule(color=INK, strokeDash=[4, 3])
            layers.append(rule.encode(y=alt.Y("value:Q", title=title)))
        if unit in by_unit:
            reached, height = by_unit[unit], line if line is not None else top / _FREE
            layers += _age(reached, height, axes, title, growth.age_unit)
        name = alt.Title(unit, fontSize=12)
        made.append(alt.layer(*layers, title=name, width=axes.width, height=axes.height))
    rows = [alt.hconcat(*made[i : i + columns], spacing=12) for i in range(0, count, columns)]
    heading = f"Growth of {growth.quantity}" + (f" ({si.replace(' ', '·')})" if si else "")
    subtitle = _heading(growth, ages, len(panels), serviced=any(len(parts) > 1 for parts in panels.values()))
    return alt.vconcat(*rows, title=alt.Title(heading, subtitle=subtitle), spacing=10)


def _panels(growth: Growth, stretches: Sequence[Stretch]) -> dict[str, list[tuple[int, float]]]:
    """For each specimen its units of the growth, and the age at which each began, in their order."""
    known = {each.name: each for each in stretches}
    panels: dict[str, list[tuple[int, float]]] = {}
    for i, name in enumerate(growth.units):
        of = known.get(name, Stretch(name, name, 0.0))
        panels.setdefault(of.unit, []).append((i, of.begun))
    return {unit: sorted(parts, key=lambda part: part[1]) for unit, parts in panels.items()}


def _grown(
    growth: Growth,
    curves: GrowthCurves,
    runs: list[tuple[FloatArray, FloatArray]],
    parts: list[tuple[int, float]],
    at: FloatArray,
    axes: _Axes,
    title: str | None,
    unit: str,
    most: float,
) -> list[alt.Chart]:
    """Runs and curve of a specimen, growing anew at each maintenance; nothing above ``most``."""
    layers: list[alt.Chart] = []
    ends = [*(begun for _, begun in parts[1:]), math.inf]
    for (i, begun), until in zip(parts, ends, strict=True):
        inside, row = begun + at <= until, curves.units.index(growth.units[i])
        drawn = {name: getattr(curves, name)[row][inside] for name in ("low", "median", "high")}
        band = rows_of(
            age=begun + at[inside], **{name: np.minimum(each, most) for name, each in drawn.items()}
        )
        seen = rows_of(age=begun + runs[i][0], value=runs[i][1])
        layers += _curve(growth, band, seen, axes, title, unit)
    events = [{"age": begun} for _, begun in parts if begun > 0.0]
    if events:
        mark = plot(events).mark_rule(color=INK, strokeDash=[2, 2])
        layers.append(mark.encode(x=alt.X("age:Q", scale=axes.age)))
    return layers


def _values(growth: Growth, si: str, *, short: bool) -> str:
    """The title of the axis of values."""
    name = "Value" if short else capital(growth.quantity)
    return f"{name} ({_unit(si)})"


def _unit(si: str) -> str:
    """The unit of the values, as it is shown."""
    return si.replace(" ", "·") or "as given"


def axis_end(last: float, medians: list[float]) -> float:
    """Return where the axis of ages ends: beyond the medians, but near what was followed."""
    finite = [each for each in medians if math.isfinite(each)]
    farthest = _FARTHEST * last if last > 0.0 else max([1.0, *finite])
    return float(min(_BEYOND * max([last, *finite]), farthest)) or 1.0


def age_axis(field: str, age_unit: str, scale: alt.Scale, count: int = 8) -> alt.X:
    """Return an axis of ages."""
    title = f"Age ({age_unit or 'as given'})"
    axis = alt.Axis(labelExpr="format(datum.value, '~s')", tickCount=count, labelOverlap=True)
    return alt.X(f"{field}:Q", title=title, scale=scale, axis=axis)


def _curve(
    growth: Growth, band: list[Row], runs: list[Row], axes: _Axes, title: str | None, unit: str
) -> list[alt.Chart]:
    x = age_axis("age", growth.age_unit, axes.age, 8 if axes.height == HEIGHT else 3)
    axis = alt.Axis(format=".3~g", tickCount=5)
    low, median, value = (
        alt.Y(f"{name}:Q", title=title, scale=axes.value, axis=axis) for name in ("low", "median", "value")
    )
    age = age_tip(growth.age_unit)
    tips = [age, tip("median", f"median ({unit})"), tip("low", "from"), tip("high", "to")]
    area = plot(band).mark_area(color=BLUE, opacity=0.18, clip=True).encode(x=x, y=low, y2="high:Q")
    line = plot(band).mark_line(color=BLUE, strokeWidth=2, clip=True)
    points = plot(runs).mark_point(color=INK, filled=True, opacity=1, size=28)
    seen = [age, tip("value", f"run ({unit})")]
    return [area, line.encode(x=x, y=median, tooltip=tips), points.encode(x=x, y=value, tooltip=seen)]


def _age(
    reached: AgeAtLimit, height: float, axes: _Axes, title: str | None, age_unit: str
) -> list[alt.Chart]:
    """The interval of the age, as far as it lies within the axis, and its median."""
    span = {"low": reached.age.low, "high": min(reached.age.high, axes.end), "value": height}
    mark = {**span, "age": reached.age.value}
    tips = [age_tip(age_unit, "age at the limit"), tip("low", "from"), tip("high", "to")]
    y = alt.Y("value:Q", scale=axes.value, title=title)
    layers = []
    if reached.age.low < axes.end:
        rule = plot([span]).mark_rule(color=ORANGE, strokeWidth=4, clip=True)
        layers.append(rule.encode(x=alt.X("low:Q", scale=axes.age), x2="high:Q", y=y))
    if reached.age.value < axes.end:
        point = plot([mark]).mark_point(**(DIAMOND | {"stroke": ORANGE, "size": 70, "strokeWidth": 2}))
        layers.append(point.encode(x=alt.X("age:Q", scale=axes.age), y=y, tooltip=tips))
    return layers


def _heading(growth: Growth, ages: AgesAtLimit | None, count: int, *, serviced: bool) -> list[str]:
    words = ["points: runs; lines and bands: each specimen, 90 %"]
    if serviced:
        words[0] += "; dotted: maintenance, from which it grows anew"
    if ages:
        reached = "where the sum over age reaches the limit" if ages.accumulates else "at the dashed limit"
        words.append(f"diamonds: age {reached}, with 90 % interval")
    if count > _SHOWN:
        words.append(f"{_SHOWN} of {count} specimens are shown")
    return [growth.headline(), *words]


def ages_chart(ages: AgesAtLimit) -> Chart:
    """Return the age of each specimen at a limit, B10 and B50 if known, with 90 % intervals."""
    shown = [*ages.units[: 2 * _SHOWN], *ages.rows[len(ages.units) :]]
    last = max(each.last for each in ages.units)
    end = axis_end(last, [each.age.value for each in shown])
    scale = alt.Scale(domain=[0.0, end], nice=False)
    rows = [
        {
            "unit": each.unit,
            "age": each.age.value if math.isfinite(each.age.value) else None,
            "low": min(each.age.low, end),
            "high": min(each.age.high, end),
            "last": None if math.isnan(each.last) else each.last,
        }
        for each in shown
    ]
    base = plot(rows).encode(y=alt.Y("unit:N", title=None, sort=[each.unit for each in shown]))
    age, last_seen = age_tip(ages.age_unit), age_tip(ages.age_unit, "last seen", "last")
    tips = ["unit:N", age, tip("low", "from"), tip("high", "to"), last_seen]
    spans = base.mark_rule(color=BLUE, strokeWidth=2)
    points = base.mark_point(color=BLUE, filled=True, opacity=1, size=70, clip=True)
    ticks = base.mark_tick(color=INK, thickness=2, size=14)
    words = "points: medians with 90 % intervals; vertical ticks: last observation"
    if len(ages.units) > 2 * _SHOWN:
        words += f"; {2 * _SHOWN} of {len(ages.units)} specimens are shown"
    title = alt.Title(f"Age at which {ages.quantity} reaches {ages.limit:.4g}", subtitle=words)
    return alt.layer(
        spans.encode(x=age_axis("low", ages.age_unit, scale), x2="high:Q"),
        points.encode(x=age_axis("age", ages.age_unit, scale), tooltip=tips),
        ticks.encode(x=age_axis("last", ages.age_unit, scale)),
        title=title,
        width=WIDTH,
        height=24 * len(rows),
    )
