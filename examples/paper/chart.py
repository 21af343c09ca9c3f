"""The band of any drive in one chart: in scaled form only damping number and stick speed remain.

With time in units of sqrt(m/k) and speed in units of v_t, a drive is its damping number
F_t / (v_t sqrt(k m)), its stick speed v_s / v_t and the two exponents.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import INK, WIDTH, Chart, Row, plot, ramp
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag
from hersey.motion.sweep import sweep
from hersey.stability.hysteresis import cycles_without_sticking, hysteresis
from hersey.stability.hysteresis_sweep import hysteresis_sweep
from paper.figure import Claim, OwnFigure, Verdict
from paper.sweep import Case

#: Damping numbers: few where the curves are nearly straight and dear to compute.
DAMPING = np.r_[np.geomspace(1e-3, 0.1, 24, endpoint=False), np.geomspace(0.1, 30.0, 60)]
#: Stick speeds over v_t.
STICK_SPEEDS = (1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3)
CLOSURES = ("retained", "stiction")
#: Drives that are to agree, how closely, the seed of their draw, and how many decades each parameter spans.
DRIVES, AGREEMENT, SEED, DECADES = 200, 1e-9, 13, 6.0
#: How far from V* they are simulated, as a share.
ASIDE = 1e-5
#: V*/v_t shown, its ticks, and the damping number at which each curve is named.
_SHOWN = {"retained": (1.0, 25.0), "stiction": (1.0, 120.0)}
_TICKS = (1, 2, 3, 5, 10, 20, 50, 100)
_NAMED = {
    "retained": (6.0, 6.0, 6.0, 3.5, 2.2, 1.2),
    "stiction": (3.0, 4.0, 6.0, 6.0, 3.5, 1.5),
}
_UNIT = Drivetrain(1.0, 1.0)


@dataclass(frozen=True)
class BandChart:
    """V*/v_t by closure and stick speed (rows) at the damping numbers (columns).

    ``released`` is V*/v_t of laps released at the stick speed: less than that of ``retained`` where a
    deeper stick-slip lasts longer.
    """

    damping: FloatArray
    fold: Mapping[str, FloatArray]
    released: FloatArray

    def at(self, closure: str, stick_speed: float, damping: float) -> tuple[float, float]:
        """Return V*/v_t of a curve by straight lines in logarithms, and how far these may miss, as a share.

        A straight line misses a curve by an eighth of its second difference.
        """
        x, y = np.log(self.damping), np.log(self.fold[closure][STICK_SPEEDS.index(stick_speed)])
        right = int(np.clip(np.searchsorted(self.damping, damping), 2, x.size - 2))
        bend = np.abs(np.diff(y[right - 2 : right + 2], 2)).max()
        return float(np.exp(np.interp(np.log(damping), x, y))), float(bend) / 8.0


def chart_figure() -> OwnFigure:
    """Draw V*/v_t against damping number for both closures, and judge that it holds for any drive."""
    chart = chart_of()
    title = "V* of any drive"
    subtitle = "exponents of the paper; each curve is a stick speed v_s / v_t, named on it"
    panels = alt.vconcat(*(_panel(chart, closure) for closure in CLOSURES), spacing=18).properties(
        title=alt.Title(title, subtitle=subtitle, offset=14)
    )
    data = {"damping number F_t / (v_t sqrt(k m))": chart.damping}
    for closure in CLOSURES:
        for speed, curve in zip(STICK_SPEEDS, chart.fold[closure], strict=True):
            data[f"V*/v_t, {closure}, v_s/v_t = {speed:g}"] = curve
    for speed, curve in zip(STICK_SPEEDS, chart.released, strict=True):
        data[f"V*/v_t of laps released at v_s, v_s/v_t = {speed:g}"] = curve
    columns = {name: tuple(column.tolist()) for name, column in data.items()}
    return OwnFigure("chart", title, panels, (reads_baseline(chart), scales()), columns)


def chart_of() -> BandChart:
    """Compute the chart."""
    fold = {}
    for closure in CLOSURES:
        grid = hysteresis_sweep(
            _UNIT, _drag(1.0, closure), transition_force=DAMPING, stick_speed=STICK_SPEEDS
        )
        fold[closure] = grid.upper.values.T
    drags = (_drag(float(damping)) for damping in DAMPING)
    released = [cycles_without_sticking(_UNIT, drag, slowest=STICK_SPEEDS).drive_speed for drag in drags]
    return BandChart(DAMPING, fold, np.array(released).T)


def reads_baseline(chart: BandChart) -> Claim:
    """Judge whether the chart, read at the baseline, gives the V* of the baseline."""
    case = Case()
    number = damping_number(case)
    read, resolution = chart.at("retained", case.stick_speed, number)
    band = hysteresis(case.train, case.drag, sensitivity=False)
    miss = abs(read * band.transition / band.upper - 1.0)
    return Claim(
        "Chart",
        "Read at the damping number of the baseline, the chart gives the V* of the baseline.",
        "holds if they differ by no more than straight lines between the points of the chart can miss; in "
        "direction if by ten times that.",
        Verdict.of(miss <= resolution, miss <= 10.0 * resolution),
        f"At {number:.6g} the chart reads {read:.5g}, the band itself is {band.upper:.7g}: {miss:.1g} apart, "
        f"where straight lines may miss by {resolution:.1g}.",
        {
            "damping_number": number,
            "read": read,
            "fold_speed": band.upper,
            "miss": miss,
            "resolution": resolution,
        },
    )


def scales() -> Claim:
    """Judge whether drives of one damping number and one v_s/v_t have one V*/v_t, whatever their size."""
    case = Case()
    number, stick = damping_number(case), case.stick_speed / case.drag.transition_speed
    decades = np.random.default_rng(SEED).uniform(-DECADES / 2.0, DECADES / 2.0, (3, DRIVES))
    stiffness, mass, speed = 10.0**decades
    given = {
        "stiffness": stiffness,
        "mass": mass,
        "transition_speed": speed,
        "transition_force": number * speed * np.sqrt(stiffness * mass),
        "stick_speed": stick * speed,
    }
    apart, confirmed = {}, 0
    for closure in CLOSURES:
        drag = _drag(1.0, closure)
        fold = hysteresis_sweep(_UNIT, drag, **given, zip=True).upper.values
        apart[closure] = float((fold / speed).max() / (fold / speed).min() - 1.0)
        # the band is found in scaled form; the motion is not, and so it bears witness
        below, above = (
            sweep(_UNIT, drag, drive_speed=fold * (1.0 + side * ASIDE), **given, zip=True).kind.values
            for side in (-1, 1)
        )
        confirmed += int(np.sum((below == "stick_slip") & (above == "steady_sliding")))
    worst, asked = max(apart.values()), DRIVES * len(CLOSURES)
    return Claim(
        "Chart",
        "Only damping number, v_s/v_t and the exponents count: drives that share them share V*/v_t.",
        f"holds if {DRIVES} drives of the baseline's numbers, k, m and v_t over {DECADES:g} decades each, "
        f"agree to {AGREEMENT:g} with either closure, and simulated from rest all stick at {ASIDE:g} of V* "
        "below it and slide as much above; in direction if they agree to 0.1 %.",
        Verdict.of(worst <= AGREEMENT and confirmed == asked, worst <= 1e-3),
        f"They agree to {apart['retained']:.1g} (retained) and {apart['stiction']:.1g} (stiction); "
        f"simulation confirms {confirmed} of {asked}.",
        {"drives": asked, "confirmed": confirmed}
        | {f"apart_{closure}": value for closure, value in apart.items()},
    )


def damping_number(case: Case) -> float:
    """Return F_t / (v_t sqrt(k m))."""
    drag, train = case.drag, case.train
    return drag.transition_force / (drag.transition_speed * float(np.sqrt(train.stiffness * train.mass)))


def _drag(damping: float, closure: str = "retained") -> Drag:
    """The drag of a belt in scaled form."""
    given = Case().drag
    return Drag(
        damping,
        1.0,
        ehl_exponent=given.ehl_exponent,
        mixed_exponent=given.mixed_exponent,
        stick_speed=min(STICK_SPEEDS),
        closure=closure,
    )


def _panel(chart: BandChart, closure: str) -> Chart:
    low, high = _SHOWN[closure]
    x = alt.X(
        "x:Q",
        title="Damping number F_t / (v_t √(k m)) (no unit)",
        scale=alt.Scale(type="log", domain=[float(DAMPING[0]), float(DAMPING[-1])], nice=False),
        axis=alt.Axis(values=[0.001, 0.01, 0.1, 1, 10], format="~g"),
    )
    y = alt.Y(
        "y:Q",
        title="V* / v_t (no unit)",
        scale=alt.Scale(type="log", domain=[low, high], nice=False),
        axis=alt.Axis(values=[tick for tick in _TICKS if tick <= high], format="~g", minExtent=30),
    )
    layers: list[alt.Chart] = []
    for i, hue in enumerate(ramp(len(STICK_SPEEDS))):
        curve = chart.fold[closure][i]
        if closure == "retained":
            deeper = curve > chart.released[i] * 1.001
            dotted = _rows(chart.damping[deeper], chart.released[i][deeper])
            layers.append(_plain(dotted, x, y, color=hue, strokeDash=[2, 3], strokeWidth=1.3))
        # where there is no band V* has come down to v_t: the curve ends there
        banded = np.minimum.accumulate(np.r_[True, curve[:-1] > 1.0 + 1e-6])
        layers.append(_plain(_rows(chart.damping[banded], curve[banded]), x, y, color=hue, strokeWidth=2.2))
    for speed, number, hue in zip(STICK_SPEEDS, _NAMED[closure], ramp(len(STICK_SPEEDS)), strict=True):
        name = [{"x": number, "y": chart.at(closure, speed, number)[0], "name": f"{speed:g}"}]
        for look in ({"stroke": "white", "strokeWidth": 5}, {"color": hue, "fontWeight": "bold"}):
            layers.append(plot(name).mark_text(fontSize=12, **look).encode(x=x, y=y, text="name:N"))
    number = damping_number(Case())
    dot = plot([{"x": number, "y": chart.at(closure, 0.01, number)[0], "name": "baseline"}])
    layers.append(dot.mark_point(filled=True, size=60, color=INK, opacity=1).encode(x=x, y=y))
    below = dot.mark_text(fontSize=12, color=INK, dx=-22, dy=-13)
    layers.append(below.encode(x=x, y=y, text="name:N"))
    notes = {
        "retained": "retained; dotted: laps released at v_s alone, outlasted there by a deeper stick-slip",
        "stiction": "stiction; V* goes beyond the chart towards little damping",
    }
    heading = alt.Title(notes[closure], fontSize=12, frame="group")
    return alt.layer(*layers).properties(width=WIDTH, height=300, title=heading)


def _rows(damping: FloatArray, fold: FloatArray) -> list[Row]:
    pairs = zip(damping.tolist(), fold.tolist(), strict=True)
    return [{"x": a, "y": b} for a, b in pairs if np.isfinite(b)]


def _plain(rows: list[Row], x: alt.X, y: alt.Y, **look: Any) -> alt.Chart:
    chart: alt.Chart = plot(rows).mark_line(clip=True, **look).encode(x=x, y=y)
    return chart
