"""The motion of the belt: a trajectory over time, and the lap to which it settles."""

from __future__ import annotations

from itertools import pairwise

import altair as alt

from hersey.arrays import FloatArray
from hersey.charts.over_time import BARE, over_time, shaded, temperatures_over_time, time_axis
from hersey.charts.style import BLUE, INK, ORANGE, WIDTH, Chart, Row, categories, plot, rows_of, stacked
from hersey.motion.simulation import StickSlipCycle
from hersey.motion.trajectory import Trajectory

#: Names and colours of the modes, dark to light by speed.
MODES = {
    "stuck": ("stuck", BLUE),
    "creep": ("creep", "#7a3b9c"),
    "microslip": ("microslip", "#777"),
    "mixed": ("mixed: drag falls with speed", ORANGE),
    "ehl": ("EHL: drag rises with speed", "#f2c14e"),
}
#: Units of length, force and time in which a motion is shown if none are given.
SI = ("m", "N", "s")


def trajectory_chart(run: Trajectory, *, units: tuple[str, str, str] = SI) -> Chart:
    """Return belt speed, spring force and mode over time; ``units`` are those of length, force and time."""
    length, force, time = units
    x = time_axis((0.0, float(run.time[-1])), None, tickCount=12, **BARE)
    panels: list[alt.Chart | Chart] = [
        _panel(run, run.belt_speed, f"Sliding speed ({length}/{time})", x, time, height=210),
        _panel(run, run.spring_force, f"Spring force ({force})", x, time, height=150),
    ]
    if run.film_temperature is not None and run.roll_temperature is not None:
        both = run.film_temperature.tolist(), run.roll_temperature.tolist()
        hot = temperatures_over_time(run.time.tolist(), *both, x, unit=time)
        panels.append(hot.properties(width=WIDTH, height=120))
    panels.append(mode_strip(run, title=f"Time ({time})"))
    changes = f"{len(run.events)} changes of mode" if run.events else "no change of mode"
    words = [f"{run.time.size} samples; {changes}"]
    if run.roll_slips:
        words.append(f"shaded: {run.slipping_in_words(lambda duration: f'{duration:.6g} {time}')}")
    return stacked(*panels, title=alt.Title("Motion", subtitle=words), spacing=8)


def cycle_chart(cycle: StickSlipCycle, *, units: tuple[str, str, str] = SI) -> Chart:
    """Return the lap to which a motion settles: how long it sticks and slips, and how far it swings."""
    length, _, time = units
    swings = [
        _swing(cycle.speed_min, cycle.speed_max, f"Sliding speed ({length}/{time})"),
        _swing(cycle.stretch_min, cycle.stretch_max, f"Spring stretch ({length})"),
    ]
    panels = [_lap(cycle, time), *swings] if cycle.frequency > 0 else swings
    title = alt.Title("Final motion", subtitle=_in_words(cycle, time))
    return stacked(*panels, title=title, spacing=14)


def mode_strip(run: Trajectory, *, title: str = "Time (s)") -> alt.Chart:
    """Return the modes of a motion as a strip; the legend leaves out those too short to be seen."""
    end = float(run.time[-1])
    times = [0.0, *(event.time for event in run.events), end]
    modes = [str(run.mode[0]), *(event.to_mode for event in run.events)]
    spans: list[Row] = [
        {"from": a, "to": b, "mode": MODES.get(mode, (mode, INK))[0]}
        for (a, b), mode in zip(pairwise(times), modes, strict=True)
    ]
    seen = {span["mode"] for span in spans if span["to"] - span["from"] > end / WIDTH}
    looks = dict(MODES.values())
    legend = alt.Legend(
        title="mode", orient="bottom", titleOrient="left", values=[name for name in looks if name in seen]
    )
    color = categories(alt.Color, "mode", looks, legend)
    scale, axis = alt.Scale(domain=[0.0, end], nice=False), alt.Axis(tickCount=12, format="~g")
    x = alt.X("from:Q", title=title, scale=scale, axis=axis)
    chart: alt.Chart = plot(spans).mark_rect().encode(x=x, x2=alt.X2("to:Q"), color=color)
    return chart.properties(width=WIDTH, height=26)


def _panel(
    run: Trajectory, values: FloatArray, name: str, x: alt.X, time: str, *, height: int
) -> alt.Chart | Chart:
    """A quantity against time, shaded where the roll slips on the belt."""
    line = over_time(rows_of(time=run.time, value=values), name, x, unit=time)
    layers = [shaded(run.roll_slips, ORANGE), line] if run.roll_slips else [line]
    return alt.layer(*layers, width=WIDTH, height=height)


def _in_words(cycle: StickSlipCycle, time: str) -> str:
    kind = cycle.kind.replace("_", "-" if cycle.kind == "stick_slip" else " ")
    if cycle.frequency == 0:
        return kind
    unit = "Hz" if time == "s" else f"1/{time}"
    words = f"{kind} at {cycle.frequency:.4g} {unit}, stuck {cycle.stuck_fraction:.1%} of the time"
    slips = cycle.grip_slip_duration * cycle.frequency
    return words + (f"; the drive slips {slips:.1%} of the time" if slips else "")


def _lap(cycle: StickSlipCycle, time: str) -> Chart:
    """One lap as a strip."""
    period = 1.0 / cycle.frequency
    names = [f"stuck, {cycle.stick_duration:.4g} {time}", f"slipping, {cycle.slip_duration:.4g} {time}"]
    ends = [0.0, cycle.stick_duration, period]
    rows: list[Row] = [
        {"from": a, "to": b, "part": name}
        for (a, b), name in zip(pairwise(ends), names, strict=True)
        if b > a
    ]
    x = alt.X(
        "from:Q", title=f"Time in one cycle ({time})", scale=alt.Scale(domain=[0.0, period], nice=False)
    )
    legend = alt.Legend(title=None, orient="top", labelLimit=300)
    color = categories(alt.Color, "part", dict(zip(names, (BLUE, "#f2c14e"), strict=True)), legend)
    strip = plot(rows).mark_rect()
    return alt.layer(strip.encode(x=x, x2=alt.X2("to:Q"), color=color), width=WIDTH, height=34)


def _swing(low: float, high: float, name: str) -> Chart:
    """Least and greatest value of a quantity in a lap, with their numbers."""
    x = alt.X("low:Q", title=name, scale=alt.Scale(zero=True, padding=46))
    span = plot([{"low": low, "high": high}]).mark_rule(strokeWidth=5, color=BLUE)
    marks = plot([{"low": end, "text": f"{end:.4g}"} for end in dict.fromkeys((low, high))]).encode(x=x)
    layers = [
        span.encode(x=x, x2=alt.X2("high:Q")),
        marks.mark_point(filled=True, size=90, color=BLUE, opacity=1),
        marks.mark_text(dy=-14, color=INK, fontSize=12).encode(text=alt.Text("text:N")),
    ]
    return alt.layer(*layers, width=WIDTH, height=50)
