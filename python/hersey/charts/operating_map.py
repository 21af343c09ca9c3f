"""The operating map as a chart: temperature across, drive speed up, everything named on it.

Regions differ in lightness and carry their names, lines differ in dash, and what is extrapolated is hatched,
so that the picture survives greyscale.
"""

from __future__ import annotations

from dataclasses import dataclass

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import Chart, Row, plot
from hersey.stability.operating_map import OperatingMap
from hersey.units import ZERO_CELSIUS, celsius, rpm

WIDTH, HEIGHT = 680, 450
_INK, _BLUE = "#222", "#1f4e9c"
#: Name, text in the legend, text on the map, and colour of each region, lightness falling.
_REGIONS = (
    ("smooth", "smooth (EHL)", "smooth", "#eef5fb"),
    ("bistable", "bistable: smooth only from above", "smooth only from above", "#f5cf7f"),
    ("swing", "small swing without sticking", "small swing", "#e08f2d"),
    ("stick_slip", "stick-slip", "stick-slip", "#cc6a3d"),
    ("stall", "stall", "stall", "#44444e"),
)
#: Pixels between hatches, width of a letter, height of a line of text.
_HATCH, _LETTER, _LINE = 9.0, 7.0, 15.0
#: Contours of torque aimed at, and the steps that read well.
_CONTOURS, _STEPS = 6, (1.0, 2.0, 2.5, 5.0, 10.0)
#: Where a point's name may stand above or below it, in pixels, the nearest first.
_ROWS = (17.0, -17.0, 33.0, -33.0, 49.0, -49.0)
#: Pixels of room that a name gives up to stand in the measured range.
_PREFERENCE = 40.0
#: Least height of a region that is shown, in pixels.
_THIN = 4.0
#: Least share by which V* exceeds the transition speed where its line is drawn.
_VISIBLE = 1.01


Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class _Frame:
    """Window of the chart and its pixels: ``x`` in degC (0 to 1 if isothermal), speeds in m/s."""

    x: FloatArray
    low: float
    high: float
    thermal: bool

    @classmethod
    def of(cls, drawn: OperatingMap) -> _Frame:
        """Return the window of a map."""
        hot = drawn.temperature
        x = np.array([0.0, 1.0] if hot is None else [celsius(t) for t in hot.tolist()])
        return cls(x, float(drawn.speed[0]), float(drawn.speed[-1]), hot is not None)

    def across(self, x: float) -> float:
        """Pixels from the left."""
        return WIDTH * (x - float(self.x[0])) / float(self.x[-1] - self.x[0])

    def up(self, speed: float) -> float:
        """Pixels from the bottom."""
        return HEIGHT * float(np.log(speed / self.low) / np.log(self.high / self.low))

    def at(self, across: float, up: float) -> tuple[float, float]:
        """What pixels stand for."""
        x = float(self.x[0]) + across / WIDTH * float(self.x[-1] - self.x[0])
        return x, self.low * float((self.high / self.low) ** (up / HEIGHT))

    def clipped(self, speeds: FloatArray) -> FloatArray:
        """Speeds within the window."""
        return np.clip(speeds, self.low, self.high)


def map_chart(drawn: OperatingMap, *, tooltips: bool = True) -> Chart:
    """Return the chart of an operating map; without ``tooltips`` files that cannot show them are smaller."""
    frame = _Frame.of(drawn)
    bands = _bands(drawn, frame)
    labels = _Labels(frame)
    marks = _points(drawn, frame, labels)
    speed_limit = _speed_limit(drawn, frame, labels)
    contours = _contours(drawn, frame, labels)
    layers: list[alt.Chart | Chart] = [
        _regions(bands, frame),
        *_hatches(drawn, frame),
        *contours,
        *_edges(drawn, frame),
        *_measured(drawn, frame),
        *speed_limit,
        *marks,
        labels.regions(bands, _measured_box(drawn, frame)),
        *([_tooltips(drawn, frame)] if tooltips else []),
    ]
    main = alt.layer(*layers)
    title = alt.Title(_title(drawn), subtitle=_subtitle(drawn))
    both = alt.layer(main, _revolutions(drawn, frame)).resolve_scale(y="independent")
    chart: Chart = both.properties(title=title, width=WIDTH, height=HEIGHT)
    return chart


def _wide(drawn: OperatingMap, edge: FloatArray) -> FloatArray:
    """One value per column; the one column of an isothermal map is drawn from side to side."""
    return np.repeat(edge, 2, axis=-1) if drawn.temperature is None else edge


def _title(drawn: OperatingMap) -> str:
    return "Operating map" + (" (isothermal fit)" if drawn.temperature is None else "")


def _subtitle(drawn: OperatingMap) -> list[str]:
    counted = ", ".join(["fit", *(name.replace("_", " ") for name in drawn.uncertain)])
    first = "solid: transition speed, shaded its 95 % interval"
    if np.any(drawn.upper > _VISIBLE * drawn.transition):
        first += f"; dashed: V*, dotted its 95 % interval ({counted})"
    elif np.any(drawn.upper_interval[1] > _VISIBLE * drawn.transition_interval[1]):
        first += f"; dotted: 95 % interval of V* ({counted})"
    second = "thin: drag torque; frame: range of the dwells; hatched: extrapolated"
    if drawn.torque_limit is not None:
        second += f"; stall beyond {drawn.torque_limit:.3g} N·m ({drawn.limited_by})"
    return [first, second]


def _x(frame: _Frame, field: str = "x:Q") -> alt.X:
    domain = [float(frame.x[0]), float(frame.x[-1])]
    return alt.X(
        field,
        title="Temperature (°C)" if frame.thermal else None,
        scale=alt.Scale(domain=domain, nice=False),
        axis=alt.Axis(grid=False, tickCount=8) if frame.thermal else None,
    )


def _y(frame: _Frame, field: str = "y:Q") -> alt.Y:
    low, high = 1e3 * frame.low, 1e3 * frame.high
    return alt.Y(
        field,
        title="Drive speed at the belt (mm/s)",
        scale=alt.Scale(type="log", domain=[low, high], nice=False),
        axis=alt.Axis(grid=False, values=_decades(low, high), format="~g"),
    )


def _decades(low: float, high: float) -> list[float]:
    """1, 2 and 5 of every power of ten between two numbers."""
    powers = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    values = [float(f"{m}e{p}") for p in powers for m in (1, 2, 5)]
    return [v for v in values if low <= v <= high]


def _bands(drawn: OperatingMap, frame: _Frame) -> dict[str, list[tuple[FloatArray, FloatArray]]]:
    """Lower and upper edge (m/s) of each region at each column of the chart; the stall has two parts."""
    names = ("stall_below", "lower", "transition", "upper", "stall_above")
    below, lower, bend, upper, above = (frame.clipped(_wide(drawn, getattr(drawn, n))) for n in names)
    bottom, top = np.full_like(below, frame.low), np.full_like(below, frame.high)

    def between(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
        low = np.clip(low, below, above)
        return low, np.maximum(np.clip(high, below, above), low)

    return {
        "stick_slip": [between(bottom, lower)],
        "swing": [between(lower, bend)],
        "bistable": [between(bend, upper)],
        "smooth": [between(upper, top)],
        "stall": [(bottom, below), (above, top)],
    }


def _regions(bands: dict[str, list[tuple[FloatArray, FloatArray]]], frame: _Frame) -> alt.Chart:
    rows = [
        {"x": x, "y": 1e3 * low, "top": 1e3 * high, "region": text, "part": f"{name} {part}"}
        for name, text, _, _ in _REGIONS
        for part, edges in enumerate(bands[name])
        if HEIGHT * np.log(edges[1] / edges[0]).max() > _THIN * np.log(frame.high / frame.low)
        for x, low, high in zip(*map(np.ndarray.tolist, (frame.x, *edges)), strict=True)
    ]
    shown = [r for r in _REGIONS if any(row["region"] == r[1] for row in rows)]
    scale = alt.Scale(domain=[r[1] for r in shown], range=[r[3] for r in shown])
    legend = alt.Legend(
        orient="bottom",
        title=None,
        symbolType="square",
        symbolSize=160,
        symbolStrokeColor="#666",
        labelLimit=260,
    )
    chart: alt.Chart = (
        plot(rows)
        .mark_area(clip=True)
        .encode(
            x=_x(frame),
            y=_y(frame),
            y2="top:Q",
            color=alt.Color("region:N", scale=scale, legend=legend),
            detail="part:N",
        )
    )
    return chart


def _hatches(drawn: OperatingMap, frame: _Frame) -> list[alt.Chart]:
    """Diagonals across all that lies outside the measured range, pale ones between for dark regions."""
    looks = ((0.0, "#555", 0.45), (_HATCH / 2, "white", 0.3))
    return [_hatch(_diagonals(drawn, frame, start), frame, color, opacity) for start, color, opacity in looks]


def _diagonals(drawn: OperatingMap, frame: _Frame, offset: float) -> list[Row]:
    left, bottom, right, top = _measured_box(drawn, frame)
    rows: list[Row] = []
    for shift in np.arange(offset - HEIGHT, WIDTH, _HATCH).tolist():
        start, end = max(0.0, shift), min(float(WIDTH), shift + HEIGHT)
        enter, leave = max(left, bottom + shift), min(right, top + shift)
        inside = [enter, leave] if leave > enter else []
        stops = sorted([start, *(min(max(v, start), end) for v in inside), end])
        for a, b in zip(stops[::2], stops[1::2], strict=True):
            if b - a > 0.5:
                (x, y), (x2, y2) = frame.at(a, a - shift), frame.at(b, b - shift)
                rows.append({"x": x, "y": 1e3 * y, "x2": x2, "y2": 1e3 * y2})
    return rows


def _hatch(rows: list[Row], frame: _Frame, color: str, opacity: float) -> alt.Chart:
    chart: alt.Chart = (
        plot(rows)
        .mark_rule(color=color, opacity=opacity, strokeWidth=0.7, clip=True)
        .encode(x=_x(frame), y=_y(frame), x2="x2:Q", y2="y2:Q")
    )
    return chart


def _measured_box(drawn: OperatingMap, frame: _Frame) -> Box:
    low, high = (frame.up(v) for v in drawn.measured_speed)
    left, right = 0.0, float(WIDTH)
    if drawn.measured_temperature is not None:
        left, right = (frame.across(celsius(t)) for t in drawn.measured_temperature)
    return max(left, 0.0), max(low, 0.0), min(right, float(WIDTH)), min(high, float(HEIGHT))


def _measured(drawn: OperatingMap, frame: _Frame) -> list[alt.Chart]:
    left, bottom, right, top = _measured_box(drawn, frame)
    if not (right > left and top > bottom):
        return []
    (x, y), (x2, y2) = frame.at(left, bottom), frame.at(right, top)
    rows: list[Row] = [{"x": x, "y": 1e3 * y, "x2": x2, "y2": 1e3 * y2}]
    base = plot(rows).encode(x=_x(frame), y=_y(frame), x2="x2:Q", y2="y2:Q")
    return [
        base.mark_rect(filled=False, stroke=stroke, strokeWidth=width)
        for stroke, width in (("white", 3.0), (_INK, 1.2))
    ]


def _edges(drawn: OperatingMap, frame: _Frame) -> list[alt.Chart]:
    low, high = (frame.clipped(_wide(drawn, edge)) for edge in drawn.transition_interval)
    shade = [
        {"x": x, "y": 1e3 * a, "top": 1e3 * b}
        for x, a, b in zip(*map(np.ndarray.tolist, (frame.x, low, high)), strict=True)
    ]
    interval = (
        plot(shade)
        .mark_area(color=_INK, opacity=0.35, clip=True)
        .encode(x=_x(frame), y=_y(frame), y2="top:Q")
    )
    beyond = _VISIBLE * drawn.transition_interval[1]
    charts = [
        _line(drawn, frame, drawn.transition, [1.0, 0.0], 1.8),
        _line(
            drawn,
            frame,
            np.where(drawn.upper > _VISIBLE * drawn.transition, drawn.upper, 0.0),
            [7.0, 4.0],
            1.8,
        ),
        *(
            _line(drawn, frame, np.where(edge > beyond, edge, 0.0), [1.5, 3.5], 1.3)
            for edge in drawn.upper_interval
        ),
        *(_line(drawn, frame, edge, [1.0, 0.0], 1.0) for edge in (drawn.stall_below, drawn.stall_above)),
    ]
    return [interval, *(chart for chart in charts if chart is not None)]


def _line(
    drawn: OperatingMap, frame: _Frame, edge: FloatArray, dash: list[float], width: float, color: str = _INK
) -> alt.Chart | None:
    """A line where there is a speed, which may leave the window; none at 0 or far beyond it."""
    columns = zip(frame.x.tolist(), _wide(drawn, edge).tolist(), strict=True)
    rows: list[Row] = [{"x": x, "y": 1e3 * v} for x, v in columns if 0.5 * frame.low < v < 2.0 * frame.high]
    if len(rows) < 2:
        return None
    chart: alt.Chart = (
        plot(rows)
        .mark_line(color=color, strokeDash=dash, strokeWidth=width, clip=True)
        .encode(x=_x(frame), y=_y(frame))
    )
    return chart


def _contours(drawn: OperatingMap, frame: _Frame, labels: _Labels) -> list[alt.Chart]:
    """Lines of constant torque where the belt slides steadily, each with its value."""
    scale, unit = (1.0, "N·m") if drawn.torque.max() >= 1.0 else (1e3, "mN·m")
    charts = []
    for level in _levels(drawn, scale):
        rising = drawn.contour(level / scale)[1]
        speeds = np.where(rising > 1.0001 * drawn.transition, rising, 0.0)
        line = _line(drawn, frame, speeds, [1.0, 0.0], 0.9, _BLUE)
        if line is not None:
            charts.append(line)
            labels.along(f"{level:.4g} {unit}", _wide(drawn, speeds))
    return charts


def _levels(drawn: OperatingMap, scale: float) -> list[float]:
    """Round torques from the least above the transition to the greatest that does not stall."""
    rising = drawn.speed >= drawn.transition[:, None]
    if not np.any(rising):
        return []
    low = scale * float(drawn.torque[rising].min())
    high = scale * min(float(drawn.torque[rising].max()), drawn.torque_limit or np.inf)
    rough = (high - low) / _CONTOURS
    if not rough > 0:
        return []
    power = 10.0 ** np.floor(np.log10(rough))
    step = next(s for s in _STEPS if s * power >= rough * 0.999) * power
    return [float(k * step) for k in range(int(np.ceil(low / step)), int(np.ceil(high / step)))]


def _speed_limit(drawn: OperatingMap, frame: _Frame, labels: _Labels) -> list[alt.Chart]:
    if drawn.speed_limit is None or not frame.low < drawn.speed_limit < frame.high:
        return []
    limit = np.full(drawn.transition.size, drawn.speed_limit)
    looks = (([1.0, 0.0], 3.0, "white"), ([10.0, 3.0, 2.0, 3.0], 1.3, _INK))
    lines = [_line(drawn, frame, limit, *look) for look in looks]
    labels.along("greatest drive speed", _wide(drawn, limit), "lines")
    return [line for line in lines if line is not None]


def _points(drawn: OperatingMap, frame: _Frame, labels: _Labels) -> list[alt.Chart]:
    rows: list[Row] = []
    for number, point in enumerate(drawn.points, 1):
        x = celsius(point.temperature) if drawn.temperature is not None else number / (len(drawn.points) + 1)
        if not (frame.x[0] <= x <= frame.x[-1] and frame.low <= point.speed <= frame.high):
            continue
        labels.beside(point.name, x, point.speed)
        rows.append(
            {
                "x": x,
                "y": 1e3 * point.speed,
                "name": point.name,
                "rpm": rpm(point.speed / drawn.roll_radius),
                "torque": point.at.torque,
                "state": point.at.verdict(),
            }
        )
    if not rows:
        return []
    marks = (
        plot(rows)
        .mark_point(
            shape="diamond", filled=True, fill="white", stroke=_INK, strokeWidth=2, size=110, opacity=1
        )
        .encode(x=_x(frame), y=_y(frame), tooltip=[alt.Tooltip("name:N", title="point"), *_tips(drawn)])
    )
    return [marks]


def _tips(drawn: OperatingMap) -> list[alt.Tooltip]:
    hot = [("x", "temperature (°C)")] if drawn.temperature is not None else []
    numbers = [
        *hot,
        ("y", "drive speed (mm/s)"),
        ("rpm", "drive speed (rpm)"),
        ("torque", "drag torque (N·m)"),
    ]
    tips = [alt.Tooltip(f"{field}:Q", title=title, format=".3~g") for field, title in numbers]
    return [*tips, alt.Tooltip("state:N", title="here")]


def _tooltips(drawn: OperatingMap, frame: _Frame) -> alt.Chart:
    """Unseen cells that say what the belt does under the pointer."""
    columns, speeds = np.linspace(frame.x[0], frame.x[-1], 25), np.geomspace(frame.low, frame.high, 31)
    columns = columns if drawn.temperature is not None else frame.x
    middles = 0.5 * (columns[1:] + columns[:-1])
    centres = np.sqrt(speeds[1:] * speeds[:-1])
    across, up = (grid.ravel() for grid in np.meshgrid(middles, centres, indexing="ij"))
    states = drawn.look_up(None if drawn.temperature is None else across + ZERO_CELSIUS, up)
    rows: list[Row] = []
    for number, (x, speed, state) in enumerate(zip(across.tolist(), up.tolist(), states, strict=True)):
        i, j = divmod(number, centres.size)
        rows.append(
            {
                "left": float(columns[i]),
                "right": float(columns[i + 1]),
                "bottom": 1e3 * float(speeds[j]),
                "top": 1e3 * float(speeds[j + 1]),
                "x": x,
                "y": 1e3 * speed,
                "rpm": rpm(speed / drawn.roll_radius),
                "torque": state.torque,
                "state": state.verdict() + (" (extrapolated)" if state.extrapolated else ""),
            }
        )
    chart: alt.Chart = (
        plot(rows)
        .mark_rect(opacity=0, clip=True)
        .encode(
            x=_x(frame, "left:Q"), x2="right:Q", y=_y(frame, "bottom:Q"), y2="top:Q", tooltip=_tips(drawn)
        )
    )
    return chart


def _revolutions(drawn: OperatingMap, frame: _Frame) -> alt.Chart:
    """The second axis: revolutions of the roll."""
    low, high = (rpm(v / drawn.roll_radius) for v in (frame.low, frame.high))
    axis = alt.Axis(orient="right", grid=False, values=_decades(low, high), format="~g")
    y = alt.Y(
        "rpm:Q",
        title="Roll speed (rpm)",
        scale=alt.Scale(type="log", domain=[low, high], nice=False),
        axis=axis,
    )
    rows: list[Row] = [{"x": float(frame.x[0]), "rpm": low}]
    chart: alt.Chart = plot(rows).mark_point(opacity=0, size=0).encode(x=_x(frame), y=y)
    return chart


@dataclass(frozen=True)
class _Text:
    text: str
    across: float
    up: float
    style: str


class _Labels:
    """Texts on the map, each where it covers no other."""

    def __init__(self, frame: _Frame) -> None:
        self._frame = frame
        self._texts: list[_Text] = []
        self._taken: list[Box] = []

    def beside(self, text: str, x: float, speed: float) -> None:
        """Name a point, on the first side where there is room."""
        across, up = self._frame.across(x), self._frame.up(speed)
        self._taken.append((across - 8, up - 8, across + 8, up + 8))
        away = 0.5 * _LETTER * len(text) + 12
        sides = [(away, 0.0), (-away, 0.0), *((dx, dy) for dy in _ROWS for dx in (0.0, away, -away))]
        for dx, dy in sides:
            if self._put(text, across + dx, up + dy, "points"):
                return
        self._put(text, across, up + 17, "points", force=True)

    def along(self, text: str, speeds: FloatArray, style: str = "contours") -> None:
        """Name a line, above its far end or as near to it as there is room, or else below."""
        columns = list(zip(self._frame.x.tolist(), speeds.tolist(), strict=True))
        shown = [(x, v) for x, v in reversed(columns) if self._frame.low < v < self._frame.high]
        for away in (8.0, -9.0):
            for x, speed in shown:
                left = self._frame.across(x) - 0.5 * _LETTER * len(text) - 4
                if self._put(text, left, self._frame.up(speed) + away, style):
                    return

    def regions(self, bands: dict[str, list[tuple[FloatArray, FloatArray]]], measured: Box) -> Chart:
        """Name each region where it is roomiest, and return all texts."""
        for name, _, text, _ in _REGIONS:
            best: tuple[float, float, float] | None = None
            for edges in bands[name]:
                for across, up, room in self._rooms(text, edges, measured):
                    if best is None or room > best[0]:
                        best = room, across, up
            if best is not None:
                self._put(text, best[1], best[2], "regions")
        return self._chart()

    def _rooms(
        self, text: str, edges: tuple[FloatArray, FloatArray], measured: Box
    ) -> list[tuple[float, float, float]]:
        """Places in a region where a text fits, with the room around it (pixels), more if measured."""
        left, bottom, right, top = measured
        half = 0.5 * _LETTER * len(text) + 4
        places = np.array([self._frame.across(x) for x in self._frame.x.tolist()])
        low, high = (np.array([self._frame.up(v) for v in edge.tolist()]) for edge in edges)
        found = []
        for across in np.arange(half, WIDTH - half, 8.0).tolist():
            columns = np.append(
                places[(places > across - half) & (places < across + half)], [across - half, across + half]
            )
            floor = float(np.interp(columns, places, low).max())
            ceiling = float(np.interp(columns, places, high).min())
            for up in np.arange(floor + _LINE / 2, ceiling - _LINE / 2, 6.0).tolist():
                if self._is_free(self._box(text, across, up)):
                    known = (
                        left < across - half < across + half < right
                        and bottom < up - _LINE < up + _LINE < top
                    )
                    room = min(up - floor, ceiling - up, 80.0) + (_PREFERENCE if known else 0.0)
                    found.append((across, up, room - 0.05 * abs(across - WIDTH / 2)))
        return found

    def _box(self, text: str, across: float, up: float) -> Box:
        half = 0.5 * _LETTER * len(text)
        return across - half, up - _LINE / 2, across + half, up + _LINE / 2

    def _is_free(self, box: Box) -> bool:
        left, bottom, right, top = box
        if left < 0 or bottom < 0 or right > WIDTH or top > HEIGHT:
            return False
        return not any(
            left < end and start < right and bottom < head and base < top
            for start, base, end, head in self._taken
        )

    def _put(self, text: str, across: float, up: float, style: str, *, force: bool = False) -> bool:
        box = self._box(text, across, up)
        if not (force or self._is_free(box)):
            return False
        self._taken.append(box)
        self._texts.append(_Text(text, across, up, style))
        return True

    def _chart(self) -> Chart:
        """All texts with a pale rim, so that lines do not run through them."""
        looks: dict[str, Row] = {
            "regions": {"fontSize": 13, "fontWeight": "bold", "color": _INK},
            "points": {"fontSize": 13, "fontWeight": "bold", "color": "black"},
            "contours": {"fontSize": 11, "color": _BLUE},
            "lines": {"fontSize": 11, "color": _INK},
        }
        layers = []
        for style, look in looks.items():
            rows = []
            for t in self._texts:
                if t.style == style:
                    x, y = self._frame.at(t.across, t.up)
                    rows.append({"x": x, "y": 1e3 * y, "text": t.text})
            if rows:
                base = plot(rows).encode(x=_x(self._frame), y=_y(self._frame), text="text:N")
                rim = {**look, "color": "white", "stroke": "white", "strokeWidth": 3.5, "strokeJoin": "round"}
                layers += [base.mark_text(**rim), base.mark_text(**look)]
        return alt.layer(*layers)
