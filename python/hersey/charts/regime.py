"""Exponents of damping in speed against what each regime of lubrication predicts."""

from __future__ import annotations

import math
from collections.abc import Sequence

import altair as alt

from hersey.charts.labels import apart
from hersey.charts.style import BLUE, HEIGHT, INK, ORANGE, WIDTH, Chart, Row, plot, tip
from hersey.document.parts import BranchPart
from hersey.units import celsius, rpm
from hersey.verdict.regime import BranchExponent, Regime

#: What the branches are called.
_BRANCHES = {"ehl": "rising torque", "mixed": "falling torque", "all": "all speeds"}
#: Colour and shape of each.
_LOOKS = {
    "rising torque": (BLUE, "circle"),
    "falling torque": (ORANGE, "square"),
    "all speeds": ("#555", "diamond"),
}
#: The axis shows at least these exponents.
_LEAST, _GREATEST = -1.3, 0.1


def regime_chart(result: Regime) -> Chart:
    """Return the exponents of a verdict on the regime."""
    rows = [exponent_row(branch) for branch in result.exponents]
    return exponent_chart(rows, [(h.name, h.low, h.high) for h in result.hypotheses])


def exponent_row(branch: BranchExponent | BranchPart) -> Row:
    """Return the row of an exponent at one temperature on one branch."""
    return {
        "where": "all" if branch.temperature is None else f"{celsius(branch.temperature):.0f} °C",
        "order": branch.temperature or 0.0,
        "branch": _BRANCHES[branch.branch],
        "value": branch.exponent.value,
        "low": branch.exponent.low,
        "high": branch.exponent.high,
        "speeds": f"{rpm(branch.speed_low):.3g} to {rpm(branch.speed_high):.3g} rpm, {branch.points} dwells",
    }


def exponent_chart(rows: list[Row], regimes: Sequence[tuple[str, float | None, float]]) -> Chart:
    """Return exponents with their intervals over named regimes, each from a least to a greatest exponent."""
    low = min([_LEAST, *(r["low"] for r in rows)]) - 0.05
    high = max([_GREATEST, *(r["high"] for r in rows)])
    scale = alt.Scale(domain=[low, high], nice=False)
    title = alt.Title(
        "Exponent of damping, with 95 % intervals", subtitle="against what each regime predicts"
    )
    layers = [*_regimes(regimes, scale, low, high), *_exponents(rows, scale)]
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def _regimes(
    regimes: Sequence[tuple[str, float | None, float]], scale: alt.Scale, low: float, high: float
) -> list[alt.Chart]:
    """Ranges shaded (an open one down to the axis), single exponents dashed, all named on the right."""
    named: list[Row] = [
        {"name": name, "low": low if least is None or math.isinf(least) else least, "high": greatest}
        for name, least, greatest in regimes
    ]
    y = alt.Y("low:Q", scale=scale)
    shade = plot([h for h in named if h["high"] != h["low"]]).mark_rect(color="#bbb", opacity=0.5, clip=True)
    rule = plot([h for h in named if h["high"] == h["low"]]).mark_rule(color=INK, strokeDash=[4, 3])
    middles = [(max(h["low"], low) + h["high"]) / 2 for h in named]
    heights = apart([HEIGHT * (middle - low) / (high - low) for middle in middles])
    names: list[Row] = [
        {"text": h["name"], "down": HEIGHT - up} for h, up in zip(named, heights, strict=True)
    ]
    text = plot(names).mark_text(align="left", dx=6, color=INK)
    return [
        shade.encode(y=y, y2=alt.Y2("high:Q")),
        rule.encode(y=y),
        text.encode(x=alt.value(WIDTH), y=alt.Y("down:Q", scale=None, axis=None), text=alt.Text("text:N")),
    ]


def _exponents(rows: list[Row], scale: alt.Scale) -> list[alt.Chart]:
    branches = [name for name in _LOOKS if any(r["branch"] == name for r in rows)]
    legend = alt.Legend(orient="top", title=None)
    colors = alt.Scale(domain=branches, range=[_LOOKS[name][0] for name in branches])
    shapes = alt.Scale(domain=branches, range=[_LOOKS[name][1] for name in branches])
    color = alt.Color("branch:N", scale=colors, legend=legend)
    shape = alt.Shape("branch:N", scale=shapes, legend=legend)
    tips = [tip("value", "exponent"), tip("low", "95 % from"), tip("high", "to"), alt.Tooltip("speeds:N")]
    x = alt.X("where:N", title=None, sort=alt.SortField("order"), axis=alt.Axis(labelAngle=0))
    y = alt.Y("value:Q", title="exponent of damping in speed", scale=scale)
    bars = plot(rows).mark_rule(strokeWidth=3)
    dots = plot(rows).mark_point(filled=True, size=90)
    return [
        bars.encode(x=x, y=alt.Y("low:Q", scale=scale), y2=alt.Y2("high:Q"), color=color),
        dots.encode(x=x, y=y, color=color, shape=shape, tooltip=tips),
    ]
