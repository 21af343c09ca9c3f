"""Friction coefficient against the Hersey number: dwells, model, regimes, and where the drive stalls."""

from __future__ import annotations

import math
from dataclasses import dataclass

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.labels import apart
from hersey.charts.style import (
    HEIGHT,
    INK,
    WIDTH,
    Chart,
    Row,
    plot,
    rows_of,
    temperature_channels,
    temperature_name,
    tip,
)
from hersey.lubrication.mixed import MixedContact, MixedFilm
from hersey.verdict.evidence import MeasuredFilm

#: What is drawn across: the number, its unit, and what its letters mean.
NUMBER = "Hersey number ηU/p (µm): viscosity, sliding speed, mean pressure p = N/(nip L)"
COEFFICIENT = "Friction coefficient T/(R N) (1)"
#: Points of a line, strips of the shade, and its darkest.
_LINE, _STRIPS, _DARKEST = 240, 96, 0.55
#: How far the model goes beyond its least drag, ratios of the Hersey number, and room beside the dwells.
_BELOW, _BEYOND, _ROOM = 100.0, 100.0, 1.5
#: Share of the load on the asperities above which lubrication is called boundary, and lambda of a film.
BOUNDARY_SHARE, FILM_LAMBDA = 0.9, 3.0
#: A level is drawn if it is within this ratio of what else is seen.
_NEAR = 20.0
#: Names of temperatures, K apart.
_GROUP = 5.0


@dataclass(frozen=True)
class _Model:
    """The model along the Hersey number (m) at one temperature."""

    hersey: FloatArray
    friction: FloatArray
    film: MixedFilm

    @property
    def shear(self) -> FloatArray:
        """The friction of the film, over the load."""
        whole, boundary = self.film.torque, self.film.boundary_torque
        return np.asarray(self.friction * (1.0 - boundary / whole))


def friction_chart(
    measured: MeasuredFilm | None,
    mixed: MixedContact | None = None,
    *,
    temperature: float | None = None,
    grip: float | None = None,
    motor: float | None = None,
) -> Chart:
    """Return friction against the Hersey number.

    Parameters
    ----------
    measured
        Dwells of a log.
    mixed
        What shares the load; then regimes are shaded by the share that asperities carry.
    temperature
        Of the model, K: it depends on it only where boundary friction does.
    grip, motor
        Friction coefficients beyond which the belt slips on the roll, and the motor gives no more.
    """
    dwells = np.empty(0) if measured is None else measured.hersey_number
    model = None
    if mixed is not None:
        kelvin = _temperature(measured) if temperature is None else temperature
        model = along(mixed, kelvin, dwells)
    seen = _seen(measured, model)
    span = _span(dwells, model)
    stalls = [(value, name) for value, name in ((grip, "the drive slips"), (motor, "motor stalls")) if value]
    # A limit far beyond all that is measured would press the curve flat: it is named in the subtitle.
    near = [(value, name) for value, name in stalls if value < _NEAR * seen.max()]
    far = [f"{name} at {value:.3g}, beyond the chart" for value, name in stalls if (value, name) not in near]
    low, high = seen.min() / _ROOM, max([float(seen.max()), *(value for value, _ in near)]) * _ROOM
    domain = [1e6 * end for end in span]
    x = alt.X("hersey:Q", title=NUMBER, scale=alt.Scale(type="log", domain=domain, nice=False))
    y = alt.Y("friction:Q", title=COEFFICIENT, scale=alt.Scale(type="log", domain=[low, high], nice=False))
    layers: list[alt.Chart] = []
    if model is not None:
        layers += _regimes(model, span, x)
        layers += _curves(model, x, y)
    elif measured is not None:
        layers.append(_film(measured, x, y))
    if near:
        layers += _stalls(near, (low, high))
    if measured is not None:
        layers.append(_dots(measured, x, y))
    subtitle = [*_legend(measured, model), *(["; ".join(far)] if far else [])]
    title = alt.Title("Stribeck curve", subtitle=subtitle)
    return alt.layer(*layers, width=WIDTH, height=HEIGHT, title=title)


def along(mixed: MixedContact, kelvin: float, dwells: FloatArray) -> _Model:
    """Return the model over its least drag and the Hersey numbers (m) of dwells, at a temperature (K)."""
    contact = mixed.contact
    # Hersey number over viscosity and speed of the roll, m per Pa.
    per = contact.roll_radius / contact.nip.pressure_mean
    viscosity = float(mixed.lubricant.viscosity(kelvin))
    turn = per * viscosity * float(mixed.transition(kelvin).speed)
    known = [turn] if math.isfinite(turn) else []
    ends = [*(each / _BELOW for each in known), *(each * _BEYOND for each in known)]
    low, high = _ends(np.array([*ends, *dwells.tolist()]))
    hersey = np.geomspace(low, high, _LINE)
    film = mixed.at(speed=hersey / (per * viscosity), temperature=kelvin)
    return _Model(hersey, film.torque / (contact.roll_radius * contact.load), film)


def _ends(numbers: FloatArray) -> tuple[float, float]:
    return (float(numbers.min()), float(numbers.max())) if numbers.size else (1e-9, 1e-5)


def _temperature(measured: MeasuredFilm | None) -> float:
    return 373.15 if measured is None else float(np.median(measured.predicted.temperature))


def _seen(measured: MeasuredFilm | None, model: _Model | None) -> FloatArray:
    parts = [] if measured is None else [measured.friction]
    parts += [] if model is None else [model.friction]
    return np.concatenate(parts)


def _span(dwells: FloatArray, model: _Model | None) -> tuple[float, float]:
    low, high = _ends(np.concatenate([dwells, np.empty(0) if model is None else model.hersey]))
    return low / _ROOM**0.5, high * _ROOM**0.5


def _regimes(model: _Model, span: tuple[float, float], x: alt.X) -> list[alt.Chart]:
    """A shade as dark as the share of the load on the asperities, and the names of the regimes."""
    edges = np.geomspace(*span, _STRIPS + 1)
    middle = np.sqrt(edges[1:] * edges[:-1])
    share = np.interp(np.log(middle), np.log(model.hersey), np.ravel(model.film.share))
    rows = rows_of(hersey=1e6 * edges[:-1], end=1e6 * edges[1:] * 1.001, dark=_DARKEST * share)
    opacity = alt.Opacity("dark:Q", scale=None)
    shade = plot(rows).mark_rect(color="#8a8f98", strokeWidth=0).encode(x=x, x2="end:Q", opacity=opacity)
    names = []
    lambda_ = np.interp(np.log(middle), np.log(model.hersey), np.ravel(model.film.lambda_ratio))
    film = lambda_ > FILM_LAMBDA
    boundary = (share > BOUNDARY_SHARE) & ~film
    for name, inside in (("boundary", boundary), ("mixed", ~film & ~boundary), ("film", film)):
        if np.count_nonzero(inside) * WIDTH / _STRIPS > 10 * len(name):
            places = np.log(middle[inside])
            names.append({"hersey": 1e6 * math.exp(0.5 * (places[0] + places[-1])), "name": name})
    style: Row = {"fontSize": 13, "fontStyle": "italic", "color": INK}
    texts = plot(names).mark_text(**style).encode(x=x, y=alt.value(12), text="name:N")
    return [shade, texts]


def _curves(model: _Model, x: alt.X, y: alt.Y) -> list[alt.Chart]:
    whole = rows_of(hersey=1e6 * model.hersey, friction=model.friction)
    film = rows_of(hersey=1e6 * model.hersey, friction=model.shear)
    dashed = plot(film).mark_line(color=INK, strokeDash=[5, 4], strokeWidth=1.3, clip=True)
    solid = plot(whole).mark_line(color=INK, strokeWidth=2, clip=True)
    return [line.encode(x=x, y=y, order="hersey:Q") for line in (dashed, solid)]


def _film(measured: MeasuredFilm, x: alt.X, y: alt.Y) -> alt.Chart:
    """The film of the governing law, scaled to the data."""
    order = np.argsort(measured.hersey_number)
    scale = measured.friction / measured.torque * measured.predicted_torque * measured.calibration.value
    rows = rows_of(hersey=1e6 * measured.hersey_number[order], friction=scale[order])
    line: alt.Chart = plot(rows).mark_line(color=INK, strokeDash=[6, 4], strokeWidth=1.5, clip=True)
    return line.encode(x=x, y=y, order="hersey:Q")


def _dots(measured: MeasuredFilm, x: alt.X, y: alt.Y) -> alt.Chart:
    """Dwells, temperatures by colour and shape."""
    kelvin = measured.temperature
    # Dwells of one temperature differ by some kelvin.
    steps = (_GROUP * np.round((kelvin - 273.15) / _GROUP) + 273.15).tolist()
    rows = rows_of(
        hersey=1e6 * measured.hersey_number,
        friction=measured.friction,
        level=[temperature_name(each) for each in steps],
    )
    color, shape = temperature_channels(steps, orient="top")
    tips = [tip("hersey", "Hersey number, um"), tip("friction", "friction")]
    dots: alt.Chart = plot(rows).mark_point(
        filled=True, size=45, opacity=0.9, stroke="white", strokeWidth=0.6
    )
    return dots.encode(x=x, y=y, color=color, shape=shape, tooltip=tips)


def _stalls(near: list[tuple[float, str]], domain: tuple[float, float]) -> list[alt.Chart]:
    """Levels above which the belt stalls, a soft shade above the least of them, names on the right."""
    low, high = (math.log(each) for each in domain)
    ups = apart([HEIGHT * (math.log(value) - low) / (high - low) for value, _ in near])
    rows: list[Row] = [
        {"friction": value, "down": HEIGHT - up, "text": f"{name} ({value:.3g})"}
        for (value, name), up in zip(near, ups, strict=True)
    ]
    least = [{"friction": min(value for value, _ in near), "top": domain[1]}]
    y = alt.Y("friction:Q")
    words = plot(rows).mark_text(align="left", dx=6, color="#a33", fontSize=12)
    return [
        plot(least).mark_rect(color="#c0392b", opacity=0.08).encode(y=y, y2="top:Q"),
        plot(rows).mark_rule(color="#a33", strokeWidth=1.6, strokeDash=[8, 3]).encode(y=y),
        words.encode(x=alt.value(WIDTH), y=alt.Y("down:Q", scale=None, axis=None), text="text:N"),
    ]


def _legend(measured: MeasuredFilm | None, model: _Model | None) -> list[str]:
    """What the lines and shades mean."""
    if model is not None:
        mixed = model.film.mixed
        return [
            "solid: film and asperities; dashed: film alone; grey: share of the load carried by asperities",
            f"model: boundary friction {mixed.friction.coefficient:g}, roughness "
            f"{1e6 * (mixed.contact.roughness or 0.0):g} µm, E* {1e-9 * mixed.asperities.modulus:g} GPa; "
            f"film: lambda > {FILM_LAMBDA:g}; boundary: asperities carry over {BOUNDARY_SHARE:.0%}",
        ]
    assert measured is not None
    return [f"dashed: predicted film friction times {measured.calibration.value:.3g}, which fits the data"]
