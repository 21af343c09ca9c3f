"""Transition speed against temperature: the line of the contact, and what the log shows."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.style import BLUE, INK, WIDTH, Chart, logarithmic_axis, plot, rows_of, span, tip
from hersey.units import celsius, rpm
from hersey.verdict.transition import ContactTransition


def transition_chart(transition: ContactTransition) -> Chart:
    """Return the speeds of the contact, and those of the log with their interval, against temperature."""
    hot = [celsius(kelvin) for kelvin in transition.temperature.tolist()]
    speeds = (transition.speed, transition.measured, transition.low, transition.high)
    model, seen, below, above = ([float(rpm(value)) for value in each.tolist()] for each in speeds)
    x = alt.X("hot:Q", title="Temperature (°C)", scale=alt.Scale(zero=False, padding=12))
    seen_speeds = [v for v in (*model, *seen, *below, *above) if np.isfinite(v)] or [1.0]
    y = alt.Y("speed:Q", title="Transition speed (rpm)", **logarithmic_axis(span(seen_speeds)))
    line = [row for row in rows_of(hot=hot, speed=model) if np.isfinite(row["speed"])]
    dots = [row for row in rows_of(hot=hot, speed=seen) if np.isfinite(row["speed"])]
    bars = [
        row
        for row in rows_of(hot=hot, speed=below, top=above)
        if np.isfinite(row["speed"]) and np.isfinite(row["top"])
    ]
    tips = [tip("hot", "°C"), tip("speed", "rpm")]
    layers = [
        plot(line).mark_line(color=INK, point=len(line) == 1).encode(x=x, y=y, tooltip=tips),
        plot(bars).mark_rule(color=BLUE, strokeWidth=1.5).encode(x=x, y=y, y2="top:Q"),
        plot(dots).mark_point(filled=True, color=BLUE, size=55, opacity=1).encode(x=x, y=y, tooltip=tips),
    ]
    title = alt.Title(
        "Transition speed",
        subtitle="line: film and asperities of the contact as stated"
        + ("; dots: the fitted surface, with 95 %" if dots else ""),
    )
    return alt.layer(*layers, title=title, width=WIDTH, height=240)
