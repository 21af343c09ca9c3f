"""Shapes of drag curves: drag against speed, with one minimum at speed 1 and drag 1.

A shape takes two relative speeds, that of the boundary part and that of the film part. They differ only
where the boundary part does not depend on temperature. Each shape has its parameters drawn at random.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import minimize_scalar

Shape = Callable[[float, float], float]
Random = np.random.Generator

#: Mean torque of drive 1 of github RViMLab/TRO2021-Dynamic-Modelling (MIT; IEEE T-RO 37(4), 2021): rpm, and
#: % of 9.84 mN m as the mean of both directions of rotation. The points at 50 and 60 rpm are omitted, so that
#: there is one minimum.
MEASURED = (
    (2, 32.09),
    (10, 31.45),
    (20, 30.78),
    (30, 29.95),
    (40, 29.35),
    (70, 29.33),
    (80, 29.80),
    (90, 30.22),
    (100, 30.37),
    (120, 31.71),
    (140, 32.78),
    (200, 36.26),
)
#: Range of relative speed in which a minimum is searched.
_SEARCHED = (1e-3, 1e3)
#: Points of that search.
_SEARCH_POINTS = 600


def log_uniform(random: Random, low: float, high: float) -> float:
    """Draw a number whose logarithm is uniform between two bounds."""
    return math.exp(random.uniform(math.log(low), math.log(high)))


def minimum(curve: Callable[[float], float], low: float, high: float) -> float:
    """Return the speed at which a curve is lowest, between two speeds."""
    grid = np.linspace(math.log(low), math.log(high), _SEARCH_POINTS)
    best = int(np.argmin([curve(math.exp(x)) for x in grid.tolist()]))
    bounds = grid[max(best - 1, 0)], grid[min(best + 1, _SEARCH_POINTS - 1)]
    found = minimize_scalar(
        lambda x: curve(math.exp(x)), bounds=bounds, method="bounded", options={"xatol": 1e-10}
    )
    return math.exp(float(found.x))


def corner(rising: float, falling: float) -> Shape:
    """Return two power laws that meet in a sharp corner."""
    return lambda boundary, film: max(boundary**falling, film**rising)


def p_norm(p: float, rising: float, falling: float) -> Shape:
    """Return the p-norm of two power laws, whose minimum is rounded (physics.md, section 7)."""
    w = -falling / (rising - falling)
    up, down = rising * p, falling * p
    return lambda boundary, film: (w * film**up + (1.0 - w) * boundary**down) ** (1.0 / p)


def exponential(excess: float, power: float, viscous: float) -> Shape:
    """Return the Stribeck curve with an exponential fall above Coulomb friction, and viscous friction."""
    return lambda boundary, film: 1.0 + excess * math.exp(-(boundary**power)) + viscous * film


def sigmoid(excess: float, steepness: float, film_force: float, rising: float, *, error: bool) -> Shape:
    """Return a fall in ln(speed) that follows tanh or the error function, and a rising power law."""
    fall = math.erf if error else math.tanh

    def force(boundary: float, film: float) -> float:
        return (
            1.0
            + 0.5 * excess * (1.0 - fall(steepness * math.log(boundary)))
            + film_force * math.pow(film, rising)
        )

    return force


def saturating(power: float, film_force: float, rising: float) -> Shape:
    """Return boundary friction that levels off at low speed, and a film that follows a power law."""
    return lambda boundary, film: 1.0 / (1.0 + boundary**power) + film_force * math.pow(film, rising)


def mixed_contact(decay: float, film_force: float, rising: float) -> Shape:
    """Return a contact whose asperities carry exp(-c lambda) of the load, lambda = (eta v)^0.6."""

    def force(_boundary: float, film: float) -> float:
        share = math.exp(-decay * film**0.6)
        return share + (1.0 - share) * film_force * math.pow(film, rising)

    return force


def table(speeds: list[float], forces: list[float]) -> Shape:
    """Return a monotone cubic through points in log-log; power laws continue it at both ends."""
    x, y = np.log(speeds), np.log(forces)
    knots, cubics = x.tolist(), PchipInterpolator(x, y).c.T.tolist()
    first, last = (y[1] - y[0]) / (x[1] - x[0]), (y[-1] - y[-2]) / (x[-1] - x[-2])
    start, end = (float(x[0]), float(y[0])), (float(x[-1]), float(y[-1]))

    def force(_boundary: float, film: float) -> float:
        at = math.log(film)
        if at <= start[0]:
            return math.exp(start[1] + first * (at - start[0]))
        if at >= end[0]:
            return math.exp(end[1] + last * (at - end[0]))
        piece = bisect_right(knots, at) - 1
        a, b, c, d = cubics[piece]
        u = at - knots[piece]
        return math.exp(((a * u + b) * u + c) * u + d)

    return force


@dataclass(frozen=True)
class Curve:
    """A drag curve at a reference temperature: a shape, its scales, and what varies with temperature."""

    family: str
    shape: Shape
    force: float  #: least drag, N
    speed: float  #: speed of least drag, m/s
    boundary_fixed: bool = False  #: whether the boundary part does not depend on temperature

    def at(self, shift: float) -> Callable[[float], float]:
        """Return drag against speed where viscosity is 1/shift of that at the reference temperature."""
        shape, force, film = self.shape, self.force, self.speed * shift
        boundary = self.speed if self.boundary_fixed else film
        return lambda speed: force * shape(speed / boundary, speed / film)


def _drawn_corner(random: Random) -> Shape:
    return corner(random.uniform(0.25, 0.5), -random.uniform(0.15, 0.7))


def _drawn_p_norm(random: Random) -> Shape:
    p = float(random.choice([1, 2, 4, 8]))
    return p_norm(p, random.uniform(0.25, 0.5), -random.uniform(0.15, 0.7))


def _drawn_exponential(random: Random) -> Shape:
    excess, power = log_uniform(random, 0.3, 3.0), random.uniform(0.5, 2.0)
    return exponential(excess, power, log_uniform(random, 0.03, 0.3))


def _drawn_sigmoid(random: Random) -> Shape:
    excess, steepness = log_uniform(random, 0.4, 4.0), random.uniform(0.5, 1.5)
    film, rising = log_uniform(random, 0.05, 0.5), random.uniform(0.3, 1.0)
    return sigmoid(excess, steepness, film, rising, error=random.random() < 0.5)


def _drawn_saturating(random: Random) -> Shape:
    film = log_uniform(random, 0.05, 0.5)
    return saturating(random.uniform(0.6, 1.5), film, random.uniform(0.25, 0.6))


def _drawn_mixed_contact(random: Random) -> Shape:
    return mixed_contact(1.0, log_uniform(random, 0.03, 0.3), random.uniform(0.25, 0.6))


def _drawn_table(random: Random) -> Shape:
    """Draw an irregular table: a rounded curve whose slope wiggles, with one minimum."""
    base = p_norm(random.uniform(1.0, 3.0), random.uniform(0.25, 0.5), -random.uniform(0.15, 0.7))
    steps = random.uniform(0.5, 1.5, size=14)
    x = np.concatenate([[0.0], np.cumsum(steps)])
    x = math.log(0.004) + x * (math.log(60.0 / 0.004) / x[-1])
    slopes = np.diff([math.log(base(v, v)) for v in np.exp(x).tolist()])
    wiggled = slopes * np.exp(0.4 * random.standard_normal(slopes.size))
    y = np.concatenate([[0.0], np.cumsum(wiggled)])
    return table(np.exp(x).tolist(), np.exp(y).tolist())


def _drawn_measured(random: Random) -> Shape:
    """Return the measured curve, with its fall and its rise stretched by a factor."""
    speeds, forces = (list(column) for column in zip(*MEASURED, strict=True))
    power = log_uniform(random, 1.0, 6.0)
    return table([float(v) for v in speeds], [float(f) ** power for f in forces])


#: Families of shapes by name, each with the function that draws one.
FAMILIES: dict[str, Callable[[Random], Shape]] = {
    "corner": _drawn_corner,
    "p-norm": _drawn_p_norm,
    "exponential": _drawn_exponential,
    "sigmoid": _drawn_sigmoid,
    "saturating": _drawn_saturating,
    "mixed contact": _drawn_mixed_contact,
    "irregular table": _drawn_table,
    "measured table": _drawn_measured,
}
#: Families whose boundary part is a term of its own, which may be independent of temperature.
SEPARABLE = ("corner", "p-norm", "exponential", "sigmoid", "saturating")


def draw(random: Random, force: float, speed: float, family: str = "mixed") -> Curve:
    """Draw a curve whose least drag is the force given, at the speed given; of any family if it is mixed."""
    any_family = str(random.choice(list(FAMILIES)))
    family = any_family if family == "mixed" else family
    shape = FAMILIES[family](random)
    fixed = family in SEPARABLE and random.random() < 0.25
    return Curve(family, _normalized(shape), force, speed, fixed)


def _normalized(shape: Shape) -> Shape:
    """Return the shape with its minimum at speed 1 and drag 1."""
    scale = minimum(lambda v: shape(v, v), *_SEARCHED)
    least = shape(scale, scale)
    return lambda boundary, film: shape(boundary * scale, film * scale) / least
