"""Laws of ages at failure on the axis of ln age: Weibull, lognormal and gamma, each of two parameters.

All are ``ln age = m + x``, where x depends on one shape k alone. For the Weibull law exp(m) is the scale
and k the shape; for the lognormal law exp(m) is the median and 1/k the deviation of ln age; for the gamma
law exp(m) is the scale and k the shape. Functions take x and k as arrays that broadcast.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.special import gammainc, gammaincc, gammaincinv, gammaln, log_ndtr, ndtri

from hersey.arrays import FloatArray
from hersey.errors import ParameterError

LawName = Literal["weibull", "lognormal", "gamma"]
_HALF_LOG_2PI = 0.5 * np.log(2 * np.pi)
#: Arguments of exponentials are held below this.
_GREATEST = 600.0
_Function = Callable[[FloatArray, FloatArray], FloatArray]


@dataclass(frozen=True)
class Distribution:
    """A law of ages: logarithms of density (of ln age), of survival and of the share failed; and quantiles.

    ``quantile`` takes shares and k and returns x. ``title`` is the name in sentences; ``parameters`` names
    shape and scale as they are shown. ``is_pivotal``: m and 1/k are location and scale of ln age.
    """

    name: LawName
    title: str
    parameters: tuple[str, str]
    log_density: _Function
    log_survival: _Function
    log_failed: _Function
    quantile: _Function
    is_pivotal: bool


def _power(x: FloatArray, k: FloatArray) -> FloatArray:
    return np.asarray(np.exp(np.minimum(k * x, _GREATEST)))


def _weibull_density(x: FloatArray, k: FloatArray) -> FloatArray:
    return np.asarray(np.log(k) + k * x - _power(x, k))


def _weibull_failed(x: FloatArray, k: FloatArray) -> FloatArray:
    return np.asarray(np.log(-np.expm1(-np.maximum(_power(x, k), 1e-300))))


def _normal_density(x: FloatArray, k: FloatArray) -> FloatArray:
    return np.asarray(np.log(k) - 0.5 * (k * x) ** 2 - _HALF_LOG_2PI)


def _gamma_density(x: FloatArray, k: FloatArray) -> FloatArray:
    return np.asarray(k * x - np.exp(np.minimum(x, _GREATEST)) - gammaln(k))


def _gamma_survival(x: FloatArray, k: FloatArray) -> FloatArray:
    x = np.minimum(x, _GREATEST)
    age = np.exp(x)
    share = np.asarray(gammaincc(k, age))
    # Far out the share is below the least number; there the density over 1 - (k - 1)/age holds.
    far = (k - 1) * x - age - gammaln(k) - np.log1p(np.clip((1 - k) / np.maximum(age, 1e-300), -0.99, 1.0))
    with np.errstate(divide="ignore"):
        return np.where(share > 1e-290, np.log(share), far)


def _gamma_failed(x: FloatArray, k: FloatArray) -> FloatArray:
    share = np.asarray(gammainc(k, np.exp(np.minimum(x, _GREATEST))))
    with np.errstate(divide="ignore"):
        return np.where(share > 1e-290, np.log(share), k * x - gammaln(k + 1))


WEIBULL = Distribution(
    "weibull",
    "Weibull",
    ("shape", "scale"),
    _weibull_density,
    lambda x, k: -_power(x, k),
    _weibull_failed,
    lambda share, k: np.log(-np.log1p(-share)) / k,
    is_pivotal=True,
)
LOGNORMAL = Distribution(
    "lognormal",
    "lognormal",
    ("sigma", "median"),
    _normal_density,
    lambda x, k: np.asarray(log_ndtr(-k * x)),
    lambda x, k: np.asarray(log_ndtr(k * x)),
    lambda share, k: np.asarray(ndtri(share)) / k,
    is_pivotal=True,
)
GAMMA = Distribution(
    "gamma",
    "gamma",
    ("shape", "scale"),
    _gamma_density,
    _gamma_survival,
    _gamma_failed,
    lambda share, k: np.log(np.maximum(gammaincinv(k, share), 1e-300)),
    is_pivotal=False,
)
DISTRIBUTIONS: dict[str, Distribution] = {each.name: each for each in (WEIBULL, LOGNORMAL, GAMMA)}


def distribution_named(name: str) -> Distribution:
    """Return a law by its name.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    if name not in DISTRIBUTIONS:
        raise ParameterError(f"law '{name}' is none of {', '.join(DISTRIBUTIONS)}", quantity="law")
    return DISTRIBUTIONS[name]
