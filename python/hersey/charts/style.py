"""Sizes, colours and small pieces that all charts share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Any, ClassVar, Literal

import altair as alt
import numpy as np
from altair.utils.schemapi import debug_mode

from hersey.charts.labels import apart
from hersey.units import celsius

WIDTH, HEIGHT = 680, 340
#: Ink for words and rules, the first and the second colour of lines (static/tokens.css of the pages).
INK, BLUE, ORANGE = "#15202b", "#0a5c8f", "#b8500c"
#: Secondary text, faint shade, edges, red and green.
SECONDARY, SHADE, EDGE, RED, GREEN = "#4b5965", "#eaeef1", "#73808c", "#a5301a", "#17694a"
#: Anchors of the colours of temperatures, cold to hot.
_RAMP = ((0x2B, 0x4F, 0x9E), (0x7A, 0x3F, 0x9D), (0xB3, 0x2C, 0x66), (0xB8, 0x50, 0x0C))
#: Shares of greatest over least beyond which an axis names decades alone, and below which it has even steps.
_WIDE, _CLOSE = 1e4, 5.0
SHAPES = ("circle", "square", "triangle-up", "diamond", "cross", "triangle-down")
Row = dict[str, Any]
#: A pale rim around words, so that lines do not run through them.
RIM: Row = {"color": "white", "stroke": "white", "strokeWidth": 3.5, "strokeJoin": "round"}
#: The user's own points.
DIAMOND: Row = {
    "shape": "diamond",
    "fill": "white",
    "stroke": INK,
    "strokeWidth": 1.8,
    "size": 85,
    "opacity": 1,
}
ROLL_SPEED, TEMPERATURE = "Speed (rpm)", "Temperature (°C)"
#: How dwells are drawn.
APPROACHES = "filled: reached from a lower speed; open: from a higher one; bars: two standard errors"
Chart = alt.LayerChart | alt.FacetChart | alt.VConcatChart | alt.HConcatChart


class _Inline:
    """Rows that altair passes on as they are: it would copy all of them for every layer and channel."""

    #: Altair takes what has a schema and `to_dict` for a piece of its own.
    _schema: ClassVar[dict[str, str]] = {"type": "array"}

    def __init__(self, rows: list[Row]) -> None:
        self._rows = rows

    def to_dict(self) -> list[Row]:
        return self._rows


class _Plot(alt.Chart):
    """A chart that altair takes as it is: it would look each channel up in its whole schema, and copy all."""

    def encode(self, *args: Any, **channels: Any) -> Any:
        """Add channels, those written short or as values as the classes that altair finds for them."""
        return super().encode(*args, **{name: _channel(name, given) for name, given in channels.items()})

    def copy(self, deep: Any = True, ignore: list[str] | None = None) -> Any:
        """Return a copy that shares what no chart changes: its pieces."""
        return super().copy(deep=False if deep is True else deep, ignore=ignore)


class _Layers(alt.LayerChart):
    """Layers that are not copied when they become part of another chart, as altair does."""

    def copy(self, deep: Any = True, ignore: list[str] | None = None) -> Any:
        """Return a copy that shares the layers."""
        return super().copy(deep=False if deep is True else deep, ignore=ignore)


def _channel(name: str, given: Any) -> Any:
    kind = name[0].upper() + name[1:]
    if isinstance(given, str):
        return getattr(alt, kind)(given)
    return getattr(alt, f"{kind}Value")(**given) if isinstance(given, dict) else given


def plot(rows: list[Row]) -> alt.Chart:
    """Return a chart of rows, to which marks and channels are given."""
    return _Plot(alt.Data(values=_Inline(rows)))


def layered(*layers: alt.Chart | alt.LayerChart, **properties: Any) -> alt.LayerChart:
    """Return charts one over another, to be laid into others."""
    return _Layers(layer=layers, **properties)


def temperature_name(kelvin: float | None) -> float:
    """Return a temperature as legends name it, whole degC; 0 where none was recorded."""
    return 0.0 if kelvin is None else float(round(celsius(kelvin)))


def temperature_channels(
    kelvin: Sequence[float | None], *, legend: bool = True, orient: Literal["right", "top"] = "right"
) -> tuple[alt.Color, alt.Shape]:
    """Return colour and shape of the field ``level`` for these temperatures (K)."""
    return level_channels(sorted({temperature_name(t) for t in kelvin}), legend=legend, orient=orient)


def level_channels(
    levels: Sequence[float], *, legend: bool = True, orient: Literal["right", "top"] = "right"
) -> tuple[alt.Color, alt.Shape]:
    """Return colour by lightness and shape of the field ``level``, so that temperatures survive greyscale."""
    named = alt.Legend(title="°C", symbolOpacity=1, orient=orient) if legend else None
    shapes = [SHAPES[i % len(SHAPES)] for i in range(len(levels))]
    return (
        alt.Color("level:N", scale=alt.Scale(domain=list(levels), range=ramp(len(levels))), legend=named),
        alt.Shape("level:N", scale=alt.Scale(domain=list(levels), range=shapes), legend=named),
    )


def categories(
    channel: type[alt.Color | alt.Shape | alt.StrokeDash],
    field: str,
    looks: Mapping[str, Any],
    legend: alt.Legend | None,
) -> Any:
    """Return a channel in which each name of a field has its look: a colour, a shape or dashes."""
    scale = alt.Scale(domain=list(looks), range=list(looks.values()))
    return channel(f"{field}:N", scale=scale, legend=legend)


def rimmed(base: alt.Chart, **look: Any) -> list[alt.Chart]:
    """Return words over a pale rim, so that lines do not run through them."""
    return [base.mark_text(**(look | RIM)), base.mark_text(**({"color": INK} | look))]


def stacked(*panels: alt.Chart | Chart, spacing: float, title: alt.Title | None = None) -> Chart:
    """Return panels one above another, each with its own colours and shapes."""
    together = alt.vconcat(*panels, spacing=spacing, **({} if title is None else {"title": title}))
    chart: Chart = together.resolve_scale(color="independent", shape="independent")
    return chart


def unchecked() -> AbstractContextManager[None]:
    """Let altair make charts without checking each piece against its schema: the tests check whole charts."""
    return debug_mode(False)


def ramp(count: int) -> list[str]:
    """Blue (cold) by purple to orange (hot), all dark enough for words on white."""
    anchors = np.array(_RAMP, dtype=float)
    at = np.linspace(0, 3, count) if count > 1 else np.array([0.0])
    channels = [np.interp(at, range(4), anchors[:, i]) for i in range(3)]
    return [f"#{int(r):02x}{int(g):02x}{int(b):02x}" for r, g, b in zip(*channels, strict=True)]


def across(pixels: float = 0.0) -> Any:
    """Return a place so many pixels right of a chart's right edge, whatever its width."""
    return alt.value(alt.ExprRef(f"width + {pixels:g}"))


def rows_of(**columns: object) -> list[Row]:
    """Return one row per entry of columns of one length: arrays, lists or ranges."""
    lists = [c.tolist() if isinstance(c, np.ndarray) else c for c in columns.values()]
    return [dict(zip(columns, entries, strict=True)) for entries in zip(*lists, strict=True)]


def logarithmic() -> alt.Scale:
    """Return a logarithmic scale that ends a little beyond the data."""
    return alt.Scale(type="log", nice=False, padding=12)


def span(values: Sequence[float], room: float = 0.05) -> tuple[float, float]:
    """Return least and greatest with some room on a logarithmic axis."""
    low, high = np.log(min(values)), np.log(max(values))
    pad = room * (high - low) + 0.02
    return float(np.exp(low - pad)), float(np.exp(high + pad))


def logarithmic_axis(domain: tuple[float, float], **look: Any) -> Row:
    """Return scale and axis of a channel from a least to a greatest value, with round numbers along it."""
    low, high = domain
    decades = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    if high / low < _CLOSE:  # round numbers at even steps
        rough = (high - low) / 5
        power = 10.0 ** np.floor(np.log10(rough))
        step = power * min(each for each in (1, 2, 5, 10) if each * power >= rough)
        values = [float(f"{i * step:.9g}") for i in range(int(np.ceil(low / step)), int(high / step) + 1)]
    else:
        steps = (1, 2, 5) if high / low < _WIDE else (1,)
        values = [each * 10.0**decade for decade in decades for each in steps]
    return {
        "scale": alt.Scale(type="log", domain=list(domain), nice=False),
        "axis": alt.Axis(values=[v for v in values if low <= v <= high], format="~g", **look),
    }


def torque_unit(largest: float) -> tuple[float, str]:
    """Return the factor from N m, and the unit in which torques up to the ``largest`` read best."""
    return (1.0, "N·m") if largest >= 1.0 else (1e3, "mN·m")


def level(value: float, name: str, *, lift: float = 0.0) -> list[alt.Chart]:
    """Return a dashed level across a chart, named right of it where no line crosses the words.

    ``lift`` moves the name up by pixels, away from that of a level nearby.
    """
    mark = plot([{"value": value, "name": name}])
    y = alt.Y("value:Q")
    rule = mark.mark_rule(color=INK, strokeDash=[4, 3], strokeWidth=1).encode(y=y)
    text = mark.mark_text(align="left", dx=6, dy=-lift, color=INK, fontSize=12)
    return [rule, text.encode(x=across(), y=y, text=alt.Text("name:N"))]


def levels(marks: list[tuple[float, str]], domain: tuple[float, float], height: float) -> list[alt.Chart]:
    """Return levels across a chart of ``height`` pixels with this ``domain``, their names apart."""
    low, high = domain
    heights = [height * (value - low) / (high - low) for value, _ in marks]
    lifts = [place - up for place, up in zip(apart(heights), heights, strict=True)]
    return [
        layer
        for (value, name), lift in zip(marks, lifts, strict=True)
        for layer in level(value, name, lift=lift)
    ]


def zoom() -> alt.Parameter:
    """Return zooming by the wheel while Shift is held, and moving by the mouse."""
    return alt.selection_interval(bind="scales", zoom="wheel![event.shiftKey]")


def tip(field: str, title: str) -> alt.Tooltip:
    """Return a number of a tooltip, to four digits."""
    return alt.Tooltip(f"{field}:Q", title=title, format=".4~g")


def age_tip(age_unit: str, name: str = "age", field: str = "age") -> alt.Tooltip:
    """Return an age of a tooltip, with its unit."""
    return tip(field, f"{name} ({age_unit or 'as given'})")
