"""Torque of a mixed contact against speed: the whole, the film's part of it, and where it turns."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.against_speed import against_speed, curve_rows
from hersey.charts.style import Chart, Row, rows_of, temperature_name, tip, torque_unit
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
    alone = factor * (lines.shear_torque + lines.rolling_torque)
    whole, part = (
        [row for torque, kelvin in zip(each, hot, strict=True) for row in curve_rows(speed, torque, kelvin)]
        for each in (factor * lines.torque, alone)
    )
    corners: list[Row] = [
        {"speed": rpm(at), "y": factor * torque}
        for at, torque in zip(turns.speed.tolist(), turns.torque.tolist(), strict=True)
        if at > 0
    ]
    tips = [tip("speed", "rpm"), tip("y", unit), tip("ratio", "lambda"), tip("share", "share, %")]
    subtitle = "lines: torque; dashed: film alone" + ("; ticks: transition speed" if corners else "")
    return against_speed(
        [row for row in _rows(film, factor) if row["speed"] > 0],
        whole,
        f"Torque ({unit})",
        tips=tips,
        parts=part,
        turns=corners,
    ).properties(title=alt.Title("Film and asperities", subtitle=subtitle))


def _rows(film: MixedFilm, factor: float) -> list[Row]:
    kelvin = np.ravel(film.temperature).tolist()
    return rows_of(
        speed=rpm(np.ravel(film.speed)),
        y=factor * np.ravel(film.torque),
        ratio=np.ravel(film.lambda_ratio),
        share=100.0 * np.ravel(film.share),
        level=[temperature_name(each) for each in kelvin],
    )
