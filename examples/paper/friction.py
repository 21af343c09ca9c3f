"""Fig. 8: friction coefficient against the Hersey (Sommerfeld) number, from a log and from the model."""

from __future__ import annotations

from typing import Any

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.friction import along, friction_chart
from hersey.errors import ParameterError
from hersey.lubrication.mixed import MixedContact
from hersey.machine.machine import Machine
from hersey.verdict.evidence import MeasuredFilm, measured_film
from paper.cross_section import contact_of
from paper.figure import ABOUT, Claim, PaperFigure, Verdict
from paper.measured import Measured
from paper.system import motor_left

#: Share of the dwells, at either end of the Hersey number, over which a slope is taken; fewest dwells of it.
_END, _FEWEST = 0.25, 4
#: Degree of the smooth curve by which one law of the Hersey number is judged.
_DEGREE = 4


def figure_8(machine: Machine, measured: Measured | None = None) -> PaperFigure:
    """Draw friction against the Hersey number for a machine, and judge what is said of it by a log.

    Raises
    ------
    ParameterError
        If the file states no contact or lubricant, or, without a log, not what shares the load.
    """
    contact, mixed = contact_of(machine), machine.mixed
    if machine.lubricant is None:
        raise ParameterError("the machine file states no [lubricant]")
    heat = machine.points[0].temperature if machine.points else None
    film = None
    if measured is not None:
        grip = machine.limits.roll_friction
        film = measured_film(
            measured.points, measured.surface, contact, machine.lubricant, temperature=heat, grip=grip
        )
    elif mixed is None:
        raise ParameterError(
            "without a log it needs what shares the load: [asperities] and [boundary] of the machine file"
        )
    title = "Friction coefficient against the Hersey number"
    limits = {"grip": machine.limits.roll_friction, "motor": motor_friction(machine)}
    chart = friction_chart(film, mixed, temperature=heat, **limits)
    stated: Any = chart.title
    chart.title = alt.Title(f"Fig. 8: {title}", subtitle=stated.subtitle)
    claims = () if film is None else (turns(film), collapses(film), drives(film, limits))
    return PaperFigure(8, title, chart, claims, _table(film, mixed, heat))


def motor_friction(machine: Machine) -> float | None:
    """Return the friction coefficient at which the motor gives no more, the no-load torque taken off."""
    contact = machine.contact
    if machine.limits.motor_torque is None or contact is None:
        return None
    return motor_left(machine) / (contact.roll_radius * contact.load) or None


def turns(film: MeasuredFilm) -> Claim:
    """Judge whether friction falls at low Hersey numbers and rises at high ones."""
    order = np.argsort(film.hersey_number)
    x, y = np.log(film.hersey_number[order]), np.log(film.friction[order])
    count = max(_FEWEST, round(_END * x.size))
    low, high = _slope(x[:count], y[:count]), _slope(x[-count:], y[-count:])
    return Claim(
        "Fig. 8",
        "Friction falls with the Sommerfeld number in the boundary region, and rises under a film.",
        f"holds if its slope on logarithmic axes is negative over the {_END:.0%} of the dwells at the lowest "
        "Hersey numbers and positive over those at the highest; in direction if it is less at the lowest.",
        Verdict.of(low < 0.0 < high, low < high),
        f"The slope is {low:+.2f} at the lowest and {high:+.2f} at the highest numbers.",
        {"slope_lowest": low, "slope_highest": high},
    )


def collapses(film: MeasuredFilm) -> Claim:
    """Judge whether friction hangs on the Hersey number alone."""
    x, y = np.log(film.hersey_number), np.log(film.friction)
    degree = min(_DEGREE, max(1, np.unique(np.round(x, 3)).size - 2))
    centred = (x - x.mean()) / max(float(np.ptp(x)), 1e-9)
    away = y - np.polyval(np.polyfit(centred, y, degree), centred)
    scatter, spread = float(np.sqrt(np.mean(away**2))), float(y.std())
    return Claim(
        "Fig. 8",
        "Friction hangs on the Sommerfeld number alone: all temperatures make one curve.",
        f"holds if the dwells scatter by {ABOUT:.0%} at most about one smooth curve (degree {_DEGREE} in "
        "logarithms); in direction if by less than half of what they do about their mean.",
        Verdict.of(scatter <= ABOUT, scatter < 0.5 * spread),
        f"They scatter by {scatter:.1%} about the curve and by {spread:.0%} about their mean. The Hersey "
        "number takes the viscosity of the machine file.",
        {"scatter": scatter, "spread": spread},
    )


def drives(film: MeasuredFilm, limits: dict[str, float | None]) -> Claim:
    """Judge whether the drive turns: friction below what roll and motor can bear."""
    known = [value for value in limits.values() if value is not None]
    limit, most = min(known, default=np.nan), float(film.friction.max())
    share = float(np.mean(film.friction < limit))
    told = " and ".join(f"{name} {value:.3g}" for name, value in limits.items() if value is not None)
    return Claim(
        "Fig. 8",
        "Below the limit of the friction coefficient the belt rotates, above it would stall.",
        "holds if every dwell, in which it rotated, is below what the file states of roll and motor; in "
        "direction if more than half are.",
        Verdict.of(share == 1.0, share > 0.5),
        f"{share:.0%} of the dwells are below; the greatest friction is {most:.3g}, the limits: "
        f"{told or 'none are stated'}.",
        {"greatest_friction": most, "limit": float(limit)},
    )


def _slope(x: FloatArray, y: FloatArray) -> float:
    return float(np.polyfit(x, y, 1)[0]) if np.ptp(x) > 0.0 else np.nan


def _table(
    film: MeasuredFilm | None, mixed: MixedContact | None, kelvin: float | None
) -> dict[str, tuple[float, ...]]:
    found: dict[str, FloatArray] = {}
    if film is not None:
        found |= {
            "temperature (K)": film.temperature,
            "Hersey number (m)": film.hersey_number,
            "Sommerfeld number (1)": film.sommerfeld_number,
            "friction (1)": film.friction,
        }
    if mixed is not None:
        heat = 373.15 if kelvin is None else kelvin
        model = along(mixed, heat, np.empty(0) if film is None else film.hersey_number)
        found |= {"model Hersey number (m)": model.hersey, "model friction (1)": model.friction}
    return {name: tuple(np.ravel(values).tolist()) for name, values in found.items()}
