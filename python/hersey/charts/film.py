"""The regime chart of a nip and, with a log, its Stribeck curve."""

from __future__ import annotations

from collections.abc import Iterator

import altair as alt
import numpy as np

from hersey import _core
from hersey.arrays import FloatArray, IntArray, pointwise
from hersey.charts.friction import friction_chart
from hersey.charts.labels import Labels
from hersey.charts.style import (
    BLUE,
    DIAMOND,
    INK,
    RIM,
    WIDTH,
    Chart,
    Row,
    categories,
    logarithmic_axis,
    plot,
    stacked,
)
from hersey.charts.transition import transition_chart
from hersey.lubrication.film_result import REGIMES, Film
from hersey.lubrication.mixed import MixedContact
from hersey.study.nip import film_points
from hersey.study.nip_film import FilmPoint
from hersey.units import celsius, rpm
from hersey.verdict.evidence import MeasuredFilm
from hersey.verdict.transition import ContactTransition

#: Shades of the regimes that stay apart in grey.
_SHADES = ("#f0eee2", "#eed9cf", "#dce9ef", "#cfdccb")
#: Width that is counted on to keep names apart, and height, pixels.
_NARROW, _TALL = 270, 250
#: Cells of the chart to a side, and decades shown beyond the points.
_CELLS, _MARGIN = 90, 1.5
#: Most points that are named, and the width of a letter in pixels.
_NAMED, _LETTER = 8, 5.6
#: Looks of the texts, and the rim around those that stand on marks.
_LOOKS: dict[str, Row] = {
    "regimes": {"fontSize": 11.5, "fontStyle": "italic"},
    "points": {"fontSize": 12, "fontWeight": "bold"},
}
_RIMS: dict[str, Row] = {"regimes": {}, "points": RIM}
_TIPS = [
    alt.Tooltip("name:N", title="point"),
    alt.Tooltip("regime:N", title="regime"),
    alt.Tooltip("h:Q", title="minimum film (µm)", format=".3~g"),
]
#: The chart shows at least this.
_LEAST = {"g_v": (-2.0, 4.0), "g_e": (-1.0, 3.0)}
#: Speed parameter at which the chart is computed: the regimes depend on g_V and g_E alone.
_U = 1e-10


def film_chart(
    film: Film,
    names: list[str] | None = None,
    measured: MeasuredFilm | None = None,
    transition: ContactTransition | None = None,
    mixed: MixedContact | None = None,
) -> Chart:
    """Return the regime chart with the points of a film on it.

    Over the Stribeck curve if there is a log, and over transition speeds if they are given.

    Points without ``names`` are called by their speed and temperature. The curve has the model of a ``mixed``
    contact, if one is given.
    """
    points = film_points(film, _places(film) if names is None else names)
    dwells = [] if measured is None or measured.predicted is film else _dwells(measured)
    charts: list[Chart] = [regime_chart(points, dwells, film.nip.layer_factor)]
    if measured is not None:
        charts.append(friction_chart(measured, mixed, grip=measured.grip))
    if transition is not None:
        charts.append(transition_chart(transition))
    return charts[0] if len(charts) == 1 else stacked(*charts, spacing=24)


def measured_chart(measured: MeasuredFilm) -> Chart:
    """Return where the dwells of a log lie on the regime chart, over their Stribeck curve."""
    chart = regime_chart([], _dwells(measured), measured.predicted.nip.layer_factor)
    return stacked(chart, friction_chart(measured, grip=measured.grip), spacing=24)


def _dwells(measured: MeasuredFilm) -> list[FilmPoint]:
    return film_points(measured.predicted, [""] * measured.speed.size)


def regime_chart(points: list[FilmPoint], dwells: list[FilmPoint], layer_factor: float) -> Chart:
    """Return the regime chart with named points of the machine and the dwells of a log on it."""
    named, unnamed = [_row(point) for point in points], [_row(dwell) for dwell in dwells]
    known = [row for row in (*named, *unnamed) if row["g_v"] > 0]
    spans = [_span([row[name] for row in known], least) for name, least in _LEAST.items()]
    x = alt.X("g_v:Q", title="Viscosity parameter g_V (no unit)", **_log(spans[0]))
    y = alt.Y("g_e:Q", title="Elasticity parameter g_E (no unit)", **_log(spans[1]))
    cells, regime = _cells(spans, layer_factor)
    color = categories(alt.Color, "regime", dict(zip(REGIMES, _SHADES, strict=True)), None)
    area = plot(cells).mark_rect(clip=True, strokeWidth=0)
    dots = plot([row for row in unnamed if row["g_v"] > 0])
    marks = plot([row for row in named if row["g_v"] > 0]).mark_point(**DIAMOND)
    layers = [
        area.encode(x=x, x2="g_v2:Q", y=y, y2="g_e2:Q", color=color),
        dots.mark_point(filled=True, color=BLUE, size=12, opacity=1).encode(x=x, y=y),
        marks.encode(x=x, y=y, tooltip=_TIPS),
        *_texts(named if len(named) <= _NAMED else [], unnamed, spans, regime, x, y),
    ]
    hidden = "" if known else " No points: alpha is unknown, so g_V = 0."
    subtitle = [
        "Shaded: the regime whose film formula applies. g_V = G W^1.5/U^0.5, g_E = W/U^0.5; "
        "U = eta u/(E'R) with the mean speed u, W = w/(E'R), G = alpha E'." + hidden
    ]
    if dwells and points:
        subtitle.append("Diamonds: operating points; dots: dwells.")
    title = alt.Title("Film regimes", subtitle=subtitle)
    return alt.layer(*layers, width=WIDTH, height=_TALL, title=title)


def _texts(
    points: list[Row],
    dwells: list[Row],
    spans: list[tuple[float, float]],
    regime: IntArray,
    x: alt.X,
    y: alt.Y,
) -> list[alt.Chart]:
    """Names of the points, and of each regime where it is roomiest, none over another."""
    labels = Labels(_NARROW, _TALL, letter=_LETTER)
    (left, right), (bottom, top) = spans
    for row in (*dwells, *points):
        if row["g_v"] > 0:
            across = float(_NARROW * (np.log10(row["g_v"]) - left) / (right - left))
            up = float(_TALL * (np.log10(row["g_e"]) - bottom) / (top - bottom))
            if row in points:
                labels.beside(row["name"], across, up, "points")
            else:
                labels.avoid(across, up)
    for name, *column in _columns_of(regime):
        labels.inside(name, [(column[0], column[1], column[2])], "regimes")
    layers: list[alt.Chart] = []
    for style, look in _LOOKS.items():
        placed: list[Row] = [
            {
                "g_v": 10 ** (left + (right - left) * t.across / _NARROW),
                "g_e": 10 ** (bottom + (top - bottom) * t.up / _TALL),
                "name": t.text,
            }
            for t in labels.texts
            if t.style == style
        ]
        base = plot(placed).encode(x=x, y=y, text=alt.Text("name:N"))
        layers += [base.mark_text(**(look | rim)) for rim in (_RIMS[style], {"color": INK}) if rim]
    return layers


def _places(film: Film) -> list[str]:
    speed, kelvin = np.broadcast_arrays(film.speed, film.temperature)
    pairs = zip(rpm(speed).ravel().tolist(), celsius(kelvin).ravel().tolist(), strict=True)
    return [f"{v:.3g} rpm, {t:.0f} °C" for v, t in pairs]


def _row(point: FilmPoint) -> Row:
    return {
        "name": point.name,
        "g_v": point.viscosity_parameter,
        "g_e": point.elasticity_parameter,
        "regime": point.regime,
        "h": 1e6 * point.minimum_thickness,
    }


def _span(values: list[float], least: tuple[float, float]) -> tuple[float, float]:
    """Decades to show."""
    if not values:
        return least
    logs = np.log10(values)
    return min(least[0], float(logs.min()) - _MARGIN), max(least[1], float(logs.max()) + _MARGIN)


def _log(span: tuple[float, float]) -> Row:
    return logarithmic_axis((10.0 ** span[0], 10.0 ** span[1]))


def _cells(spans: list[tuple[float, float]], softness: float) -> tuple[list[Row], IntArray]:
    """Cells of the chart, neighbours of one regime as one, and the regime of each, shape (across, up)."""
    edges = [np.linspace(low, high, _CELLS + 1) for low, high in spans]
    middle = [0.5 * (edge[1:] + edge[:-1]) for edge in edges]
    v, e = np.meshgrid(*middle, indexing="ij")
    g_v, g_e = 10.0**v, 10.0**e
    w = g_e * np.sqrt(_U)
    states = pointwise(_core.line_film, g_v * np.sqrt(_U) / w**1.5, _U, 1.0, w, 1.0, 1.0, softness)
    regime = states.regime.astype(int)
    cells = []
    for i in range(_CELLS):
        # Neighbours of one regime are one cell.
        start = 0
        for j in range(1, _CELLS + 1):
            if j == _CELLS or regime[i, j] != regime[i, start]:
                cells.append(
                    {
                        "g_v": 10.0 ** edges[0][i],
                        "g_v2": 10.0 ** (edges[0][i + 1] + 0.03),
                        "g_e": 10.0 ** edges[1][start],
                        "g_e2": 10.0 ** edges[1][j],
                        "regime": REGIMES[regime[i, start]],
                    }
                )
                start = j
    return cells, regime


def _columns_of(regime: IntArray) -> Iterator[tuple[str, FloatArray, FloatArray, FloatArray]]:
    """Each regime's columns of cells in pixels: where they are across, from where they reach to where."""
    across = (np.arange(_CELLS) + 0.5) * _NARROW / _CELLS
    cell = _TALL / _CELLS
    for k, name in enumerate(REGIMES):
        inside = regime == k
        low = np.argmax(inside, axis=1)
        yield name, across, cell * low, cell * (low + inside.sum(axis=1))
