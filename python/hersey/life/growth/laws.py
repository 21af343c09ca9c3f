"""How a positive indicator may grow with age: its logarithm over that of the new specimen, ln G.

Each law has a size x = ln(r T) of its specimen (ln s of one that ends) and may have a shape that all
specimens share. Ages are in T, the greatest age of the data. Torque is proportional to 1/h of a layer of oil
(`oil_layer`). Side flow alone thins it as h = (h0^-2 + K t)^(-1/2); a steady loss, h0 - e t, is the curved
law at c = -1.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy import special

from hersey.arrays import FloatArray
from hersey.life.oil_layer import age_of_layer, log_layer

#: Greatest size: beyond it growth is as good as infinite.
_GREATEST = 30.0
#: Least value under a logarithm: where a layer has dried out, the indicator is as good as infinite.
_DRY = 1e-12
#: Steps to an age at the most, and how near it, relative, they end.
_TURNS, _NEAR = 30, 1e-9
#: Curvature below which the curved law is taken as exponential.
_STRAIGHT = 1e-5

Form = Callable[[FloatArray, FloatArray, FloatArray], FloatArray]
Sloped = Callable[[FloatArray, FloatArray, FloatArray], tuple[FloatArray, FloatArray]]


class Law(NamedTuple):
    """A law of growth; its functions take size, age and shapes, which broadcast from the second axis on."""

    name: str
    formula: str
    log_growth: Form  #: ln G
    sloped: Sloped  #: ln G and its derivative by the size
    age: Form  #: age at which ln G is the second argument; infinite where it never is
    shapes: tuple[tuple[str, float, float], ...] = ()  #: name, mean and standard deviation of each prior
    grows: bool = True
    falls_by: Callable[[FloatArray], FloatArray] | None = None  #: how far ln G may fall at first, of shapes
    ends: bool = False  #: growth ends; its size is the logarithm of the whole growth


def _rise(x: FloatArray, t: FloatArray) -> FloatArray:
    return np.asarray(np.exp(np.minimum(x, _GREATEST)) * t)


def _linear(z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Logarithm of 1 + z, and its derivative by that of z."""
    return np.log1p(z), z / (1.0 + z)


def _side_flow(x: FloatArray, t: FloatArray, _: FloatArray) -> tuple[FloatArray, FloatArray]:
    grown, slope = _linear(_rise(x, t))
    return 0.5 * grown, 0.5 * slope


def _full(t: FloatArray, a: FloatArray) -> FloatArray:
    """How much of a saturating growth has come."""
    return np.asarray(-np.expm1(-t * np.exp(-a[0])))


def _saturating_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    left = 1.0 - np.expm1(y) * np.exp(-x)
    return np.where(left > 0.0, -np.exp(a[0]) * np.log(np.where(left > 0.0, left, 1.0)), np.inf)


def _bent(a: FloatArray) -> FloatArray:
    return np.asarray(np.where(np.abs(a[0]) < _STRAIGHT, _STRAIGHT, a[0]))


def _curved(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    z, bent = _rise(x, t), _bent(a)
    return np.log(np.maximum(1.0 + bent * z, _DRY)) / bent


def _curved_sloped(x: FloatArray, t: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    z, bent = _rise(x, t), _bent(a)
    left = np.maximum(1.0 + bent * z, _DRY)
    return np.log(left) / bent, z / left


def _curved_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    bent = _bent(a)
    return np.expm1(bent * y) / bent * np.exp(-x)


def _dried_rates(x: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The new layer, K and e of one that thins at the rate exp(x) when new, q of it by evaporation."""
    rate, evaporated = np.exp(np.minimum(x, _GREATEST)), special.expit(a[0])
    return np.ones(()), 2.0 * (1.0 - evaporated) * rate, evaporated * rate


def _dried(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    return -log_layer(*_dried_rates(x, a), t)


def _dried_sloped(x: FloatArray, t: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    new, side_flow, evaporation = _dried_rates(x, a)
    layer = log_layer(new, side_flow, evaporation, t)
    return -layer, t * (0.5 * side_flow * np.exp(2.0 * layer) + evaporation)


def _dried_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    return age_of_layer(*_dried_rates(x, a), -y)


def _rested(law: Law) -> Law:
    """The law of a drag of which a share p grows so and the rest stays; logit p is the last shape."""

    def log_growth(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
        return np.asarray(np.log1p(special.expit(a[-1]) * np.expm1(law.log_growth(x, t, a))))

    def sloped(x: FloatArray, t: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
        share, (whole, slope) = special.expit(a[-1]), law.sloped(x, t, a)
        more = share * np.expm1(whole)
        return np.log1p(more), (share + more) / (1.0 + more) * slope

    def age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
        return law.age(x, np.log1p(np.expm1(y) / special.expit(a[-1])), a)

    return Law(law.name, law.formula, log_growth, sloped, age, (*law.shapes, ("logit p", 1.0, 1.0)))


def _power_of_age(x: FloatArray, t: FloatArray, m: FloatArray) -> FloatArray:
    return np.asarray(np.exp(np.minimum(m * x, _GREATEST)) * t**m)


def _power(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    return np.log1p(_power_of_age(x, t, np.exp(a[0])))


def _power_sloped(x: FloatArray, t: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    m = np.exp(a[0])
    grown, slope = _linear(_power_of_age(x, t, m))
    return grown, m * slope


def _power_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    return np.asarray(np.expm1(y) ** np.exp(-a[0]) * np.exp(-x))


def _come(t: FloatArray, a: FloatArray) -> FloatArray:
    """How much has come of a growth that sets in as a power of age and ends."""
    with np.errstate(divide="ignore"):
        return np.asarray(special.expit(np.exp(a[1]) * (np.log(t) - a[0])))


def _sigmoid(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    return np.asarray(np.exp(np.minimum(x, _GREATEST)) * _come(t, a))


def _sigmoid_sloped(x: FloatArray, t: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    return (_sigmoid(x, t, a),) * 2


def _sigmoid_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    part = y * np.exp(-x)
    held = np.where(part < 1.0, part, 0.0)
    return np.where(part < 1.0, (held / (1.0 - held)) ** np.exp(-a[1]) * np.exp(a[0]), np.inf)


def _run_in(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    return np.asarray(np.log1p(_power_of_age(x, t, np.exp(a[2])) - special.expit(a[1]) * _full(t, a)))


def _run_in_sloped(x: FloatArray, t: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    m = np.exp(a[2])
    grown = _power_of_age(x, t, m)
    left = grown - special.expit(a[1]) * _full(t, a)
    return np.log1p(left), m * grown / (1.0 + left)


def _run_in_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    """Newton's method from the age at which all of the run-in has come: growth is not yet there before."""
    m, share, pace, need = np.exp(a[2]), special.expit(a[1]), np.exp(-a[0]), np.expm1(y)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        early, late = need ** (1.0 / m) * np.exp(-x), (need + share) ** (1.0 / m) * np.exp(-x)
        at = late + 0.0 * early
        for _ in range(_TURNS):
            grown, left = np.exp(np.minimum(m * x, _GREATEST)) * at**m, np.exp(-pace * at)
            over = grown - share * (1.0 - left) - need
            step = over / (m * grown / at - share * pace * left)
            at = np.clip(np.where(np.isfinite(step), at - step, early), early, late)
            if not (np.abs(step) > _NEAR * at).any():
                break
    return np.asarray(at)


def _settled(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    part = -np.expm1(-np.exp(a[1]) * np.log1p(t * np.exp(-a[0])))
    return np.log1p(_rise(x, part))


def _settled_sloped(x: FloatArray, t: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    return _linear(np.expm1(_settled(x, t, a)))


def _settled_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    left = 1.0 - np.expm1(y) * np.exp(-x)
    held = np.where(left > 0.0, left, 1.0)
    return np.where(left > 0.0, np.exp(a[0]) * np.expm1(-np.log(held) * np.exp(-a[1])), np.inf)


def _never(x: FloatArray, y: FloatArray, _: FloatArray) -> FloatArray:
    return np.where(np.asarray(y) > 0.0, np.inf, 0.0) + 0.0 * x


def _constant(x: FloatArray, t: FloatArray, _: FloatArray) -> FloatArray:
    return 0.0 * (x + t)


LAWS = (
    Law("constant", "1", _constant, lambda *at: (_constant(*at), _constant(*at)), _never, grows=False),
    Law(
        "side flow",
        "sqrt(1 + r t)",
        lambda x, t, _: 0.5 * np.log1p(_rise(x, t)),
        _side_flow,
        lambda x, y, _: np.expm1(2.0 * y) * np.exp(-x),
    ),
    Law(
        "linear",
        "1 + r t",
        lambda x, t, _: np.log1p(_rise(x, t)),
        lambda x, t, _: _linear(_rise(x, t)),
        lambda x, y, _: np.expm1(y) * np.exp(-x),
    ),
    Law(
        "exponential",
        "exp(r t)",
        lambda x, t, _: _rise(x, t),
        lambda x, t, _: (_rise(x, t),) * 2,
        lambda x, y, _: y * np.exp(-x),
    ),
    Law(
        "saturating",
        "1 + s (1 - exp(-t/tau))",
        lambda x, t, a: np.log1p(_rise(x, _full(t, a))),
        lambda x, t, a: _linear(_rise(x, _full(t, a))),
        _saturating_age,
        (("ln(tau/T)", 0.3, 1.0),),
        ends=True,
    ),
    Law("curved", "(1 + c r t)^(1/c)", _curved, _curved_sloped, _curved_age, (("c", 0.5, 1.0),)),
    _rested(
        Law(
            "drying film",
            "1 - p + p/h, h' = -r ((1 - q) h^3 + q h)",
            _dried,
            _dried_sloped,
            _dried_age,
            (("logit q", -1.0, 1.5),),
        )
    ),
    Law("power", "1 + (r t)^m", _power, _power_sloped, _power_age, (("ln m", 0.3, 0.4),)),
    Law(
        "sigmoid",
        "exp(s z / (1 + z)), z = (t/tau)^m",
        _sigmoid,
        _sigmoid_sloped,
        _sigmoid_age,
        (("ln(tau/T)", 0.0, 0.7), ("ln m", 0.7, 0.5)),
        ends=True,
    ),
    Law(
        "run-in",
        "1 - d (1 - exp(-t/tau)) + (r t)^m",
        _run_in,
        _run_in_sloped,
        _run_in_age,
        (("ln(tau/T)", -2.0, 1.0), ("logit d", -2.0, 1.0), ("ln m", 0.3, 0.4)),
        falls_by=lambda a: -np.log(special.expit(-a[1])),
    ),
)

#: A law that settles as slowly as a power of age: none of an indicator over specimens, but of one record.
SETTLING = Law(
    "slow",
    "1 + s (1 - (1 + t/tau)^-m)",
    _settled,
    _settled_sloped,
    _settled_age,
    (("ln(tau/T)", 0.3, 1.0), ("ln m", 0.0, 0.5)),
)
