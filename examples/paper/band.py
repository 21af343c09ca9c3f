"""The band of drive speeds where the past decides: what can last there, and the edge between."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, INK, Chart, Row, plot
from hersey.motion.simulation import steady_start, stick_slip
from hersey.motion.sweep import sweep
from hersey.stability.hysteresis import (
    CyclesWithoutSticking,
    HysteresisBand,
    cycles_without_sticking,
    hysteresis,
)
from paper.figure import Claim, OwnFigure, Verdict, shown
from paper.sweep import Case

#: Drive speeds shown (in/s), and those of the panel that shows the lower edge enlarged, with its belt speeds.
SHOWN, ENLARGED, ENLARGED_BELT = (0.9, 2.4), (0.979, 1.003), (0.5, 1.5)
#: How far from the fold, from the lower edge, and from the unstable cycle a belt is tried, as shares.
AT_FOLD, AT_LOWER, OFF_CYCLE = 1e-6, 2e-4, 1e-3
#: Unstable cycles tried.
TRIED = 24
#: Greatest difference between two ways to the same speed, as a share, and that which is still alike.
SAME, ALIKE = 1e-3, 1e-2
#: Stick-slip cycles along the drive speed.
_VALUES = 121
#: Range of belt speeds shown (in/s), around stick speed and slip.
_BELT = (0.007, 7.0)
_ORANGE = "#d9730d"


@dataclass(frozen=True)
class Motions:
    """What lasts, or parts what lasts, along the drive speed; all speeds in in/s."""

    band: HysteresisBand
    drive_speed: FloatArray
    slowest: FloatArray
    fastest: FloatArray
    cycles: CyclesWithoutSticking


def band_figure() -> OwnFigure:
    """Draw belt speeds of every motion against drive speed, and check the edges by the motion itself."""
    case = Case()
    motions = motions_of(case)
    band = motions.band
    title = "The band where the past decides"
    subtitle = (
        "least and greatest belt speed of a lap; solid: lasts, dashed: unstable, the edge between sliding "
        "and stick-slip"
    )
    pair = alt.hconcat(_whole(motions), _lower_end(motions), spacing=28)
    chart = alt.vconcat(pair).properties(
        title=alt.Title(f"{title}: {band.lower:.4g} to {band.upper:.4g} in/s", subtitle=subtitle, offset=14)
    )
    claims = (ends_at_fold(case, motions), parts(case, motions.cycles), small_swing(case, motions))
    cycles = motions.cycles
    data = {
        "drive speed, stick-slip (in/s)": motions.drive_speed,
        "least belt speed, stick-slip (in/s)": motions.slowest,
        "greatest belt speed, stick-slip (in/s)": motions.fastest,
        "drive speed, without sticking (in/s)": cycles.drive_speed,
        "least belt speed, without sticking (in/s)": cycles.slowest,
        "greatest belt speed, without sticking (in/s)": cycles.fastest,
        "without sticking, stable (1) or not (0)": cycles.stable.astype(float),
    }
    return OwnFigure(
        "band", title, chart, claims, {name: tuple(column.tolist()) for name, column in data.items()}
    )


def motions_of(case: Case) -> Motions:
    """Return the band, the stick-slip cycles along it, and the cycles without sticking."""
    band = hysteresis(case.train, case.drag, sensitivity=False)
    drive = np.linspace(SHOWN[0], band.upper * (1.0 - AT_FOLD), _VALUES)
    swept = sweep(case.train, case.drag, drive_speed=drive)
    sticking = swept.kind.values == "stick_slip"
    # close to v_t the small oscillation shrinks as the square root of nothing: it needs laps of its own
    start, end = case.stick_speed, case.drag.transition_speed
    slowest = np.r_[np.geomspace(start, 0.5 * end, 81), np.linspace(0.5 * end, 0.999 * end, 161)[1:]]
    return Motions(
        band,
        drive[sticking],
        swept.speed_min.values[sticking],
        swept.speed_max.values[sticking],
        cycles_without_sticking(case.train, case.drag, slowest=slowest),
    )


def ends_at_fold(case: Case, motions: Motions) -> Claim:
    """Judge whether stick-slip ends where it meets the unstable cycle."""
    fold = motions.band.upper
    below, above = (
        stick_slip(case.train, case.drag, drive_speed=fold * (1.0 + side * AT_FOLD)) for side in (-1, 1)
    )
    met = float(motions.cycles.fastest[0])
    miss = abs(below.speed_max / met - 1.0)
    ends = below.kind == "stick_slip" and above.kind == "steady_sliding"
    return Claim(
        "Band",
        "Stick-slip ends at V*, where it meets the unstable cycle.",
        f"holds if a belt from rest sticks at {AT_FOLD:g} of V* below it and slides as much above, and both "
        f"cycles reach the same speed there within {SAME:.1%}; in direction if within {ALIKE:.0%}.",
        Verdict.of(ends and miss <= SAME, ends and miss <= ALIKE),
        f"At V* = {fold:.7g} in/s both reach {shown(met)} in/s, to {miss:.1g}.",
        {"fold_speed": fold, "fastest": met, "miss": miss},
    )


def parts(case: Case, cycles: CyclesWithoutSticking) -> Claim:
    """Judge whether the unstable cycle parts what slides from what sticks."""
    unstable = np.flatnonzero(~cycles.stable)
    places = np.unique(unstable[np.linspace(1, unstable.size * 0.95, TRIED).astype(int)])
    inside = [_from_cycle(case, cycles, i, 1.0 + OFF_CYCLE) for i in places]
    outside = [_from_cycle(case, cycles, i, 1.0 - OFF_CYCLE) for i in places]
    kept = sum(kind != "stick_slip" for kind in inside)
    lost = sum(kind == "stick_slip" for kind in outside)
    count = len(places)
    return Claim(
        "Band",
        "The unstable cycle is the edge: within it the belt comes to slide, outside it to stick.",
        f"holds if each of {count} cycles along it, started {OFF_CYCLE:.1%} slower at its slowest, ends "
        f"in stick-slip, and {OFF_CYCLE:.1%} faster does not; in direction if more than half do.",
        Verdict.of(kept == lost == count, min(kept, lost) > count / 2),
        f"Inside {kept} of {count} end without sticking, outside {lost} of {count} end sticking.",
        {"tried": count, "inside_slide": kept, "outside_stick": lost},
    )


def small_swing(case: Case, motions: Motions) -> Claim:
    """Judge whether the small oscillation below v_t lasts down to the lower edge and is the one drawn."""
    lower, cycles = motions.band.lower, motions.cycles
    below, above = (
        stick_slip(case.train, case.drag, drive_speed=lower * (1.0 + side * AT_LOWER), start="steady")
        for side in (-1, 1)
    )
    drive, slowest = cycles.drive_speed[cycles.stable], cycles.slowest[cycles.stable]
    miss = abs(above.speed_min / float(np.interp(lower * (1.0 + AT_LOWER), drive, slowest)) - 1.0)
    ends = below.kind == "stick_slip" and above.kind == "oscillation"
    return Claim(
        "Band",
        "Just below v_t a small oscillation without sticking lasts, down to the lower edge of the band.",
        f"holds if a belt started sliding swings without sticking at {AT_LOWER:g} of the lower edge above it "
        f"as slow as drawn within {SAME:.1%}, and sticks as much below; in direction if within {ALIKE:.0%}.",
        Verdict.of(ends and miss <= SAME, ends and miss <= ALIKE),
        f"The lower edge is {lower:.6g} in/s; just above it the belt swings between {shown(above.speed_min)} "
        f"and {shown(above.speed_max)} in/s, as drawn to {miss:.1g}.",
        {"lower": lower, "slowest": above.speed_min, "fastest": above.speed_max, "miss": miss},
    )


def _from_cycle(case: Case, cycles: CyclesWithoutSticking, place: int, share: float) -> str:
    """What a belt settles to from the slowest point of a lap, its speed changed by a factor."""
    speed = float(cycles.slowest[place]) * share
    start = steady_start(case.train, case.drag, speed)
    drive = float(cycles.drive_speed[place])
    return stick_slip(case.train, case.drag, drive_speed=drive, start=start).kind


def _whole(motions: Motions) -> Chart:
    band, top = motions.band, motions.fastest
    x = alt.X(
        "x:Q",
        title="Drive speed / v_t (v_t = 1 in/s)",
        scale=alt.Scale(domain=list(SHOWN), nice=False),
        axis=alt.Axis(tickCount=8, format=".1f"),
    )
    y = alt.Y(
        "y:Q",
        title="Belt speed (in/s)",
        scale=alt.Scale(type="log", domain=list(_BELT), nice=False),
        axis=alt.Axis(values=[0.01, 0.03, 0.1, 0.3, 1, 3], format="~g"),
    )
    stuck = [(motions.drive_speed, motions.slowest), (motions.drive_speed, top)]
    layers: list[alt.Chart] = [
        *_rule(x, y, band.lower, 0.03, f"lower edge {band.lower:.4f}", -8),
        *_rule(x, y, band.transition, 0.03, "v_t", 9),
        *_rule(x, y, band.upper, 0.1, f"V* = {band.upper:.4f}", 9),
        *_without_sticking(motions.cycles, SHOWN, x, y),
        *(_line(a, b, x, y, color=BLUE, strokeWidth=2.4) for a, b in stuck),
        *_steady(motions, SHOWN, x, y),
        *_label(1.3, 5.0, "stick-slip, greatest", x, y),
        *_label(1.08, 0.0124, "stick-slip, least: the stick speed", x, y),
        *_label(1.24, 1.95, "unstable, greatest", x, y),
        *_label(1.42, 0.13, "unstable, least", x, y),
        *_label(1.72, 1.37, "steady sliding", x, y),
    ]
    return alt.layer(*layers).properties(width=404, height=360)


def _lower_end(motions: Motions) -> Chart:
    x = alt.X(
        "x:Q",
        title="Drive speed / v_t (v_t = 1 in/s)",
        scale=alt.Scale(domain=list(ENLARGED), nice=False),
        axis=alt.Axis(values=[0.98, 0.985, 0.99, 0.995, 1.0], format="~g"),
    )
    y = alt.Y(
        "y:Q",
        title="Belt speed (in/s)",
        scale=alt.Scale(domain=list(ENLARGED_BELT), nice=False),
        axis=alt.Axis(tickCount=6),
    )
    band = motions.band
    layers: list[alt.Chart] = [
        *_rule(x, y, band.lower, 1.27, "lower edge", -8),
        *_rule(x, y, band.transition, 1.27, "v_t", 9),
        *_without_sticking(motions.cycles, ENLARGED, x, y),
        *_steady(motions, ENLARGED, x, y),
        *_label(0.9831, 1.028, "small oscillation", x, y),
        *_label(0.9838, 1.42, "unstable", x, y),
    ]
    return alt.layer(*layers).properties(
        width=210, height=360, title=alt.Title("lower edge, enlarged", fontSize=12, frame="group")
    )


def _without_sticking(
    cycles: CyclesWithoutSticking, shown_from_to: tuple[float, float], x: alt.X, y: alt.Y
) -> list[alt.Chart]:
    """Least and greatest speeds of the unstable cycle, dashed, and of the small oscillation."""
    layers = []
    inside = (cycles.drive_speed >= shown_from_to[0]) & (cycles.drive_speed <= shown_from_to[1])
    for which, look in (
        (~cycles.stable, {"strokeDash": [5, 3], "strokeWidth": 1.8}),
        (cycles.stable, {"strokeWidth": 2.4}),
    ):
        here = which & inside
        for belt in (cycles.slowest, cycles.fastest):
            layers.append(_line(cycles.drive_speed[here], belt[here], x, y, color=_ORANGE, **look))
    return layers


def _steady(motions: Motions, ends: tuple[float, float], x: alt.X, y: alt.Y) -> list[alt.Chart]:
    """Steady sliding: dashed below v_t, where it does not last."""
    middle = motions.band.transition
    low, high = np.linspace(ends[0], middle, 20), np.linspace(middle, ends[1], 60)
    return [
        _line(low, low, x, y, color=INK, strokeDash=[2, 3], strokeWidth=1.4),
        _line(high, high, x, y, color=INK, strokeWidth=2.4),
    ]


def _line(drive: FloatArray, belt: FloatArray, x: alt.X, y: alt.Y, **look: Any) -> alt.Chart:
    rows: list[Row] = [
        {"x": float(a), "y": float(b), "order": i} for i, (a, b) in enumerate(zip(drive, belt, strict=True))
    ]
    chart: alt.Chart = plot(rows).mark_line(clip=True, **look).encode(x=x, y=y, order="order:Q")
    return chart


def _rule(x: alt.X, y: alt.Y, at: float, height: float, name: str, aside: int) -> list[alt.Chart]:
    """A drive speed, named along its line from a height on."""
    mark = plot([{"x": at, "y": height, "name": name}])
    text = mark.mark_text(angle=270, align="left", dy=aside, color=INK, fontSize=12)
    return [
        mark.mark_rule(color="#999", strokeWidth=1).encode(x=x),
        text.encode(x=x, y=y, text="name:N"),
    ]


def _label(at: float, height: float, name: str, x: alt.X, y: alt.Y) -> list[alt.Chart]:
    """The name of a line; a white edge keeps grid lines out of the letters."""
    mark = plot([{"x": at, "y": height, "name": name}])
    halo = mark.mark_text(align="left", fontSize=12, stroke="white", strokeWidth=4)
    text = mark.mark_text(align="left", fontSize=12, color=INK)
    return [layer.encode(x=x, y=y, text="name:N") for layer in (halo, text)]
