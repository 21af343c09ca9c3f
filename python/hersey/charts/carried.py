"""What carries the torque of the drive, stacked against speed, with the dwells on it."""

from __future__ import annotations

import altair as alt

from hersey.charts.style import HEIGHT, INK, WIDTH, Chart, logarithmic, plot, rows_of, tip, torque_unit
from hersey.document.parts import CarriedPart
from hersey.units import celsius, rpm

#: Parts from below, with their names and shades that stay apart in grey.
_PARTS = (
    ("rest", "rest of the drive", "#d5d5d5"),
    ("contact", "contact", "#d9730d"),
    ("shear", "film, sheared over the nip", "#1f4e9c"),
    ("inlet", "film, inlet and pressure", "#8fb4e3"),
)


def carried_chart(part: CarriedPart) -> Chart:
    """Return the parts of the torque as areas, one upon another, and the whole torque of the dwells."""
    factor, unit = torque_unit(max(part.measured_torque))
    names, shades = [name for _, name, _ in _PARTS], [shade for _, _, shade in _PARTS]
    rows = [
        {"speed": rpm(speed), "torque": factor * torque, "part": name, "order": order}
        for order, (field, name, _) in enumerate(_PARTS)
        for speed, torque in zip(part.speed, getattr(part, field), strict=True)
    ]
    dwells = rows_of(
        speed=[rpm(speed) for speed in part.measured_speed],
        whole=[factor * torque for torque in part.measured_torque],
    )
    x = alt.X("speed:Q", title="Drive speed (rpm)", scale=logarithmic())
    areas = (
        plot(rows)
        .mark_area(line=False)
        .encode(
            x=x,
            y=alt.Y("torque:Q", title=f"Torque ({unit})", stack="zero"),
            order="order:Q",
            color=alt.Color(
                "part:N",
                scale=alt.Scale(domain=names, range=shades),
                legend=alt.Legend(title=None, orient="bottom"),
            ),
            tooltip=["part:N", tip("speed", "rpm"), tip("torque", unit)],
        )
    )
    dots = (
        plot(dwells)
        .mark_point(filled=True, fill="white", stroke=INK, strokeWidth=1.2, size=45, opacity=1)
        .encode(x=x, y="whole:Q", tooltip=[tip("speed", "rpm"), tip("whole", unit)])
    )
    title = alt.Title(
        f"What carries the torque at {celsius(part.temperature):.0f} °C",
        subtitle="areas: by the machine's file; circles: dwells of the log, rest of the drive included",
    )
    return alt.layer(areas, dots, title=title, width=WIDTH, height=HEIGHT)
