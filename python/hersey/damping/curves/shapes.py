"""Shapes of drag curves: ln torque over ln Hersey number, vectorised over draws of their numbers.

A shape takes x = ln(H/H_at), shape (draws, points), and its own numbers, shape (draws, numbers). Numbers that
must be positive are kept as logarithms. ``up`` is the exponent of force in speed on the rising side, ``down``
minus that on the falling side.

==========  ==============================================================  ==========================
shape       F / F_ref                                                       limits
==========  ==============================================================  ==========================
sharp       two powers that meet in a corner (Eqs. 20-23 of the paper)      p to infinity of ``blend``
blend       [w x^(up p) + (1 - w) x^(-down p)]^(1/p), least at x = 1        the same branches far off
stribeck    1 + exp(peak - x^decay) + exp(film) x^up                        Coulomb friction between
saturating  1/(1 + x^fall) + exp(floor) + exp(film) x^up                    constant at rest
plus        exp(floor) + x^up                                               never falls
free        ``blend`` times a smooth curve without a formula                any
==========  ==============================================================  ==========================

Stribeck peak: Armstrong-Helouvry, Dupont and Canudas de Wit, Automatica 30 (1994) 1083.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray

#: Sharpness that stands for a corner.
_CORNER = 60.0
#: Exponents are bounded, so that no draw overflows.
_BOUND = 40.0


@dataclass(frozen=True)
class Prior:
    """A normal prior of one number of a shape."""

    name: str
    mean: float
    deviation: float


@dataclass(frozen=True)
class Shape:
    """A family of curves: its name, what it is called, and the priors of its numbers."""

    name: str
    words: str
    priors: tuple[Prior, ...]
    curve: Callable[[FloatArray, FloatArray], FloatArray]
    residual: float = 0.0  #: standard deviation of the smooth curve that multiplies it, relative
    falls: bool = True  #: whether force falls anywhere


_UP = Prior("ln up", float(np.log(0.4)), 0.5)
_DOWN = Prior("ln down", float(np.log(0.5)), 0.8)
_SHARPNESS = Prior("ln p", float(np.log(3.0)), 0.9)


def _exp(value: FloatArray) -> FloatArray:
    return np.exp(np.clip(value, -_BOUND, _BOUND))


def _norm(x: FloatArray, up: FloatArray, down: FloatArray, p: FloatArray | float) -> FloatArray:
    """Ln of the p-norm of the two powers whose least value is 1, at x = 0."""
    rising = np.log(down / (up + down)) + up * p * x
    falling = np.log(up / (up + down)) - down * p * x
    return np.asarray(np.logaddexp(rising, falling) / p)


def _sharp(x: FloatArray, n: FloatArray) -> FloatArray:
    return _norm(x, _exp(n[:, :1]), _exp(n[:, 1:2]), _CORNER)


def _blend(x: FloatArray, n: FloatArray) -> FloatArray:
    return _norm(x, _exp(n[:, :1]), _exp(n[:, 1:2]), _exp(np.clip(n[:, 2:3], -2.0, 5.0)))


def _stribeck(x: FloatArray, n: FloatArray) -> FloatArray:
    up, peak, film, decay = (n[:, i : i + 1] for i in range(4))
    falling = np.clip(peak, -_BOUND, _BOUND) - _exp(_exp(np.clip(decay, -2.0, 2.0)) * x)
    slow = np.logaddexp(0.0, np.maximum(falling, -300.0))
    return np.asarray(np.logaddexp(slow, film + _exp(up) * x))


def _saturating(x: FloatArray, n: FloatArray) -> FloatArray:
    up, fall, film, floor = (n[:, i : i + 1] for i in range(4))
    boundary = -np.logaddexp(0.0, _exp(np.clip(fall, -3.0, 2.0)) * x)
    return np.asarray(np.logaddexp(np.logaddexp(boundary, floor), film + _exp(up) * x))


def _plus(x: FloatArray, n: FloatArray) -> FloatArray:
    return np.asarray(np.logaddexp(n[:, 1:2], _exp(n[:, :1]) * x))


_FILM, _FLOOR = Prior("ln film", -1.5, 1.5), Prior("ln floor", -2.0, 1.5)
#: A law with Coulomb friction has a film that rises faster than one without.
_FILM_UP = Prior("ln up", float(np.log(0.6)), 0.5)

SHARP = Shape("sharp", "two power laws with a corner", (_UP, _DOWN), _sharp)
BLEND = Shape("blend", "two power laws with a smooth bend", (_UP, _DOWN, _SHARPNESS), _blend)
STRIBECK = Shape(
    "stribeck",
    "exponential Stribeck curve",
    (_FILM_UP, Prior("ln peak", 0.0, 1.2), _FILM, Prior("ln decay", 0.1, 0.5)),
    _stribeck,
)
SATURATING = Shape(
    "saturating",
    "boundary friction that saturates, plus a film",
    (_FILM_UP, Prior("ln fall", 0.0, 0.6), _FILM, _FLOOR),
    _saturating,
)
PLUS = Shape("plus", "constant {quantity} plus a power of speed", (_FILM_UP, _FLOOR), _plus, falls=False)
FREE = tuple(
    Shape("free", f"smooth curve without a formula ({100 * size:.0f} %)", BLEND.priors, _blend, size)
    for size in (0.03, 0.10)
)
#: All shapes, the simplest first.
SHAPES = (PLUS, SHARP, BLEND, STRIBECK, SATURATING, *FREE)
