"""Fig. 2: torque against speed at each temperature, and Eq. 9."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import HEIGHT, WIDTH
from hersey.lubrication import paper
from hersey.machine.machine import Machine
from hersey.units import rpm
from paper.dwells import SPEED, lines, marks, span, table, unit_of
from paper.figure import ABOUT, Claim, PaperFigure, Verdict, shown
from paper.measured import Branch, Measured

#: Exponent of speed in the torque of Eq. 9.
EXPONENT = 0.3
#: Within this factor of Eq. 9 its level counts as that of the log.
_LEVEL = 2.0


def figure_2(measured: Measured, machine: Machine | None = None) -> PaperFigure:
    """Draw torque against speed of a log, and Eq. 9 for the machine, and judge what is said of it."""
    factor, unit = unit_of(measured)
    powers, straights, theory = [], [], []
    for branch in measured.rising:
        speed = span(measured, branch)
        power = factor * branch.damping(speed) * speed
        powers.append((branch.kelvin, speed, power))
        slope, level = _straight(measured, branch)
        straights.append((branch.kelvin, speed, factor * (level + slope * speed)))
        if (expected := _equation_9(machine, branch, speed)) is not None:
            theory.append((branch.kelvin, speed, factor * expected))
    greatest = factor * float(measured.torque.max())
    tall = [float(height.max()) for _, _, height in theory]
    top = 1.05 * max([greatest, *(each for each in tall if each < _LEVEL * greatest)])
    y = alt.Y("y:Q", title=f"Torque ({unit})", scale=alt.Scale(domain=[0.0, top], nice=False))
    end = 1.03 * rpm(float(measured.speed.max()))
    x = alt.X("speed:Q", title=SPEED, scale=alt.Scale(domain=[0.0, end], nice=False))
    layers = [
        lines(measured, straights, strokeDash=[5, 4], strokeWidth=1.0),
        lines(measured, theory, strokeDash=[1.5, 3], strokeWidth=1.8),
        lines(measured, powers),
        marks(measured, factor * measured.torque, y, x),
    ]
    subtitle = f"{measured.name}; solid: power of speed through the rising branch; dashed: straight line"
    if theory:
        subtitle += "; dotted: Eq. 9" if min(tall) < top else "; Eq. 9 is beyond the chart"
    title = alt.Title("Fig. 2: Torque against speed and temperature", subtitle=subtitle)
    chart = alt.layer(*layers, title=title, width=WIDTH, height=HEIGHT)
    claims = [rises_as(measured), bends(measured)]
    if (agreement := agrees(measured, machine)) is not None:
        claims.append(agreement)
    return PaperFigure(2, "Torque against speed and temperature", chart, tuple(claims), table(measured))


def rises_as(measured: Measured) -> Claim:
    """Judge whether torque goes as speed to the 0.3 where it rises."""
    found = {f"exponent{b.where}": 1.0 + b.exponent.value for b in measured.rising}
    values = np.array(list(found.values()))
    near = bool(values.size) and bool(np.all(np.abs(values - EXPONENT) <= ABOUT))
    told = ", ".join(f"{1.0 + b.exponent.value:.3f}{b.where}" for b in measured.rising) or "none"
    return Claim(
        "Fig. 2",
        "Torque goes as speed to the power 0.3.",
        f"holds if the exponent of the rising branch is within {ABOUT:g} of 0.3 at every temperature; in "
        "direction if it is between 0 and 1.",
        Verdict.of(near, bool(values.size) and bool(np.all((values > 0.0) & (values < 1.0)))),
        f"Exponents of torque where it rises with speed: {told}.",
        found,
    )


def bends(measured: Measured) -> Claim:
    """Judge whether a power of speed describes torque better than a straight line, numbers alike."""
    power, line = [], []
    for branch in measured.rising:
        speed, torque = measured.speed[branch.index], measured.torque[branch.index]
        slope, level = _straight(measured, branch)
        power.append(_miss(branch.damping(speed) * speed / torque))
        line.append(_miss((level + slope * speed) / torque))
    pairs = np.array([power, line]).reshape(2, -1)
    means = pairs.mean(axis=1) if pairs.size else np.full(2, np.nan)
    return Claim(
        "Fig. 2",
        "A power of speed describes torque better than a straight line.",
        "holds if it misses the dwells of the rising branch by less at every temperature, both with two "
        "numbers; in direction if on average.",
        Verdict.of(bool(pairs.size) and bool(np.all(pairs[0] < pairs[1])), bool(means[0] < means[1])),
        f"The power misses the dwells by {means[0]:.1%} (root mean square), the straight line by "
        f"{means[1]:.1%}.",
        {"miss_power": float(means[0]), "miss_line": float(means[1])},
    )


def agrees(measured: Measured, machine: Machine | None) -> Claim | None:
    """Judge whether Eq. 9 gives the torque of the log; None where the machine does not say enough."""
    ratios = []
    for branch in measured.rising:
        speed = measured.speed[branch.index]
        if (expected := _equation_9(machine, branch, speed)) is not None:
            ratios.append(np.log(measured.torque[branch.index] / expected))
    if not ratios:
        return None
    ratio = float(np.exp(np.concatenate(ratios).mean()))
    exponents = np.array([1.0 + branch.exponent.value for branch in measured.rising])
    far = float(np.abs(exponents - EXPONENT).max())
    alike = far <= ABOUT
    return Claim(
        "Fig. 2",
        "Eq. 9 agrees with the torque measured.",
        f"holds if the exponents of speed are within {ABOUT:g} of each other and the levels within a factor "
        f"{_LEVEL:g}; in direction if the exponents are.",
        Verdict.of(alike and 1.0 / _LEVEL <= ratio <= _LEVEL, alike),
        f"The exponents differ by {far:.3f} at most; the torque measured is {shown(ratio)} times that of "
        "Eq. 9 for the machine file (geometric mean over the rising branch).",
        {"largest_difference": far, "measured_over_equation_9": ratio},
    )


def _equation_9(machine: Machine | None, branch: Branch, speed: FloatArray) -> FloatArray | None:
    """Torque of Eq. 9, N m; None without contact, pressure-viscosity coefficient or temperature."""
    if machine is None or machine.contact is None or machine.lubricant is None or branch.kelvin is None:
        return None
    contact, lubricant = machine.contact, machine.lubricant
    if not lubricant.pressure_viscosity:
        return None
    return paper.torque(
        pressure_viscosity=lubricant.alpha(branch.kelvin),
        viscosity=lubricant.viscosity(branch.kelvin),
        entrainment_speed=0.5 * speed * contact.roll_radius,
        load=contact.load,
        length=contact.length,
        rubber_thickness=contact.rubber_thickness,
        radius=contact.roll_radius,
        effective_modulus=contact.effective_modulus,
    )


def _straight(measured: Measured, branch: Branch) -> tuple[float, float]:
    """Slope and level of the straight line whose relative misses are least, speed in rad/s."""
    speed, torque = measured.speed[branch.index], measured.torque[branch.index]
    slope, level = np.polyfit(speed, torque, 1, w=1.0 / torque)
    return float(slope), float(level)


def _miss(ratio: FloatArray) -> float:
    """Root mean square of what a law misses, as a share."""
    return float(np.sqrt(np.mean((ratio - 1.0) ** 2)))
