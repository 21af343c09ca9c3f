"""The hysteresis band: what the belt does at which drive speed."""

from __future__ import annotations

import math

import altair as alt

from hersey.charts.operating_map.regions import REGIONS, region_color
from hersey.charts.style import INK, WIDTH, Chart, Row, plot, rimmed
from hersey.stability.hysteresis import HysteresisBand

#: Beyond the outermost of the three speeds the axis goes on by this factor.
_BEYOND = 1.6
_HEIGHT = 90


def band_chart(band: HysteresisBand, *, unit: str = "m/s") -> Chart:
    """Return what the belt does over the drive speed, with the intervals of its edges if they are known."""
    edges = [e for e in (band.lower, band.transition, band.upper) if 0 < e < math.inf]
    low, high = min(edges) / _BEYOND, max(edges) * _BEYOND
    x = alt.X(
        "from:Q",
        title=f"Drive speed ({unit})",
        scale=alt.Scale(type="log", domain=[low, high], nice=False),
        axis=alt.Axis(grid=False, format="~g"),
    )
    sentences = [part.rstrip(".") + "." for part in band.verdict().split(". ")]
    title = alt.Title("Hysteresis band", subtitle=[*sentences, f"closure: {band.closure}"])
    layers = [_states(band, low, high, x), *_edges(band, x, high)]
    return alt.layer(*layers, title=title, width=WIDTH, height=_HEIGHT)


def _states(band: HysteresisBand, low: float, high: float, x: alt.X) -> alt.Chart:
    """The states from the slow side up, those without width left out."""
    top = min(band.upper, high)
    spans = {
        "stick_slip": (low, band.lower),
        "swing": (band.lower, band.transition),
        "bistable": (max(band.transition, band.lower), top),
        "smooth": (max(top, band.transition), high),
    }
    if band.stalls:  # at any speed; what one that moves does the verdict says
        spans = {"stall": (low, high)}
    looks = {name: (text, color) for name, text, _, color in REGIONS}
    rows: list[Row] = [
        {"from": max(a, low), "to": b, "state": looks[name][0]} for name, (a, b) in spans.items() if b > a
    ]
    seen = {row["state"] for row in rows}
    color = region_color("state", [name for name, text, _, _ in REGIONS if text in seen])
    chart: alt.Chart = plot(rows).mark_rect(clip=True).encode(x=x, x2=alt.X2("to:Q"), color=color)
    return chart


def _edges(band: HysteresisBand, x: alt.X, high: float) -> list[alt.Chart]:
    """The three speeds with their numbers, each on a line of its own, and their intervals."""
    named = (
        ("sticks below", band.lower, band.lower_interval),
        ("transition speed", band.transition, None),
        ("V*", band.upper, band.interval),
    )
    rows: list[Row] = []
    for number, (name, value, interval) in enumerate(named):
        if 0 < value <= high:
            ends = interval or (value, value)
            text = f"{name} {value:.4g}"
            rows.append({"from": value, "low": ends[0], "high": ends[1], "y": 18 + 26 * number, "text": text})
    y = alt.Y("y:Q", scale=None, axis=None)
    rule = plot(rows).mark_rule(color=INK, strokeWidth=1.5).encode(x=x)
    span = plot([r for r in rows if r["high"] > r["low"]]).mark_rule(color=INK, strokeWidth=5, opacity=0.6)
    middle = math.sqrt(max(r["from"] for r in rows) * min(r["from"] for r in rows)) if rows else 0.0
    texts: list[alt.Chart] = []
    # Words stand on the side of their line where the chart is.
    for left in (True, False):
        words = plot([r for r in rows if (r["from"] < middle) == left]).encode(x=x, y=y, text="text:N")
        texts += rimmed(words, align="left" if left else "right", dx=6 if left else -6, fontSize=12)
    return [rule, span.encode(x=alt.X("low:Q"), x2=alt.X2("high:Q"), y=y), *texts]
