"""The film over life: relative to a flooded film, and the oil layer against the layer it needs."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import BoolArray
from hersey.charts.growth import age_axis
from hersey.charts.style import (
    BLUE,
    INK,
    ORANGE,
    WIDTH,
    Chart,
    Row,
    age_tip,
    categories,
    level,
    plot,
    ramp,
    rows_of,
    stacked,
    tip,
)
from hersey.life.film.of_runs import Estimates
from hersey.life.film.through_life import FilmLife
from hersey.life.oil_layer import STARVED

#: Units drawn by themselves, in rows of so many, and the size of each.
_SHOWN, _ACROSS = 8, 4
#: Up to so many units have a colour of their own in the legend.
_NAMED = 24
_SMALL = 150
_HEIGHT = 260
#: Curves go so far beyond the last run of any unit.
_BEYOND = 2.0
#: Room above the greatest layer.
_ROOM = 1.5
#: What all points of runs look like.
_POINT: Row = {"opacity": 1, "clip": True}
#: A micrometre in metres.
_MICRO = 1e-6


def film_life_chart(film: FilmLife) -> Chart:
    """Return the film relative to a flooded one, above the layers of the specimens that starve first."""
    ages = film.ages <= _BEYOND * float(film.runs.age.max())
    if ages.sum() < 2:
        ages[:] = True
    names = [each.unit for each in film.starves[0].units]
    soonest = sorted(range(len(names)), key=lambda k: film.starves[0].units[k].age.value)
    chosen = sorted(soonest[:_SHOWN])
    return stacked(_over_flooded(film, ages, names), _layers(film, ages, names, chosen), spacing=24)


def _age(film: FilmLife, ages: BoolArray, *, ticks: int) -> alt.X:
    scale = alt.Scale(domain=[0.0, float(film.ages[ages].max())], nice=False)
    return age_axis("age", film.runs.age_unit, scale, ticks)


def _over_flooded(film: FilmLife, ages: BoolArray, names: list[str]) -> Chart:
    curve, read = film.curves[0], film.film[0]
    rows = [
        row
        for k, name in enumerate(names)
        for row in _known(
            age=film.ages[ages],
            value=curve.value[k, ages],
            low=curve.low[k, ages],
            high=curve.high[k, ages],
            unit=np.full(int(ages.sum()), name),
        )
    ]
    x = _age(film, ages, ticks=8)
    y = alt.Y("value:Q", title="Film over flooded film (1)", scale=alt.Scale(domain=[0.0, 1.05], nice=False))
    low = alt.Y("low:Q", title="Film over flooded film (1)")
    legend = alt.Legend(title=None, orient="bottom-left", columns=4, symbolOpacity=1)
    looks = dict(zip(names, ramp(len(names)), strict=True))
    colour = categories(alt.Color, "unit", looks, legend if len(names) <= _NAMED else None)
    tips = [alt.Tooltip("unit:N"), age_tip(film.runs.age_unit), tip("value", "film over flooded film")]
    band, line = plot(rows).mark_area(opacity=0.08, clip=True), plot(rows).mark_line(strokeWidth=2, clip=True)
    runs = plot(_runs(film, read, most=1.0))
    bars, points = runs.mark_rule(strokeWidth=1, clip=True), runs.mark_point(filled=True, **_POINT, size=40)
    layers = [
        band.encode(x=x, y=low, y2="high:Q", color=colour),
        line.encode(x=x, y=y, color=colour, tooltip=tips),
        bars.encode(x=x, y=alt.Y("low:Q"), y2="high:Q", color=colour),
        points.encode(x=x, y=y, color=colour, tooltip=tips),
        *level(STARVED, "starved below"),
    ]
    name = f"Film at {film.points[0]}, relative to a flooded inlet at the same viscosity"
    words = "points: runs; lines and bands: law over all specimens; 90 % intervals"
    title = alt.Title(name, subtitle=[film.headline(), words])
    return alt.layer(*layers, title=title, width=WIDTH, height=_HEIGHT)


def _known(**columns: np.ndarray) -> list[Row]:
    """Rows of a curve from the age on at which its layer was renewed."""
    known = np.isfinite(columns["value"])
    return rows_of(**{name: column[known] for name, column in columns.items()})


def _runs(film: FilmLife, read: Estimates, *, most: float, unit: str = "", factor: float = 1.0) -> list[Row]:
    """Rows of the runs with an estimate, of one unit or of all; unknown ends at ``most``."""
    names = enumerate(film.runs.unit)
    chosen = [i for i, name in names if np.isfinite(read.value[i]) and (not unit or name == unit)]
    return rows_of(
        age=film.runs.age[chosen],
        value=np.minimum(factor * read.value[chosen], most),
        low=np.maximum(factor * read.low[chosen], 0.0),
        high=np.minimum(factor * read.high[chosen], most),
        unit=[film.runs.unit[i] for i in chosen],
    )


def _layers(film: FilmLife, ages: BoolArray, names: list[str], chosen: list[int]) -> Chart:
    most = _ROOM * float(np.nanmax(film.layers.value[chosen][:, ages])) / _MICRO
    each = [_layer(film, ages, names[k], k, most, first=i % _ACROSS == 0) for i, k in enumerate(chosen)]
    lines = [alt.hconcat(*each[i : i + _ACROSS], spacing=14) for i in range(0, len(each), _ACROSS)]
    more = f"; the {len(chosen)} specimens that starve first" if len(chosen) < len(names) else ""
    subtitle = (
        f"blue: oil layer; orange: layer needed at {film.points[0].name}, which grows as the oil thickens; "
        "the film starves where they meet"
    )
    title = alt.Title(f"Oil layer and the layer that the film needs{more}", subtitle=subtitle)
    return alt.vconcat(*lines, spacing=10, title=title)


def _layer(film: FilmLife, ages: BoolArray, name: str, k: int, most: float, *, first: bool) -> Chart:
    rows = _known(
        age=film.ages[ages],
        value=film.layers.value[k, ages] / _MICRO,
        low=np.minimum(film.layers.low[k, ages] / _MICRO, most),
        high=np.minimum(film.layers.high[k, ages] / _MICRO, most),
        need=film.needs[0][k, ages] / _MICRO,
    )
    x = _age(film, ages, ticks=3)
    scale = alt.Scale(domain=[0.0, most], nice=False)
    y = alt.Y("value:Q", title="Layer (µm)" if first else None, scale=scale)
    tips = [age_tip(film.runs.age_unit), tip("value", "layer (µm)"), tip("need", "layer needed (µm)")]
    chart = plot(rows)
    seen = plot(_runs(film, film.layer, most=most, unit=name, factor=1.0 / _MICRO))
    return alt.layer(
        chart.mark_area(color=BLUE, opacity=0.15, clip=True).encode(x=x, y=alt.Y("low:Q"), y2="high:Q"),
        chart.mark_line(color=BLUE, strokeWidth=2, clip=True).encode(x=x, y=y, tooltip=tips),
        chart.mark_line(color=ORANGE, strokeWidth=2, clip=True).encode(x=x, y=alt.Y("need:Q"), tooltip=tips),
        seen.mark_rule(color=INK, strokeWidth=1, clip=True).encode(x=x, y=alt.Y("low:Q"), y2="high:Q"),
        seen.mark_point(color=INK, filled=True, size=25, opacity=1, clip=True).encode(x=x, y=y),
        title=alt.Title(name, fontSize=12),
        width=_SMALL,
        height=_SMALL * 0.8,
    )
