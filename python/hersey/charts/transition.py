"""Transition speed against temperature: the contact model, and the log."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.style import (
    BLUE,
    INK,
    TEMPERATURE,
    WIDTH,
    Chart,
    logarithmic_axis,
    plot,
    rows_of,
    span,
    tip,
)
from hersey.units import celsius, rpm
from hersey.verdict.transition import ContactTransition


def transition_chart(transition: ContactTransition) -> Chart:
    """Return the speeds of the contact, and those of the log with their interval, against temperature."""
    hot = [celsius(kelvin) for kelvin in transition.temperature.tolist()]
    speeds = (transition.speed, transition.measured, transition.low, transition.high)
    model, seen, below, above = ([float(rpm(value)) for value in each.tolist()] for each in speeds)
    x = alt.X("hot:Q", title=TEMPERATURE, scale=alt.Scale(zero=False, padding=12))
    seen_speeds = [v for v in (*model, *seen, *below, *above) if np.isfinite(v)] or [1.0]
    y = alt.Y("speed:Q", title="Transition speed (rpm)", **logarithmic_axis(span(seen_speeds)))
    line, dots, bars = (
        [row for row in rows_of(hot=hot, **each) if all(np.isfinite(value) for value in row.values())]
        for each in ({"speed": model}, {"speed": seen}, {"speed": below, "top": above})
    )
    tips = [tip("hot", "°C"), tip("speed", "rpm")]
    layers = [
        plot(line).mark_line(color=INK, point=len(line) == 1).encode(x=x, y=y, tooltip=tips),
        plot(bars).mark_rule(color=BLUE, strokeWidth=1.5).encode(x=x, y=y, y2="top:Q"),
        plot(dots).mark_point(filled=True, color=BLUE, size=55, opacity=1).encode(x=x, y=y, tooltip=tips),
    ]
    subtitle = "line: contact model" + ("; dots: fitted to the log, with 95 % intervals" if dots else "")
    title = alt.Title("Transition speed", subtitle=subtitle)
    return alt.layer(*layers, title=title, width=WIDTH, height=240)
