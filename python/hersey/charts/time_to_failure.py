"""Failure modes against age for each specimen, and the share of specimens that has failed."""

from __future__ import annotations

import math

import altair as alt

from hersey.charts.growth import age_axis, axis_end
from hersey.charts.style import (
    BLUE,
    INK,
    SECONDARY,
    SHAPES,
    WIDTH,
    Chart,
    Row,
    age_tip,
    categories,
    plot,
    ramp,
    rows_of,
    tip,
)
from hersey.life.growth.limit_ages import SURE, AgeAtLimit, rounded
from hersey.life.time_to_failure.estimate import ShareEnded, TimeToFailure

#: Units shown; pixels of each way in the row of a unit, and of the share ended.
_SHOWN, _STEP, _GAP, _SHARES = 24, 9, 14, 200
#: Stands for the failure modes that are not drawn.
_LATER = "later"


def time_to_failure_chart(found: TimeToFailure) -> Chart:
    """Return the failure modes of each specimen, above the share of new ones that has failed, if known.

    A mark with its 90 % interval for each mode, the most probable first one filled. Modes known only to come
    later are counted. Of many specimens those that fail first are shown.
    """
    greatest = max(each.age.last for each in found.units)
    shown = sorted(found.units, key=lambda each: each.age.age.value)[:_SHOWN]
    names = {each.unit for each in shown}
    order = [each.unit for each in found.units if each.unit in names]
    medians = [each.age.age.value for each in shown]
    end = axis_end(greatest, medians if found.b50 is None else [*medians, found.b50.age.value])
    scale = alt.Scale(domain=[0.0, end], nice=False)
    parts = [_units(found, order, end, scale)]
    if found.curve is not None:
        parts.append(_share(found.curve, found.age_unit, scale))
    title = alt.Title("Failure modes against age", subtitle=_heading(found, end))
    chart: Chart = alt.vconcat(*parts, title=title, spacing=16)
    return chart


def _heading(found: TimeToFailure, end: float) -> list[str]:
    words = [
        "marks: medians with 90 % intervals; filled: probably first; vertical ticks: last observation",
    ]
    far = [mode.name for mode in found.modes if not any(_is_drawn(each, end) for each in mode.ages.units)]
    if far:
        words.append(f"later for all specimens: {'; '.join(far)}")
    if len(found.units) > _SHOWN:
        words.append(f"{_SHOWN} of {len(found.units)} specimens are shown, those that fail first")
    return words


def _units(found: TimeToFailure, order: list[str], end: float, scale: alt.Scale) -> Chart:
    seen = [
        mode for mode in found.modes if any(a.unit in order and _is_drawn(a, end) for a in mode.ages.units)
    ]
    named = {mode.name: mode.name + (" (precursor)" if mode.sign else "") for mode in seen}
    last = [{"unit": each.unit, "last": each.age.last} for each in found.units if each.unit in order]
    names = list(named.values())
    y = alt.Y("unit:N", title=None, sort=order, scale=alt.Scale(domain=order))
    lanes = [*names, _LATER]
    apart = alt.YOffset("way:N", sort=lanes, scale=alt.Scale(domain=lanes, paddingOuter=0.5))
    look = alt.Legend(title=None, orient="top", columns=3, labelLimit=400, symbolOpacity=1)
    legend = look if names else None  # one without a name has no size
    shapes = [SHAPES[i % len(SHAPES)] for i in range(len(names))]
    colour = categories(alt.Color, "way", dict(zip(names, ramp(len(names)), strict=False)), legend)
    shape = categories(alt.Shape, "way", dict(zip(names, shapes, strict=True)), legend)
    tips = ["unit:N", "way:N", age_tip(found.age_unit), tip("low", "from"), tip("to", "to")]
    marks = {"x": age_axis("age", found.age_unit, scale), "color": colour, "shape": shape, "tooltip": tips}
    base = plot(_rows(found, named, order, end)).encode(y=y, yOffset=apart)
    spans, low = base.mark_rule(strokeWidth=2, clip=True), age_axis("low", found.age_unit, scale)
    row = _row(len(lanes))
    ticks = plot(last).mark_tick(color=INK, thickness=2, size=row - 6)
    later = plot(_later(found, order, end))
    words = later.mark_text(color=SECONDARY, fontSize=10, align="right", dx=-4, dy=5)
    first = base.transform_filter("datum.first != null").mark_point(filled=True, opacity=1, size=60)
    layers = [
        ticks.encode(y=y, x=age_axis("last", found.age_unit, scale)),
        spans.encode(x=low, x2="high:Q", color=colour),
        base.mark_point(fill="white", opacity=1, size=52, strokeWidth=1.6).encode(**marks),
        first.encode(**marks),
        words.encode(x=age_axis("end", found.age_unit, scale), y=y, yOffset=apart, text="words:N"),
    ]
    return alt.layer(*layers, width=WIDTH, height=row * len(order))


def _is_drawn(reached: AgeAtLimit, end: float) -> bool:
    """Whether more is known on the axis than that it comes later than the age followed shows."""
    age = reached.age
    return age.low < end and (age.value <= end or (math.inf > age.value and age.low < reached.shown(SURE)))


def _later(found: TimeToFailure, order: list[str], end: float) -> list[Row]:
    """How many failure modes of each unit are not drawn, and later than which age they come."""
    lows: dict[str, list[float]] = {name: [] for name in order}
    for mode in found.modes:
        for reached in mode.ages.units:
            if reached.unit in lows and not _is_drawn(reached, end):
                lows[reached.unit].append(reached.age.low)
    rows: list[Row] = []
    for name, each in lows.items():
        count = f"{len(each)} more mode{'s' * (len(each) > 1)}"
        count = count if len(each) < len(found.modes) else "all modes" if len(each) > 1 else "1 mode"
        if each:
            words = f"{count} later than {float(rounded(min(each))):,.10g} \N{RIGHTWARDS ARROW}"
            rows.append({"unit": name, "way": _LATER, "end": end, "words": words})
    return rows


def _rows(found: TimeToFailure, named: dict[str, str], order: list[str], end: float) -> list[Row]:
    """The age of each unit by each failure mode, as far as it is on the axis."""
    likely = {each.unit: max(each.first, key=lambda name: each.first[name]) for each in found.units}
    return [
        {
            "unit": reached.unit,
            "way": named[mode.name],
            "age": reached.age.value if reached.age.value <= end else None,
            "low": reached.age.low,
            "high": min(reached.age.high, end),
            "to": reached.age.high if math.isfinite(reached.age.high) else None,
            "first": named[mode.name]
            if likely[reached.unit] == mode.name and reached.age.value <= end
            else None,
        }
        for mode in found.modes
        if mode.name in named
        for reached in mode.ages.units
        if reached.unit in order and _is_drawn(reached, end)
    ]


def _row(ways: int) -> int:
    """Pixels of the row of a unit."""
    return _STEP * ways + _GAP


def _share(curve: ShareEnded, unit: str, scale: alt.Scale) -> Chart:
    """Predicted share failed of new specimens."""
    rows = rows_of(age=curve.age, median=100 * curve.median, low=100 * curve.low, high=100 * curve.high)
    shares = alt.Scale(domain=[0, 100])
    y = alt.Y("median:Q", title="Share failed (%)", scale=shares)
    x = age_axis("age", unit, scale)
    tips = [age_tip(unit), tip("median", "share failed (%)"), tip("low", "from"), tip("high", "to")]
    band = plot(rows).mark_area(color=BLUE, opacity=0.18, clip=True)
    layers = [
        band.encode(x=x, y=alt.Y("low:Q", title="Share failed (%)", scale=shares), y2="high:Q"),
        plot(rows).mark_line(color=BLUE, strokeWidth=2, clip=True).encode(x=x, y=y, tooltip=tips),
    ]
    words = "line and band: prediction for new specimens, 90 %"
    title = alt.Title("New specimens", subtitle=words, fontSize=13)
    return alt.layer(*layers, width=WIDTH, height=_SHARES, title=title)
