"""Speed of a wheel that coasts down, in closed form, with its derivatives.

    dw/dt = -(a + b w + c w^2)

is a Riccati equation: w is the ratio of two numbers that obey a linear one, whose matrix squared is a
multiple of one. So one formula holds for every sign of b^2/4 - a c, and for coefficients that are zero.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray

#: Below this, |square of the rate times time|, hyperbolic functions are taken as their series.
_SMALL = 1e-3


def speeds(law: FloatArray, first: float, time: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the speed at each time after the start, and its derivatives.

    Parameters
    ----------
    law
        Coefficients a, b and c, shape (3,).
    first
        Speed at time 0.
    time
        Shape (rows,), none negative.

    Returns
    -------
    Speed, shape (rows,), and derivatives by a, b, c and the first speed, shape (rows, 4). Speed is 0, and so
    are the derivatives, from where the wheel stands.
    """
    a, b, c = (float(each) for each in law)
    square = b * b / 4.0 - a * c
    cosh, sinh, by_cosh, by_sinh = _even_functions(square, time)
    over = first * (cosh - b / 2.0 * sinh) - a * sinh
    under = cosh + (b / 2.0 + c * first) * sinh
    d_over = first * (by_cosh - b / 2.0 * by_sinh) - a * by_sinh
    d_under = by_cosh + (b / 2.0 + c * first) * by_sinh
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        speed = over / under
        columns = []
        for own_over, own_under, by_square in (
            (-sinh, 0.0 * sinh, -c),
            (-first / 2.0 * sinh, sinh / 2.0, b / 2.0),
            (0.0 * sinh, first * sinh, -a),
        ):
            whole_over, whole_under = own_over + by_square * d_over, own_under + by_square * d_under
            columns.append((whole_over - speed * whole_under) / under)
        columns.append((cosh - b / 2.0 * sinh - speed * c * sinh) / under)
    moving = np.logical_and.accumulate((under > 0) & (over > 0))
    jacobian = np.stack(columns, axis=-1)
    return np.where(moving, speed, 0.0), np.where(moving[:, None], jacobian, 0.0)


def _even_functions(square: float, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Cosh of the rate times time, sinh of it over the rate, and both derivatives by the rate squared.

    All four are scaled by one factor, which keeps them finite; no ratio of them depends on it.
    """
    x = square * time * time
    root = np.sqrt(np.abs(x))
    if square > 0:
        small = np.exp(-2.0 * root)
        cosh, sinh = (1.0 + small) / 2.0, (1.0 - small) / 2.0
        scale = np.exp(-root)
    else:
        cosh, sinh, scale = np.cos(root), np.sin(root), np.ones(root.shape)
    near = np.abs(x) < _SMALL
    with np.errstate(divide="ignore", invalid="ignore"):
        over_rate = np.where(near, scale * (1 + x / 6 + x * x / 120), sinh / np.where(near, 1, root)) * time
        by_sinh = np.where(
            near,
            scale * time**3 * (1 / 6 + x / 60 + x * x / 1680),
            (time * cosh - over_rate) / (2.0 * np.where(near, 1.0, square)),
        )
    cosh = np.where(near, scale * (1 + x / 2 + x * x / 24), cosh)
    return cosh, over_rate, time * over_rate / 2.0, by_sinh
