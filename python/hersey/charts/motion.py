"""The motion of the belt: a trajectory over time, and the lap to which it settles."""

from __future__ import annotations

from itertools import pairwise

import altair as alt

from hersey.arrays import FloatArray
from hersey.charts.style import BLUE, INK, ORANGE, WIDTH, Chart, Row, plot, rows_of, tip
from hersey.motion.simulation import StickSlipCycle
from hersey.motion.trajectory import Trajectory
from hersey.units import celsius

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
_AXIS = 46


def trajectory_chart(run: Trajectory, *, units: tuple[str, str, str] = SI) -> Chart:
    """Return belt speed, spring force and mode over time; ``units`` are those of length, force and time."""
    length, force, time = units
    panels = [
        _over_time(run, run.belt_speed, f"Belt speed ({length}/{time})", time, height=210),
        _over_time(run, run.spring_force, f"Spring force ({force})", time, height=150),
        *_temperatures(run, time),
        mode_strip(run, title=f"Time ({time})"),
    ]
    changes = f"{len(run.events)} changes of mode" if run.events else "no change of mode"
    words = [f"{run.time.size} samples; {changes}"]
    if run.roll_slips:
        words.append(f"shaded: {run.slipping_in_words()}")
    title = alt.Title("Motion of the belt", subtitle=words)
    stacked: Chart = alt.vconcat(*panels, spacing=8, title=title).resolve_scale(color="independent")
    return stacked


def cycle_chart(cycle: StickSlipCycle, *, units: tuple[str, str, str] = SI) -> Chart:
    """Return the lap to which a motion settles: how long it sticks and slips, and how far it swings."""
    length, _, time = units
    swings = [
        _swing(cycle.speed_min, cycle.speed_max, f"Belt speed ({length}/{time})"),
        _swing(cycle.stretch_min, cycle.stretch_max, f"Spring stretch ({length})"),
    ]
    panels = [_lap(cycle, time), *swings] if cycle.frequency > 0 else swings
    title = alt.Title("What the motion settles to", subtitle=_in_words(cycle, time))
    stacked: Chart = alt.vconcat(*panels, spacing=14, title=title).resolve_scale(color="independent")
    return stacked


def temperatures_over_time(
    times: FloatArray, film: FloatArray, roll: FloatArray, x: alt.X, *, unit: str = "s"
) -> alt.Chart:
    """Return the temperatures (K) of film and roll over time, in degC on an axis of their own."""
    rows = [
        row
        for body, kelvin in (("film", film), ("roll", roll))
        for row in rows_of(time=times, value=celsius(kelvin), body=[body] * times.size)
    ]
    legend = alt.Legend(title=None, orient="top-left", fillColor="white", padding=4)
    chart: alt.Chart = (
        plot(rows)
        .mark_line(strokeWidth=1.5)
        .encode(
            x=x,
            y=alt.Y(
                "value:Q",
                title="Temperature (°C)",
                scale=alt.Scale(zero=False),
                axis=alt.Axis(minExtent=_AXIS),
            ),
            color=alt.Color(
                "body:N", scale=alt.Scale(domain=["film", "roll"], range=[ORANGE, INK]), legend=legend
            ),
            tooltip=[tip("time", f"time ({unit})"), tip("value", "temperature (°C)"), "body:N"],
        )
        .properties(width=WIDTH, height=120)
    )
    return chart


def _temperatures(run: Trajectory, time: str) -> list[alt.Chart]:
    if run.film_temperature is None or run.roll_temperature is None:
        return []
    return [
        temperatures_over_time(
            run.time, run.film_temperature, run.roll_temperature, _bare_time(run), unit=time
        )
    ]


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
    names, hues = [name for name, _ in MODES.values()], [hue for _, hue in MODES.values()]
    legend = alt.Legend(orient="bottom", titleOrient="left", values=[name for name in names if name in seen])
    color = alt.Color("mode:N", title="mode", scale=alt.Scale(domain=names, range=hues), legend=legend)
    x = alt.X(
        "from:Q",
        title=title,
        scale=alt.Scale(domain=[0.0, end], nice=False),
        axis=alt.Axis(tickCount=12, format="~g"),
    )
    chart: alt.Chart = plot(spans).mark_rect().encode(x=x, x2=alt.X2("to:Q"), color=color)
    return chart.properties(width=WIDTH, height=26)


def _over_time(
    run: Trajectory, values: FloatArray, name: str, time: str, *, height: int
) -> alt.Chart | Chart:
    """A quantity against time."""
    x = _bare_time(run)
    y = alt.Y("value:Q", title=name, axis=alt.Axis(minExtent=_AXIS))
    tips = [tip("time", f"time ({time})"), tip("value", name)]
    line = plot(rows_of(time=run.time, value=values)).mark_line(color=BLUE, strokeWidth=1.5)
    drawn: alt.Chart = line.encode(x=x, y=y, tooltip=tips)
    if not run.roll_slips:
        return drawn.properties(width=WIDTH, height=height)
    # where the roll slips on the belt the panel is shaded from top to bottom
    spans: list[Row] = [{"time": begin, "to": end} for begin, end in run.roll_slips]
    shade = plot(spans).mark_rect(color=ORANGE, opacity=0.25).encode(x=x, x2=alt.X2("to:Q"))
    layered: Chart = alt.layer(shade, drawn).properties(width=WIDTH, height=height)
    return layered


def _bare_time(run: Trajectory) -> alt.X:
    """Time without labels: the axis is drawn under the last panel alone."""
    return alt.X(
        "time:Q",
        title=None,
        scale=alt.Scale(domain=[0.0, float(run.time[-1])], nice=False),
        axis=alt.Axis(tickCount=12, labels=False, ticks=False),
    )


def _in_words(cycle: StickSlipCycle, time: str) -> str:
    kind = cycle.kind.replace("_", "-" if cycle.kind == "stick_slip" else " ")
    if cycle.frequency == 0:
        return kind
    unit = "Hz" if time == "s" else f"1/{time}"
    words = f"{kind} at {cycle.frequency:.4g} {unit}, stuck {cycle.stuck_fraction:.1%} of the time"
    slips = cycle.grip_slip_duration * cycle.frequency
    return words + (f"; the roll slips {slips:.1%} of it" if slips else "")


def _lap(cycle: StickSlipCycle, time: str) -> Chart:
    """One lap as a strip."""
    period = 1.0 / cycle.frequency
    names = [f"stuck, {cycle.stick_duration:.4g} {time}", f"slipping, {cycle.slip_duration:.4g} {time}"]
    rows: list[Row] = [
        {"from": 0.0, "to": cycle.stick_duration, "part": names[0]},
        {"from": cycle.stick_duration, "to": period, "part": names[1]},
    ]
    scale = alt.Scale(domain=names, range=[BLUE, "#f2c14e"])
    x = alt.X("from:Q", title=f"Time in one lap ({time})", scale=alt.Scale(domain=[0.0, period], nice=False))
    color = alt.Color("part:N", scale=scale, legend=alt.Legend(title=None, orient="top", labelLimit=300))
    strip = plot([row for row in rows if row["to"] > row["from"]]).mark_rect()
    return alt.layer(strip.encode(x=x, x2=alt.X2("to:Q"), color=color), width=WIDTH, height=34)


def _swing(low: float, high: float, name: str) -> Chart:
    """Least and greatest value of a quantity in a lap, with their numbers."""
    x = alt.X("low:Q", title=name, scale=alt.Scale(zero=True, padding=46))
    span = plot([{"low": low, "high": high}]).mark_rule(strokeWidth=5, color=BLUE)
    ends: list[Row] = [{"low": low, "text": f"{low:.4g}"}]
    if high > low:
        ends.append({"low": high, "text": f"{high:.4g}"})
    dots = plot(ends).mark_point(filled=True, size=90, color=BLUE, opacity=1)
    text = plot(ends).mark_text(dy=-14, color=INK, fontSize=12)
    layers = [
        span.encode(x=x, x2=alt.X2("high:Q")),
        dots.encode(x=x),
        text.encode(x=x, text=alt.Text("text:N")),
    ]
    return alt.layer(*layers, width=WIDTH, height=50)
