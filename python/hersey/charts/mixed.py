"""Torque of a mixed contact against speed: the whole, the film's part of it, and where it turns."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.style import (
    HEIGHT,
    WIDTH,
    Chart,
    Row,
    logarithmic,
    plot,
    rows_of,
    temperature_channels,
    temperature_name,
    tip,
    torque_unit,
)
from hersey.lubrication.mixed import MixedFilm
from hersey.units import rpm

#: Speeds along each line, and how far beyond points and transitions the lines go.
_SPEEDS, _BEYOND = 160, 10.0


def mixed_chart(film: MixedFilm) -> Chart:
    """Return torque against speed at each temperature of the points, the film's part of it dashed."""
    hot = np.unique(film.temperature)
    turns = film.mixed.transition(hot)
    known = np.concatenate([np.ravel(film.speed), np.ravel(turns.speed)])
    known = known[known > 0]  # neither rest nor a transition that is nowhere
    low, high = (known.min(), known.max()) if known.size else (1.0, 1.0)
    speed = np.geomspace(low / _BEYOND, high * _BEYOND, _SPEEDS)
    lines = film.mixed.at(speed=speed, temperature=hot[:, None])
    factor, unit = torque_unit(float(lines.torque.max()))
    color, _ = temperature_channels(hot.tolist(), legend=hot.size > 1)
    x = alt.X("speed:Q", title="Drive speed (rpm)", scale=logarithmic())
    y = alt.Y("torque:Q", title=f"Torque ({unit})", scale=logarithmic())
    whole = _rows(lines, factor)
    alone = factor * np.ravel(lines.shear_torque + lines.rolling_torque)
    part = [row | {"torque": torque} for row, torque in zip(whole, alone.tolist(), strict=True)]
    corners = [
        {"speed": rpm(at), "torque": factor * torque, "level": temperature_name(kelvin)}
        for at, torque, kelvin in zip(turns.speed, turns.torque, hot, strict=True)
        if at > 0
    ]
    tips = [tip("speed", "rpm"), tip("torque", unit), tip("ratio", "lambda"), tip("share", "share, %")]
    moving = [row for row in _rows(film, factor) if row["speed"] > 0]
    layers = [
        plot(part).mark_line(strokeDash=[4, 3], clip=True).encode(x=x, y=y, color=color),
        plot(whole).mark_line().encode(x=x, y=y, color=color),
        plot(corners)
        .mark_point(shape="diamond", size=90, filled=True, opacity=1)
        .encode(x=x, y=y, color=color),
        plot(moving).mark_point(filled=True, size=40, opacity=1).encode(x=x, y=y, color=color, tooltip=tips),
    ]
    title = alt.Title(
        "Film and asperities",
        subtitle="lines: torque; dashed: what the film adds"
        + ("; diamonds: transition speed" if corners else ""),
    )
    return alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)


def _rows(film: MixedFilm, factor: float) -> list[Row]:
    kelvin = np.ravel(film.temperature).tolist()
    return rows_of(
        speed=rpm(np.ravel(film.speed)),
        torque=factor * np.ravel(film.torque),
        ratio=np.ravel(film.lambda_ratio),
        share=100.0 * np.ravel(film.share),
        level=[temperature_name(each) for each in kelvin],
    )
