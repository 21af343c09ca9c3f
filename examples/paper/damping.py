"""Figs. 3 and 7: damping against speed, its exponents, and where they cross -1."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.labels import apart
from hersey.charts.style import HEIGHT, INK, WIDTH, Chart, Row, levels, logarithmic, plot
from hersey.damping.dwells.groups import SAME_SPEED
from hersey.units import rpm
from paper.dwells import dots, lines, marks, span, speed_axis, table, unit_of
from paper.figure import ABOUT, Claim, PaperFigure, Verdict
from paper.measured import Branch, Measured

#: Exponents of damping that the paper measured, and that of Eq. 10.
_MEASURED, _THEORY = (-0.8, -0.6), -0.7
#: Neighbours closer than this ratio of speeds tell no local exponent.
_STEP = 1.15
_LOCAL_HEIGHT = 170
#: Room of `logarithmic` at either end of an axis, pixels.
PADDING = 12


def figure_3(measured: Measured) -> PaperFigure:
    """Draw damping against speed of a log where torque rises, and judge what is said of it."""
    claims = (is_power_law(measured), in_range(measured), is_theory(measured), is_cleaner(measured))
    title = "Damping against speed and temperature"
    subtitle = f"{measured.name}: dwells; lines: power of speed where torque rises, with its exponent"
    panel = _damping(measured, measured.rising)
    chart = panel.properties(title=alt.Title(f"Fig. 3: {title}", subtitle=subtitle))
    return PaperFigure(3, title, chart, claims, table(measured))


def figure_7(measured: Measured) -> PaperFigure:
    """Draw damping where its exponent crosses -1, and judge what is said of it."""
    claims = (crosses(measured), crosses_hotter(measured))
    title = "Damping through the transition"
    subtitle = (
        f"{measured.name}: dwells; above: power laws, dashed where torque falls with speed; below: exponent "
        "between neighbouring speeds"
    )
    chart = alt.vconcat(_damping(measured, measured.branches), _local(measured), spacing=14).properties(
        title=alt.Title(f"Fig. 7: {title}", subtitle=subtitle)
    )
    return PaperFigure(7, title, chart, claims, table(measured))


def is_power_law(measured: Measured) -> Claim:
    """Judge whether one power of speed describes damping at each temperature."""
    misses = [
        branch.damping(measured.speed[branch.index]) / measured.damping[branch.index] - 1.0
        for branch in measured.rising
    ]
    all_ = np.concatenate(misses) if misses else np.array([np.nan])
    worst, typical = float(np.abs(all_).max()), float(np.sqrt(np.mean(all_**2)))
    return Claim(
        "Fig. 3",
        "Damping varies as a power of speed.",
        f"holds if the power law of each temperature misses no dwell of the rising branch by over "
        f"{ABOUT:.0%}; in direction if its root mean square does not.",
        Verdict.of(worst <= ABOUT, typical <= ABOUT),
        f"It misses them by {typical:.1%} (root mean square), by {worst:.1%} at most.",
        {"largest_miss": worst, "typical_miss": typical},
    )


def in_range(measured: Measured) -> Claim:
    """Judge whether the exponents of damping are those that the paper measured."""
    values = [branch.exponent.value for branch in measured.rising]
    low, high = _MEASURED
    return Claim(
        "Fig. 3",
        "The exponent of damping in speed is between -0.6 and -0.8.",
        "holds if it is at every temperature, on the rising branch; in direction if it is between -1 and 0.",
        Verdict.of(
            bool(values) and all(low <= value <= high for value in values),
            bool(values) and all(-1.0 < value < 0.0 for value in values),
        ),
        f"Exponents with 95 % intervals: {_told(measured.rising)}.",
        {f"exponent{branch.where}": branch.exponent.value for branch in measured.rising},
    )


def is_theory(measured: Measured) -> Claim:
    """Judge whether the exponent is that of Eq. 10."""
    c = measured.surface.c
    away = abs(c.value - _THEORY)
    return Claim(
        "Fig. 3",
        "That is the exponent of theory, -0.7 (Eq. 10).",
        f"holds if the exponent of the whole surface is within {ABOUT:g} of -0.7; in direction if between -1 "
        "and 0.",
        Verdict.of(away <= ABOUT, -1.0 < c.value < 0.0),
        f"The surface has {c}; -0.7 is {'inside' if c.low <= _THEORY <= c.high else 'outside'} the interval. "
        "An exponent near it does not show by itself which film it is.",
        {"exponent": c.value, "low": c.low, "high": c.high},
    )


def is_cleaner(measured: Measured) -> Claim:
    """Judge whether dividing torque by speed makes data cleaner; residuals in logarithms cannot change."""
    statistics = measured.surface.statistics
    torque, damping = statistics.r_squared_torque, statistics.r_squared_damping
    return Claim(
        "Fig. 3",
        "Torque divided by speed is cleaner data.",
        "holds if the dwells scatter less about the law, as a share of the value; in direction if R2 alone "
        "grows.",
        Verdict.of(False, damping > torque),
        f"R2 is {damping:.4f} for damping and {torque:.4f} for torque, of the same residuals: a share of "
        f"{np.sqrt(np.mean(measured.surface.residuals**2)):.2%} in both. What changes is the steepness of "
        "the curve.",
        {"r_squared_damping": damping, "r_squared_torque": torque},
    )


def crosses(measured: Measured) -> Claim:
    """Judge whether the exponent is below -1 on one branch and between -1 and 0 on the other."""
    falling, rising = [b for b in measured.branches if b.falls], measured.rising
    both = bool(falling) and bool(rising)
    apart_ = all(b.exponent.high < -1.0 for b in falling) and all(
        b.exponent.low > -1.0 and b.exponent.high < 0.0 for b in rising
    )
    near = all(b.exponent.value < -1.0 for b in falling) and all(
        -1.0 < b.exponent.value < 0.0 for b in rising
    )
    return Claim(
        "Fig. 7",
        "The exponent is below -1 where lubrication is mixed or boundary, and between -1 and 0 under a film.",
        "holds if the 95 % intervals of every falling and every rising branch lie on those sides; in "
        "direction if the values do. A log with one branch alone does not bear it out.",
        Verdict.of(both and apart_, both and near),
        f"Falling: {_told(falling)}. Rising: {_told(rising)}.",
        {f"falling{b.where}": b.exponent.value for b in falling}
        | {f"rising{b.where}": b.exponent.value for b in rising},
    )


def crosses_hotter(measured: Measured) -> Claim:
    """Judge whether the exponent crosses -1 at low speed and high temperature."""
    known = [kelvin for kelvin, _ in measured.groups if kelvin is not None]
    speeds = [measured.surface.transition_speed(kelvin) for kelvin in known]
    falls, last = bool(speeds) and np.isfinite(speeds[0]), speeds[-1] if speeds else np.nan
    first = speeds[0] if speeds else np.nan
    seen = {kelvin for kelvin in known for b in measured.branches if b.falls and b.kelvin == kelvin}
    cold = not seen or min(seen) > known[0]
    return Claim(
        "Fig. 7",
        "The exponent crosses -1 at low speed and high temperature.",
        "holds if the transition speed rises with temperature, and the coldest dwells show no falling "
        "branch; in direction if it rises.",
        Verdict.of(falls and last > first and cold, falls and last > first),
        f"The transition is at {rpm(first):.3g} rpm at the lowest temperature and at {rpm(last):.3g} rpm at "
        "the highest."
        if falls
        else "The log shows no transition.",
        {"transition_speed_coldest": first, "transition_speed_hottest": last},
    )


def local_exponents(measured: Measured) -> list[tuple[float | None, FloatArray, FloatArray]]:
    """Return by temperature (K) the exponents of damping between neighbouring speeds, and those speeds."""
    found = []
    for kelvin, group in measured.groups:
        speed, damping = (np.log(values[group]) for values in (measured.speed, measured.damping))
        order = np.argsort(speed)
        steps = np.flatnonzero(np.diff(speed[order]) > SAME_SPEED) + 1
        means = [(speed[part].mean(), damping[part].mean()) for part in np.split(order, steps)]
        z, y = np.array(means).T
        wide = np.diff(z) > np.log(_STEP)
        middle = np.exp(0.5 * (z[1:] + z[:-1]))
        found.append((kelvin, middle[wide], (np.diff(y) / np.diff(z))[wide]))
    return found


def _damping(measured: Measured, branches: list[Branch]) -> Chart:
    """Damping against speed on logarithmic axes, with power laws, the exponents of those that rise named."""
    factor, unit = unit_of(measured)
    x = speed_axis(measured)
    y = alt.Y("y:Q", title=f"Damping ({unit}·s/rad)", scale=logarithmic())
    drawn = {
        falls: [
            (b.kelvin, speed, factor * b.damping(speed))
            for b in branches
            if b.falls == falls
            for speed in [span(measured, b)]
        ]
        for falls in (False, True)
    }
    layers = [
        lines(measured, drawn[False]),
        lines(measured, drawn[True], strokeDash=[5, 3]),
        marks(measured, factor * measured.damping, y, x),
        _names(measured, branches),
    ]
    return alt.layer(*layers, width=WIDTH, height=HEIGHT)


def _names(measured: Measured, branches: list[Branch]) -> alt.Chart:
    """Exponents beside the fast ends of rising branches."""
    damping = np.log(measured.damping)
    low, high = float(damping.min()), float(damping.max())
    rising = [b for b in branches if not b.falls]
    ends = [float(np.log(b.damping(span(measured, b)[-1:])[0])) for b in rising]
    room = HEIGHT - 2 * PADDING
    ups = apart([PADDING + room * (end - low) / max(high - low, 1e-9) for end in ends])
    rows: list[Row] = [
        {"down": HEIGHT - up, "text": f"exponent {b.exponent.value:.2f}"}
        for b, up in zip(rising, ups, strict=True)
    ]
    names: alt.Chart = (
        plot(rows)
        .mark_text(align="left", dx=6, color=INK, fontSize=12)
        .encode(x=alt.value(WIDTH), y=alt.Y("down:Q", scale=None, axis=None), text=alt.Text("text:N"))
    )
    return names


def _local(measured: Measured) -> Chart:
    """Exponents between neighbouring speeds, with the levels that they are compared with."""
    local = local_exponents(measured)
    values = np.concatenate([each for _, _, each in local])
    domain = (min(-1.4, float(values.min()) - 0.1), max(-0.4, float(values.max()) + 0.1))
    y = alt.Y("y:Q", title="Exponent of damping (1)", scale=alt.Scale(domain=list(domain), nice=False))
    layers = [
        lines(measured, local, strokeWidth=1.0).encode(y=y),
        dots(measured, local, y, speed_axis(measured)),
    ]
    named = levels([(-1.0, "-1: torque turns"), (_THEORY, "-0.7: Eq. 10")], domain, _LOCAL_HEIGHT)
    return alt.layer(*layers, *named, width=WIDTH, height=_LOCAL_HEIGHT)


def _told(branches: list[Branch]) -> str:
    return (
        ", ".join(
            f"{b.exponent.value:.3f} [{b.exponent.low:.3f}, {b.exponent.high:.3f}]{b.where}" for b in branches
        )
        or "none"
    )
