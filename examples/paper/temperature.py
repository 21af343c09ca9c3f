"""Fig. 4: the fitted surface of damping; and torque against 1/T, of which the paper speaks beside it."""

from __future__ import annotations

import warnings

import altair as alt
import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.charts.style import (
    HEIGHT,
    INK,
    WIDTH,
    Chart,
    plot,
    rows_of,
    temperature_channels,
    temperature_name,
)
from hersey.errors import InsufficientDataError
from hersey.machine.machine import Machine
from hersey.units import celsius, rpm
from paper.dwells import SPEED, table, unit_of
from paper.figure import ABOUT, Claim, PaperFigure, Verdict
from paper.measured import Measured

#: Cells of the surface across and up.
_CELLS = (60, 40)
#: How far beyond the dwells it is drawn: ratio of speeds, and K.
_BEYOND, _WARMER = 1.08, 4.0
#: Energy of the slope that the paper reports, cal/mol, and joules in a calorie.
_REPORTED, _CALORIE = 9460.77, 4.184
#: Exponent of viscosity in the torque of Eq. 9.
_VISCOSITY = 0.3
_ARRHENIUS_HEIGHT = 220


def figure_4(measured: Measured, machine: Machine | None = None) -> PaperFigure:
    """Draw the fitted surface and torque against 1/T of a log, and judge what is said of them.

    Raises
    ------
    InsufficientDataError
        If the log has one temperature, or none.
    """
    if measured.surface.b is None:
        raise InsufficientDataError(f"{measured.name} has no temperatures, over which Fig. 4 is drawn")
    title = "Damping against temperature and speed"
    subtitle = f"{measured.name}; above: B = a T^b w^c, marks the dwells; below: torque brought to one speed"
    chart = alt.vconcat(_surface(measured), _arrhenius(measured), spacing=18).resolve_scale(
        color="independent", shape="independent"
    )
    chart = chart.properties(title=alt.Title(f"Fig. 4: {title}", subtitle=subtitle))
    claims = [describes(measured), is_straight(measured)]
    if machine is not None and machine.lubricant is not None:
        claims.append(is_energy(measured, machine))
    return PaperFigure(4, title, chart, tuple(claims), table(measured))


def describes(measured: Measured) -> Claim:
    """Judge whether one surface describes the damping measured."""
    misses = np.expm1(measured.surface.residuals)
    worst, typical = float(np.abs(misses).max()), float(np.sqrt(np.mean(misses**2)))
    bends = "with a falling branch" if measured.surface.transition else "of one branch"
    return Claim(
        "Fig. 4",
        "B = a T^b w^c describes the damping measured.",
        f"holds if the surface misses no dwell by over {ABOUT:.0%}; in direction if its root mean square "
        "does not.",
        Verdict.of(worst <= ABOUT, typical <= ABOUT),
        f"The surface, {bends}, misses the dwells by {typical:.1%} (root mean square), "
        f"by {worst:.1%} at most.",
        {"largest_miss": worst, "typical_miss": typical},
    )


def is_straight(measured: Measured) -> Claim:
    """Judge whether ln torque is a straight line in 1/T."""
    inverse, height, _ = at_one_speed(measured)
    slope, miss, count = _line(inverse, height)
    energy = slope * _core.GAS_CONSTANT
    return Claim(
        "Eq. 9",
        "The logarithm of torque against 1/T is a straight line.",
        f"holds if the least-squares line misses the mean torque of no temperature by over {ABOUT:.0%}, "
        "of at least three; in direction if torque falls as it grows hotter.",
        Verdict.of(count > 2 and miss <= ABOUT, slope > 0.0),
        f"It misses {count} temperatures by {miss:.1%} at most; its slope is {energy / 1e3:.3g} kJ/mol "
        f"({energy / _CALORIE:.5g} cal/mol), where the paper has {_REPORTED:g} cal/mol for its grease.",
        {"energy_of_torque": energy, "largest_miss": miss, "temperatures": count},
    )


def is_energy(measured: Measured, machine: Machine) -> Claim:
    """Judge whether the slope is the activation energy of the lubricant by way of Eq. 9."""
    assert machine.lubricant is not None
    inverse, height, _ = at_one_speed(measured)
    energy = _line(inverse, height)[0] * _core.GAS_CONSTANT / _VISCOSITY
    stated = float(machine.lubricant.activation_energy(1.0 / float(inverse.mean())))
    ratio = energy / stated
    return Claim(
        "Eq. 9",
        "The slope, over the exponent 0.3 of viscosity, is the activation energy of the lubricant.",
        f"holds if it is within {ABOUT:.0%} of that of the machine file; in direction if within a factor 2.",
        Verdict.of(abs(ratio - 1.0) <= ABOUT, 0.5 <= ratio <= 2.0),
        f"The log has {energy / 1e3:.3g} kJ/mol, the lubricant of the file {stated / 1e3:.3g} kJ/mol at the "
        "mean of 1/T.",
        {"energy_of_log": energy, "energy_of_lubricant": stated},
    )


def at_one_speed(measured: Measured) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return 1/T (1/K), ln torque brought to the reference speed, and T (K), of the rising dwells."""
    index = np.concatenate([b.index for b in measured.rising] or [np.arange(measured.speed.size)])
    kelvin = np.asarray(measured.points.column("temperature"), dtype=float)[index]
    away = np.log(measured.speed[index] / measured.surface.reference_speed)
    height = np.log(measured.torque[index]) - (1.0 + measured.surface.c.value) * away
    of = np.array(measured.kelvin, dtype=float)[index]
    return 1.0 / kelvin, height, of


def _line(inverse: FloatArray, height: FloatArray) -> tuple[float, float, int]:
    """Slope (K), largest miss of the mean of a temperature, and how many temperatures there are."""
    slope, level = np.polyfit(inverse, height, 1)
    away = height - level - slope * inverse
    order = np.argsort(inverse)
    groups = np.split(order, np.flatnonzero(np.diff(1.0 / inverse[order]) < -3.0) + 1)
    means = [abs(np.expm1(away[group].mean())) for group in groups]
    return float(slope), float(max(means)), len(groups)


def _surface(measured: Measured) -> Chart:
    """The law by colour over speed and temperature, and the dwells in the same colours."""
    surface = measured.surface
    assert surface.temperature_range is not None
    factor, unit = unit_of(measured)
    slow, fast = surface.speed_range
    across = np.geomspace(slow / _BEYOND, fast * _BEYOND, _CELLS[0] + 1)
    low, high = surface.temperature_range
    up = np.linspace(low - _WARMER, high + _WARMER, _CELLS[1] + 1)
    speed, kelvin = np.meshgrid(np.sqrt(across[1:] * across[:-1]), 0.5 * (up[1:] + up[:-1]), indexing="ij")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        law = surface.damping(speed=speed, temperature=kelvin)
    left, bottom = np.meshgrid(across[:-1], up[:-1], indexing="ij")
    right, top = np.meshgrid(across[1:], up[1:], indexing="ij")
    cells = rows_of(
        speed=rpm(left.ravel()),
        speed2=rpm(right.ravel()) * 1.002,
        kelvin=celsius(bottom.ravel()),
        kelvin2=celsius(top.ravel()) + 0.1,
        damping=factor * law.ravel(),
    )
    dwells = rows_of(
        speed=rpm(measured.speed),
        kelvin=celsius(np.asarray(measured.points.column("temperature"), dtype=float)),
        damping=factor * measured.damping,
    )
    x = alt.X(
        "speed:Q", title=SPEED, scale=alt.Scale(type="log", nice=False, domain=rpm(across[[0, -1]]).tolist())
    )
    y = alt.Y("kelvin:Q", title="Temperature (°C)", scale=alt.Scale(zero=False, nice=False))
    color = alt.Color(
        "damping:Q",
        scale=alt.Scale(type="log", scheme="viridis"),
        legend=alt.Legend(title=f"Damping ({unit}·s/rad)", format="~g", titleLimit=200),
    )
    layers = [
        plot(cells).mark_rect(strokeWidth=0).encode(x=x, x2="speed2:Q", y=y, y2="kelvin2:Q", color=color),
        plot(dwells)
        .mark_point(filled=True, stroke="white", strokeWidth=1.2, size=80, opacity=1)
        .encode(x=x, y=y, color=color),
    ]
    return alt.layer(*layers, width=WIDTH, height=HEIGHT)


def _arrhenius(measured: Measured) -> Chart:
    """Torque of the rising dwells at the reference speed against 1/T, and the least-squares line."""
    inverse, height, kelvin = at_one_speed(measured)
    factor, unit = unit_of(measured)
    slope, level = np.polyfit(inverse, height, 1)
    ends = np.array([inverse.min(), inverse.max()])
    rows = rows_of(
        inverse=1e3 * inverse,
        torque=factor * np.exp(height),
        level=[temperature_name(each) for each in kelvin.tolist()],
    )
    color, shape = temperature_channels(kelvin.tolist())
    at = rpm(measured.surface.reference_speed)
    x = alt.X("inverse:Q", title="1000/T (1/K)", scale=alt.Scale(zero=False, nice=False, padding=14))
    y = alt.Y(
        "torque:Q",
        title=f"Torque at {at:.3g} rpm ({unit})",
        scale=alt.Scale(type="log", nice=False, padding=14),
    )
    line = rows_of(inverse=1e3 * ends, torque=factor * np.exp(level + slope * ends))
    layers = [
        plot(line).mark_line(color=INK, strokeDash=[5, 3], strokeWidth=1.2).encode(x=x, y=y),
        plot(rows).mark_point(filled=True, size=42, opacity=0.8).encode(x=x, y=y, color=color, shape=shape),
    ]
    return alt.layer(*layers, width=WIDTH, height=_ARRHENIUS_HEIGHT)
