"""Exponents of damping in speed against what each regime of lubrication predicts."""

from __future__ import annotations

import math
from collections.abc import Sequence

import altair as alt

from hersey.charts.style import (
    BLUE,
    INK,
    RED,
    SECONDARY,
    SHADE,
    WIDTH,
    Chart,
    Row,
    categories,
    plot,
    rimmed,
    tip,
)
from hersey.schema.domain import TORQUE, Domain
from hersey.units import celsius
from hersey.verdict.regime import BranchExponent, Regime

#: What the branches are called.
_BRANCHES = {"ehl": "rising {what}", "mixed": "falling {what}", "all": "all speeds"}
#: What rises and falls.
_WHAT = ("torque", "friction")
#: Colour and shape of each.
_LOOKS = {
    "rising torque": (BLUE, "circle"),
    "falling torque": (RED, "square"),
    "rising friction": (BLUE, "circle"),
    "falling friction": (RED, "square"),
    "all speeds": (BLUE, "diamond"),
}
#: The axis shows at least these exponents.
_LEAST, _GREATEST = -1.3, 0.1
#: Height of a row; width that is counted on to keep names apart, that of a letter, height of a line, pixels.
_ROW, _NARROW, _LETTER, _LINE = 24, 250, 6.2, 14
#: Shorter names of regimes, for the picture alone.
_SHORT = {
    "dry Coulomb friction or a rigid film": "dry or rigid",
    "rigid piezoviscous film": "rigid piezoviscous",
    "Dowson-Higginson EHL": "Dowson-Higginson",
    "falling branch": "torque falls",
}


_AXIS = alt.Axis(tickCount=6, format=".1f")


def regime_chart(result: Regime) -> Chart:
    """Return the exponents of a verdict on the regime."""
    rows = [exponent_row(branch, result.domain) for branch in result.exponents]
    return exponent_chart(rows, [(h.name, h.low, h.high) for h in result.hypotheses])


def exponent_row(branch: BranchExponent, of: Domain = TORQUE) -> Row:
    """Return the row of an exponent at one temperature on one branch."""
    return {
        "where": "all" if branch.temperature is None else f"{celsius(branch.temperature):.0f} °C",
        "order": branch.temperature or 0.0,
        "branch": _BRANCHES[branch.branch].format(what="torque" if of.is_torque else "friction"),
        "value": branch.exponent.value,
        "low": branch.exponent.low,
        "high": branch.exponent.high,
        "speeds": f"{of.between(branch.speed_low, branch.speed_high)}, {branch.points} dwells",
    }


def exponent_chart(
    rows: list[Row],
    regimes: Sequence[tuple[str, float | None, float]],
    solved: float | None = None,
) -> Chart:
    """Return exponents with their intervals over named regimes, each from a least to a greatest exponent.

    ``solved`` is what the film of the contact gives, if it is known.
    """
    shown = [row | {"text": ""} for row in rows]
    for row in shown:  # an interval that is not shown has no length
        row |= {end: row["value"] for end in ("low", "high") if row[end] is None}
    low = min([_LEAST, *(r["low"] for r in shown)]) - 0.05
    high = max([_GREATEST, *(r["high"] for r in shown)]) + 0.05
    shown[-1]["text"] = _words(rows[-1])
    places = sorted({(r["order"], r["where"]) for r in shown})
    order = [where for _, where in places]
    nip: list[Row] = []
    if solved is not None:
        text = f"{solved:.2f} computed".replace("-", "\u2212")
        nip = [{"where": "contact", "value": solved, "text": text}]
        order.append("contact")
    scale = alt.Scale(domain=[low, high], nice=False)
    x = alt.X("value:Q", title="Exponent of damping in speed (no unit)", scale=scale, axis=_AXIS)
    y = alt.Y("where:N", title=None, sort=order, axis=alt.Axis(grid=False))
    title = alt.Title("Exponent of damping, with 95 % intervals", subtitle=_subtitle(shown))
    layers = [
        *_regimes(regimes, scale, low, high),
        *_exponents(shown, x, y, scale, 0.5 * (low + high)),
        *_nip(nip, x, y, 0.5 * (low + high)),
    ]
    return alt.layer(*layers, title=title, width=WIDTH, height=_ROW * max(len(order), 3))


def _words(row: Row) -> str:
    value, low, high = row["value"], row["low"], row["high"]
    if low is None or high is None:
        return f"{value:.2f}".replace("-", "\u2212")
    places = 2 if high - low > 0.02 else 3
    return f"{value:.{places}f} [{low:.{places}f}, {high:.{places}f}]".replace("-", "\u2212")


def _subtitle(rows: list[Row]) -> str:
    seen = {r["branch"] for r in rows}
    marks = {"rising": "circles", "falling": "squares"}
    shapes = {f"{does} {what}": f"{mark}: {does} {what}" for does, mark in marks.items() for what in _WHAT}
    said = [words for branch, words in shapes.items() if branch in seen]
    return "; ".join([*said, "grey: predicted by each regime"]).capitalize() + "."


def _regimes(
    regimes: Sequence[tuple[str, float | None, float]], scale: alt.Scale, low: float, high: float
) -> list[alt.Chart]:
    """Ranges shaded (an open one down to the axis), single exponents dashed, all named above."""
    named: list[Row] = [
        {"name": name, "low": low if least is None or math.isinf(least) else least, "high": greatest}
        for name, least, greatest in regimes
    ]
    x = alt.X("low:Q", scale=scale)
    shade = plot([h for h in named if h["high"] != h["low"]]).mark_rect(color=SHADE, clip=True)
    rule = plot([h for h in named if h["high"] == h["low"]]).mark_rule(color=SECONDARY, strokeDash=[4, 3])
    layers = [shade.encode(x=x, x2=alt.X2("high:Q")), rule.encode(x=x)]
    ends = [-math.inf] * len(named)
    for each in sorted(named, key=lambda h: h["low"] + h["high"]):
        middle = (each["low"] + each["high"]) / 2
        at = _NARROW * (middle - low) / (high - low)
        short = _SHORT.get(str(each["name"]), str(each["name"]))
        half = 0.5 * _LETTER * len(short)
        side = "left" if at < half else "right" if at > _NARROW - half else "center"
        left = {"left": at, "right": at - 2 * half, "center": at - half}[side]
        row = next(i for i, end in enumerate(ends) if left > end + 6)
        ends[row] = left + 2 * half
        name = plot([{"text": short, "low": middle}])
        text = name.mark_text(align=side, fontSize=12, color=SECONDARY)  # type: ignore[arg-type]  # of three
        layers.append(text.encode(x=x, y=alt.value(-9 - _LINE * row), text=alt.Text("text:N")))
    return layers


def _exponents(rows: list[Row], x: alt.X, y: alt.Y, scale: alt.Scale, middle: float) -> list[alt.Chart]:
    seen = [name for name in _LOOKS if any(r["branch"] == name for r in rows)]
    color = categories(alt.Color, "branch", {name: _LOOKS[name][0] for name in seen}, None)
    shape = categories(alt.Shape, "branch", {name: _LOOKS[name][1] for name in seen}, None)
    tips = [
        alt.Tooltip("where:N", title="where"),
        alt.Tooltip("branch:N", title="branch"),
        tip("value", "exponent"),
        tip("low", "95 % from"),
        tip("high", "to"),
        alt.Tooltip("speeds:N", title="speeds"),
    ]
    bars = plot(rows).mark_rule(strokeWidth=1.6, color=INK)
    dots = plot(rows).mark_point(filled=True, size=60, opacity=1)
    last, right = rows[-1], rows[-1]["value"] < middle
    end, side, dx = ("high", "left", 10) if right else ("low", "right", -10)
    look: Row = {"align": side, "dx": dx, "fontWeight": "bold", "fontSize": 12}
    words = plot([last]).encode(x=alt.X(f"{end}:Q", scale=scale), y=y, text="text:N")
    return [
        bars.encode(x=alt.X("low:Q", scale=scale), x2=alt.X2("high:Q"), y=y),
        dots.encode(x=x, y=y, color=color, shape=shape, tooltip=tips),
        *rimmed(words, **look),
    ]


def _nip(rows: list[Row], x: alt.X, y: alt.Y, middle: float) -> list[alt.Chart]:
    """What the film of the contact gives, under the rest."""
    if not rows:
        return []
    mark = plot(rows).mark_point(shape="triangle-down", filled=True, size=60, color=SECONDARY, opacity=1)
    side: Row = {"align": "left", "dx": 10} if rows[0]["value"] < middle else {"align": "right", "dx": -10}
    words = plot(rows).mark_text(color=SECONDARY, fontSize=12, **side)
    return [mark.encode(x=x, y=y), words.encode(x=x, y=y, text="text:N")]
