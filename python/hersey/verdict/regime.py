"""What the exponent of speed says about lubrication: named hypotheses, tested, and a verdict in words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from hersey.arrays import FloatArray
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.estimation import CONFIDENCE, Estimate
from hersey.damping.law import distinct_speeds, scaled_temperature
from hersey.damping.surface import DampingSurface
from hersey.units import rpm

#: Name, least and greatest exponent of damping in speed, and where it comes from.
HYPOTHESES: tuple[tuple[str, float, float, str], ...] = (
    ("constant film", 0.0, 0.0, "a film of fixed thickness, as when starved: torque proportional to speed"),
    ("soft EHL", -0.60, -0.56, "isoviscous film in a rubber nip, numerical solutions for a layered roll"),
    ("Dowson-Higginson EHL", -0.70, -0.70, "piezoviscous line contact, Eq. 10 of the paper"),
    ("dry Coulomb friction", -1.0, -1.0, "torque independent of speed"),
    ("falling branch", -np.inf, -1.0, "torque falls with speed: mixed lubrication, stick-slip possible"),
)


@dataclass(frozen=True)
class Hypothesis:
    """A named value (or range) of the exponent, and how probable a deviation like the measured one is."""

    name: str
    low: float
    high: float
    meaning: str
    p_value: float

    @property
    def consistent(self) -> bool:
        """Whether it survives at the 5 % level."""
        return self.p_value > 1.0 - CONFIDENCE


@dataclass(frozen=True)
class BranchExponent:
    """Exponent of damping in speed at one temperature (K; None if not recorded) on one branch."""

    temperature: float | None
    branch: str  #: ``ehl`` or ``mixed``; ``all`` where the data show one branch only
    points: int
    speed_low: float  #: rad/s
    speed_high: float
    exponent: Estimate


@dataclass(frozen=True)
class Regime:
    """Evidence and verdict."""

    exponents: tuple[BranchExponent, ...]
    hypotheses: tuple[Hypothesis, ...]
    verdict: str


def regime(points: SteadyPoints, surface: DampingSurface) -> Regime:
    """Return the evidence on the lubrication regime, from steady points and the surface fitted to them."""
    tested = tuple(_tested(h, surface) for h in HYPOTHESES)
    return Regime(_exponents(points, surface), tested, _verdict(surface, tested))


def _freedom(surface: DampingSurface) -> int:
    return surface.statistics.points - surface.statistics.variables


def _tested(hypothesis: tuple[str, float, float, str], surface: DampingSurface) -> Hypothesis:
    name, low, high, meaning = hypothesis
    c = surface.c
    away = max(low - c.value, c.value - high, 0.0) / max(c.error, 1e-12)
    sides = 1.0 if np.isinf(low) else 2.0
    p = min(1.0, sides * float(stats.t.sf(away, _freedom(surface))))
    return Hypothesis(name, low, high, meaning, p)


def _exponents(points: SteadyPoints, surface: DampingSurface) -> tuple[BranchExponent, ...]:
    speed = np.abs(points.column("speed"))
    torque = np.abs(points.column("torque"))
    error = np.hypot(points.column("torque_error") / torque, surface.statistics.scatter)
    hot = surface.b is not None
    level = torque * np.exp(-_warmth(points, surface))
    groups = list(groups_of_temperature(points.column("temperature"))) if hot else [np.arange(speed.size)]
    found = []
    for group in groups:
        kelvin = float(np.mean(points.column("temperature")[group])) if hot else None
        at = surface.transition_speed(kelvin)
        sides = [("all", group)]
        if surface.transition:
            slow = speed[group] < at
            sides = [("mixed", group[slow]), ("ehl", group[~slow])]
        for branch, members in sides:
            if members.size > 2 and distinct_speeds(speed[members]) >= 3:
                exponent = _slope(speed[members], level[members], error[members], surface)
                low, high = float(speed[members].min()), float(speed[members].max())
                found.append(BranchExponent(kelvin, branch, int(members.size), low, high, exponent))
    return tuple(found)


def _warmth(points: SteadyPoints, surface: DampingSurface) -> FloatArray:
    """Logarithm of T^b of each dwell about the reference: dwells of a group differ by some kelvin."""
    if surface.b is None or surface.reference_temperature is None:
        return np.zeros(len(points))
    temperature = scaled_temperature(points.column("temperature"), surface.temperature_scale)
    return np.asarray(surface.b.value * np.log(temperature / surface.reference_temperature))


def _slope(speed: FloatArray, torque: FloatArray, error: FloatArray, surface: DampingSurface) -> Estimate:
    """Weighted straight line of ln B on ln w; the scatter is that of the whole surface."""
    z, y = np.log(speed), np.log(torque / speed)
    weight = 1.0 / np.maximum(error, 1e-9) ** 2
    centred = z - np.average(z, weights=weight)
    spread = float(np.sum(weight * centred**2))
    slope, deviation = float(np.sum(weight * centred * y)) / spread, spread**-0.5
    reach = float(stats.t.ppf(0.5 + CONFIDENCE / 2, _freedom(surface))) * deviation
    return Estimate(slope, deviation, slope - reach, slope + reach)


def _verdict(surface: DampingSurface, tested: tuple[Hypothesis, ...]) -> str:
    kept = [h.name for h in tested if h.consistent]
    c = _in_words(surface.c)
    agrees = f"agrees with {' and '.join(kept)}" if kept else _between(surface.c.value)
    if surface.transition is None:
        if "falling branch" in kept and surface.c.high < -1.0:
            return (
                f"Torque falls as speed rises over the whole range (damping exponent {c}): mixed or boundary "
                "lubrication, where the drive can stick and slip."
            )
        return (
            f"Damping varies as speed to the power {c}, which {agrees}. "
            "No transition to a falling branch shows in these data."
        )
    t = surface.transition
    where = f"{rpm(t.speed.value):.3g} rpm [{rpm(t.speed.low):.3g}, {rpm(t.speed.high):.3g}]"
    if t.gradual:
        where = f"about {rpm(t.least_torque_speed):.2g} rpm"
    if surface.reference_temperature is not None:
        where += f" at {surface.reference_temperature:.0f} {surface.temperature_scale}"
        where += ", higher when hotter" if t.temperature_exponent > 0 else ""
    least = ", where torque is least," if t.gradual else ""
    return (
        f"Above {where}{least} torque rises with speed, as under a carrying film: damping varies as speed to "
        f"the power {c}, which {agrees}. Below it torque rises as the drive slows (exponent "
        f"{_in_words(t.mixed_exponent)}, below -1): mixed lubrication, where the drive can stick and slip."
    )


def _in_words(e: Estimate) -> str:
    digits = int(np.clip(1 - np.floor(np.log10(max(e.high - e.low, 1e-4))), 2, 4))
    return f"{e.value:.{digits}f} [{e.low:.{digits}f}, {e.high:.{digits}f}]"


def _between(c: float) -> str:
    above = [h for h in HYPOTHESES if h[1] > c]
    below = [h for h in HYPOTHESES if h[2] < c]
    if above and below:
        return f"agrees with no named regime: it lies between {above[-1][0]} and {below[0][0]}"
    return "agrees with no named regime"
