"""A layer that side flow and evaporation thin at once: dh/dz = -((1 - q) h^3 + q), h(0) = 1.

z is age times the relative rate at which the new layer thins, q the share of evaporation in that; side flow
goes as h^3 (van Zoelen, Venner, Lugt, Proc. IMechE J 223 (2009) 541), evaporation takes the same from the
free surface whatever lies below. The age of a thickness is a closed form; the thickness at an age is read
from a table of it.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy import special

from hersey.arrays import FloatArray

#: logit q of the table: ends and steps; columns from the new layer to the dry one.
_END, _ROWS, _COLUMNS = 8.0, 321, 257
#: Thinnest layer, and greatest logarithm of age times rate.
_DRY, _GREATEST = 1e-12, 30.0


def dried_age(x: FloatArray, y: FloatArray, a: FloatArray) -> FloatArray:
    """Return the age at which 1/h has grown by exp(y); exp(x) is the rate, a[0] logit q."""
    return _thinned(np.exp(-y), np.clip(a[0], -_END, _END)) * np.exp(-x)


def dried(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    """Return ln (1/h) at age t."""
    z = np.exp(np.minimum(x, _GREATEST)) * t
    row = (np.clip(a[0], -_END, _END) + _END) * ((_ROWS - 1) / (2.0 * _END))
    above = np.minimum(row.astype(np.intp), _ROWS - 2)
    share = row - above
    end = _ends()
    dry = np.exp(end[above] * (1.0 - share) + end[above + 1] * share)
    left = 1.0 - z / dry
    column = np.minimum(np.log1p(np.maximum(z, 0.0)) / np.log1p(dry), 1.0) * (_COLUMNS - 1)
    before = np.minimum(column.astype(np.intp), _COLUMNS - 2)
    part = column - before
    flat, place = _table().ravel(), above * _COLUMNS + before
    low = flat.take(place) * (1.0 - part) + flat.take(place + 1) * part
    place = place + _COLUMNS
    high = flat.take(place) * (1.0 - part) + flat.take(place + 1) * part
    return np.asarray(-(low + share * (high - low)) - np.log(np.maximum(left, _DRY)))


def dried_slope(x: FloatArray, t: FloatArray, a: FloatArray) -> FloatArray:
    """Return the derivative of `dried` by x."""
    h, q = np.exp(-dried(x, t, a)), special.expit(np.clip(a[0], -_END, _END))
    return np.asarray(np.exp(np.minimum(x, _GREATEST)) * t * ((1.0 - q) * h**2 + q / h))


def _thinned(h: FloatArray, logit: FloatArray) -> FloatArray:
    """Age times rate when the layer is h: the integral of 1 / ((1 - q) h^3 + q) from h to 1."""
    # In partial fractions of 1 / (h^3 + k^3).
    k = np.exp(logit / 3.0)
    root = np.sqrt(3.0)

    def upto(h: FloatArray | float) -> FloatArray:
        bent = np.log((h + k) / np.sqrt(h**2 - h * k + k**2))
        return np.asarray((bent + root * np.arctan((2.0 * h - k) / (k * root))) / (3.0 * k**2))

    return (upto(1.0) - upto(h)) / special.expit(-logit)


def _logits() -> FloatArray:
    return np.linspace(-_END, _END, _ROWS)


@lru_cache(maxsize=1)
def _ends() -> FloatArray:
    """Logarithm of z at which the layer is dry, per row."""
    return np.asarray(np.log(_thinned(np.array(0.0), _logits())))


@lru_cache(maxsize=1)
def _table() -> FloatArray:
    """Logarithm of h over the share of life left: rows of logit q, columns even in ln(1 + z)."""
    h = np.concatenate([np.linspace(0.0, 0.02, 200)[:-1], np.geomspace(0.02, 1.0, 1200)])
    even = np.linspace(0.0, 1.0, _COLUMNS)
    rows = []
    for logit, end in zip(_logits(), np.exp(_ends()), strict=True):
        z = _thinned(h, logit)
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.log(h) - np.log1p(-z / end)
        values[0] = np.log(special.expit(logit) * end)
        # Close to dry both logarithms are large and their difference is as at the end.
        values[1:4] = values[0]
        values[-1] = 0.0
        rows.append(np.interp(even * np.log1p(end), np.log1p(z)[::-1], values[::-1]))
    return np.array(rows)
